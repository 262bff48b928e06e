"""The fold between the two halves of an octahedral map."""

from typing import Annotated

from shaderlib.lang import Interval, f32, helper, vec2


@helper
def octahedral_fold(
    p: Annotated[vec2, Interval(-1.0, 1.0)], amount: Annotated[f32, Interval(-1.0, 1.0)]
) -> vec2:
    """Move both coordinates away from 0 by an amount.

    p        point of the octahedral square, or w.xy
    amount   distance, negative toward 0
    returns  p + s(p) amount with s(x) = 1 for x >= 0, else -1
    form     a comparison: the built-in sign is 0 at 0, which collapses two great circles
    source   derived for this library
    """
    return p + vec2(amount if p.x >= 0.0 else -amount, amount if p.y >= 0.0 else -amount)
