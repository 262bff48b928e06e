"""Conformance: references, hard cases, value tests on every driver, measured error and speed."""
