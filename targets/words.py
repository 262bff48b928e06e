"""The arrays that go into and come out of a device."""

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Words: TypeAlias = npt.NDArray[np.uint32]
"""An array (slots, lanes): row k holds the k-th 32-bit word of every lane, whatever its type."""
