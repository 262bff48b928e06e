"""One random program: a source text with structs, helpers and an entry function, and inputs for it."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from typing import Any

import numpy as np

from codegen.ir.types import BOOL, F32, I32, U32, UVEC2, UVEC3, VEC2, VEC3, VEC4, Field, Struct, Type
from conformance.fuzz.choices import NAMES, Choice
from conformance.fuzz.scope import Helper, Local, Scope
from conformance.fuzz.statements import Statements

HEADER = (
    "from typing import Annotated\n"
    "from shaderlib.lang import abs, atan2, bits_to_float, clamp, cos, cross, dot, exp, exp2, f32\n"
    "from shaderlib.lang import float_to_bits, floor, i32, inverse_sqrt, length, log, log2, max, min\n"
    "from shaderlib.lang import normalize, sin, sqrt, u32, uvec2, uvec3, vec2, vec3, vec4\n"
    "from shaderlib.lang import Interval, helper, struct\n"
)
"""What every source of random programs imports."""

RANGE = 4.0
"""Floats of inputs lie in [-RANGE, RANGE]."""
SIGNED_RANGE = 1000
VALUE_TYPES: tuple[Type, ...] = (F32, F32, F32, VEC3, VEC3, VEC2, VEC4, U32, U32, I32, BOOL, UVEC2, UVEC3)
DOMAINS: dict[Type, str] = {
    **{t: f"Interval({-RANGE}, {RANGE})" for t in (F32, VEC2, VEC3, VEC4)},
    I32: f"Interval({-SIGNED_RANGE}.0, {SIGNED_RANGE}.0)",
}


@dataclass(frozen=True)
class Case:
    """A program by its seed and number. `entry` is the function under test; names carry the number."""

    seed: int
    number: int
    text: str
    entry: str

    @property
    def replay(self) -> str:
        """The command that runs just this case."""
        return f"python -m conformance.fuzz --seed {self.seed} --case {self.number}"


def make_case(seed: int, number: int) -> Case:
    """The program of that seed and number, the same wherever it stands among others."""
    choice = Choice(seed * 1_000_003 + number)
    structs: list[Struct] = []
    for k in range(choice.choice((0, 0, 1, 2))):
        structs.append(_struct(choice, f"Pair_{number}_{k}", tuple(structs)))
    parts = [_struct_text(s) for s in structs]
    helpers: list[Helper] = []
    for k in range(choice.choice((0, 0, 1, 2))):
        made, text = _function(choice, f"helper_{number}_{k}", tuple(structs), tuple(helpers))
        helpers.append(made)
        parts.append(f"@helper\n{text}")
    entry, text = _function(choice, f"case_{number}", tuple(structs), tuple(helpers))
    return Case(seed, number, "\n\n".join([*parts, text]) + "\n", entry.name)


def _struct(choice: Choice, name: str, inner: tuple[Struct, ...]) -> Struct:
    names = choice.sample(NAMES, choice.randint(1, 4))
    return Struct(name, tuple(Field(n, choice.choice((*VALUE_TYPES, *inner))) for n in names))


def _annotation(type_: Type) -> str:
    domain = DOMAINS.get(type_)
    return f"Annotated[{type_.name}, {domain}]" if domain else type_.name


def _struct_text(struct: Struct) -> str:
    fields = "\n".join(f"    {f.name}: {_annotation(f.type)}" for f in struct.fields)
    return f"@struct\nclass {struct.name}:\n{fields}"


def _function(
    choice: Choice, name: str, structs: tuple[Struct, ...], helpers: tuple[Helper, ...]
) -> tuple[Helper, str]:
    types = [choice.choice((*VALUE_TYPES, *structs)) for _ in range(choice.randint(1, 4))]
    names = choice.sample(NAMES, len(types))
    scope = Scope(structs, helpers)
    for n, t in zip(names, types, strict=True):
        scope.add(Local(n, t, False, -SIGNED_RANGE, SIGNED_RANGE, parameter=True))
    returns = choice.choice((*VALUE_TYPES, *structs))
    body = Statements(choice, scope, returns).body()
    arguments = ast.arguments([], [ast.arg(n) for n in names], None, [], [], None, [])
    node = ast.FunctionDef(name, arguments, body, [], None, None)
    for argument, t in zip(node.args.args, types, strict=True):
        argument.annotation = ast.parse(_annotation(t), mode="eval").body
    node.returns = ast.parse(returns.name, mode="eval").body
    return Helper(name, tuple(types), returns), _text(node)


def _text(node: ast.FunctionDef) -> str:
    """The source of a function made without places in a text, which printing asks of its statements."""
    open_ends: list[ast.AST] = [node]
    while open_ends:
        statement = open_ends.pop()
        if isinstance(statement, ast.stmt):
            statement.lineno = 1
        open_ends += [*getattr(statement, "body", ()), *getattr(statement, "orelse", ())]
    return ast.unparse(node)


def draw_inputs(case: Case, parameters: Any, lanes: int) -> dict[str, Any]:
    """Inputs of the entry: the first half small dyadic numbers, on which most arithmetic is exact."""
    rng = np.random.Generator(np.random.PCG64([case.seed, case.number]))
    return {p.name: _draw(rng, p.type, lanes) for p in parameters}


def _draw(rng: np.random.Generator, type_: Type, lanes: int) -> Any:
    if isinstance(type_, Struct):
        return {f.name: _draw(rng, f.type, lanes) for f in type_.fields}
    shape = (lanes,) if not hasattr(type_, "size") else (lanes, type_.size)
    element = getattr(type_, "element", type_)
    if element == BOOL:
        return rng.random(shape) < 0.5
    few = slice(lanes // 4)  # of these lanes integers are small enough to end a loop early
    if element == I32:
        signed = rng.integers(-SIGNED_RANGE, SIGNED_RANGE + 1, shape, dtype=np.int32)
        signed[few] = signed[few] % 8 - 2
        return signed
    if element == U32:
        small = rng.integers(0, 64, shape, dtype=np.uint32)
        large = rng.integers(0, 2**32, shape, dtype=np.uint32)
        words = np.where(rng.random(shape) < 0.5, small, large)
        words[few] %= 8
        return words
    values = rng.uniform(-RANGE, RANGE, shape).astype(np.float32)
    values[: lanes // 2] = np.round(values[: lanes // 2] * 4.0) / 4.0
    return values
