"""Named domains of integers."""

from typing import Annotated

from shaderlib.lang import Finite, u32

# Any of the 2^32 values.
AnyInteger = Annotated[u32, Finite()]
