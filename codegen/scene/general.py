"""The general function of a scene: the model summed over the lights, with every parameter still an input.

It is what a host would write around the library, and the reference that everything specialised is held to:
struct parameters are taken apart, each light has its own inputs, a point light is turned into a direction and
a colour.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from codegen.errors import Place
from codegen.ir import nodes as ir
from codegen.ir.domains import Domain, Interval, Unit
from codegen.ir.types import F32, VEC3, Struct, Type
from codegen.scene.document import Scene
from codegen.scene.environment import ConstantLight
from codegen.scene.lights import Lights
from codegen.scene.model import COLOUR, HALF, LIGHT, VIEWER, Slot

CLOSEST_SQUARE = 1e-12
"""Squared distance to a point light below which its direction fades instead of being normalised."""
REACH = 1e4
"""Largest coordinate of a position."""


@dataclass(frozen=True)
class LightInputs:
    """The names that one light's inputs have: what it is, and the model's path -> name of the parameter.

    kind   "directional", "point" or "constant"
    names  path of the model (with "position" for a point light) -> parameter
    """

    kind: str
    names: dict[str, str]
    constant: ConstantLight | None = None


@dataclass(frozen=True)
class General:
    """The general function with what its parameters stand for.

    slots   parameter -> slot of the model; those of lights included
    lights  the inputs of each light
    """

    function: ir.Function
    slots: dict[str, Slot]
    lights: tuple[LightInputs, ...]
    shared: dict[str, str]
    model: str

    @property
    def model_calls(self) -> list[int]:
        """Which of the function's calls are those of the model, by their number among all calls."""
        calls = [e for e in ir.expressions(self.function.body) if isinstance(e, ir.Call)]
        return [k for k, call in enumerate(calls) if call.function == self.model]


def colour_domain(lights: Lights) -> Interval:
    """The domain of a light's colour."""
    if len(lights.colour) == 3:
        return Interval(min(lights.colour), max(lights.colour))
    return Interval(*lights.colour)


def general_function(scene: Scene, constant: Sequence[ConstantLight] = ()) -> General:
    """The general function over the scene's lights and these constant ones, named FUNCTION_general."""
    builder = _Builder(scene)
    inputs = [builder.light("directional", k) for k in range(scene.lights.directional)]
    inputs += [builder.light("point", scene.lights.directional + k) for k in range(scene.lights.point)]
    inputs += [builder.constant(light, k) for k, light in enumerate(constant)]
    return builder.finish(inputs)


