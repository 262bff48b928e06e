"""Operations over many lanes by loops that are compiled, where that is wanted; else None.

A result is (low, high, look, product): settled ends, whether a lane needs a closer look, and the ends of the
exact product where the table fuses. Only speed depends on what is done here.
"""

from __future__ import annotations

from typing import Any

from codegen.intervals.accuracy import Absolute, Row, Ulp
from codegen.intervals.compiled import ends, kernels
from codegen.intervals.context import Context
from codegen.intervals.numbers import Array
from codegen.intervals.values import Range

Found = tuple[Array, Array, int, "tuple[Array, Array] | None"]
_NEVER_NEAR, _NEVER_FAR = 2.0**-1000, float("inf")


def _lanes(context: Context, *values: Range) -> int:
    """The number of lanes of a result that a compiled loop gives; 0 for none."""
    if context.loops:
        for value in values:
            if len(value.low) > 1:
                return len(value.low)
    return 0


def _ends(x: Range) -> tuple[Any, Any]:
    return ends(x.low, x.high)


def _shared_last(a: Range, b: Range) -> tuple[Range, Range]:
    """Operands of a commutative operation, so that fewer kinds of loops are compiled."""
    return (b, a) if len(a.low) == 1 else (a, b)


def add(context: Context, a: Range, b: Range) -> Found | None:
    """a + b."""
    count = _lanes(context, a, b)
    if not count:
        return None
    a, b = _shared_last(a, b)
    if context.table.rounding == "either":
        low, high, look = kernels().add(*_ends(a), *_ends(b), count)
        return low, high, look, None
    products = [x for x in (a, b) if context.table.fused and x.product is not None]
    if not products:
        if a.is_point and b.is_point:
            near, look = kernels().add_points(_ends(a)[0], _ends(b)[0], count)
            return None if look else (near, near, 0, None)
        low, high, look = kernels().add_nearest(*_ends(a), *_ends(b), count)
        return low, high, look, None
    of, other = (a, b) if products[0] is a else (b, a)
    assert of.product is not None
    low, high, look = kernels().add_fused(*_ends(of), *_ends(other), *ends(*of.product), count)
    if len(products) > 1:
        assert other.product is not None
        look = kernels().fuse(low, high, *_ends(of), *ends(*other.product), count)
    return low, high, look, None


def subtract(context: Context, a: Range, b: Range) -> Found | None:
    """a - b; None as well where it is the sum with -b that has a loop."""
    count = _lanes(context, a, b)
    if not count or context.table.rounding != "either":
        return None
    low, high, look = kernels().subtract(*_ends(a), *_ends(b), count)
    return low, high, look, None


def multiply(context: Context, a: Range, b: Range) -> Found | None:
    """a b; a square where both are one value."""
    count = _lanes(context, a, b)
    if not count:
        return None
    if context.table.rounding == "nearest":
        a, b = _shared_last(a, b)
        if a.is_point and b.is_point:
            exact, near, look = kernels().multiply_points(_ends(a)[0], _ends(b)[0], count)
            return None if look else (near, near, 0, (exact, exact) if context.table.fused else None)
        if a is b:
            return None
        least, most, low, high, look = kernels().multiply_nearest(*_ends(a), *_ends(b), count)
        return low, high, look, (least, most) if context.table.fused else None
    if a is b:
        low, high, look = kernels().square(*_ends(a), count)
    else:
        a, b = _shared_last(a, b)
        low, high, look = kernels().multiply(*_ends(a), *_ends(b), count)
    return low, high, look, None


_ORDERS = {"<": ("less", False), "<=": ("at_most", False), ">": ("at_most", True), ">=": ("less", True)}
"""Comparison -> the loop that decides it, and whether that decides the opposite."""


def compare(context: Context, op: str, a: Range, b: Range) -> tuple[Array, Array, int] | None:
    """Whether a comparison of two different values may hold, may fail, and may do both in a lane."""
    count = _lanes(context, a, b)
    if not count or a is b or op not in _ORDERS:
        return None
    name, opposite = _ORDERS[op]
    true, false, undecided = getattr(kernels(), name)(*_ends(a), *_ends(b), count)
    return (false, true, undecided) if opposite else (true, false, undecided)


