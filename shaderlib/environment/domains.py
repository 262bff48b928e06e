"""Named parameter domains of light from environment maps, and the numbers that a map is prepared with."""

from typing import Annotated

from shaderlib.lang import Edges, Interval, Texture, f32, u32

# Half side of each square of a map in units of the disc radius. `vair env` writes maps with the same border.
MAP_BORDER = 1.2

# Samples that an estimator draws at most; what asks for more gets these.
MOST_SAMPLES = 4096

# Density per steradian up to which a sample is left out. Its weight would be no larger than others, but a
# quotient of numbers close to the denormals is unreliable.
SMALLEST_DENSITY = 1.0e-30

# Level of the densest sample below which filtering costs more error than it saves: samples then lie closer
# than half a texel's blur. Measured with 40 samples of a Phong lobe of exponent 1000.
SHARP_LOD = 0.5

# A dual-paraboloid map with its levels: the disc around +z left, the disc around -z right, 2 n by n texels, n
# a power of two, down to one texel per disc.
ParaboloidMap = Annotated[Texture, Edges("clamp", "clamp")]

# Level of a map, 0 for the largest.
Level = Annotated[f32, Interval(0.0, 64.0)]
WholeLevel = Annotated[u32, Interval(0, 17)]

# Share of a disc's side that one texel takes.
TexelShare = Annotated[f32, Interval(1.0e-5, 2.0, scale="log")]

# Number of samples that an estimator is to draw.
Samples = Annotated[u32, Interval(0, 4096)]
