"""Light from environment maps, in float64: the lecture's estimators and their error against quadrature."""
