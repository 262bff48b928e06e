"""The proof that a reduced function is what was asked for."""
