"""Guards that ranges prove idle: minima, maxima, clamps, absolute values, comparisons.

before   max(cosine, 1e-12)      with cosine in [0.05, 1]
after    cosine

The proof is the range, which holds on every target (codegen.passes.analysis.ranges), and is logged.
"""

from __future__ import annotations

from codegen.ir import nodes as ir
from codegen.ir.types import BOOL
from codegen.passes.analysis.ranges import Bounds, Ranges
from codegen.passes.ssa.values import Rewrite, Rule, Values, constant_components

NAME = "ranges"
_COMPARISONS = frozenset({"<", "<=", ">", ">=", "==", "!="})


def guards(ranges: Ranges) -> Rule:
    """The rule that removes what is proven idle."""

    def rule(values: Values, e: ir.Expr) -> Rewrite | None:
        match e:
            case ir.Builtin(op="min" | "max" as op, args=(a, b)):
                return _extreme(values, ranges, op, a, b)
            case ir.Builtin(op="clamp"):
                return _clamp(values, ranges, e)
            case ir.Builtin(op="abs", args=(a,)):
                return _magnitude(values, ranges, a)
            case ir.Binary() if e.op in _COMPARISONS:
                return _comparison(values, ranges, e)
        return None

    return rule


def _extreme(values: Values, ranges: Ranges, op: str, a: ir.Expr, b: ir.Expr) -> Rewrite | None:
    for chosen, other in ((a, b), (b, a)):
        if _below(ranges, chosen, other) if op == "min" else _below(ranges, other, chosen):
            return Rewrite(chosen, NAME, _proof(values, ranges, chosen, other))
    return None


def _below(ranges: Ranges, a: ir.Expr, b: ir.Expr) -> bool:
    """Whether a <= b in every component, wherever both are known."""
    return all(
        x.finite and y.finite and x.high <= y.low
        for x, y in zip(ranges.bounds(a), ranges.bounds(b), strict=True)
    )


def _clamp(values: Values, ranges: Ranges, e: ir.Builtin) -> Rewrite | None:
    x, low, high = e.args
    above, under = _below(ranges, low, x), _below(ranges, x, high)
    if above and under:
        return Rewrite(x, NAME, f"{_proof(values, ranges, x)}, inside the ends")
    if not _below(ranges, low, high):
        return None  # with crossed ends targets differ
    if _below(ranges, high, x):
        return Rewrite(high, NAME, _proof(values, ranges, x, high))
    if _below(ranges, x, low):
        return Rewrite(low, NAME, _proof(values, ranges, x, low))
    if above:
        limited = values.build(ir.Builtin(e.type, "min", (x, high)))
        return Rewrite(limited, NAME, _proof(values, ranges, x, low))
    if under:
        limited = values.build(ir.Builtin(e.type, "max", (x, low)))
        return Rewrite(limited, NAME, _proof(values, ranges, x, high))
    return None


def _magnitude(values: Values, ranges: Ranges, a: ir.Expr) -> Rewrite | None:
    found = ranges.bounds(a)
    if all(b.finite and b.low >= 0.0 for b in found):
        return Rewrite(a, NAME, _proof(values, ranges, a))
    if all(b.finite and b.high <= 0.0 for b in found):
        return Rewrite(values.negative(a), NAME, _proof(values, ranges, a))
    return None


def _comparison(values: Values, ranges: Ranges, e: ir.Binary) -> Rewrite | None:
    (found,) = ranges.bounds(e)
    if found.low != found.high:
        return None
    decided = values.number(found.low == 1.0, BOOL)
    return Rewrite(decided, NAME, _proof(values, ranges, e.left, e.right))


def _proof(values: Values, ranges: Ranges, *of: ir.Expr) -> str:
    shown = []
    for e in of:
        if constant_components(e) is None:
            shown.append(f"{values.show(e)} in {_together(ranges.bounds(e))}")
    return f"proven on every target: {', '.join(shown) or 'constants'}"


def _together(found: tuple[Bounds, ...]) -> Bounds:
    return Bounds(min(b.low for b in found), max(b.high for b in found))
