"""A library with further functions that no source holds: transformed, random or reduced ones."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from codegen.bounds import Bound
from codegen.ir.nodes import Function, StructDef
from codegen.library import Library

NO_HASH = "0" * 16
"""Stands where an emitted file names the hash of its sources: these functions have none."""


class ExtendedLibrary(Library):
    """A library whose functions are those of another one, some of them replaced and some added.

    Everything that works on a library (emission, execution, evaluation, intervals) works on it.
    """

    def __init__(self, base: Library, added: Mapping[str, Function]) -> None:
        self.root = base.root
        self.resolver = base.resolver
        self.base = base
        self.added = dict(added)

    def function(self, name: str) -> Function:
        """An added function, or one of the base library."""
        return self.added[name] if name in self.added else self.base.function(name)

    def struct(self, name: str) -> StructDef:
        """A struct of the base library."""
        return self.base.struct(name)

    @property
    def bounds(self) -> dict[str, list[Bound]]:
        """Bounds of the base library; added functions declare none."""
        return {}

    def _hash(self, functions: Iterable[Function], structs: Iterable[StructDef]) -> str:
        return NO_HASH
