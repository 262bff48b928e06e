"""Maps of the sphere onto squares, texel solid angles, filtered lookups, weights of combined estimators."""
