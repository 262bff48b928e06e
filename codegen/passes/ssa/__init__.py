"""Functions as values in single assignment, on which the other passes work."""
