"""What can go wrong in a Python module: the operators that make mutants of the oracle and the generator."""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterator
from typing import TypeVar

from conformance.mutation.sites import Offer

N = TypeVar("N", bound=ast.AST)

COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
}
ARITHMETIC: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.Mod: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Pow: ast.Mult,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
    ast.BitXor: ast.BitAnd,
    ast.LShift: ast.RShift,
    ast.RShift: ast.LShift,
}
CALLS = {
    "min": "max",
    "max": "min",
    "minimum": "maximum",
    "maximum": "minimum",
    "argmax": "argmin",
    "argmin": "argmax",
    "any": "all",
    "all": "any",
    "floor": "ceil",
    "sin": "cos",
    "cos": "sin",
    "log": "log2",
    "log2": "log",
    "exp": "exp2",
    "exp2": "exp",
    "logical_and": "logical_or",
    "logical_or": "logical_and",
    "median": "mean",
    "LEFT": "RIGHT",
    "RIGHT": "LEFT",
}
"""Names that are exchanged, as plain names and as attributes."""
SYMMETRIC = {
    "minimum",
    "maximum",
    "min",
    "max",
    "isinstance",
    "asarray",
    "logical_and",
    "logical_or",
    "all_of",
    "any_of",
}
"""Functions whose arguments are not exchanged: nothing would change, or only a type error would come."""
TRANSPARENT = {"abs", "sqrt", "isfinite", "normalised", "bare", "sorted", "reversed"}
"""Functions whose call is replaced by its argument."""


def changed(node: N, **fields: object) -> N:
    """A copy of the node with other fields."""
    made = copy.deepcopy(node)
    for name, value in fields.items():
        setattr(made, name, value)
    return made


def rule(node: ast.AST) -> Iterator[Offer]:
    """Every operator of this file on one node."""
    if isinstance(node, ast.keyword) and node.arg == "strict":
        node.value.checks_only = True  # type: ignore[attr-defined]  # the mark goes to where the value is visited
    if hasattr(node, "checks_only"):
        return
    _mark_unordered(node)
    yield from _expression(node)
    yield from _collection(node)
    yield from _statement(node)


def _mark_unordered(node: ast.AST) -> None:
    """Members to look up and exceptions to catch have no order.

    A parent is visited before its parts, which carry the mark.
    """
    match node:
        case ast.Compare(ops=[ast.In() | ast.NotIn()], comparators=[ast.Tuple() as unordered]):
            unordered.unordered = True  # type: ignore[attr-defined]
        case ast.Call(func=ast.Name(id="isinstance"), args=[_, ast.Tuple() as unordered]):
            unordered.unordered = True  # type: ignore[attr-defined]
        case ast.ExceptHandler(type=ast.Tuple() as unordered):
            unordered.unordered = True  # type: ignore[attr-defined]


def _expression(node: ast.AST) -> Iterator[Offer]:
    match node:
        case ast.Compare(ops=[op]):
            for other in COMPARISONS[type(op)]:
                yield "comparison", changed(node, ops=[other()])
        case ast.BinOp(op=op, left=left, right=right):
            if type(op) in ARITHMETIC:
                yield "operator", changed(node, op=ARITHMETIC[type(op)]())
            if isinstance(op, ast.Sub | ast.Div):  # inside abs() this is the same
                yield "operands exchanged", changed(node, left=right, right=left)
        case ast.BoolOp(op=op):
            yield "and for or", changed(node, op=ast.Or() if isinstance(op, ast.And) else ast.And())
        case ast.UnaryOp(op=op, operand=operand) if not isinstance(op, ast.UAdd):
            yield "sign or negation dropped", operand
        case ast.IfExp(body=body, orelse=orelse):
            yield "always this side", body
            yield "always that side", orelse
        case ast.Constant():
            yield from _constant(node)
        case ast.JoinedStr(values=values):
            for k, part in enumerate(values):
                if isinstance(part, ast.Constant):
                    yield "text dropped", changed(node, values=[*values[:k], *values[k + 1 :]])
        case ast.Call():
            yield from _call(node)
        case ast.Name(id=name) | ast.Attribute(attr=name) if name in CALLS:
            slot = "id" if isinstance(node, ast.Name) else "attr"
            yield "name exchanged", changed(node, **{slot: CALLS[name]})