def divide(context: Context, row: Row, x: Range, y: Range) -> Found | None:
    """x / y; looked at where the row promises nothing as well."""
    count = _lanes(context, x, y)
    if not count or "x" in row.magnitude or row.normal:
        return None
    assert isinstance(row.accuracy, Ulp)
    low, high, look = kernels().divide(*_ends(x), *_ends(y), row.accuracy.ulps, *_limits(row, "y"), count)
    return low, high, look, None


def _limits(row: Row, operand: str) -> tuple[float, float]:
    """Least and largest magnitude of an operand for which the row promises something."""
    if operand not in row.magnitude:
        return _NEVER_NEAR, _NEVER_FAR
    near, far = row.magnitude[operand]
    return 2.0**near, 2.0**far


def within_ulp(
    context: Context, low: Array, high: Array, ulps_low: float | Array, ulps_high: float | Array
) -> Found | None:
    """Float32 results within some ULP of exact values between two ends."""
    count = _lanes(context, Range(low, high))
    if not count:
        return None
    low, high, look = kernels().within_ulp(low, high, ulps_low, ulps_high, count)
    return low, high, look, None


def absolute_or_ulp(context: Context, promise: Absolute, x: Range, low: Array, high: Array) -> Found | None:
    """Float32 results within an absolute bound where x lies in its interval, within some ULP elsewhere."""
    count = _lanes(context, x)
    if not count or promise.elsewhere is None:
        return None
    low, high, look = kernels().absolute_or_ulp(
        *_ends(x), *ends(low, high), promise.bound, *promise.within, promise.elsewhere.ulps, count
    )
    return low, high, look, None


def square_root(context: Context, x: Range, root: Row, quotient: Row) -> Found | None:
    """1 / (1 / sqrt(x)); looked at where x may be negative as well."""
    count = _lanes(context, x)
    if not count or "x" in quotient.magnitude or root.magnitude:
        return None
    assert isinstance(root.accuracy, Ulp) and isinstance(quotient.accuracy, Ulp)
    low, high, look = kernels().square_root(
        *_ends(x), root.accuracy.ulps, quotient.accuracy.ulps, *_limits(quotient, "y"), count
    )
    return low, high, look, None


def inverse_square_root(context: Context, x: Range, row: Row) -> Found | None:
    """1 / sqrt(x); looked at where x may be 0 or less as well."""
    count = _lanes(context, x)
    if not count:
        return None
    assert isinstance(row.accuracy, Ulp)
    low, high, look = kernels().inverse_square_root(*_ends(x), row.accuracy.ulps, count)
    return low, high, look, None


def sum_of_three(context: Context, terms: list[Range]) -> Range | None:
    """The hull of the sums over all groupings; None where a lane needs a closer look."""
    count = _lanes(context, *terms)
    if not count or context.table.rounding != "either" or len(terms) != 3:
        return None
    if any(t.cause is not None or len(t.low) == 1 for t in terms):
        return None
    a, b, c = terms
    low, high, look = kernels().sum_of_three(a.low, a.high, b.low, b.high, c.low, c.high, count)
    return None if look else Range(low, high)


def scaled_dot(
    context: Context, a: tuple[Range, ...], b: tuple[Range, ...], share: float, epsilon: float
) -> Found | None:
    """The inner product of two vectors of three, off by a share of the largest square of any component."""
    parts = (*a, *b)
    same = [x is y for x, y in zip(a, b, strict=True)]
    if len(a) != 3 or any(same) != all(same) or any(len(x.low) == 1 for x in parts):
        return None
    count = _lanes(context, *parts)
    if not count:
        return None
    every = [end for x in parts for end in (x.low, x.high)]
    low, high, look = kernels().scaled_dot(*every, all(same), share, epsilon, count)
    return low, high, look, None
