"""Named parameter domains of maps and estimators."""

from typing import Annotated

from shaderlib.lang import Interval, f32

# Texels along one side of a map.
TexelCount = Annotated[f32, Interval(1.0, 65536.0, scale="log")]

# Radius of the coordinate square of a paraboloid map in units of the unit disc; above 1 the map has a rim.
Border = Annotated[f32, Interval(1.0, 2.0)]

# Which half of a dual map: 0 front, 1 back.
MapHalf = Annotated[f32, Interval(0.0, 1.0)]

# Number of samples that an estimator draws.
SampleCount = Annotated[f32, Interval(1.0, 1.0e6, scale="log")]

# Probability density per steradian.
Density = Annotated[f32, Interval(0.0, 1.0e20, scale="log")]

SolidAngle = Annotated[f32, Interval(0.0, 12.6, scale="log")]
