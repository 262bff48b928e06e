"""Point sequences and hashes, bit-exact on every target, and maps from the unit square."""
