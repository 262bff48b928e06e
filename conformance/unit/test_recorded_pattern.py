"""Where a function is an arbitrary pattern, pictures depend on that very pattern: it stays as recorded.

No formula fixes shell_strand_mask, so that nothing else would notice strands that have moved.
"""

from zlib import crc32

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.library import load_library
from conformance.check.engine import draw

RECORDED = {("shell_strand_mask", "uniform"): 0xB0858B77, ("shell_strand_mask", "domain_ends"): 0x5D43A33C}
"""Function, family of points -> CRC-32 of the words of its values at 4000 points with seed 1."""


@pytest.mark.parametrize(("name", "family"), RECORDED)
def test_pattern_is_as_recorded(name: str, family: str) -> None:
    library = load_library()
    values = evaluate(library, name, draw(library.function(name), family, 4000, 1).inputs)
    assert isinstance(values, np.ndarray)
    assert 0.02 < np.mean(values != 0) < 0.98
    assert crc32(np.ascontiguousarray(values).view(np.uint32).tobytes()) == RECORDED[name, family]
