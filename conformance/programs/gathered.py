"""Sums in any order, factors that their terms share taken out of them.

    dot(vec3(x, x, 0.5), vec3(y))      becomes      y ((x + x) + 0.5)

Mesa 22.3.6 makes a (b + c) of a b + a c wherever a sum has two such products, a constant or a square among
them; which terms meet depends on the order that it has brought them into, so a function has several forms.
What is left of a sum is written as `dot`, whose promise is a sum in any order.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import combinations, islice

from codegen.ir import nodes as ir
from codegen.ir.types import F32, Vector
from conformance.programs.chains import LONGEST, Chain, Known, Signed, adds, collect, joined, meaning, scalars

MOST_ORDERED = 5
"""Terms of a sum that is taken in any order: n terms have about 3^n partial sums."""
MOST_FORMS = 12
"""Forms of a function that are looked at."""
MOST_TRIED = 48
"""Forms of a short sum that these are chosen from, since equal terms make equal forms; a long sum has one."""
DEEPEST = 3
"""Factors that are taken out one inside the other."""
ONE = ir.Const(F32, 1.0)


def gathered(function: ir.Function) -> Iterator[ir.Function]:
    """Forms of a straightened function: its sums in any order, then with factors taken out, most first."""
    body, known = scalars(function)
    gathering = _Gathering(known)
    while gathering.number < gathering.most:
        yield replace(function, body=ir.map_wholes(body, gathering.changed))
        gathering.number += 1


def reordered(function: ir.Function) -> ir.Function:
    """Any function with its sums in any order, expression by expression: also where all are constants."""
    body, _ = scalars(function)
    return replace(function, body=ir.map_wholes(body, _Gathering({}).changed))


@dataclass(frozen=True)
class _Product:
    """A term of a sum: its sign, and its factors beside what each stands for."""

    negative: bool
    factors: tuple[ir.Expr, ...]
    means: tuple[ir.Expr, ...]

    def over(self, factor: ir.Expr) -> Signed:
        """The product without one such factor."""
        k = self.means.index(factor)
        left = [(False, f) for f in (*self.factors[:k], *self.factors[k + 1 :])]
        return self.negative, joined(left or [(False, ONE)], False)


@dataclass(frozen=True)
class _Shared:
    """A factor times the sum of what it was taken out of."""

    factor: ir.Expr
    left: tuple[_Term, ...]


_Term = tuple[bool, "ir.Expr | _Shared"]


@dataclass
class _Gathering:
    """One form of a function: each of its sums in its form of that number, or in its last."""

    known: Known
    number: int = 0
    most: int = 1
    """Forms of the sum that has most."""
    found: dict[ir.Expr, list[tuple[_Term, ...]]] = field(default_factory=dict)
    """Sum -> its forms."""

    def changed(self, e: ir.Expr) -> ir.Expr:
        """An expression with each of its sums in one form, the outermost as long as they can be."""
        if adds(e):
            forms = self.forms(e)
            if len(forms) > 1 or 2 < len(forms[0]) <= MOST_ORDERED:
                return self.total(forms[min(self.number, len(forms) - 1)])
        return self.inside(e)

    def forms(self, e: ir.Expr) -> list[tuple[_Term, ...]]:
        """Forms of a sum, the one in which no factor is taken out first."""
        if e not in self.found:
            terms = self.terms(e)
            tried = MOST_TRIED if len(terms) <= MOST_ORDERED else 1
            ways = islice(self.factored(terms, DEEPEST), tried)
            self.found[e] = list(dict.fromkeys([tuple(terms), *ways]))[:MOST_FORMS]
            self.most = max(self.most, len(self.found[e]))
        return self.found[e]

    def inside(self, e: ir.Expr) -> ir.Expr:
        return ir.rebuild(e, tuple(map(self.changed, ir.children(e)))) if ir.children(e) else e

    def terms(self, e: ir.Expr) -> list[Signed]:
        found = Chain([], [])
        collect(self.known, e, False, True, found)
        return [*found.others, *found.constants]

    def factored(self, terms: list[Signed], deepest: int) -> Iterator[tuple[_Term, ...]]:
        """The sum with a factor taken out, of many terms before few, and others out of what is left."""
        products = [self.product(term) for term in terms]
        places: dict[ir.Expr, list[int]] = {}
        for k, product in enumerate(products):
            for factor in dict.fromkeys(product.means):
                places.setdefault(factor, []).append(k)
        most = max(map(len, places.values()), default=0)
        for count in range(most, 1, -1):
            for factor, found in places.items():
                for chosen in combinations(found, count):
                    first = products[chosen[0]]
                    shown = first.factors[first.means.index(factor)]
                    inner = self.quotients(factor, [products[k] for k in chosen])
                    others = [term for k, term in enumerate(terms) if k not in chosen]
                    for left in self.deeply(inner, deepest - 1):
                        for rest in self.deeply(others, deepest - 1):
                            yield (False, _Shared(shown, left)), *rest

    def deeply(self, terms: list[Signed], deepest: int) -> Iterator[tuple[_Term, ...]]:
        """The sum with factors taken out where they can be, then as it is."""
        if deepest:
            yield from self.factored(terms, deepest)
        yield tuple(terms)

    def quotients(self, factor: ir.Expr, products: list[_Product]) -> list[Signed]:
        """What is left of products once a factor is taken out: those that are sums by their terms."""
        left: list[Signed] = []
        for product in products:
            negative, e = product.over(factor)
            terms = self.terms(e)
            if len(left) + len(terms) > LONGEST:
                terms = [(False, e)]
            left += [(negative != inner, term) for inner, term in terms]
        return left

    def product(self, term: Signed) -> _Product:
        """A term by its factors."""
        found = Chain([], [])
        collect(self.known, term[1], term[0], False, found)
        factors = (*found.constants, *found.others)
        odd = sum(negative for negative, _ in factors) % 2 == 1
        parts = tuple(e for _, e in factors)
        return _Product(odd, parts, tuple(meaning(self.known, e) for e in parts))

    def total(self, terms: tuple[_Term, ...]) -> ir.Expr:
        """A sum, as an inner product with ones where it is short."""
        made: list[Signed] = []
        for negative, term in terms:
            if isinstance(term, _Shared):
                product = ir.Binary(F32, "*", self.changed(term.factor), self.total(term.left))
                made.append((negative, product))
            else:
                made.append((negative, self.inside(term)))
        return in_any_order(made)


def in_any_order(terms: list[Signed]) -> ir.Expr:
    """The terms' inner product with ones, a sum in any order; a few or many terms in their own."""
    if not 3 <= len(terms) <= MOST_ORDERED:
        return joined(terms, True)
    signed = tuple(ir.Unary(F32, "negate", e) if negative else e for negative, e in terms)
    type_ = Vector(f"vec{len(terms)}", F32, len(terms))
    ones = ir.Construct(type_, tuple(ONE for _ in terms))
    return ir.Builtin(F32, "dot", (ir.Construct(type_, signed), ones))
