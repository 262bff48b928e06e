"""Front end: Python's own parser, then name resolution and typing. Nothing of the source is executed."""