def _constant(node: ast.Constant) -> Iterator[Offer]:
    match node.value:
        case bool() as value:
            yield "truth value", ast.Constant(not value)
        case int() as value:
            yield "number", ast.Constant(value + 1)
        case float() as value:
            yield "number", ast.Constant(value * 2.0 if value else 1.0)
        case str() as value if value and len(value) < 40:
            yield "spelling", ast.Constant(f"{value}_")


def _call(node: ast.Call) -> Iterator[Offer]:
    match node.func:
        case ast.Name(id=name) | ast.Attribute(attr=name):
            pass
        case _:
            name = ""
    if name in TRANSPARENT and node.args:
        yield "call dropped", node.args[0]
    plain = name not in SYMMETRIC and not any(isinstance(a, ast.Starred) for a in node.args)
    if plain and len(node.args) >= 2:
        first, second, *rest = node.args
        yield "arguments exchanged", changed(node, args=[second, first, *rest])
    if len(node.args) >= 3 and plain:
        *rest, last, latest = node.args
        yield "last arguments exchanged", changed(node, args=[*rest, latest, last])
    for k, keyword in enumerate(node.keywords):
        if keyword.arg not in (None, "strict", "summary", "copy"):
            yield "keyword dropped", changed(node, keywords=[*node.keywords[:k], *node.keywords[k + 1 :]])


def _collection(node: ast.AST) -> Iterator[Offer]:
    match node:
        case ast.Dict(keys=keys, values=values):
            for k in range(len(keys)):
                yield (
                    "entry dropped",
                    changed(node, keys=[*keys[:k], *keys[k + 1 :]], values=[*values[:k], *values[k + 1 :]]),
                )
        case ast.Set(elts=elements) if len(elements) > 1:
            for k in range(len(elements)):
                yield "element dropped", changed(node, elts=[*elements[:k], *elements[k + 1 :]])
        case ast.Tuple(elts=[first, second, *rest], ctx=ast.Load()) if not hasattr(node, "unordered"):
            yield "elements exchanged", changed(node, elts=[second, first, *rest])
        case ast.comprehension(ifs=[_, *_]):
            yield "filter dropped", changed(node, ifs=[])
        case ast.Slice(lower=ast.AST() as lower, upper=ast.AST() as upper):
            yield "slice end dropped", changed(node, upper=None, lower=lower)
            yield "slice start dropped", changed(node, lower=None, upper=upper)
        case ast.Slice(lower=ast.AST()) | ast.Slice(upper=ast.AST()):
            yield "slice dropped", ast.Slice()


def _statement(node: ast.AST) -> Iterator[Offer]:
    match node:
        case ast.If():
            yield "branch always taken", changed(node, test=ast.Constant(True))
            yield "branch missing", changed(node, test=ast.Constant(False))
        case ast.AugAssign(target=target, op=op, value=value):
            yield "statement missing", ast.Pass()
            yield "assigned, not accumulated", ast.Assign([changed(target, ctx=ast.Store())], value)
            if type(op) in ARITHMETIC:
                yield "operator", changed(node, op=ARITHMETIC[type(op)]())
        case ast.Expr(value=ast.Call()):
            yield "statement missing", ast.Pass()
        case ast.Continue() | ast.Break():
            yield "statement missing", ast.Pass()
        case ast.Assign(targets=[ast.Name(id=name)], value=value) if _mentions(value, name):
            yield "step missing", ast.Pass()
        case ast.Match(cases=cases) if len(cases) > 1:
            for k in range(len(cases)):
                yield "case missing", changed(node, cases=[*cases[:k], *cases[k + 1 :]])


def _mentions(node: ast.AST, name: str) -> bool:
    return any(isinstance(part, ast.Name) and part.id == name for part in ast.walk(node))
