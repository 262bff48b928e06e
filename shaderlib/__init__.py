"""Vair's single source: shading functions of hair, fur and strands in a typed subset of Python."""
