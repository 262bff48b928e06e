"""All families that are stored as data."""

from __future__ import annotations

from zlib import crc32

from conformance.cases import (
    fur_families,
    lobe_families,
    map_families,
    pairs,
    sampling_families,
    scalars,
    shell_families,
    stretched_families,
    triples,
)
from conformance.cases.family import Family, Points
from conformance.cases.stream import Stream

MODULES = (
    pairs,
    triples,
    scalars,
    fur_families,
    shell_families,
    sampling_families,
    lobe_families,
    map_families,
    stretched_families,
)

FAMILIES: dict[str, Family] = {family.name: family for module in MODULES for family in module.FAMILIES}


def build(family: Family) -> Points:
    """The family's points, computed anew; the seed is its name."""
    return family.points(Stream(crc32(family.name.encode())))
