"""Sets of values that functions of factored reflectances accept."""

from typing import Annotated

from shaderlib.lang import Edges, Interval, Texture, vec3

# A factor over parabolic_uv, or a table over strand_table_uv: beyond the edges the outermost texels go on.
FactorMap = Annotated[Texture, Edges("clamp", "clamp")]
AngleTable = Annotated[Texture, Edges("clamp", "clamp")]

# What the product of factors with a peak of 1 is multiplied by; 11.4 in the largest published material.
FactorScale = Annotated[vec3, Interval(0.0, 1.0e6)]
