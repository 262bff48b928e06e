"""What can go wrong in a shading function: the operators that make mutants of the library.

Changes that the front end refuses are no mutants; the front end knows the types, this file does not.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator

from conformance.mutation.python_rules import changed
from conformance.mutation.sites import Offer

FACTOR = 1.02
"""Constants are off by 2 %: far above every bound, far below what an eye would see."""
OPERATORS: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.FloorDiv,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
    ast.BitXor: ast.BitOr,
    ast.LShift: ast.RShift,
    ast.RShift: ast.LShift,
}
OPPOSITE: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.GtE,
    ast.LtE: ast.Gt,
    ast.Gt: ast.LtE,
    ast.GtE: ast.Lt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
}
CALLS = {
    "sin": "cos",
    "cos": "sin",
    "min": "max",
    "max": "min",
    "exp": "exp2",
    "exp2": "exp",
    "log": "log2",
    "log2": "log",
    "sqrt": "inverse_sqrt",
    "inverse_sqrt": "sqrt",
}
GUARDS = {"max", "min", "clamp", "abs", "floor", "safe_sqrt", "normalize", "safe_normalize"}
"""Functions whose call is replaced by its first argument."""
SYMMETRIC = {"min", "max", "clamp", "dot"}
"""Built-in functions that give the same with their first two arguments exchanged (clamp: min of max)."""
SYMMETRIC_OF_THE_LIBRARY = {
    "ashikhmin_shirley_pdf",
    "ashikhmin_shirley_value",
    "blinn_phong_pdf",
    "blinn_phong_value",
    "cranley_patterson",
    "fur_slab_depth",
    "ggx_value",
    "half_sum",
    "inherited_shadow",
    "lambert_value",
    "lod_from_pdf",
    "phong_pdf",
    "phong_power",
    "phong_value",
    "poulin_fournier_value",
    "satin_diffuse",
    "satin_highlight",
    "satin_highlight_eight",
    "scheuermann_fade",
    "shell_shadow",
    "shell_sine_power",
    "sin_angle",
    "sin_angle_cosine",
    "sin_angle_cross",
    "sin_angle_half",
    "strand_lobe_defect",
    "strand_specular_half",
    "strand_specular_half_cubic8",
    "strand_specular_half_from4",
    "strand_specular_half_from8",
    "strand_value",
    "ward_pdf",
    "ward_value",
    "wrapped_sum",
}
"""Those of the library: reciprocal lobes, angles, products. test_mutation.py holds them to it."""
COMPONENTS = str.maketrans("xyzw", "yxxz")


def rule(node: ast.AST) -> Iterator[Offer]:
    """Every operator of this file on one node."""
    match node:
        case ast.BinOp(op=op, left=left, right=right):
            if type(op) in OPERATORS:
                yield "operator", changed(node, op=OPERATORS[type(op)]())
            if isinstance(op, ast.Add | ast.Sub | ast.Mult | ast.Div):
                yield "term dropped", left
            if isinstance(op, ast.Add | ast.Mult):
                yield "term dropped", right
            if isinstance(op, ast.Sub | ast.Div):
                yield "operands exchanged", changed(node, left=right, right=left)
        case ast.UnaryOp(op=ast.USub() | ast.Not(), operand=operand):
            yield "sign or negation dropped", operand
        case ast.Compare(ops=[op]) if type(op) in OPPOSITE:
            yield "comparison", changed(node, ops=[OPPOSITE[type(op)]()])
        case ast.BoolOp(op=op):
            yield "and for or", changed(node, op=ast.Or() if isinstance(op, ast.And) else ast.And())
        case ast.Constant(value=float() as value) if value:
            yield "constant", ast.Constant(value * FACTOR)
        case ast.Constant(value=int() as value) if not isinstance(value, bool):
            yield "constant", ast.Constant(value + 1)
        case ast.IfExp(body=body, orelse=orelse):
            yield "always this side", body
            yield "always that side", orelse
        case ast.If():
            yield "branch always taken", changed(node, test=ast.Constant(True))
            yield "guard removed", changed(node, test=ast.Constant(False))
        case ast.AugAssign() | ast.Assign(targets=[ast.Name()]):
            yield from _assignment(node)
        case ast.Attribute(attr=components) if set(components) <= set("xyzw"):
            yield "components", changed(node, attr=components.translate(COMPONENTS))
        case ast.Call(func=ast.Name(id=name)):
            yield from _call(node, name)


def _assignment(node: ast.AugAssign | ast.Assign) -> Iterator[Offer]:
    match node:
        case ast.AugAssign():
            yield "statement missing", ast.Pass()
        case ast.Assign(targets=[ast.Name(id=name)], value=value):
            if any(isinstance(part, ast.Name) and part.id == name for part in ast.walk(value)):
                yield "step missing", changed(node, value=ast.Name(name, ast.Load()))


def _call(node: ast.Call, name: str) -> Iterator[Offer]:
    if name in CALLS:
        yield "function", changed(node, func=ast.Name(CALLS[name], ast.Load()))
    if name in GUARDS and node.args:
        yield "guard removed", node.args[0]
    symmetric = name in SYMMETRIC or name in SYMMETRIC_OF_THE_LIBRARY
    if len(node.args) >= 2 and not symmetric and not name[0].isupper():
        first, second, *rest = node.args
        yield "arguments exchanged", changed(node, args=[second, first, *rest])
