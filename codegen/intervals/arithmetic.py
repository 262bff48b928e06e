"""Sums, products, quotients and orderings of float intervals under a table."""

from __future__ import annotations

import numpy as np

from codegen.intervals import bulk, numbers
from codegen.intervals.accuracy import Row, Ulp
from codegen.intervals.causes import Codes, first
from codegen.intervals.context import Context
from codegen.intervals.numbers import LARGEST, SMALLEST, Array
from codegen.intervals.products import exact_product, kept_product, unrounded
from codegen.intervals.values import Product, Range

_FAR = 2.0**1000


def settle(
    context: Context, low: Array, high: Array, codes: Codes = None, product: Product | None = None
) -> Range:
    """A value from its float32 ends: overflow is anything, and below the normal numbers lies what may flush.

    A result below 2^-126 may become 0 where the table flushes, and so may one that only rounding makes
    normal (Vulkan says so); its neighbours are then not told apart: the interval reaches 0 and the smallest
    normal number.
    """
    found = numbers.reach(low, high)
    if numbers.usual(found):
        if codes is not None:
            return bounded(context, low, high, codes, product)
        return Range(low, high, None, product, found)
    same = low is high
    low, high = _below_normal(context, low, high)
    return bounded(context, low, high, codes, product, same)


def bounded(
    context: Context,
    low: Array,
    high: Array,
    codes: Codes,
    product: Product | None = None,
    same: bool = False,
) -> Range:
    """A value from ends that are settled but may overflow; `same`: low and high were one array before."""
    if codes is not None:
        found = bulk.unknown(context, low, high, codes)
        if found is not None and not found[2]:
            return Range(found[0], found[1], codes, product)
    over = ~((low >= -LARGEST) & (high <= LARGEST))
    if over.any():
        fresh = over if codes is None else over & (codes == 0)
        codes = context.unbounded(codes, fresh, "", "the result may overflow")
        low, high, same = np.where(over, -np.inf, low), np.where(over, np.inf, high), False
    if same and (low == high).all():
        high = low
    return Range(low, high, None, product) if codes is None else anything(low, high, codes, product)


def anything(low: Array, high: Array, codes: Array, product: Product | None = None) -> Range:
    """A value whose ends are infinite where it has a cause."""
    unknown = codes > 0
    return Range(np.where(unknown, -np.inf, low), np.where(unknown, np.inf, high), codes, product)


def _below_normal(context: Context, low: Array, high: Array) -> tuple[Array, Array]:
    small_low = (np.abs(low) < SMALLEST) & (low != 0.0)
    small_high = (np.abs(high) < SMALLEST) & (high != 0.0)
    if context.table.flush:
        if small_low.any():
            low = np.where(small_low, np.where(low > 0.0, 0.0, -SMALLEST), low)
        if small_high.any():
            high = np.where(small_high, np.where(high < 0.0, 0.0, SMALLEST), high)
    else:
        step = numbers.DENORMAL_STEP
        low = np.where(small_low, np.floor(low / step) * step, low)
        high = np.where(small_high, np.ceil(high / step) * step, high)
    return low, high


def from_input(context: Context, given: Array) -> Range:
    """Exact float32 inputs; one below the normal numbers may be read as 0."""
    a = given.astype(np.float64)
    if numbers.usual(found := numbers.reach(a, a)):
        return Range(a, a, None, None, found)
    low, high, codes = a, a, _not_finite(context, a)
    small = (np.abs(a) < SMALLEST) & (a != 0.0)
    if context.table.flush and small.any():
        low, high = np.where(small, np.minimum(a, 0.0), a), np.where(small, np.maximum(a, 0.0), a)
    return Range(low, high) if codes is None else anything(low, high, codes)


def checked(context: Context, found: bulk.Found, codes: Codes) -> Range:
    """A value that a loop over the lanes settled, looked at where it has to be."""
    low, high, look, product = found
    if look or codes is not None:
        return bounded(context, low, high, codes, product)
    return Range(low, high, None, product)


def _not_finite(context: Context, a: Array) -> Codes:
    bad = ~np.isfinite(a)
    return context.unbounded(None, bad, "", "the input is not finite") if bad.any() else None


def rounded(context: Context, low: Array, high: Array) -> tuple[Array, Array]:
    """The float32 results of correct rounding of exact values between two ends."""
    if context.table.rounding == "nearest":
        near = numbers.nearest(low)
        return near, near if high is low else numbers.nearest(high)
    return numbers.down(low), numbers.up(high)


def negate(a: Range) -> Range:
    """-a."""
    low = -a.high
    product = None if a.product is None else a.product.opposite()
    known = None if a.known is None else (-a.known[1], -a.known[0], a.known[2])
    return Range(low, low if a.is_point else -a.low, a.cause, product, known)


