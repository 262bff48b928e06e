"""Shells and fins with fake fur as one writes them by hand, for the benchmark only."""
