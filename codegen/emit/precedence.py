"""Which operand may stand without parentheses. One table serves C, GLSL and WGSL.

It is stricter than C where WGSL's grammar or a reader needs it (shifts, bit operators, && beside ||), and
never lets an operand of the same level stand bare on the right, so a + (b + c) stays what it is.
"""

from __future__ import annotations

import math

from codegen.ir import nodes as ir

_PLAIN = frozenset({"primary", "unary"})
_SUM = _PLAIN | {"product", "sum"}
_TESTS = _SUM | {"comparison"}

LEVEL = {
    "*": "product", "/": "product", "//": "product", "%": "product",
    "+": "sum", "-": "sum",
    "<<": "shift", ">>": "shift",
    "<": "comparison", "<=": "comparison", ">": "comparison", ">=": "comparison",
    "==": "comparison", "!=": "comparison",
    "&": "bit and", "^": "bit xor", "|": "bit or",
    "and": "and", "or": "or",
}  # fmt: skip

LEFT: dict[str, frozenset[str]] = {
    "product": _PLAIN | {"product"},
    "sum": _SUM,
    "shift": _PLAIN,
    "comparison": _SUM,
    "bit and": _PLAIN | {"bit and"},
    "bit xor": _PLAIN | {"bit xor"},
    "bit or": _PLAIN | {"bit or"},
    "and": _TESTS | {"and"},
    "or": _TESTS | {"or"},
}
RIGHT: dict[str, frozenset[str]] = {
    "product": frozenset({"primary"}),
    "sum": _PLAIN - {"unary"} | {"product"},
    "shift": frozenset({"primary"}),
    "comparison": _SUM,
    "bit and": frozenset({"primary"}),
    "bit xor": frozenset({"primary"}),
    "bit or": frozenset({"primary"}),
    "and": _TESTS,
    "or": _TESTS,
}
CONDITION = _TESTS


def level(e: ir.Expr) -> str:
    """The level of an expression's outermost operation."""
    match e:
        case ir.Binary():
            return LEVEL[e.op]
        case ir.Unary():
            return "unary"
        case ir.Const() if not isinstance(e.value, bool) and math.copysign(1.0, e.value) < 0.0:
            return "unary"
        case ir.Select():
            return "conditional"
        case _:
            return "primary"
