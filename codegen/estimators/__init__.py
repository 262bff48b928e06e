"""Estimators of what a lobe reflects of an environment map, one function per lobe, from a template.

Neither the shading languages nor the source subset have functions as values: each lobe gets a source file.
"""

from codegen.estimators.sources import estimator_sources

__all__ = ["estimator_sources"]
