"""Half precision: how far the half form of each function errs, and where it is of use."""
