"""Guards one at a time, over ranges that are given: what is idle, what may act, and the proof that is told.

Plan. x in [0.5, 2], y in [3, 4], n in [-2, -1], p in [0, 1], m in [-1, 0], z in [0.25, 3], g in [-1, 0.5];
c and e are 1; of f nothing is known, of h and l one end only. (Whole functions: test_passes_guards.)
  idle   every guard in every order of its operands, ends that only touch included
  acts   ranges that overlap, ends that may cross, components of which one is not decided
"""

from __future__ import annotations

import math
from typing import cast

import pytest

from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, VEC2, Type
from codegen.passes.analysis.ranges import Bounds, Ranges
from codegen.passes.rules.guards import guards
from codegen.passes.rules.scalars import components
from codegen.passes.ssa import patterns
from codegen.passes.ssa.values import Values, constant_components

KNOWN = {
    "x": (0.5, 2.0), "y": (3.0, 4.0), "n": (-2.0, -1.0), "p": (0.0, 1.0), "m": (-1.0, 0.0),
    "z": (0.25, 3.0), "f": (-math.inf, math.inf), "h": (1.0, math.inf), "l": (-math.inf, -1.0),
    "g": (-1.0, 0.5), "c": (1.0, 1.0), "e": (1.0, 1.0),
}  # fmt: skip


class Given:
    """Ranges of variables and constants as they are given; of comparisons, what follows from these."""

    def bounds(self, e: ir.Expr) -> tuple[Bounds, ...]:
        numbers = constant_components(e)
        if numbers is not None:
            return tuple(Bounds(float(x), float(x)) for x in numbers)
        match e:
            case ir.Var():
                return (Bounds(*KNOWN[e.name]),)
            case ir.Construct():
                parts = [b for a in e.args for b in self.bounds(a)]
                return tuple(parts * 2 if len(parts) == 1 else parts)
            case ir.Binary():
                return (self.compared(e),)
            case _:
                raise TypeError(type(e).__name__)

    def compared(self, e: ir.Binary) -> Bounds:
        (a,), (b,) = self.bounds(e.left), self.bounds(e.right)
        less, equal = (a.high < b.low), (a.low == a.high == b.low == b.high)
        more, apart = (a.low > b.high), (a.high < b.low or a.low > b.high)
        sure, never = {
            "<": (less, a.low >= b.high), "<=": (a.high <= b.low, more), ">": (more, a.high <= b.low),
            ">=": (a.low >= b.high, less), "==": (equal, apart), "!=": (apart, equal),
        }[e.op]  # fmt: skip
        return Bounds(1.0 if sure else 0.0, 0.0 if never else 1.0)


def simplified(text: str, type_: Type) -> tuple[str, list[str]]:
    """What is left of a guard, and the reasons that are logged."""
    values = Values(rules=(components, guards(cast(Ranges, Given()))))
    given: dict[str, ir.Expr] = {name: values.intern(ir.Var(F32, name)) for name in KNOWN}
    pairs = {f"{a}{b}": (given[a], given[b]) for a in "xynzpm" for b in "xynzpm"}
    given |= {name: values.build(ir.Construct(VEC2, parts)) for name, parts in pairs.items()}
    found = patterns.make(patterns.parse(text), given, values, type_)
    assert all(s.name == "ranges" for s in values.log if "proven" in s.why)
    return values.show(found), [s.why for s in values.log if s.name == "ranges"]


