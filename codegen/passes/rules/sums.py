"""Sums whose terms cancel: products are multiplied out where a term with a variable then vanishes exactly.

before   (1 + k) * r + (1 - k) * r        0.5 * (a + b) + 0.5 * (a - b)
after    2 * r                            a

The result is the same real number, so it lies among what the roundings of the original permit where either
neighbour may be taken. Constants never cancel: (x + c) - c may be there to round x.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from codegen.intervals.numbers import LARGEST, SMALLEST
from codegen.ir import nodes as ir
from codegen.ir.types import F32, Type, Vector
from codegen.passes.analysis.operations import number_of_operations
from codegen.passes.ssa.values import Rewrite, Rule, Values, constant_components

NAME = "sums"
WHY = "real: terms cancel exactly when multiplied out, so the result is the same real number"
MOST_TERMS = 16
"""Longest sum of products that is looked at."""
DEEPEST = 6
"""Operations inside each other that are multiplied out."""

Monomial = tuple[int, ...]
Factor = int | Fraction
"""Exact; whole numbers as integers, whose arithmetic is much faster."""
Polynomial = dict[Monomial, Factor]
"""Products of values (their numbers in order of first sight, sorted) with their exact factors.

Not their ids: products are rebuilt in this order, and text must not depend on where values lie in memory.
"""


def cancellation() -> Rule:
    """The rule that replaces a sum by what is left of it; it remembers what it multiplied out."""
    expanded = _Expansion()

    def rule(values: Values, e: ir.Expr) -> Rewrite | None:
        if not (isinstance(e, ir.Binary) and e.op in ("+", "-") and _element(e.type) == F32):
            return None
        if not _subtracts(e, DEEPEST):
            return None
        found = expanded.of(e, DEEPEST)
        if found is None or not found.cancels:
            return None
        left = {monomial: factor for monomial, factor in found.terms.items() if factor}
        made = _rebuilt(values, left, expanded.atoms, e)
        if made is None or _cost(made) >= _cost(e):
            return None
        return Rewrite(made, NAME, WHY)

    return rule


def _subtracts(e: ir.Expr, depth: int) -> bool:
    """Whether anything that is multiplied out has a minus, without which nothing cancels."""
    match e:
        case ir.Binary(op="-") | ir.Unary(op="negate"):
            return True
        case ir.Binary(op="+" | "*") if depth > 0:
            return _subtracts(e.left, depth - 1) or _subtracts(e.right, depth - 1)
        case _:
            return any(x < 0 for x in constant_components(e) or ())


@dataclass(frozen=True)
class _Sum:
    """A sum of products, and whether a product of variables cancelled on the way."""

    terms: Polynomial
    cancels: bool = False


class _Expansion:
    """Multiplies out values, each once per depth; `atoms` keeps what products are made of, by number."""

    def __init__(self) -> None:
        self.atoms: dict[int, ir.Expr] = {}
        self._numbers: dict[int, int] = {}
        self._known: dict[tuple[int, int], tuple[_Sum | None, ir.Expr]] = {}

    def of(self, e: ir.Expr, depth: int) -> _Sum | None:
        """The value multiplied out; None where that takes too many terms."""
        key = id(e), depth
        if key not in self._known:
            self._known[key] = self.made(e, depth), e
        return self._known[key][0]

    def made(self, e: ir.Expr, depth: int) -> _Sum | None:
        numbers = constant_components(e)
        if numbers is not None:
            same = all(x == numbers[0] for x in numbers)
            return _Sum({(): _exact(float(numbers[0]))}) if same else self.atom(e)
        if depth > 0:
            match e:
                case ir.Unary(op="negate"):
                    return _scaled(self.of(e.operand, depth - 1), -1)
                case ir.Binary(op="+" | "-" as op):
                    return _added(self.of(e.left, depth - 1), self.of(e.right, depth - 1), op)
                case ir.Binary(op="*"):
                    return _multiplied(self.of(e.left, depth - 1), self.of(e.right, depth - 1))
        return self.atom(e)

    def atom(self, e: ir.Expr) -> _Sum:
        """One value by its number, which is below 0 for a constant with components of their own."""
        count = len(self._numbers)
        is_constant = constant_components(e) is not None
        number = self._numbers.setdefault(id(e), ~count if is_constant else count)
        self.atoms[number] = e
        return _Sum({(number,): 1})


def _exact(number: float) -> Factor:
    return int(number) if number.is_integer() else Fraction(number)


def _added(a: _Sum | None, b: _Sum | None, op: str) -> _Sum | None:
    if a is None or b is None:
        return None
    total, cancels = dict(a.terms), a.cancels or b.cancels
    for monomial, factor in b.terms.items():
        added = total.get(monomial, 0) + (factor if op == "+" else -factor)
        varies = any(number >= 0 for number in monomial)
        cancels = cancels or (added == 0 and factor != 0 and varies)
        total[monomial] = added
    return _Sum(total, cancels) if len(total) <= MOST_TERMS else None


def _multiplied(a: _Sum | None, b: _Sum | None) -> _Sum | None:
    if a is None or b is None or len(a.terms) * len(b.terms) > MOST_TERMS:
        return None
    total: Polynomial = {}
    for p, x in a.terms.items():
        for q, y in b.terms.items():
            monomial = tuple(sorted((*p, *q)))
            total[monomial] = total.get(monomial, 0) + x * y
    return _Sum(total, a.cancels or b.cancels)


def _scaled(a: _Sum | None, by: Factor) -> _Sum | None:
    if a is None:
        return None
    return _Sum({monomial: factor * by for monomial, factor in a.terms.items()}, a.cancels)


def _rebuilt(
    values: Values, left: Mapping[Monomial, Factor], atoms: Mapping[int, ir.Expr], like: ir.Expr
) -> ir.Expr | None:
    """The sum of what is left, positive terms first; None where a factor is no float32."""
    total: ir.Expr | None = None
    for monomial, factor in sorted(left.items(), key=lambda item: item[1] < 0):
        term = _term(values, monomial, factor if factor > 0 else -factor, atoms)
        if term is None:
            return None
        if total is None:
            total = term if factor > 0 else values.negative(term)
        else:
            parts = (values.splat(total, like.type), values.splat(term, like.type))
            total = values.binary("+" if factor > 0 else "-", *parts)
    if total is None:
        return values.number(0.0, like.type)
    return values.splat(total, like.type)


def _term(values: Values, monomial: Monomial, factor: Factor, atoms: Mapping[int, ir.Expr]) -> ir.Expr | None:
    if not SMALLEST <= factor <= LARGEST or Fraction(float(np.float32(factor))) != factor:
        return None
    made = None if factor == 1 and monomial else values.number(float(factor), F32)
    # Scalars first, so that a vector is scaled once.
    for e in sorted((atoms[k] for k in monomial), key=lambda x: isinstance(x.type, Vector)):
        made = e if made is None else values.binary("*", made, e)
    return made


def _element(type_: Type) -> Type:
    return type_.element if isinstance(type_, Vector) else type_


def _cost(e: ir.Expr) -> int:
    """Operations of an expression, each value once."""
    seen: set[int] = set()
    total = 0
    waiting = [e]
    while waiting:
        x = waiting.pop()
        if id(x) not in seen:
            seen.add(id(x))
            total += number_of_operations(x)
            waiting += ir.children(x)
    return total
