"""The general function of a scene: the model summed over the lights, with every parameter still an input.

It is what a host would write around the library, and the reference that everything specialised is held to:
struct parameters are taken apart, each light has its own inputs, a point light is turned into a direction and
a colour.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from codegen.errors import Place
from codegen.ir import nodes as ir
from codegen.ir.domains import Domain, Interval, Unit
from codegen.ir.types import F32, I32, VEC3, Scalar, Struct, Type, Vector, array_of
from codegen.scene.description.document import Scene
from codegen.scene.description.lights import UNROLLED, Lights
from codegen.scene.description.model import COLOUR, HALF, LIGHT, VIEWER, Slot
from codegen.scene.description.settings import Range
from codegen.scene.environment import ConstantLight

CLOSEST_SQUARE = 1e-12
"""Squared distance to a point light below which its direction fades instead of being normalised."""
REACH = 1e4
"""Largest coordinate of a position."""


@dataclass(frozen=True)
class LightInputs:
    """The inputs of one light, or of all lights of a kind that has too many to be written out.

    kind      "directional", "point" or "constant"
    names     path of the model (with "position" for a point light) -> parameter
    count     how many; more than one: the parameters are arrays
    constant  the lights themselves, for constant ones
    """

    kind: str
    names: dict[str, str]
    count: int = 1
    constant: tuple[ConstantLight, ...] = ()


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
    """The general function over the scene's lights and these constant ones, named FUNCTION_general.

    Up to UNROLLED lights of a kind are written out; more are a loop over arrays.
    """
    builder = _Builder(scene)
    inputs: list[LightInputs] = []
    first = 0
    for kind, count in (("directional", scene.lights.directional), ("point", scene.lights.point)):
        if count > UNROLLED:
            inputs.append(builder.light(kind, "s" if first == 0 else f"s_{first}", count))
        else:
            inputs += [builder.light(kind, builder.suffix.format(first + k)) for k in range(count)]
        first += count
    if len(constant) > UNROLLED:
        inputs.append(builder.constant(tuple(constant)))
    else:
        inputs += [builder.constant((light,)) for light in constant]
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

    def add(self, slot: Slot, name: str, count: int = 1) -> None:
        type_ = slot.type
        if count > 1:
            assert isinstance(type_, Scalar | Vector)
            type_ = array_of(type_, count)
        self.slots[name] = Slot(slot.path, name, type_, slot.domain, slot.doc)

    def light(self, kind: str, suffix: str, count: int = 1) -> LightInputs:
        """One light, or an array of lights, as parameters."""
        names = {}
        if kind == "directional":
            stem = "l" if count == 1 else "light_direction"
            names[LIGHT] = self.own(f"{stem}{suffix}", VEC3, Unit(), "direction to the light", count)
        else:
            what = "position of the light"
            domain = Interval(-REACH, REACH)
            names["position"] = self.own(f"light_position{suffix}", VEC3, domain, what, count)
        what = "linear RGB of the light"
        if kind == "point":
            what += " at distance 1"
        stem = "light" if count == 1 else "light_colour"
        names[COLOUR] = self.own(f"{stem}{suffix}", VEC3, colour_domain(self.scene.lights), what, count)
        for path in self.scene.lights.per_light:
            slot = self.model.slots[path]
            names[path] = f"{slot.name}{suffix}"
            self.add(self.narrowed(slot), names[path], count)
        return LightInputs(kind, names, count)

    def constant(self, lights: tuple[ConstantLight, ...]) -> LightInputs:
        """Constant lights; what each light has of its own is one value for all of these."""
        names = {}
        for path in self.scene.lights.per_light:
            slot = self.model.slots[path]
            names[path] = f"{slot.name}_environment"
            if names[path] not in self.slots:
                self.add(slot, names[path])
        return LightInputs("constant", names, len(lights), lights)

    def narrowed(self, slot: Slot) -> Slot:
        """The slot with the scene's range for its domain: arrays have no other place for it."""
        setting = self.scene.settings.get(slot.path)
        if not isinstance(setting, Range):
            return slot
        return replace(slot, domain=Interval(min(setting.low), max(setting.high)))

    def own(self, name: str, type_: Type, domain: Domain, doc: str, count: int = 1) -> str:
        self.add(Slot(name, name, type_, domain, doc), name, count)
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
            statements, value = (
                self.loop(light, f"_{k}", arguments)
                if light.count > 1
                else self.term(light, f"_{k}", arguments)
            )
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

    def loop(
        self, light: LightInputs, suffix: str, shared: dict[str, ir.Expr]
    ) -> tuple[list[ir.Stmt], ir.Expr]:
        """A loop over the lights of one kind, and its sum."""
        body: list[ir.Stmt] = []
        if light.constant:
            body += [
                ir.Let(f"constant_{what}{suffix}", _array([getattr(one, what) for one in light.constant]))
                for what in ("direction", "colour")
            ]
        total = ir.Var(VEC3, f"total{suffix}")
        statements, value = self.term(light, suffix, shared)
        body.append(ir.Let(total.name, ir.Construct(VEC3, (ir.Const(F32, 0.0),)), mutable=True))
        statements.append(ir.Assign(total.name, ir.Binary(VEC3, "+", total, value)))
        body.append(ir.For(f"light_number{suffix}", 0, light.count, tuple(statements)))
        return body, total

    def element(self, light: LightInputs, name: str, type_: Type, suffix: str) -> ir.Expr:
        """A parameter of one light: itself, or the element of an array."""
        if light.count == 1 or light.kind == "constant":
            return ir.Var(type_, name)
        assert isinstance(type_, Scalar | Vector)
        return ir.Index(
            type_, ir.Var(array_of(type_, light.count), name), ir.Var(I32, f"light_number{suffix}")
        )

    def constants(self, light: LightInputs, suffix: str) -> tuple[ir.Expr, ir.Expr]:
        """Direction and colour of a constant light."""
        if light.count == 1:
            return _vector(light.constant[0].direction), _vector(light.constant[0].colour)
        index = ir.Var(I32, f"light_number{suffix}")
        arrays = (
            ir.Var(array_of(VEC3, light.count), f"constant_{what}{suffix}")
            for what in ("direction", "colour")
        )
        first, second = (ir.Index(VEC3, array, index) for array in arrays)
        return first, second

    def term(
        self, light: LightInputs, suffix: str, shared: dict[str, ir.Expr]
    ) -> tuple[list[ir.Stmt], ir.Expr]:
        """The statements and the value of one light."""
        body: list[ir.Stmt] = []
        arguments = dict(shared)
        if light.constant:
            direction, colour = self.constants(light, suffix)
        elif light.kind == "point":
            statements, direction, colour = self.point(light, suffix)
            body += statements
        else:
            direction = self.element(light, light.names[LIGHT], VEC3, suffix)
            colour = self.element(light, light.names[COLOUR], VEC3, suffix)
        if HALF in self.model.slots:
            half = ir.Call(VEC3, "half_vector", (direction, ir.Var(VEC3, VIEWER)))
            body.append(ir.Let(f"halfway{suffix}", half))
            arguments[HALF] = ir.Var(VEC3, f"halfway{suffix}")
        arguments[LIGHT], arguments[COLOUR] = direction, colour
        for path in self.scene.lights.per_light:
            slot = self.model.slots[path]
            arguments[path] = self.element(light, light.names[path], slot.type, suffix)
        for p in self.model.function.parameters:
            if p.name not in arguments:
                arguments[p.name] = self.mixed(p, light, suffix)
        ordered = tuple(arguments[p.name] for p in self.model.function.parameters)
        value: ir.Expr = ir.Call(VEC3, self.model.function.name, ordered)
        if not self.model.takes_colour:
            value = ir.Binary(VEC3, "*", colour, value)
        body.append(ir.Let(f"radiance{suffix}", value))
        return body, ir.Var(VEC3, f"radiance{suffix}")

    def mixed(self, p: ir.Parameter, light: LightInputs, suffix: str) -> ir.Expr:
        """A struct with some fields of the light's own."""
        assert isinstance(p.type, Struct)
        parts = []
        for f in p.type.fields:
            path = f"{p.name}.{f.name}"
            own = light.names.get(path)
            parts.append(
                ir.Var(f.type, self.shared[path]) if own is None else self.element(light, own, f.type, suffix)
            )
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
                    ir.Binary(
                        VEC3,
                        "-",
                        self.element(light, light.names["position"], VEC3, suffix),
                        ir.Var(VEC3, "position"),
                    ),
                ),
                ir.Let(square.name, ir.Builtin(F32, "dot", (offset, offset))),
                ir.Let(direction.name, ir.Binary(VEC3, "*", scale, offset)),
                ir.Let(
                    colour.name,
                    ir.Binary(VEC3, "/", self.element(light, light.names[COLOUR], VEC3, suffix), falloff),
                ),
            ],
            direction,
            colour,
        )


def _single(value: float) -> float:
    return float(np.float32(value))


def _vector(value: Sequence[float]) -> ir.Expr:
    return ir.Construct(VEC3, tuple(ir.Const(F32, _single(x)) for x in value))


def _array(values: Sequence[Sequence[float]]) -> ir.Expr:
    return ir.Construct(array_of(VEC3, len(values)), tuple(map(_vector, values)))