IDLE: dict[str, tuple[str, str]] = {
    "min(x, 5.0)": ("x", "x in [0.5, 2]"),
    "min(5.0, x)": ("x", "x in [0.5, 2]"),
    "min(x, 2.0)": ("x", "x in [0.5, 2]"),
    "min(x, 0.25)": ("0.25", "x in [0.5, 2]"),
    "min(0.5, x)": ("0.5", "x in [0.5, 2]"),
    "min(x, y)": ("x", "x in [0.5, 2], y in [3, 4]"),
    "min(y, x)": ("x", "x in [0.5, 2], y in [3, 4]"),
    "max(x, y)": ("y", "y in [3, 4], x in [0.5, 2]"),
    "max(y, x)": ("y", "y in [3, 4], x in [0.5, 2]"),
    "max(x, 0.5)": ("x", "x in [0.5, 2]"),
    "max(0.25, x)": ("x", "x in [0.5, 2]"),
    "max(x, 2.0)": ("2", "x in [0.5, 2]"),
    "min(1.0, 2.0)": ("1", "constants"),
    "max(xy, 0.5)": ("vec2(x, y)", "vec2(x, y) in [0.5, 4]"),
    "min(xn, yp)": ("vec2(x, n)", "vec2(x, n) in [-2, 2], vec2(y, p) in [0, 4]"),
    "clamp(x, 0.5, 2.0)": ("x", "x in [0.5, 2], inside the ends"),
    "clamp(x, n, y)": ("x", "x in [0.5, 2], inside the ends"),
    "clamp(x, 2.0, 9.0)": ("2", "x in [0.5, 2]"),
    "clamp(x, -9.0, 0.5)": ("0.5", "x in [0.5, 2]"),
    "clamp(x, y, 9.0)": ("y", "x in [0.5, 2], y in [3, 4]"),
    "clamp(y, 0.0, x)": ("x", "y in [3, 4], x in [0.5, 2]"),
    "clamp(x, 0.0, 1.0)": ("min(x, 1)", "x in [0.5, 2]"),
    "clamp(x, n, 1.0)": ("min(x, 1)", "x in [0.5, 2], n in [-2, -1]"),
    "clamp(x, 1.0, 9.0)": ("max(x, 1)", "x in [0.5, 2]"),
    "clamp(x, 1.0, y)": ("max(x, 1)", "x in [0.5, 2], y in [3, 4]"),
    "clamp(x, z, 4.0)": ("max(x, z)", "x in [0.5, 2]"),
    "clamp(xx, 0.0, 1.0)": ("min(vec2(x), vec2(1))", "vec2(x) in [0.5, 2]"),
    "abs(x)": ("x", "x in [0.5, 2]"),
    "abs(p)": ("p", "p in [0, 1]"),
    "abs(xp)": ("vec2(x, p)", "vec2(x, p) in [0, 2]"),
    "abs(n)": ("-n", "n in [-2, -1]"),
    "abs(m)": ("-m", "m in [-1, 0]"),
    "abs(nm)": ("-(vec2(n, m))", "vec2(n, m) in [-2, 0]"),
    "x < y": ("true", "x in [0.5, 2], y in [3, 4]"),
    "y < x": ("false", "y in [3, 4], x in [0.5, 2]"),
    "x <= 2.0": ("true", "x in [0.5, 2]"),
    "y <= x": ("false", "y in [3, 4], x in [0.5, 2]"),
    "y > x": ("true", "y in [3, 4], x in [0.5, 2]"),
    "x > 5.0": ("false", "x in [0.5, 2]"),
    "x >= n": ("true", "x in [0.5, 2], n in [-2, -1]"),
    "x >= y": ("false", "x in [0.5, 2], y in [3, 4]"),
    "x == y": ("false", "x in [0.5, 2], y in [3, 4]"),
    "min(c, e)": ("c", "c in [1, 1], e in [1, 1]"),
    "max(e, c)": ("e", "e in [1, 1], c in [1, 1]"),
    "c == e": ("true", "c in [1, 1], e in [1, 1]"),
    "c != e": ("false", "c in [1, 1], e in [1, 1]"),
    "x != y": ("true", "x in [0.5, 2], y in [3, 4]"),
}


def type_of(text: str) -> Type:
    if any(op in text for op in "<>=!"):
        return BOOL
    words = text.replace("(", " ").replace(",", " ").replace(")", " ").split()[1:]
    return VEC2 if any(len(w) == 2 and w.isalpha() for w in words) else F32


@pytest.mark.parametrize("text", IDLE)
def test_idle_guard_is_gone_and_its_proof_told(text: str) -> None:
    left, proof = IDLE[text]
    found, reasons = simplified(text, type_of(text))
    assert found == left.replace("-(vec2(n, m))", "-vec2(n, m)")
    assert reasons == [f"proven on every target: {proof}"]


ACTS = (
    *("min(x, 1.0)", "min(x, z)", "max(x, z)", "max(x, 0.75)", "min(f, x)", "max(x, f)", "max(h, 1.0)"),
    *("min(1.0, h)", "max(l, -1.0)", "min(l, x)", "max(xy, 1.0)", "max(yx, 1.0)", "min(xn, xy)"),
    *("clamp(x, 0.75, 1.0)", "clamp(x, z, 2.0)", "clamp(x, f, 2.0)", "clamp(x, z, 1.0)"),
    *("clamp(x, 5.0, 1.0)", "clamp(y, 5.0, 1.0)", "clamp(y, 5.0, 3.5)", "clamp(x, 0.25, 0.125)"),
    *("clamp(xy, 0.75, 3.5)", "clamp(f, 0.0, 1.0)", "clamp(h, 1.0, 2.0)", "clamp(l, -2.0, -1.0)"),
    *("abs(f)", "abs(g)", "abs(h)", "abs(l)", "abs(xn)", "abs(nx)"),
    *("x < z", "x <= 1.0", "x > 1.0", "x >= 2.0", "x == 1.0", "x != 1.0", "f < x"),
)


@pytest.mark.parametrize("text", ACTS)
def test_guard_that_may_act_is_left(text: str) -> None:
    assert simplified(text, type_of(text))[1] == []


@pytest.mark.parametrize("text", ["floor(x)", "x + 0.0", "sqrt(y)"])
def test_what_is_no_guard_is_left(text: str) -> None:
    values = Values()
    x = {name: values.intern(ir.Var(F32, name)) for name in "xy"}
    e = patterns.make(patterns.parse(text), x, values, F32)
    assert guards(cast(Ranges, Given()))(values, e) is None
