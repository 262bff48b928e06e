"""Products before they are rounded: their exact ends, and what is kept of one for a multiply-add."""

from __future__ import annotations

import numpy as np

from codegen.intervals.numbers import Array
from codegen.intervals.tables import Table
from codegen.intervals.values import Product, Range

ROUNDED_EITHER_WAY = Product(None, None)
"""Any product of a table under which a rounded product's interval holds the unrounded product."""


def kept_product(table: Table, a: Range, b: Range) -> Product | None:
    """What is kept of a b; None where no multiply-add may use it unrounded."""
    if not table.contracts:
        return None
    if table.rounding == "either":
        return ROUNDED_EITHER_WAY
    if len(a.low) == 1:
        a, b = b, a
    return Product((a.low, a.high), (b.low, b.high), is_square=a is b)


def unrounded(product: Product) -> tuple[Array, Array]:
    """The ends of a product that is kept by its factors."""
    assert product.first is not None and product.second is not None
    a = Range(*product.first)
    low, high = exact_product(a, a if product.is_square else Range(*product.second))
    return (-high, -low) if product.is_opposite else (low, high)


def exact_product(a: Range, b: Range) -> tuple[Array, Array]:
    """Ends of the exact products of two intervals."""
    if a.is_point and b.is_point:
        exact = a.low * b.low
        return exact, exact
    if a is b:
        far = np.maximum(np.abs(a.low), np.abs(a.high))
        near = np.maximum(np.maximum(a.low, -a.high), 0.0)
        return near * near, far * far
    if a.is_point or (b.reach[0] >= 0.0 and not b.is_point):
        a, b = b, a
    if a.reach[0] >= 0.0 and not b.is_point:
        return _of_positive(a, b)
    p, q = a.low * b.low, a.high * b.low
    low, high = np.minimum(p, q), np.maximum(p, q)
    if b.is_point:
        return low, high
    r, s = a.low * b.high, a.high * b.high
    return np.minimum(low, np.minimum(r, s)), np.maximum(high, np.maximum(r, s))


def _of_positive(a: Range, b: Range) -> tuple[Array, Array]:
    """The same where a is nowhere negative: its upper end goes with what lies farther from 0."""
    bottom, top, _ = b.reach
    if bottom >= 0.0:
        return a.low * b.low, a.high * b.high
    if top <= 0.0:
        return a.high * b.low, a.low * b.high
    return np.minimum(a.low * b.low, a.high * b.low), np.maximum(a.low * b.high, a.high * b.high)
