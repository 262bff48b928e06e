"""Named parameter domains of reflection lobes."""

from typing import Annotated

from shaderlib.constants import ONE_BELOW
from shaderlib.lang import Interval, f32, vec2

# A pair of uniform numbers in [0, 1).
UniformPair = Annotated[vec2, Interval(0.0, ONE_BELOW)]

# Root mean square slope of a rough surface along one axis.
Roughness = Annotated[f32, Interval(1.0e-4, 1.0, scale="log")]

# Half the opening angle of a circular arc, in radians; pi / 2 is a half circle.
Spread = Annotated[f32, Interval(1.0e-3, 1.57079637)]