class _Builder:
    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.model = scene.model
        self.slots: dict[str, Slot] = {}
        self.shared: dict[str, str] = {}
        single = scene.lights.varying == 1 and scene.lights.environment is None
        self.suffix = "" if single else "_{}"
        per_light = {LIGHT, COLOUR, HALF, *scene.lights.per_light}
        for path, slot in self.model.slots.items():
            if path not in per_light:
                self.add(slot, slot.name)
                self.shared[path] = slot.name
        if HALF in self.model.slots and VIEWER not in self.model.slots:
            self.add(self.model.directions[VIEWER], VIEWER)
            self.shared[VIEWER] = VIEWER
        if scene.lights.point:
            what = "position of the shaded point, in one space with the lights"
            self.add(Slot("position", "position", VEC3, Interval(-REACH, REACH), what), "position")

    def add(self, slot: Slot, name: str) -> None:
        self.slots[name] = Slot(slot.path, name, slot.type, slot.domain, slot.doc)

    def light(self, kind: str, k: int) -> LightInputs:
        suffix = self.suffix.format(k)
        names = {}
        if kind == "directional":
            names[LIGHT] = self.own(f"l{suffix}", VEC3, Unit(), "direction to the light")
        else:
            what = "position of the light"
            names["position"] = self.own(f"light_position{suffix}", VEC3, Interval(-REACH, REACH), what)
        what = "linear RGB of the light"
        if kind == "point":
            what += " at distance 1"
        names[COLOUR] = self.own(f"light{suffix}", VEC3, colour_domain(self.scene.lights), what)
        for path in self.scene.lights.per_light:
            slot = self.model.slots[path]
            self.add(slot, slot.name + suffix)
            names[path] = slot.name + suffix
        return LightInputs(kind, names)

    def constant(self, light: ConstantLight, k: int) -> LightInputs:
        """A constant light has the first light's parameters of its own, or new ones where there is none."""
        names = {}
        for path in self.scene.lights.per_light:
            slot = self.model.slots[path]
            name = f"{slot.name}_environment"
            if name not in self.slots:
                self.add(slot, name)
            names[path] = name
        return LightInputs("constant", names, light)

    def own(self, name: str, type_: Type, domain: Domain, doc: str) -> str:
        self.slots[name] = Slot(name, name, type_, domain, doc)
        return name

    def finish(self, inputs: list[LightInputs]) -> General:
        body: list[ir.Stmt] = []
        arguments: dict[str, ir.Expr] = {}
        for p in self.model.function.parameters:
            if isinstance(p.type, Struct):
                fields = [self.shared.get(f"{p.name}.{f.name}") for f in p.type.fields]
                if all(fields):
                    parts = tuple(ir.Var(f.type, str(n)) for f, n in zip(p.type.fields, fields, strict=True))
                    body.append(ir.Let(p.name, ir.Construct(p.type, parts)))
                    arguments[p.name] = ir.Var(p.type, p.name)
            elif p.name in self.shared:
                arguments[p.name] = ir.Var(p.type, self.shared[p.name])
        total: ir.Expr | None = None
        for k, light in enumerate(inputs):
            statements, value = self.term(light, f"_{k}", arguments)
            body += statements
            total = value if total is None else ir.Binary(VEC3, "+", total, value)
        assert total is not None
        body.append(ir.Return(total))
        model = self.model.function
        parameters = tuple(ir.Parameter(name, s.type, s.domain) for name, s in self.slots.items())
        doc = ir.Doc(
            f"{model.doc.summary.rstrip('.')}, summed over the lights of a scene.",
            {name: s.doc for name, s in self.slots.items()},
        )
        function = ir.Function(
            name=f"{self.scene.function}_general",
            module="scene",
            kind="base",
            base=None,
            parameters=parameters,
            returns=VEC3,
            body=tuple(body),
            doc=doc,
            place=Place(self.scene.path.name, 1),
        )
        return General(function, self.slots, tuple(inputs), self.shared, model.name)

    def term(
        self, light: LightInputs, suffix: str, shared: dict[str, ir.Expr]
    ) -> tuple[list[ir.Stmt], ir.Expr]:
        """The statements and the value of one light."""
        body: list[ir.Stmt] = []
        arguments = dict(shared)
        if light.constant is not None:
            direction: ir.Expr = _vector(light.constant.direction)
            colour: ir.Expr = _vector(light.constant.colour)
        elif light.kind == "point":
            statements, direction, colour = self.point(light, suffix)
            body += statements
        else:
            direction, colour = ir.Var(VEC3, light.names[LIGHT]), ir.Var(VEC3, light.names[COLOUR])
        if HALF in self.model.slots:
            half = ir.Call(VEC3, "half_vector", (direction, ir.Var(VEC3, VIEWER)))
            body.append(ir.Let(f"halfway{suffix}", half))
            arguments[HALF] = ir.Var(VEC3, f"halfway{suffix}")
        arguments[LIGHT], arguments[COLOUR] = direction, colour
        for path in self.scene.lights.per_light:
            slot = self.model.slots[path]
            arguments[path] = ir.Var(slot.type, light.names[path])
        for p in self.model.function.parameters:
            if p.name not in arguments:
                arguments[p.name] = self.mixed(p, light)
        ordered = tuple(arguments[p.name] for p in self.model.function.parameters)
        value: ir.Expr = ir.Call(VEC3, self.model.function.name, ordered)
        if not self.model.takes_colour:
            value = ir.Binary(VEC3, "*", colour, value)
        body.append(ir.Let(f"radiance{suffix}", value))
        return body, ir.Var(VEC3, f"radiance{suffix}")

    def mixed(self, p: ir.Parameter, light: LightInputs) -> ir.Expr:
        """A struct with some fields of the light's own."""
        assert isinstance(p.type, Struct)
        parts = []
        for f in p.type.fields:
            path = f"{p.name}.{f.name}"
            parts.append(ir.Var(f.type, light.names.get(path) or self.shared[path]))
        return ir.Construct(p.type, tuple(parts))

    def point(self, light: LightInputs, suffix: str) -> tuple[list[ir.Stmt], ir.Expr, ir.Expr]:
        """Direction and colour of a point light: inverse square down to the scene's least distance."""
        offset, square = ir.Var(VEC3, f"offset{suffix}"), ir.Var(F32, f"distance_square{suffix}")
        direction = ir.Var(VEC3, f"to_light{suffix}")
        colour = ir.Var(VEC3, f"arriving{suffix}")
        least = ir.Const(F32, _single(self.scene.lights.distance[0] ** 2))
        closest = ir.Const(F32, _single(CLOSEST_SQUARE))
        scale = ir.Builtin(F32, "inverse_sqrt", (ir.Builtin(F32, "max", (square, closest)),))
        falloff = ir.Builtin(F32, "max", (square, least))
        return (
            [
                ir.Let(
                    offset.name,
                    ir.Binary(VEC3, "-", ir.Var(VEC3, light.names["position"]), ir.Var(VEC3, "position")),
                ),
                ir.Let(square.name, ir.Builtin(F32, "dot", (offset, offset))),
                ir.Let(direction.name, ir.Binary(VEC3, "*", scale, offset)),
                ir.Let(colour.name, ir.Binary(VEC3, "/", ir.Var(VEC3, light.names[COLOUR]), falloff)),
            ],
            direction,
            colour,
        )


def _single(value: float) -> float:
    return float(np.float32(value))


def _vector(value: Sequence[float]) -> ir.Expr:
    return ir.Construct(VEC3, tuple(ir.Const(F32, _single(x)) for x in value))
