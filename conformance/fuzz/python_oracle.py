"""The meaning of a source text by Python itself: executed statement by statement, one lane at a time.

The front end, the IR and its evaluator have no part in this. A shader's f32 is numpy's float32, a u32 its
uint32, an i32 a Python integer (generated programs keep it far from overflow); a vector is a small class.
Constant expressions are folded in double precision and rounded once, as the source language says.
"""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from codegen.evaluate.arrays import Value
from codegen.ir.nodes import Function
from codegen.ir.types import BOOL, F32, I32, Struct, Type, Vector


class Vec:
    """A vector of float32 or uint32; operators work component by component."""

    def __init__(self, parts: Sequence[Any]) -> None:
        self.parts = tuple(parts)

    def __getattr__(self, letters: str) -> Any:
        if letters.startswith("__"):
            raise AttributeError(letters)
        chosen = [self.parts["xyzw".index(c)] for c in letters]
        return chosen[0] if len(chosen) == 1 else Vec(chosen)

    def with_(self, other: Any, apply: Callable[[Any, Any], Any], swap: bool = False) -> Vec:
        """This vector and another one, or a number for all components."""
        others = other.parts if isinstance(other, Vec) else (other,) * len(self.parts)
        pairs = zip(others, self.parts, strict=True) if swap else zip(self.parts, others, strict=True)
        return Vec([apply(a, b) for a, b in pairs])

    def __neg__(self) -> Vec:
        return Vec([-a for a in self.parts])

    def __invert__(self) -> Vec:
        return Vec([~a for a in self.parts])


def _operators() -> None:
    for name in ("add", "sub", "mul", "truediv", "and_", "or_", "xor"):
        apply = getattr(operator, name)
        plain = name.rstrip("_")
        setattr(Vec, f"__{plain}__", lambda a, b, apply=apply: a.with_(b, apply))
        setattr(Vec, f"__r{plain}__", lambda a, b, apply=apply: a.with_(b, apply, swap=True))


_operators()


