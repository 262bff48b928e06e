"""Do intervals hold the exact value? Decided for millions of points by rigorous float64, else by mpmath."""
