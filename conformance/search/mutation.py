"""Small and large changes of inputs in the space of words: ULP steps, tilts, fresh values, crossing over."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from conformance.cases import background, domains
from conformance.cases.parameters import Leaf, leaves
from conformance.cases.stream import F64, Stream, norm, normalised, single, tilted
from conformance.search.population import Array, Mask, Population, pick, related, valid

SMALLEST_TILT, LARGEST_TILT = 1e-7, 1.0
"""Angles in radians, spread by magnitude: from the spacing of unit vectors to anywhere."""
LARGEST_STEP = 26.0
"""Base-2 logarithm of the longest walk over neighbouring floats: 2^23 of them make one binade."""


def mutated(stream: Stream, function: Any, parents: Population, lanes_per_island: int) -> Population:
    """One child of every lane; each differs from its parent in one leaf and, by chance, in more."""
    found = leaves(function.parameters)
    count = len(next(iter(parents.values())))
    certain = stream.below(count, len(found))
    children = dict(parents)
    for k, leaf in enumerate(found):
        chosen = (certain == k) | (stream.uniform(count) < 0.5 / len(found))
        lanes = np.flatnonzero(chosen)
        if not len(lanes):
            continue
        old = parents[leaf.path]
        changed = old.copy()
        changed[lanes] = changed_leaf(stream, leaf, found, parents, lanes, lanes_per_island)
        children[leaf.path] = pick(valid(leaf, changed), changed, old)
    return related(function, children)


def changed_leaf(
    stream: Stream, leaf: Leaf, found: list[Leaf], parents: Population, lanes: Array, island: int
) -> Array:
    """New values of one leaf in those lanes: mostly near the old ones, some fresh, some of a neighbour."""
    count = len(lanes)
    old = parents[leaf.path][lanes]
    kind = stream.uniform(count)
    other_lane = lanes // island * island + stream.below(count, island)
    values = pick(kind < 0.1, parents[leaf.path][other_lane], old)
    values = pick((kind >= 0.1) & (kind < 0.17), fresh(stream, leaf, count), values)
    near = kind >= 0.17
    if leaf.type == "Frame":
        return pick(near, turned_frames(stream, old), values)
    if old.dtype == np.bool_:
        return pick(near, ~old, values)
    if old.dtype.kind in "iu":
        return pick(near, integer_steps(stream, leaf, old), values)
    stepped = float_steps(stream, leaf, old)
    if old.ndim == 2 and old.shape[1] == 3 and domains.kind(leaf.domain) in ("Unit", "Length"):
        tilts = near & (kind < 0.6)
        stepped = pick(tilts, tilted_vectors(stream, leaf, found, parents, lanes), stepped)
    return pick(near, stepped, values)


def fresh(stream: Stream, leaf: Leaf, count: int) -> Array:
    """Values from anywhere in the domain, some of them at its ends."""
    value = background.mixed(stream, leaf, count, 0.3)
    return np.concatenate(list(value.values()), axis=1) if isinstance(value, dict) else value


def signed_steps(stream: Stream, count: int, largest: float) -> npt.NDArray[np.int64]:
    """Whole numbers of either sign, their magnitudes spread over the powers of two, half of them up to 4."""
    exponent = np.where(stream.uniform(count) < 0.5, 2.0, largest) * stream.uniform(count)
    return np.where(stream.uniform(count) < 0.5, -1, 1) * np.floor(np.exp2(exponent)).astype(np.int64)


def one_component(stream: Stream, values: Array) -> Mask:
    """Mask of values' shape with one component per lane set."""
    if values.ndim == 1:
        return np.ones(len(values), np.bool_)
    return np.asarray(np.arange(values.shape[1]) == stream.below(len(values), values.shape[1])[:, None])