def add(context: Context, a: Range, b: Range) -> Range:
    """a + b, with the unrounded product of an operand where the table allows a multiply-add."""
    codes = first(a.cause, b.cause)
    if (found := bulk.add(context, a, b)) is not None:
        return checked(context, found, codes)
    if context.table.rounding == "nearest":
        total = a.low + b.low
        low, high = rounded(context, total, total if a.is_point and b.is_point else a.high + b.high)
        if context.table.fused:
            low, high = _with_fused(low, high, a, b)
            low, high = _with_fused(low, high, b, a)
        return settle(context, low, high, codes)
    # Rounding either way, the rounded product's interval holds the unrounded product: fusing adds nothing.
    if numbers.exact_sums(a.reach, b.reach):
        total = a.low + b.low
        top = total if a.is_point and b.is_point else a.high + b.high
        return settle(context, numbers.down(total), numbers.up(top), codes)
    return settle(context, numbers.sum_down(a.low, b.low), numbers.sum_up(a.high, b.high), codes)


def _with_fused(low: Array, high: Array, a: Range, b: Range) -> tuple[Array, Array]:
    if a.product is None:
        return low, high
    least, most = unrounded(a.product)
    # Rounded outwards, since float64 may not hold the exact sum of a product and a float32.
    fused_low, fused_high = numbers.sum_down(least, b.low), numbers.sum_up(most, b.high)
    return np.minimum(low, fused_low), np.maximum(high, fused_high)


def subtract(context: Context, a: Range, b: Range) -> Range:
    """a - b; 0 where both are one value, unless that is a product of which one may be fused."""
    if a is b and a.cause is None:
        zero = np.zeros(1)
        return Range(zero, zero) if a.product is None else _rounding_of_product(context, a)
    if (found := bulk.subtract(context, a, b)) is not None:
        return checked(context, found, first(a.cause, b.cause))
    return add(context, a, negate(b))


def _rounding_of_product(context: Context, a: Range) -> Range:
    """A product minus itself, of which a multiply-add may round only one: what rounding it loses at most.

    Flushing one of them loses less than the least normal number, to which `settle` widens such a rounding.
    """
    share = 0.5 if context.table.rounding == "nearest" else 1.0
    most = share * numbers.ulp(np.maximum(np.abs(a.low), np.abs(a.high)))
    return settle(context, -most, most, None)


def multiply(context: Context, a: Range, b: Range) -> Range:
    """a b; a square where both are one value. Products of float32 are exact in float64."""
    codes = first(a.cause, b.cause)
    if (found := bulk.multiply(context, a, b)) is not None:
        return checked(context, found, codes)
    low, high = rounded(context, *exact_product(a, b))
    return settle(context, low, high, codes, kept_product(context.table, a, b))


def outside(row: Row, operand: str, x: Range) -> Array | None:
    """Where an operand may lie outside the magnitudes for which the row promises anything."""
    found = None
    if operand in row.magnitude:
        found = outside_magnitude(row.magnitude[operand], x)
        if operand in row.zero:
            found &= ~((x.low == 0.0) & (x.high == 0.0))
    if operand in row.normal:
        near = np.maximum(x.low, -x.high)
        found = (near < SMALLEST) if found is None else found | (near < SMALLEST)
    return found


def outside_magnitude(exponents: tuple[int, int], x: Range) -> Array:
    """Where |x| may be below the first or above the second of two powers of two."""
    near = np.maximum(x.low, -x.high)
    far = np.maximum(np.abs(x.low), np.abs(x.high))
    return np.asarray((near < 2.0 ** exponents[0]) | (far > 2.0 ** exponents[1]))


def divide(context: Context, row: Row, x: Range, y: Range) -> Range:
    """x / y within the row's ULP; anything where y may be 0 or outside its promised magnitudes.

    The sign of a quotient is that of its operands', and 0 / y is 0: no division is known that breaks either,
    although 2.5 ULP of a result near 0 would allow it to.
    """
    codes = first(x.cause, y.cause)
    assert isinstance(row.accuracy, Ulp)
    found = bulk.divide(context, row, x, y)
    if found is not None and codes is None and not found[2]:
        return Range(found[0], found[1])
    may_vanish = (y.low <= 0.0) & (y.high >= 0.0)
    codes = context.unbounded(codes, may_vanish & _clear(codes), "y", "the divisor may be 0")
    for operand, value in (("y", y), ("x", x)):
        bad = outside(row, operand, value)
        if bad is not None and row.reciprocal is not None:
            reciprocal = (x.low == 1.0) & (x.high == 1.0)
            bad = np.where(reciprocal, outside_magnitude(row.reciprocal, y), bad)
        if bad is not None:
            codes = context.unbounded(codes, bad & _clear(codes), operand, "outside the promised magnitudes")
    if found is not None:
        return bounded(context, found[0], found[1], codes)
    low, high = _quotient(x, y)
    return settled_within_ulp(context, low, high, row.accuracy.ulps, row.accuracy.ulps, codes)


