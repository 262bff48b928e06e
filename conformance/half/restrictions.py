"""Restrictions of a domain that may make a half form useful, mildest first."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from codegen.ir.domains import Domain, Interval, Length, Unit
from codegen.ir.nodes import Function, Parameter
from codegen.ir.types import F32, Struct, Type, Vector, element_of

LARGEST = 60000.0
"""Largest input: products with numbers near 1 stay below 65504."""
EXPONENTS = (1000.0, 100.0, 60.0, 32.0, 8.0)
"""Largest exponents."""
LOWEST = (0.0, 1.0)
"""Smallest exponents: below 1 a lobe ends in a steep edge."""
CAPS = (LARGEST, 250.0, 16.0, 4.0)
"""Largest magnitudes of other numbers."""
LEAST = (0.0, 1e-3, 0.03, 0.1)
"""Smallest positive numbers of no particular scale; 6.1e-5 is the smallest normal half."""
ANGLES = (0.0, 0.004, 0.01, 0.03, 0.1)
"""Smallest angles between the lines of any two directions or vectors."""
GRAZING = (-1.0, 0.02, 0.1)
"""Smallest cosines of light and viewer to the normal, n or the local z."""
LENGTHS = ((0.0, 8000.0), (0.01, 100.0))
LIGHTS = ("l", "v", "w")

Where = dict[str, tuple[float, float]]


@dataclass(frozen=True)
class Restriction:
    """Features held to intervals (see codegen.bounds.Bound), and what that costs of the domain, in steps."""

    penalty: float
    where: Where = field(hash=False)


def restrictions(function: Function) -> list[Restriction]:
    """All combinations for a function, mildest first."""
    scalars = list(_scalars(function.parameters))
    exponents = [(path, d) for path, d in scalars if _is_exponent(d)]
    large = [(path, d) for path, d in scalars if d.high > CAPS[-1] and not _is_exponent(d)]
    small = [
        (path, d)
        for path, d in scalars
        if d.scale == "log" and 0.0 <= d.low < LEAST[-1] and not _is_exponent(d)
    ]
    units = [p.name for p in function.parameters if isinstance(p.domain, Unit)]
    lengths = [p for p in function.parameters if isinstance(p.domain, Length)]
    pairs = list(itertools.combinations([*units, *(p.name for p in lengths)], 2))
    cosine = "{}.z" if function.module == "lobes" else "dot(n, {})"
    grazing = [name for name in LIGHTS if name in units and ("n" in units or function.module == "lobes")]
    found = []
    for steps in itertools.product(
        _steps(EXPONENTS, exponents),
        _steps(LOWEST, exponents),
        _steps(CAPS, large),
        _steps(LEAST, small),
        _steps(ANGLES, pairs),
        _steps(GRAZING, grazing),
        _steps(LENGTHS, lengths),
    ):
        exponent, lowest, cap, least, angle, graze, length = (i for i, _ in steps)
        where: Where = {
            path: (max(d.low, LOWEST[lowest]), min(EXPONENTS[exponent], d.high)) for path, d in exponents
        }
        for path, d in large:
            if d.high > CAPS[cap]:
                where[path] = (max(d.low, -CAPS[cap]), CAPS[cap])
        if least:
            where.update(
                {path: (max(d.low, LEAST[least]), where.get(path, (0.0, d.high))[1]) for path, d in small}
            )
        if angle:
            where.update({f"angle({a}, {b})": (ANGLES[angle], 1.6) for a, b in pairs})
        if graze:
            where.update({cosine.format(name): (GRAZING[graze], 1.01) for name in grazing})
        for p in lengths:
            assert isinstance(p.domain, Length)
            low, high = LENGTHS[length]
            where[f"length({p.name})"] = (low, min(high, p.domain.high))
        if any(2.0 * low >= high for path, (low, high) in where.items() if path in dict(exponents)):
            continue  # hardly an exponent is left
        found.append(Restriction(sum(weight for _, weight in steps), where))
    return sorted(found, key=lambda r: r.penalty)


def narrowed(function: Function, where: Where | None = None) -> Function:
    """The function with narrower intervals to draw from: those of `where`, or where most halves end up."""

    def domain(path: str, d: Domain | None) -> Domain | None:
        if not isinstance(d, Interval):
            return d
        if where is None:
            high = min(d.high, EXPONENTS[1] if _is_exponent(d) else CAPS[2])
            return replace(d, low=max(d.low, -high), high=high, least=max(d.least, LEAST[1]))
        stated = where.get(path) or where.get(f"{path}.x")
        if stated is None:
            return d
        low, high = max(d.low, stated[0]), min(d.high, stated[1])
        return replace(d, low=low, high=high, least=max(d.least, low, LEAST[1]) if d.scale == "log" else 0.0)

    def parameter(p: Parameter) -> Parameter:
        if isinstance(p.type, Struct):
            fields = tuple(replace(f, domain=domain(f"{p.name}.{f.name}", f.domain)) for f in p.type.fields)
            return replace(p, type=Struct(p.type.name, fields))
        return replace(p, domain=domain(p.name, p.domain))

    return replace(function, parameters=tuple(map(parameter, function.parameters)))


def _steps(values: Sequence[object], there: Sequence[object]) -> list[tuple[int, float]]:
    """Indices with their penalties; the first alone where nothing is to be restricted."""
    return [(i, float(i)) for i in range(len(values) if there else 1)]


def _is_exponent(d: Interval) -> bool:
    return d.scale == "log" and d.high == 1.0e5 and d.low >= 0.0


def _scalars(parameters: tuple[Parameter, ...]) -> Iterator[tuple[str, Interval]]:
    """Every float number with an interval: parameters, fields, components."""

    def one(path: str, type_: Type, domain: Domain | None) -> Iterator[tuple[str, Interval]]:
        if isinstance(domain, Interval) and element_of(type_) == F32:
            parts = [f"{path}.{c}" for c in "xyzw"[: type_.size]] if isinstance(type_, Vector) else [path]
            yield from ((part, domain) for part in parts)

    for p in parameters:
        if isinstance(p.type, Struct):
            for f in p.type.fields:
                yield from one(f"{p.name}.{f.name}", f.type, f.domain)
        else:
            yield from one(p.name, p.type, p.domain)
