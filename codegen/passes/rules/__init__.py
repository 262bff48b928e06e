"""Simplifications of single values, one family each."""
