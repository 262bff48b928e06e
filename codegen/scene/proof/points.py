"""Seeded inputs of a scene: random points of its ranges, and the cases that are known to be hard.

Hard cases: directions 0 and 1e-7 to 1e-1 rad from +-t, both at once, near the cone of the highlight, near
each other and opposed, at the edges of what [view] allows and at the horizon; ends of ranges, zeros and their
neighbours.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError
from codegen.evaluate.arrays import Value
from codegen.ir.domains import Interval, Length, Unit
from codegen.ir.types import Array, Vector
from codegen.scene.description.document import Scene
from codegen.scene.description.model import LIGHT, Slot
from codegen.scene.description.settings import Alias, Constant, Range
from codegen.scene.general import General

SEED = 20_265
HARD_SHARE = 0.5
"""Share of the points that are hard in one way or more."""
END_SHARE = 0.15
"""Share of the values of a range that are one of its ends or their neighbours."""
ANGLES = (0.0, *(10.0**-k for k in range(7, 0, -1)))
"""Angles from the hair, in radians."""
ROUNDS = 200
POSITIONS = 10.0
"""Shaded points lie within this distance of the origin per coordinate."""

Floats = npt.NDArray[np.float64]
Inputs = dict[str, Value]


LEAST_ROUND = 256
"""Points that a further round draws, at least, where facts left some of the first out."""


@dataclass(frozen=True)
class Points:
    """Inputs of the general function by parameter, each with `count` lanes; `hard` marks the hard ones."""

    inputs: Inputs
    count: int
    hard: npt.NDArray[np.bool_]


def draw(scene: Scene, general: General, count: int, seed: int = SEED) -> Points:
    """Exactly `count` points; raises UserError where no directions fit the facts of [view]."""
    generator = np.random.default_rng(seed)
    parts: list[tuple[Inputs, npt.NDArray[np.bool_]]] = []
    found = 0
    for attempt in range(ROUNDS):
        size = min(count, 2 * (count - found) + LEAST_ROUND)
        hard = generator.random(size) < HARD_SHARE
        inputs = _Drawing(scene, general, generator, size, hard).inputs()
        keep = np.flatnonzero(_fits(scene, general, inputs))[: count - found]
        parts.append(({name: np.asarray(v)[keep] for name, v in inputs.items()}, hard[keep]))
        found += len(keep)
        if found >= count:
            break
        if attempt >= 8 and found == 0:
            raise UserError(f"{scene.path}: [view] no directions were found that fit all facts together")
    if found < count:
        raise UserError(f"{scene.path}: [view] the facts leave too few directions to test: widen them")
    joined = {name: np.concatenate([np.asarray(part[0][name]) for part in parts]) for name in parts[0][0]}
    return Points(dict(joined), count, np.concatenate([part[1] for part in parts]))


def _fits(scene: Scene, general: General, inputs: Inputs) -> npt.NDArray[np.bool_]:
    """Which points obey the facts, as float32 sees them."""
    names = _names(general)
    keep = np.ones(len(next(iter(inputs.values()))), np.bool_)
    for (a, b), (low, high) in scene.facts.items():
        for x, y in _pairs(names, a, b):
            first, second = _directions(inputs, x), _directions(inputs, y)
            cosine = _dots(*np.broadcast_arrays(first, second))
            keep &= ((cosine >= low) & (cosine <= high)).all(axis=1)
    return keep


def _directions(inputs: Inputs, name: str) -> Floats:
    """The directions of a parameter, (N, size, 3); those to point lights from their positions."""
    value = np.asarray(inputs[name], np.float64)
    value = value[:, None] if value.ndim == 2 else value
    if not name.startswith("light_position"):
        return value
    offset = value - np.asarray(inputs["position"], np.float64)[:, None]
    return _normalised(offset)


def _names(general: General) -> dict[str, list[str]]:
    """Direction of the model -> the parameters that hold it: one, or one per light."""
    found = {path: [name] for path, name in general.shared.items()}
    found[LIGHT] = [
        light.names.get(LIGHT) or light.names["position"]
        for light in general.lights
        if light.kind != "constant"
    ]
    for light in general.lights:
        for path, name in light.names.items():
            if path not in (LIGHT, "position", "light"):
                found.setdefault(path, []).append(name)
    return found


def _pairs(names: Mapping[str, list[str]], a: str, b: str) -> list[tuple[str, str]]:
    return [(x, y) for x in names.get(a, []) for y in names.get(b, [])]


class _Drawing:
    """One batch of points, not yet held against the facts."""

    def __init__(
        self,
        scene: Scene,
        general: General,
        generator: np.random.Generator,
        count: int,
        hard: npt.NDArray[np.bool_],
    ) -> None:
        self.scene, self.general, self.random, self.count, self.hard = scene, general, generator, count, hard
        self.known: dict[str, Floats] = {}

    def inputs(self) -> Inputs:
        by_path = {slot.path: slot for slot in self.general.slots.values()}
        directions = [s for s in by_path.values() if isinstance(s.domain, Unit)]
        order = {"n": 0, "t": 1, "v": 2}
        for slot in sorted(directions, key=lambda s: order.get(s.path, 3)):
            if slot.path == slot.name or slot.path in self.general.shared:
                self.known[self.general.shared.get(slot.path, slot.name)] = self.each(slot, self.direction)
        found: Inputs = {}
        for name, slot in self.general.slots.items():
            if isinstance(slot.domain, Unit):
                if name not in self.known:
                    self.known[name] = self.each(slot, self.direction)
                found[name] = self.known[name].astype(np.float32)
            elif slot.name == "position":
                found[name] = self.random.uniform(-POSITIONS, POSITIONS, (self.count, 3)).astype(np.float32)
            elif not name.startswith("light_position"):
                found[name] = self.each(slot, self.value)
        for name, slot in self.general.slots.items():
            if name.startswith("light_position"):
                position = np.asarray(found["position"], np.float64)
                found[name] = self.each(slot, lambda _, at=position: self.light_position(at))  # type: ignore[misc]
        for name, slot in self.general.slots.items():
            setting = self.scene.settings.get(slot.path)
            if isinstance(setting, Alias) and setting.path in self.general.shared:
                found[name] = found[self.general.shared[setting.path]]
        return {name: found[name] for name in self.general.slots}

    def each(self, slot: Slot, make: Callable[[Slot], Any]) -> Any:
        """A value, or one for each element of an array, (N, size) or (N, size, 3)."""
        if not isinstance(slot.type, Array):
            return make(slot)
        one = replace(slot, type=slot.type.element)
        return np.stack([make(one) for _ in range(slot.type.size)], axis=1)

    def light_position(self, position: Floats) -> npt.NDArray[np.float32]:
        low, high = self.scene.lights.distance
        distance = np.exp(self.random.uniform(np.log(low), np.log(high), self.count))
        direction = self.toward("l")
        return np.asarray(position + direction * distance[:, None], np.float32)

    def direction(self, slot: Slot) -> Floats:
        setting = self.scene.settings.get(slot.path)
        if isinstance(setting, Constant):
            return np.broadcast_to(np.asarray(setting.value), (self.count, 3))
        to_light = {light.names.get(LIGHT) for light in self.general.lights}
        return self.toward(LIGHT if slot.path in to_light else slot.path)

    def toward(self, path: str) -> Floats:
        """Directions for a role: around the normal as the facts say, hard ones near the hair or its cone."""
        facts, n = self.scene.facts, self.known.get("n")
        if n is None or path == "n":
            result = self.uniform()
        else:
            low, high = facts.get((min("n", path), max("n", path)), (-1.0, 1.0))
            cosine = self.random.uniform(low, high, self.count)
            edge = self.lanes(0.25)
            ends = self.random.choice([low, high, min(max(0.0, low), high)], len(edge))
            cosine[edge] = np.clip(ends + self.offsets(-1.0, len(edge)), low, high)
            result = _at_cosine(n, self.random, cosine)
        hair, viewer = self.known.get("t", n), self.known.get("v")
        if hair is None or path in ("n", "t"):
            return result
        if path == "l" and viewer is not None:
            cone = self.lanes(0.5)
            cosine = -_dots(hair[cone], viewer[cone]) + self.offsets(-0.5, len(cone))
            result[cone] = _at_cosine(hair[cone], self.random, np.clip(cosine, -1.0, 1.0))
        self.put_near(result, hair, self.lanes(0.3))
        if path == "l" and viewer is not None:
            self.put_near(result, viewer, self.lanes(0.1))
        return result

    def lanes(self, share: float) -> npt.NDArray[np.intp]:
        """A share of the hard lanes."""
        hard = np.flatnonzero(self.hard)
        return hard[self.random.random(len(hard)) < share]

    def offsets(self, largest: float, count: int) -> Floats:
        """Numbers of either sign from 1e-7 to 10 to the power of `largest`."""
        sizes = 10.0 ** self.random.uniform(-7.0, largest, count)
        return np.asarray(sizes * self.random.choice([-1.0, 1.0], count))

    def put_near(self, directions: Floats, axis: Floats, lanes: npt.NDArray[np.intp]) -> None:
        """Some directions close to an axis or its opposite."""
        angles = self.random.choice(ANGLES, len(lanes)) * self.random.choice([1.0, 0.3], len(lanes))
        signs = self.random.choice([-1.0, 1.0], len(lanes))[:, None]
        directions[lanes] = _tilted(signs * axis[lanes], self.random, angles)

    def uniform(self) -> Floats:
        return _normalised(self.random.normal(size=(self.count, 3)))

    def value(self, slot: Slot) -> Value:
        setting = self.scene.settings.get(slot.path)
        shape = (self.count, slot.type.size) if isinstance(slot.type, Vector) else (self.count,)
        if isinstance(setting, Constant):
            given = np.asarray(setting.value)
            return np.broadcast_to(given if len(shape) == 2 else given[0], shape).astype(_dtype(slot))
        low, high, scale, least = _ends(slot, setting, self.scene)
        spread: npt.NDArray[Any] = self.spread(low, high, scale, least, shape, slot)
        return spread

    def spread(
        self, low: Floats, high: Floats, scale: str, least: float, shape: tuple[int, ...], slot: Slot
    ) -> Any:
        low, high = (x if len(shape) == 2 else x[0] for x in (low, high))
        share = self.random.random(shape)
        if scale == "log" and np.all(low >= 0.0):
            start = np.maximum(low, np.maximum(max(least, 1e-6), high * 1e-9))
            values = np.exp(np.log(start) + share * (np.log(np.maximum(high, start)) - np.log(start)))
        else:
            values = low + share * (high - low)
        first_end, last_end = np.float32(low), np.float32(high)
        found = values.astype(np.float32)
        np.minimum(np.maximum(found, first_end, out=found), last_end, out=found)
        ends = self.random.random(shape) < END_SHARE * self.hard.reshape(-1, *[1] * (len(shape) - 1)) * 2
        last = self.random.random(shape) >= 0.5
        beside = self.random.random(shape) >= 0.5
        inner = np.nextafter(first_end, last_end), np.nextafter(last_end, first_end)
        choices = np.array([first_end, inner[0], last_end, inner[1]])
        chosen = np.nonzero(ends)
        found[chosen] = choices[(2 * last[chosen] + beside[chosen], *chosen[1:])]
        return found.astype(_dtype(slot), copy=False)


def _ends(slot: Slot, setting: Any, scene: Scene) -> tuple[Floats, Floats, str, float]:
    """Ends per component, the scale to sample by, and where random points by magnitude start."""
    size = slot.type.size if isinstance(slot.type, Vector) else 1
    domain = slot.domain
    scale, least = (domain.scale, domain.least) if isinstance(domain, Interval) else ("linear", 0.0)
    if isinstance(setting, Range):
        return np.array(setting.low), np.array(setting.high), scale, 0.0
    if isinstance(domain, Interval):
        return np.full(size, domain.low), np.full(size, domain.high), scale, least
    reach = domain.high if isinstance(domain, Length) and domain.high <= 1e3 else 1.0
    return np.full(size, -reach), np.full(size, reach), "linear", 0.0


def _dtype(slot: Slot) -> type[np.generic]:
    element = slot.type.element if isinstance(slot.type, Vector) else slot.type
    table: dict[str, type[np.generic]] = {
        "f32": np.float32,
        "i32": np.int32,
        "u32": np.uint32,
        "bool": np.bool_,
    }
    return table[element.name]


def _dots(a: Floats, b: Floats) -> Floats:
    """a.b of the last axes: far faster than a sum along an axis of three."""
    return np.asarray(np.einsum("...k,...k", a, b))


def _normalised(a: Floats) -> Floats:
    return np.asarray(a / np.sqrt(_dots(a, a))[..., None])


def _across(axis: Floats, generator: np.random.Generator) -> Floats:
    """Unit vectors orthogonal to an axis, of any azimuth."""
    other = generator.normal(size=axis.shape)
    other -= _dots(other, axis)[:, None] * axis
    return _normalised(other)


def _at_cosine(axis: Floats, generator: np.random.Generator, cosine: Floats) -> Floats:
    sine = np.sqrt(np.maximum(1.0 - cosine * cosine, 0.0))
    return np.asarray(cosine[:, None] * axis + sine[:, None] * _across(axis, generator))


def _tilted(axis: Floats, generator: np.random.Generator, angle: Floats) -> Floats:
    return np.asarray(np.cos(angle)[:, None] * axis + np.sin(angle)[:, None] * _across(axis, generator))
