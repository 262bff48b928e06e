"""Named parameter domains: types with the set of values that a function accepts."""

from typing import Annotated

from shaderlib.lang import Interval, Length, Unit, f32, vec2, vec3

# A unit vector. Shading directions point away from the shaded point.
Direction = Annotated[vec3, Unit()]

# Linear RGB in [0, 1] per channel: reflectances and colours.
Colour = Annotated[vec3, Interval(0.0, 1.0)]

# A pair of uniform numbers, or texture coordinates.
UnitSquare = Annotated[vec2, Interval(0.0, 1.0)]

UnitInterval = Annotated[f32, Interval(0.0, 1.0)]
Cosine = Annotated[f32, Interval(-1.0, 1.0)]

# Exponent of a highlight. Below 1/2 no scene has one, and the lobe's edge is too steep for any bound.
Exponent = Annotated[f32, Interval(0.0, 1.0e5, scale="log", least=0.5)]

# Exponents that the cheap power forms accept; below the lower end their error grows quickly.
ExponentFrom4 = Annotated[f32, Interval(4.0, 1.0e5, scale="log")]
ExponentFrom8 = Annotated[f32, Interval(8.0, 1.0e5, scale="log")]
ExponentFrom16 = Annotated[f32, Interval(16.0, 1.0e5, scale="log")]

# Defect 1 - x of a cosine x.
CosineDefect = Annotated[f32, Interval(0.0, 2.0)]

# A non-negative quantity of no particular scale: optical depth, argument of e^-x.
NonNegative = Annotated[f32, Interval(0.0, 1.0e30, scale="log")]

# A vector of any direction, the zero vector included.
AnyLength = Annotated[vec3, Length(1.0e-30, 1.0e30)]

# Displacement of a strand tangent along the surface normal.
TangentShift = Annotated[f32, Interval(-2.0, 2.0)]

# Distance below the outer boundary of a coat, in scene units.
Depth = Annotated[f32, Interval(0.0, 1.0e6, scale="log")]

# Extinction per unit length, and a path length: see constants.COAT_LIMIT. A product of two that are positive
# and below 1e-9 is nothing to look at, and denormal numbers are slow enough to hide every difference in cost.
Extinction = Annotated[f32, Interval(0.0, 1.0e18, scale="log", least=1.0e-9)]
PathLength = Annotated[f32, Interval(0.0, 1.0e18, scale="log", least=1.0e-9)]

# Texel of a tangent map, decoded from [0, 1] to [-1, 1].
MapTangent = Annotated[vec3, Interval(-1.0, 1.0)]
