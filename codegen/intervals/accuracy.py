"""Kinds of accuracy that specifications promise for one operation, as values.

ULP is Muller's: the distance between the two floats around the exact value.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Exact:
    """The mathematical result, which is representable."""


@dataclass(frozen=True)
class Rounded:
    """Correctly rounded, in the table's direction."""


@dataclass(frozen=True)
class Ulp:
    """Within `ulps` ULP, plus `per_abs_x` |x| (floored if `whole`), plus `per_component` n for n-vectors."""

    ulps: float
    per_abs_x: float = 0.0
    whole: bool = False
    per_component: float = 0.0


@dataclass(frozen=True)
class Absolute:
    """Within `bound` for arguments in `within`; `elsewhere` outside it (None: nothing is promised)."""

    bound: float
    within: tuple[float, float]
    elsewhere: Ulp | None = None


@dataclass(frozen=True)
class Inherited:
    """As accurate as the formula named, evaluated with the table's own operations."""

    formula: str


@dataclass(frozen=True)
class Scaled:
    """Within (`epsilons` + `per_component` n) 2^-23 max^2 for vectors of n components.

    max is the largest magnitude of any component of any operand.
    """

    epsilons: float
    per_component: float = 0.0


@dataclass(frozen=True)
class Filter:
    """Linear filtering whose weights are within `texel` within a level and `level` between levels.

    1: nothing is stated, and any mean of the texels about the place counts.
    """

    texel: float
    level: float


@dataclass(frozen=True)
class Unstated:
    """The specification promises nothing."""


Accuracy = Exact | Rounded | Ulp | Absolute | Inherited | Scaled | Filter | Unstated


@dataclass(frozen=True)
class Row:
    """What a table says of one operation.

    accuracy   how near the result is
    cite       the clause that says so
    magnitude  operand -> (low, high): promised only for 2^low <= |operand| <= 2^high
    reciprocal the same for the divisor where the dividend is 1
    zero       operands that may be 0 although `magnitude` leaves 0 out
    normal     operands for which nothing is promised at 0 and below 2^-126
    assumed    why a promise that the specification does not make is assumed; empty where it makes it
    """

    accuracy: Accuracy
    cite: str
    magnitude: Mapping[str, tuple[int, int]] = field(default_factory=dict)
    reciprocal: tuple[int, int] | None = None
    zero: tuple[str, ...] = ()
    normal: tuple[str, ...] = ()
    assumed: str = ""
