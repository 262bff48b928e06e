"""What a scene knows, in the terms of the passes: constants, aliases, ranges and facts by parameter."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from codegen.ir import nodes as ir
from codegen.ir.domains import Interval, Unit
from codegen.ir.types import BOOL, F32, VEC3, Array, Vector
from codegen.library import Library
from codegen.passes.specialise import Specialised, specialise
from codegen.scene.description.document import Scene
from codegen.scene.description.lights import UNROLLED
from codegen.scene.description.model import COLOUR, LIGHT, Slot
from codegen.scene.description.settings import Alias, Constant, Range
from codegen.scene.general import General
from codegen.scene.reduction.sites import Known, plainly_named

Number = float | int | bool
Given = Number | tuple[Number, ...] | list["Given"]


@dataclass(frozen=True)
class Knowledge:
    """Arguments of codegen.passes.specialise for the general function of a scene."""

    constants: dict[str, Given] = field(default_factory=dict)
    aliases: dict[str, str] = field(default_factory=dict)
    ranges: dict[str, tuple[float, float]] = field(default_factory=dict)
    facts: tuple[tuple[str, float, float], ...] = ()

    def specialised(self, library: Library, name: str, new_name: str, powers: int = 0) -> Specialised:
        """A function of the library with what is known put in; locals have no names of copies.

        powers  largest constant whole exponent that becomes multiplications
        """
        made = specialise(
            library,
            name,
            self.constants,
            self.aliases,
            self.ranges,
            self.facts,
            new_name=new_name,
            powers=powers,
            unroll=UNROLLED,
        )
        return replace(made, function=plainly_named(made.function))

    def facts_of(self, function: ir.Function) -> list[tuple[str, float, float]]:
        """Facts over the parameters that a function has left, and the lengths of its products."""
        names = {p.name for p in function.parameters}
        kept = [fact for fact in self.facts if all(name in names for name in _named(fact[0]))]
        return kept + _lengths(function)


def knowledge(scene: Scene, general: General) -> Knowledge:
    """What is known of the parameters of the general function."""
    known = Knowledge(facts=tuple(_facts(scene, general)))
    for name, slot in general.slots.items():
        setting = scene.settings.get(slot.path)
        if isinstance(setting, Constant):
            known.constants[name] = given(slot, setting.value)
        elif isinstance(setting, Alias):
            known.aliases[name] = _target(general, name, setting.path)
        elif isinstance(setting, Range) and not isinstance(slot.type, Array):
            known.ranges[name] = min(setting.low), max(setting.high)
    colour = scene.lights.constant_colour
    if colour is not None:
        for light in general.lights:
            if COLOUR in light.names:
                name = light.names[COLOUR]
                known.constants[name] = given(
                    general.slots[name], tuple(float(np.float32(x)) for x in colour)
                )
    return known


def given(slot: Slot, value: tuple[float, ...]) -> Given:
    """A constant in the slot's own type."""
    if isinstance(slot.type, Array):
        one = given(replace(slot, type=slot.type.element), value)
        return [one] * slot.type.size
    element = slot.type.element if isinstance(slot.type, Vector) else slot.type
    kind = bool if element == BOOL else float if element == F32 else int
    numbers = tuple(kind(x) for x in value)
    return numbers if isinstance(slot.type, Vector) else numbers[0]


def _target(general: General, name: str, path: str) -> str:
    """The parameter that holds a path: shared, or of the same light."""
    if path in general.shared:
        return general.shared[path]
    own = next((light for light in general.lights if name in light.names.values()), general.lights[0])
    return own.names[path]


def _facts(scene: Scene, general: General) -> list[tuple[str, float, float]]:
    """Facts over parameters; the direction to a point light is none."""
    found = []
    for (a, b), (low, high) in scene.facts.items():
        for x in _holders(general, a):
            for y in _holders(general, b):
                if x != y:
                    found.append((f"dot({x}, {y})", low, high))
    return found


def _holders(general: General, path: str) -> list[str]:
    if path in general.shared:
        return [general.shared[path]]
    return [
        light.names[path]
        for light in general.lights
        if path in light.names and (path != LIGHT or light.kind == "directional")
    ]


def model_ranges(scene: Scene, general: General) -> Known:
    """Least and largest value of the model's scalar parameters and fields, as call sites see them."""
    found: Known = {}
    for path, slot in scene.model.slots.items():
        if slot.type != F32:
            continue
        setting = scene.settings.get(path)
        if isinstance(setting, Alias):
            setting = scene.settings.get(setting.path)
        if isinstance(setting, Constant):
            found[path] = setting.value[0], setting.value[0]
        elif isinstance(setting, Range):
            found[path] = setting.low[0], setting.high[0]
        elif isinstance(slot.domain, Interval):
            found[path] = slot.domain.low, slot.domain.high
    return found


def _lengths(function: ir.Function) -> list[tuple[str, float, float]]:
    """That a cross product of two unit parameters is no longer than 1."""
    units = {p.name for p in function.parameters if isinstance(p.domain, Unit) and p.type == VEC3}
    found = {}
    for e in ir.expressions(function.body):
        if isinstance(e, ir.Builtin) and e.op == "cross":
            pair = [a.name for a in e.args if isinstance(a, ir.Var) and a.name in units]
            if len(pair) == 2:
                product = f"cross({pair[0]}, {pair[1]})"
                found[f"dot({product}, {product})"] = 0.0, 1.0
    return [(expression, low, high) for expression, (low, high) in found.items()]


def _named(expression: str) -> list[str]:
    return [part.strip() for part in expression.removeprefix("dot(").removesuffix(")").split(",")]
