"""The commonest interval operations as one loop over the lanes each, compiled by numba.

Imported only where numba is installed and there are lanes enough, see codegen.intervals.compiled. What they
compute is defined by codegen.intervals.arithmetic and codegen.intervals.logic over numpy arrays,
bit for bit; here nothing is written between the steps of an operation. They are for tables that flush.

An operand is an array (N,), or one number for all lanes. The last arrays take the results; what is returned
is a flag: whether a lane needs a closer look, because it may overflow or lies outside what is promised.
"""

from __future__ import annotations

from codegen.intervals.kernels.accuracy import (
    absolute_or_ulp,
    divide,
    inverse_square_root,
    scaled_dot,
    square_root,
    within_ulp,
)
from codegen.intervals.kernels.decisions import at_most, choose, equal, less, unknown
from codegen.intervals.kernels.either import add, multiply, square, subtract, sum_of_three
from codegen.intervals.kernels.nearest import (
    add_fused,
    add_nearest,
    add_points,
    fuse,
    multiply_nearest,
    multiply_points,
    square_nearest,
)

__all__ = [
    "absolute_or_ulp",
    "add",
    "add_fused",
    "add_nearest",
    "add_points",
    "at_most",
    "choose",
    "divide",
    "equal",
    "fuse",
    "inverse_square_root",
    "less",
    "multiply",
    "multiply_nearest",
    "multiply_points",
    "scaled_dot",
    "square",
    "square_nearest",
    "square_root",
    "subtract",
    "sum_of_three",
    "unknown",
    "within_ulp",
]