def each(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function of numbers that takes vectors component by component."""

    def apply(*args: Any) -> Any:
        vector = next((a for a in args if isinstance(a, Vec)), None)
        if vector is None:
            return function(*args)
        return Vec([function(*column) for column in zip(*(a.parts for a in args), strict=True)])

    return apply


def whole(x: Any) -> int:
    """Truncated; 0 for what is no number or infinite, of which no table promises anything."""
    return int(x) if np.isfinite(x) else 0


def to_u32(x: Any) -> np.uint32:
    """Truncated, then modulo 2^32."""
    return np.uint32(whole(x) % 2**32)


def vector(size: int, element: Callable[[Any], Any]) -> Callable[..., Vec]:
    """A constructor: one number fills all components."""

    def construct(*args: Any) -> Vec:
        parts = [p for a in args for p in (a.parts if isinstance(a, Vec) else (element(a),))]
        return Vec(parts * size if len(parts) == 1 else parts)

    return construct


def dot(a: Vec, b: Vec) -> Any:
    """First component first, every operation rounded."""
    total = a.parts[0] * b.parts[0]
    for x, y in zip(a.parts[1:], b.parts[1:], strict=True):
        total = total + x * y
    return total


def cross(a: Vec, b: Vec) -> Vec:
    """The outer product."""
    (ax, ay, az), (bx, by, bz) = a.parts, b.parts
    return Vec([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


def _smaller(a: Any, b: Any) -> Any:
    a, b = _alike(a, b)
    return min(a, b)


def _larger(a: Any, b: Any) -> Any:
    a, b = _alike(a, b)
    return max(a, b)


def _alike(a: Any, b: Any) -> tuple[Any, Any]:
    """A bare literal takes the type of the other operand."""
    if isinstance(a, np.generic) and not isinstance(b, np.generic):
        return a, type(a)(b)
    if isinstance(b, np.generic) and not isinstance(a, np.generic):
        return type(b)(a), b
    return a, b


def _range(*bounds: Any) -> Any:
    """Python's range; its numbers are of the type of a limit, so that those of a u32 wrap."""
    found = range(*bounds)
    return map(np.uint32, found) if isinstance(bounds[-1], np.uint32) else found


def _f(name: str) -> Callable[..., Any]:
    function = getattr(np, name)
    return each(lambda *args: np.float32(function(*map(np.float32, args))))


NAMESPACE: dict[str, Any] = {
    **{name: _f(name) for name in ("floor", "sqrt", "exp", "exp2", "log", "log2", "sin", "cos")},
    "abs": _f("abs"),
    "atan2": _f("arctan2"),
    "inverse_sqrt": each(lambda x: np.float32(1.0) / np.sqrt(np.float32(x))),
    "min": each(_smaller),
    "max": each(_larger),
    "clamp": each(lambda x, low, high: _smaller(_larger(x, low), high)),
    "dot": dot,
    "cross": cross,
    "length": lambda v: np.sqrt(dot(v, v)),
    "normalize": lambda v: v / np.sqrt(dot(v, v)),
    "float_to_bits": lambda x: np.float32(x).view(np.uint32),
    "bits_to_float": lambda x: np.uint32(x).view(np.float32),
    "f32": np.float32,
    "i32": whole,
    "u32": to_u32,
    **{f"vec{n}": vector(n, np.float32) for n in (2, 3, 4)},
    **{f"uvec{n}": vector(n, to_u32) for n in (2, 3)},
    "range": _range,
    "helper": lambda f: f,
}


class _Literals(ast.NodeTransformer):
    """Rounds every outermost constant float expression to float32."""

    def visit(self, node: ast.AST) -> Any:
        if isinstance(node, ast.expr) and _is_constant(node) and _has_float(node):
            rounding = ast.copy_location(ast.Name("f32", ast.Load()), node)
            return ast.copy_location(ast.Call(rounding, [node], []), node)
        return super().visit(node)

    def visit_ClassDef(self, node: ast.ClassDef) -> Any:
        """A struct becomes a class with a constructor."""
        names = [
            item.target.id
            for item in node.body
            if isinstance(item, ast.AnnAssign) and isinstance(item.target, ast.Name)
        ]
        return ast.parse(f"{node.name} = structure({names!r})").body[0]

    def visit_FunctionDef(self, node: ast.FunctionDef) -> Any:
        """Annotations are not executed."""
        node.returns = None
        for argument in node.args.args:
            argument.annotation = None
        return self.generic_visit(node)


def _is_constant(node: ast.expr) -> bool:
    match node:
        case ast.Constant(value=bool()):
            return False
        case ast.Constant(value=int() | float()):
            return True
        case ast.UnaryOp(op=ast.USub(), operand=inner):
            return _is_constant(inner)
        case ast.BinOp(left=left, right=right):
            return _is_constant(left) and _is_constant(right)
        case _:
            return False


def _has_float(node: ast.expr) -> bool:
    return any(isinstance(n, ast.Constant) and isinstance(n.value, float) for n in ast.walk(node))


def structure(names: list[str]) -> Callable[..., dict[str, Any]]:
    """The constructor of a struct: its fields by position or keyword."""

    def construct(*args: Any, **keywords: Any) -> Any:
        return _Fields({**dict(zip(names, args, strict=False)), **keywords}, names)

    return construct


class _Fields(dict[str, Any]):
    """A struct value: fields by attribute."""

    def __init__(self, values: dict[str, Any], order: list[str]) -> None:
        super().__init__({n: values[n] for n in order})

    def __getattr__(self, name: str) -> Any:
        return self[name]


def run(text: str, function: Function, inputs: dict[str, Any], lanes: Sequence[int]) -> Value:
    """The values of a function of the text in some lanes of its inputs, in the shapes of codegen.evaluate."""
    tree = _Literals().visit(ast.parse(text))
    namespace: dict[str, Any] = {**NAMESPACE, "structure": structure}
    exec(compile(tree, "random program", "exec"), namespace)
    entry = namespace[function.name]
    with np.errstate(all="ignore"):
        results = [entry(*(_lane(p.type, inputs[p.name], k) for p in function.parameters)) for k in lanes]
        return _stack(function.returns, results)


def _lane(type_: Type, value: Any, lane: int) -> Any:
    if isinstance(type_, Struct):
        return _Fields(
            {f.name: _lane(f.type, value[f.name], lane) for f in type_.fields}, [f.name for f in type_.fields]
        )
    if isinstance(type_, Vector):
        return Vec(list(value[lane]))
    return int(value[lane]) if type_ == I32 else bool(value[lane]) if type_ == BOOL else value[lane]


def _stack(type_: Type, results: list[Any]) -> Value:
    if isinstance(type_, Struct):
        return {f.name: _stack(f.type, [r[f.name] for r in results]) for f in type_.fields}
    if isinstance(type_, Vector):
        dtype: Any = np.float32 if type_.element == F32 else np.uint32
        return np.array([r.parts for r in results], dtype)
    kinds: dict[Type, Any] = {F32: np.float32, I32: np.int32, BOOL: np.bool_}
    return np.array(results, kinds.get(type_, np.uint32))
