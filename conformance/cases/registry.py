"""All families that are stored as data."""

from __future__ import annotations

from zlib import crc32

from conformance.cases import pairs, scalars, triples
from conformance.cases.family import Family, Points
from conformance.cases.stream import Stream

FAMILIES: dict[str, Family] = {
    family.name: family for module in (pairs, triples, scalars) for family in module.FAMILIES
}


def build(family: Family) -> Points:
    """The family's points, computed anew; the seed is its name."""
    return family.points(Stream(crc32(family.name.encode())))
