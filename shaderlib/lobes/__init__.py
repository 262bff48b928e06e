"""Reflection lobes: value, density and sampler of each, in the local frame with z along the normal."""
