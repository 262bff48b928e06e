"""Random values inside a parameter's domain, and the ends of the domain.

Domains are told apart by class name and attributes (Interval: low, high, scale; Unit; Length: low, high;
Finite), so nothing of the generator is imported here. A parameter without a domain counts as Finite.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from conformance.cases.stream import AXES, F32, F64, Stream, neighbour, norm, normalised_single, single

Values = npt.NDArray[Any]
UNIT_TOLERANCE = 1e-6
"""A vector that is unit up to float32 rounding of its components is off by at most 2e-7."""
TINY = 1e-30
HUGE = 1e30


def kind(domain: Any) -> str:
    """Class name of the domain; Finite for None."""
    return "Finite" if domain is None else type(domain).__name__


def inward(low: float, high: float) -> tuple[np.float32, np.float32]:
    """The outermost float32 numbers inside [low, high]."""
    first, last = np.float32(low), np.float32(high)
    first = neighbour(first, 1)[0] if float(first) < low else first
    last = neighbour(last, -1)[0] if float(last) > high else last
    return np.float32(first), np.float32(last)


def contains(domain: Any, values: Values) -> npt.NDArray[np.bool_]:
    """Which rows lie in the domain."""
    wide = values.astype(np.float64)
    rows = wide.reshape(len(wide), -1)
    inside = np.asarray(np.isfinite(rows).all(axis=1), dtype=np.bool_)
    match kind(domain):
        case "Interval":
            inside &= ((rows >= domain.low) & (rows <= domain.high)).all(axis=1)
        case "Unit":
            inside &= np.abs(norm(wide) - 1.0) <= UNIT_TOLERANCE
        case "Length":
            size, slack = norm(wide), UNIT_TOLERANCE
            inside &= (size == 0.0) | (
                (size >= domain.low * (1.0 - slack)) & (size <= domain.high * (1.0 + slack))
            )
    return np.asarray(inside, dtype=np.bool_)


def magnitudes(stream: Stream, n: int, low: float, high: float) -> F64:
    """Log-uniform numbers in [low, high], 0 < low."""
    exponent = stream.uniform(n, np.log2(low), np.log2(high))
    return np.clip(np.exp2(exponent), low, high)


def signed_logarithmic(stream: Stream, n: int, low: float, high: float, least: float = 0.0) -> F64:
    """Magnitudes of any order within [low, high].

    An end at 0 is approached down to `least`, or, where that is 0, down to 1e-30 and mostly to 1e-6.
    """
    largest = max(abs(low), abs(high))
    if low > 0.0:
        return magnitudes(stream, n, low, high)
    if high < 0.0:
        return -magnitudes(stream, n, -high, -low)
    if largest == 0.0:
        return np.zeros(n)
    floor = np.where(stream.uniform(n) < 0.75, 1e-6 * min(largest, 1.0), TINY)
    floor = np.where(least > 0.0, least, floor)
    size = np.exp2(np.log2(floor) + stream.uniform(n) * (np.log2(largest) - np.log2(floor)))
    sign = np.where(stream.uniform(n) < 0.5, -1.0, 1.0) if low < 0.0 < high else np.sign(low + high)
    value = np.where(stream.uniform(n) < 0.01, 0.0, size * sign)
    return np.clip(value, low, high)


def uniform_f32(stream: Stream, n: int, domain: Any) -> F32:
    """n numbers of the domain, spread as its scale says."""
    if kind(domain) != "Interval":
        return single(signed_logarithmic(stream, n, -HUGE, HUGE))
    first, last = inward(domain.low, domain.high)
    if domain.scale == "log":
        value = signed_logarithmic(stream, n, float(first), float(last), getattr(domain, "least", 0.0))
    else:
        value = stream.uniform(n, float(first), float(last))
    return np.clip(single(value), first, last)


def uniform_integers(stream: Stream, n: int, domain: Any, signed: bool) -> Values:
    """n integers of the domain (all 32-bit ones without an interval); `scale` log favours small ones."""
    low, high = integer_range(domain, signed)
    if getattr(domain, "scale", "linear") == "log":
        value = np.floor(signed_logarithmic(stream, n, float(low), float(high) + 0.999))
    else:
        value = np.floor(stream.uniform(n, float(low), float(high) + 1.0))
    return np.clip(value, low, high).astype(np.int64).astype(np.int32 if signed else np.uint32)


def integer_range(domain: Any, signed: bool) -> tuple[int, int]:
    """Smallest and largest integer of the domain."""
    low, high = (-(1 << 31), (1 << 31) - 1) if signed else (0, (1 << 32) - 1)
    if kind(domain) == "Interval":
        low, high = max(low, int(np.ceil(domain.low))), min(high, int(np.floor(domain.high)))
    return low, high


def uniform_vectors(stream: Stream, n: int, size: int, domain: Any) -> F32:
    """n vectors (n, size) of the domain."""
    match kind(domain):
        case "Unit":
            rounded = stream.directions(n)
            # One in four is normalised in float32, as a program's own vectors are.
            raw = normalised_single(rounded * stream.uniform(n, 0.1, 10.0)[:, None])
            return np.where((stream.uniform(n) < 0.25)[:, None], raw, single(rounded))
        case "Length":
            low = domain.low if domain.low > 0.0 else min(TINY, domain.high)
            # Components round by 6e-8 each: stay clear of the ends, which have their own cases.
            length = magnitudes(stream, n, low * (1.0 + UNIT_TOLERANCE), domain.high * (1.0 - UNIT_TOLERANCE))
            length = np.where(stream.uniform(n) < 0.01, 0.0, length)
            return single(stream.directions(n) * length[:, None])
    return uniform_f32(stream, n * size, domain).reshape(n, size)


def ends_f32(domain: Any) -> F32:
    """The ends of an interval and their neighbours, 0, +-1e-30, +-1 and the middle, where they lie inside."""
    if kind(domain) != "Interval":
        return single([0.0, -0.0, TINY, -TINY, 1.0, -1.0, 1e15, -1e15, HUGE, -HUGE])
    first, last = inward(domain.low, domain.high)
    near = [*neighbour(np.repeat(first, 3), [0, 1, 2]), *neighbour(np.repeat(last, 3), [0, -1, -2])]
    ones = neighbour(np.repeat([1.0, -1.0], 3), [-1, 0, 1] * 2)
    middle = 0.5 * float(first) + 0.5 * float(last)
    values = np.concatenate([single([*near, 0.0, -0.0, TINY, -TINY, middle]), ones])
    return values[(values >= first) & (values <= last)]


def ends_vectors(domain: Any, size: int) -> F32 | None:
    """Axes of a unit vector, extreme lengths along the axes; None where the components are independent."""
    match kind(domain):
        case "Unit":
            return single(AXES)
        case "Length":
            first, last = inward(domain.low, domain.high)
            lengths = [float(first), float(last), 1.0 if domain.low <= 1.0 <= domain.high else float(last)]
            return single(np.concatenate([np.zeros((1, 3)), *(AXES * x for x in lengths)]))
    return None


def ends_integers(domain: Any, signed: bool) -> Values:
    """The ends of the range, their neighbours and the powers of two inside."""
    low, high = integer_range(domain, signed)
    candidates = {low, low + 1, high - 1, high} | {(1 << k) + d for k in range(32) for d in (-1, 0)}
    inside = np.array(sorted(x for x in candidates if low <= x <= high), dtype=np.int64)
    return inside.astype(np.int32 if signed else np.uint32)
