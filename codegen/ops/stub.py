"""Generates shaderlib/lang.py from the registry: what editors and type checkers know of the language."""

from __future__ import annotations

import itertools

from codegen.ir.types import VALUE_TYPES, Vector, vector_of
from codegen.ops.registry import BUILTINS, OPERATORS

_HEADER = '''\
"""Types, built-ins and markers of the shader language, for editors and type checkers.

Generated from the op registry by `python -m codegen.generate`; do not edit. Shader sources are parsed, never
executed: nothing here computes anything.
"""

# mypy: disable-error-code="empty-body, no-overload-impl, misc, overload-overlap, override"
# (declarations only; f32 is Python's float and u32 its int)

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar, dataclass_transform, overload

f32 = float
i32 = int
u32 = int

_T = TypeVar("_T")
_F = TypeVar("_F", bound=Callable[..., Any])


class Interval:
    """A number, or every component, in [low, high]; scale "log" samples by magnitude from `least`."""

    def __init__(self, low: float, high: float, scale: str = "linear", least: float = 0.0) -> None: ...


class Unit:
    """A unit vector, up to the rounding of its length in float32."""


class Length:
    """A vector of any direction whose length is 0 or in [low, high]."""

    def __init__(self, low: float, high: float) -> None: ...


class Finite:
    """Any finite value."""


class Edges:
    """How a map goes on beyond its edges along u and v: "repeat" or "clamp"."""

    def __init__(self, u: str, v: str) -> None: ...


class Texture:
    """A map of RGBA floats with its levels and its sampler."""


def helper(function: _F) -> _F:
    """Mark a function as not public: emitted only where something needs it."""
    raise NotImplementedError


def variant(base: str) -> Callable[[_F], _F]:
    """Mark a function as computing what `base` computes, at another cost and error."""
    raise NotImplementedError


def printed(base: str) -> Callable[[_F], _F]:
    """Mark a function as the lecture's formula to the letter, kept for comparison with `base`."""
    raise NotImplementedError


@dataclass_transform(frozen_default=True)
def struct(cls: type[_T]) -> type[_T]:
    """Mark a class as a struct: annotated fields and a docstring."""
    raise NotImplementedError
'''

_DUNDERS = {
    "+": "add", "-": "sub", "*": "mul", "/": "truediv", "//": "floordiv", "%": "mod",
    "&": "and", "|": "or", "^": "xor",
}  # fmt: skip


def generate() -> str:
    """The text of shaderlib/lang.py."""
    vectors = [t for t in VALUE_TYPES.values() if isinstance(t, Vector)]
    parts = [_HEADER, *map(_vector_class, vectors), *(_builtin(name) for name in sorted(BUILTINS))]
    return "\n\n".join(part.strip("\n") + "\n" for part in parts)


def _vector_class(type_: Vector) -> str:
    letters = "xyzw"[: type_.size]
    lines = [
        f"class {type_.name}:",
        f'    """{type_.size} components of {type_.element.name}, made of scalars or shorter vectors."""',
        "",
        f"    def __init__(self, *components: {_component_types(type_)}) -> None: ...",
    ]
    for count in (1, 2, 3):
        for letters_chosen in itertools.product(letters, repeat=count):
            result = vector_of(type_.element, count)
            if result is not None:
                lines += ["    @property", f"    def {''.join(letters_chosen)}(self) -> {result.name}: ..."]
    for symbol, dunder in _DUNDERS.items():
        forward = [t[1] for t, _ in OPERATORS[symbol].rule if len(t) == 2 and t[0] == type_]
        if forward:
            others = " | ".join(t.name for t in forward)
            lines.append(f"    def __{dunder}__(self, other: {others}) -> {type_.name}: ...")
        backward = [
            t[0] for t, _ in OPERATORS[symbol].rule if len(t) == 2 and t[1] == type_ and t[0] != type_
        ]
        if backward:
            others = " | ".join(t.name for t in backward)
            lines.append(f"    def __r{dunder}__(self, other: {others}) -> {type_.name}: ...")
    if OPERATORS["negate"].result((type_,)):
        lines.append(f"    def __neg__(self) -> {type_.name}: ...")
    return "\n".join(lines)


def _component_types(type_: Vector) -> str:
    shorter = [t.name for t in VALUE_TYPES.values() if isinstance(t, Vector) and t.element == type_.element]
    return " | ".join([type_.element.name, *shorter[: type_.size - 2]])


def _builtin(name: str) -> str:
    op = BUILTINS[name]
    lines = []
    rule = [(types, result) for types, result in op.rule]
    seen: set[tuple[str, ...]] = set()
    overloads = []
    for types, result in rule:
        # f32 is Python's float and u32, i32 its int: later overloads of the same Python types say nothing new
        key = tuple({"f32": "float", "i32": "int", "u32": "int"}.get(t.name, t.name) for t in types)
        if key not in seen:
            seen.add(key)
            overloads.append((types, result))
    # int is acceptable where float is expected, so float overloads come last to keep integers integral
    overloads.sort(key=lambda o: o[0][0].name == "f32")
    for types, result in overloads:
        if len(overloads) > 1:
            lines.append("@overload")
        arguments = ", ".join(f"{n}: {t.name}" for n, t in zip(op.names, types, strict=True))
        lines.append(f"def {name}({arguments}) -> {result.name}: ...")
    if len(overloads) > 1:
        arguments = ", ".join(f"{n}: Any" for n in op.names)
        lines += [
            f"def {name}({arguments}) -> Any:",
            f'    """{op.summary}"""',
            "    raise NotImplementedError",
        ]
    else:
        lines[-1] = lines[-1].removesuffix(" ...")
        lines += [f'    """{op.summary}"""', "    raise NotImplementedError"]
    return "\n".join(lines)