def float_steps(stream: Stream, leaf: Leaf, old: Array) -> Array:
    """Some neighbouring floats further in one component, inside the domain; no denormals."""
    steps = signed_steps(stream, len(old), 3.0 if leaf.unit else LARGEST_STEP)
    steps = steps if old.ndim == 1 else steps[:, None]
    moved = ordered(old) + np.where(one_component(stream, old), steps, 0)
    low, high = -np.float32(3e38), np.float32(3e38)
    if domains.kind(leaf.domain) == "Interval":
        low, high = domains.inward(leaf.domain.low, leaf.domain.high)
    return single(from_ordered(np.clip(moved, ordered(np.float32(low)), ordered(np.float32(high)))))


def ordered(x: npt.ArrayLike) -> npt.NDArray[np.int64]:
    """Floats as integers in the same order, neighbours one apart, +0 and -0 both 0."""
    words = np.asarray(x, np.float32).view(np.int32).astype(np.int64)
    return np.where(words < 0, -(words & 0x7FFFFFFF), words)


def from_ordered(k: npt.NDArray[np.int64]) -> npt.NDArray[np.float32]:
    """The float at a place of that order."""
    return np.where(k < 0, -k | 0x80000000, k).astype(np.uint32).view(np.float32)


def integer_steps(stream: Stream, leaf: Leaf, old: Array) -> Array:
    """A step, or one bit turned, in one component."""
    signed = old.dtype == np.int32
    low, high = domains.integer_range(leaf.domain, signed)
    wide = old.astype(np.int64)
    steps = signed_steps(stream, len(old), 31.0)
    bits = np.int64(1) << stream.below(len(old), 32).astype(np.int64)
    flips = stream.uniform(len(old)) < 0.5
    if old.ndim == 2:
        steps, bits, flips = steps[:, None], bits[:, None], flips[:, None]
    moved = np.where(flips, wide ^ bits, wide + steps)
    return np.clip(np.where(one_component(stream, old), moved, wide), low, high).astype(old.dtype)


def tilts_by_magnitude(stream: Stream, count: int) -> F64:
    """Angles of any order; one in ten is zero."""
    turn = SMALLEST_TILT * (LARGEST_TILT / SMALLEST_TILT) ** stream.uniform(count)
    return np.where(stream.uniform(count) < 0.1, 0.0, turn)


def tilted_vectors(stream: Stream, leaf: Leaf, found: list[Leaf], parents: Population, lanes: Array) -> Array:
    """The old vector, plus or minus another direction of the inputs, or one across it; each tilted.

    A vector of free length may be stretched as well.
    """
    old = parents[leaf.path][lanes].astype(np.float64)
    size = norm(old)
    count = len(lanes)
    start = normalised(np.where((size > 0.0)[:, None], old, [0.0, 0.0, 1.0]))
    others = [other for other in found if (other.unit or other.type == "Frame") and other.path != leaf.path]
    if others:
        kind, which = stream.uniform(count), stream.below(count, len(others))
        base = np.stack([parents[other.path][lanes][:, -3:] for other in others])
        other = normalised(base[which, np.arange(count)].astype(np.float64))
        sign = np.where(stream.uniform(count) < 0.5, -1.0, 1.0)[:, None]
        start = np.where((kind < 0.2)[:, None], sign * other, start)
        start = np.where(((kind >= 0.2) & (kind < 0.3))[:, None], stream.across(other), start)
    moved = normalised(tilted(start, stream.across(start), tilts_by_magnitude(stream, count)))
    if not leaf.unit:
        stretch = np.exp2(stream.uniform(count, -2.0, 2.0))
        moved = moved * np.where(stream.uniform(count) < 0.5, size, size * stretch)[:, None]
    return single(moved)


def turned_frames(stream: Stream, old: Array) -> Array:
    """Frames about a normal tilted from the old one, turned at random."""
    normals = normalised(old[:, 6:9].astype(np.float64))
    moved = normalised(tilted(normals, stream.across(normals), tilts_by_magnitude(stream, len(old))))
    return np.concatenate(list(background.frames(stream, moved).values()), axis=1)
