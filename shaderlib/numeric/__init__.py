"""Scalar and vector primitives that stay finite and accurate where the obvious formula does not."""
