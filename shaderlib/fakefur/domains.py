"""Named parameter domains of fur coats."""

from typing import Annotated

from shaderlib.lang import Interval, f32

# Number of hairs per unit of skin area.
HairDensity = Annotated[f32, Interval(0.0, 1.0e9, scale="log")]

# Length and radius of one hair, in one unit of length.
HairLength = Annotated[f32, Interval(0.0, 1.0e3, scale="log")]
HairRadius = Annotated[f32, Interval(0.0, 10.0, scale="log")]

# Silhouette area of one hair, in that unit squared.
HairArea = Annotated[f32, Interval(0.0, 2.0e4, scale="log")]

# Optical depth of a coat along a direction; 1e9 stands for "opaque", see fur_optical_depth.
OpticalDepth = Annotated[f32, Interval(0.0, 1.0e9, scale="log")]
