"""Operations over many lanes by loops that are compiled, where that is wanted; else None.

A result is (low, high, look, product): settled ends, whether a lane needs a closer look, and the unrounded
product where that is kept. Only speed depends on what is done here.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from codegen.intervals.accuracy import Absolute, Row, Ulp
from codegen.intervals.compiled import ends, kernels
from codegen.intervals.context import Context
from codegen.intervals.numbers import Array
from codegen.intervals.products import kept_product
from codegen.intervals.values import Product, Range

Found = tuple[Array, Array, int, Product | None]
_NEVER = {"y": (2.0**-1000, float("inf")), "x": (0.0, float("inf"))}
"""Limits of a row without any: a divisor of 0 is looked at all the same."""


def _lanes(context: Context, *values: Range) -> int:
    """The number of lanes of a result that a compiled loop gives; 0 for none."""
    if context.loops:
        for value in values:
            if len(value.low) > 1:
                return len(value.low)
    return 0


def _run(loop: Any, count: int, *operands: Any) -> Found:
    """What a loop finds that gives two ends."""
    low, high = np.empty(count), np.empty(count)
    return low, high, loop(*operands, low, high), None


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
    if context.table.rounding == "nearest":
        return _sum_to_nearest(context, count, _Term(a, 1.0), _Term(b, 1.0))
    a, b = _shared_last(a, b)
    return _run(kernels().add, count, *_ends(a), *_ends(b))


def subtract(context: Context, a: Range, b: Range) -> Found | None:
    """a - b."""
    count = _lanes(context, a, b)
    if not count:
        return None
    if context.table.rounding == "nearest":
        return _sum_to_nearest(context, count, _Term(a, 1.0), _Term(b, -1.0))
    return _run(kernels().subtract, count, *_ends(a), *_ends(b))


class _Term(NamedTuple):
    """A value as it goes into a sum: times 1 or -1."""

    of: Range
    sign: float

    @property
    def ends(self) -> tuple[Any, Any, float]:
        """The number that gives the lower end, the one that gives the upper, and the sign of both."""
        low, high = _ends(self.of)
        return (low, high, self.sign) if self.sign > 0.0 else (high, low, self.sign)

    @property
    def product(self) -> tuple[Any, ...]:
        """Ends of both factors, whether they are one value, and the sign of their product."""
        product = self.of.product
        assert product is not None and product.first is not None and product.second is not None
        sign = -self.sign if product.is_opposite else self.sign
        return *ends(*product.first), *ends(*product.second), product.is_square, sign


def _sum_to_nearest(context: Context, count: int, a: _Term, b: _Term) -> Found | None:
    if len(a.of.low) == 1:
        a, b = b, a
    products = [x for x in (a, b) if context.table.contracts and x.of.product is not None]
    if not products:
        if a.of.is_point and b.of.is_point:
            near = np.empty(count)
            look = kernels().add_points(*a.ends[1:], *b.ends[1:], near)
            return None if look else (near, near, 0, None)
        return _run(kernels().add_nearest, count, *a.ends, *b.ends)
    of, other = (a, b) if products[0] is a else (b, a)
    low, high, look, _ = _run(kernels().add_fused, count, *of.ends, *of.product, *other.ends)
    if len(products) > 1:
        look = kernels().fuse(low, high, *other.product, *of.ends)
    return low, high, look, None


def multiply(context: Context, a: Range, b: Range) -> Found | None:
    """a b; a square where both are one value."""
    count = _lanes(context, a, b)
    if not count:
        return None
    product = kept_product(context.table, a, b)
    a, b = _shared_last(a, b)
    if context.table.rounding == "nearest" and a.is_point and b.is_point:
        near = np.empty(count)
        look = kernels().multiply_points(_ends(a)[0], _ends(b)[0], near)
        return None if look else (near, near, 0, product)
    to_nearest = context.table.rounding == "nearest"
    if a is b:
        loop = kernels().square_nearest if to_nearest else kernels().square
        low, high, look, _ = _run(loop, count, *_ends(a))
    else:
        loop = kernels().multiply_nearest if to_nearest else kernels().multiply
        low, high, look, _ = _run(loop, count, *_ends(a), *_ends(b))
    return low, high, look, product


_ORDERS = {
    "<": ("less", False),
    "<=": ("at_most", False),
    ">": ("at_most", True),
    ">=": ("less", True),
    "==": ("equal", False),
    "!=": ("equal", True),
}
"""Comparison -> the loop that decides it, and whether that decides the opposite."""


def compare(context: Context, op: str, a: Range, b: Range) -> tuple[Array, Array, int] | None:
    """Whether a comparison of two different values may hold, may fail, and may do both in a lane."""
    count = _lanes(context, a, b)
    if not count or a is b:
        return None
    name, opposite = _ORDERS[op]
    true, false = np.empty(count, np.bool_), np.empty(count, np.bool_)
    undecided = getattr(kernels(), name)(*_ends(a), *_ends(b), true, false)
    return (false, true, undecided) if opposite else (true, false, undecided)


def unknown(context: Context, low: Array, high: Array, codes: Array) -> Found | None:
    """Ends that are infinite where there is a cause; looked at where they may overflow without one."""
    count = max(len(low), len(codes))
    if not context.loops or count == 1:
        return None
    return _run(kernels().unknown, count, *ends(low, high), codes if len(codes) > 1 else int(codes[0]))


def divide(context: Context, row: Row, x: Range, y: Range) -> Found | None:
    """x / y; looked at where the row promises nothing as well."""
    count = _lanes(context, x, y)
    if not count or row.normal:
        return None
    assert isinstance(row.accuracy, Ulp)
    limits = *_limits(row, "y"), *_limits(row, "x"), "x" in row.zero
    return _run(kernels().divide, count, *_ends(x), *_ends(y), row.accuracy.ulps, *limits)


def _limits(row: Row, operand: str) -> tuple[float, float]:
    """Least and largest magnitude of an operand for which the row promises something."""
    if operand not in row.magnitude:
        return _NEVER[operand]
    near, far = row.magnitude[operand]
    return 2.0**near, 2.0**far


def within_ulp(
    context: Context, low: Array, high: Array, ulps_low: float | Array, ulps_high: float | Array
) -> Found | None:
    """Float32 results within some ULP of exact values between two ends."""
    count = _lanes(context, Range(low, high))
    if not count:
        return None
    return _run(kernels().within_ulp, count, low, high, ulps_low, ulps_high)


def absolute_or_ulp(context: Context, promise: Absolute, x: Range, low: Array, high: Array) -> Found | None:
    """Float32 results within an absolute bound where x lies in its interval, within some ULP elsewhere."""
    count = _lanes(context, x)
    if not count or promise.elsewhere is None:
        return None
    given = promise.bound, *promise.within, promise.elsewhere.ulps
    return _run(kernels().absolute_or_ulp, count, *_ends(x), *ends(low, high), *given)


def square_root(context: Context, x: Range, root: Row, quotient: Row) -> Found | None:
    """1 / (1 / sqrt(x)); looked at where x may be negative as well."""
    count = _lanes(context, x)
    if not count or "x" in quotient.magnitude or root.magnitude:
        return None
    assert isinstance(root.accuracy, Ulp) and isinstance(quotient.accuracy, Ulp)
    ulps = root.accuracy.ulps, quotient.accuracy.ulps
    return _run(kernels().square_root, count, *_ends(x), *ulps, *_limits(quotient, "y"))


def inverse_square_root(context: Context, x: Range, row: Row) -> Found | None:
    """1 / sqrt(x); looked at where x may be 0 or less as well."""
    count = _lanes(context, x)
    if not count:
        return None
    assert isinstance(row.accuracy, Ulp)
    return _run(kernels().inverse_square_root, count, *_ends(x), row.accuracy.ulps)


def sum_of_three(context: Context, terms: list[Range]) -> Range | None:
    """The hull of the sums over all groupings; None where a lane needs a closer look."""
    count = _lanes(context, *terms)
    if not count or context.table.rounding != "either" or len(terms) != 3:
        return None
    if any(t.cause is not None or len(t.low) == 1 for t in terms):
        return None
    every = [end for term in terms for end in (term.low, term.high)]
    low, high, look, _ = _run(kernels().sum_of_three, count, *every)
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
    return _run(kernels().scaled_dot, count, *every, all(same), share, epsilon)
