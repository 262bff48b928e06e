"""Backends that this project does not ship: vectors for them, and verdicts on what they computed."""