def _clear(codes: Codes) -> Array | bool:
    return True if codes is None else codes == 0


def _quotient(x: Range, y: Range) -> tuple[Array, Array]:
    """Ends of the exact quotients for y of one sign, rounded by float64."""
    if x.is_point and y.is_point:
        q = x.low / y.low
        return q, q
    x_low, x_high, y_low, y_high = x.low, x.high, y.low, y.high
    negative = y_high < 0.0
    if negative.any():
        x_low, x_high = np.where(negative, -x_high, x_low), np.where(negative, -x_low, x_high)
        y_low, y_high = np.where(negative, -y_high, y_low), np.where(negative, -y_low, y_high)
    if y_low is y_high:
        return x_low / y_low, x_high / y_low
    return np.minimum(x_low / y_high, x_low / y_low), np.maximum(x_high / y_low, x_high / y_high)


def settled_within_ulp(
    context: Context, low: Array, high: Array, ulps_low: float | Array, ulps_high: float | Array, codes: Codes
) -> Range:
    """A value within some ULP of exact values between two ends."""
    if (found := bulk.within_ulp(context, low, high, ulps_low, ulps_high)) is not None:
        return checked(context, found, codes)
    low, high = within_ulp(low, high, ulps_low, ulps_high)
    return settle(context, low, high, codes)


def within_ulp(
    low: Array, high: Array, ulps_low: float | Array, ulps_high: float | Array
) -> tuple[Array, Array]:
    """Float32 results within some ULP of exact values between two ends, which float64 gave; sign kept.

    The spacing doubles at a power of two, so the value that allows the least result may lie a few ULP inside
    the interval: the larger spacing is taken where one is within reach.
    """
    slack = np.abs(low) * numbers.FLOAT64_MARGIN
    least = low - slack
    if low is high:
        most = high + slack
        spacing = numbers.ulp(np.maximum(np.abs(least), np.abs(most))) * numbers.PER_ULP
        first_low, last_high = least - spacing * ulps_low, most + spacing * ulps_high
    else:
        most = high + np.abs(high) * numbers.FLOAT64_MARGIN
        spacing = numbers.ulp(least) * numbers.PER_ULP
        inside = np.minimum(least + spacing * ulps_low, most)
        first_low = least - np.maximum(spacing, numbers.ulp(inside) * numbers.PER_ULP) * ulps_low
        spacing = numbers.ulp(most) * numbers.PER_ULP
        inside = np.maximum(most - spacing * ulps_high, least)
        last_high = most + np.maximum(spacing, numbers.ulp(inside) * numbers.PER_ULP) * ulps_high
    # Limits that are 0 where the sign is kept, and far beyond every result where there is none to keep.
    np.maximum(first_low, np.minimum(low, 0.0) * _FAR, out=first_low)
    np.minimum(last_high, np.maximum(high, 0.0) * _FAR, out=last_high)
    return numbers.up(first_low), numbers.down(last_high)


def smaller(a: Range, b: Range) -> Range:
    """min(a, b); anything where either may be anything, since NaN may be among it."""
    return _ordered(np.minimum, a, b)


def larger(a: Range, b: Range) -> Range:
    """max(a, b); anything where either may be anything, since NaN may be among it."""
    return _ordered(np.maximum, a, b)


def _ordered(order: np.ufunc, a: Range, b: Range) -> Range:
    codes = first(a.cause, b.cause)
    low = order(a.low, b.low)
    high = low if a.is_point and b.is_point else order(a.high, b.high)
    if codes is not None:
        low, high = np.where(codes > 0, -np.inf, low), np.where(codes > 0, np.inf, high)
    return Range(low, high, codes)


def clamp(x: Range, least: Range, most: Range) -> Range:
    """min(max(x, least), most); where least may exceed most also max(min(x, most), least)."""
    found = smaller(larger(x, least), most)
    crossed = least.high > most.low
    if not crossed.any():
        return found
    other = larger(smaller(x, most), least)
    return Range(
        np.where(crossed, np.minimum(found.low, other.low), found.low),
        np.where(crossed, np.maximum(found.high, other.high), found.high),
        found.cause,
    )


def absolute(x: Range) -> Range:
    """|x|."""
    if x.is_point:
        a = np.abs(x.low)
        return Range(a, a, x.cause)
    low, high = -x.high, -x.low
    np.maximum(low, x.low, out=low)
    np.maximum(low, 0.0, out=low)
    np.maximum(high, x.high, out=high)
    if x.cause is not None:
        low = np.where(x.cause > 0, -np.inf, low)
    return Range(low, high, x.cause)
