"""What is kept of a product before it is rounded, so that a multiply-add may use it.

Plan.
  kept     nothing where no multiply-add may use it or gives anything new, else the ends of both factors
  shared   a factor that all lanes share is the second, whichever side it stood on
  ends     an unrounded product has the ends of its factors' products, a square none below 0, either sign
"""

from __future__ import annotations

import numpy as np
import pytest

from codegen.intervals import load_table
from codegen.intervals.products import ROUNDED_EITHER_WAY, kept_product, unrounded
from codegen.intervals.values import Product, Range

MANY = Range(np.array([-2.0, 3.0]), np.array([1.0, 5.0]))
OTHER = Range(np.array([-1.0, -4.0]), np.array([0.5, 2.0]))
SHARED = Range(np.array([-3.0]), np.array([2.0]))


def kept(a: Range, b: Range) -> Product:
    found = kept_product(load_table("opencl"), a, b)
    assert found is not None
    return found


@pytest.mark.parametrize("name", ["glsl", "glsl_es", "vulkan"])
def test_what_is_rounded_either_way_holds_the_unrounded_product(name: str) -> None:
    assert kept_product(load_table(name), MANY, OTHER) is ROUNDED_EITHER_WAY


def test_nothing_is_kept_where_sums_fuse_no_less_accurately() -> None:
    assert kept_product(load_table("wgsl"), MANY, OTHER) is None


@pytest.mark.parametrize(
    ("a", "b", "first", "second"),
    [
        (MANY, OTHER, MANY, OTHER),
        (OTHER, MANY, OTHER, MANY),
        (MANY, SHARED, MANY, SHARED),
        (SHARED, MANY, MANY, SHARED),
    ],
)
def test_factors_are_kept_by_their_ends(a: Range, b: Range, first: Range, second: Range) -> None:
    found = kept(a, b)
    assert found.first is not None and found.second is not None
    assert [id(end) for end in (*found.first, *found.second)] == [
        id(end) for end in (first.low, first.high, second.low, second.high)
    ]
    assert not found.is_square and not found.is_opposite


def test_unrounded_products_have_their_ends() -> None:
    for a, b, low, high in (
        (MANY, OTHER, [-1.0, -20.0], [2.0, 10.0]),
        (MANY, SHARED, [-4.0, -15.0], [6.0, 10.0]),
        (MANY, MANY, [0.0, 9.0], [4.0, 25.0]),
    ):
        product = kept(a, b)
        assert product.is_square == (a is b)
        for made, sign in ((product, 1.0), (product.opposite(), -1.0)):
            ends = sorted((sign * np.array(low), sign * np.array(high)), key=lambda end: float(end[0]))
            assert [end.tolist() for end in unrounded(made)] == [end.tolist() for end in ends]
