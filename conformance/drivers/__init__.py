"""Conformance on drivers by name: processes of their own, several modes, known failures as data."""
