"""The inputs that a guarantee is surveyed on: see conformance.check.sample."""

from conformance.check.sample import Sample, rows, together

__all__ = ["Sample", "rows", "together"]
