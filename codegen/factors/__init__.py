"""Factored reflectance on the host: log-space fits p(v) q(h) p(l), files of samples, Waterloo's format."""
