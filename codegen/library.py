"""The library as the rest of the project sees it: functions, structs and declared error bounds."""

from __future__ import annotations

import functools
import hashlib
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from codegen.bounds import Bound, read_bounds
from codegen.errors import UserError, unknown
from codegen.frontend.resolve import Resolver
from codegen.ir.nodes import Function, StructDef, callees, expressions
from codegen.ir.types import Array, Struct, Type

SECTIONS = ("numeric", "direction", "strand", "fakefur", "shells", "sampling", "lobes", "maps", "environment")
"""Order of the sections in listings and emitted files; unknown sections follow alphabetically."""


def default_root() -> Path:
    """The folder of the installed package shaderlib, found without importing it."""
    return Path(__file__).resolve().parent.parent / "shaderlib"


@dataclass(frozen=True)
class Selection:
    """Functions and structs to emit together, dependencies first.

    names    the functions that were asked for; the others are what these need
    library  where they come from
    """

    functions: tuple[Function, ...]
    structs: tuple[StructDef, ...]
    names: tuple[str, ...]
    library: Library = field(repr=False, compare=False)

    @functools.cached_property
    def source_hash(self) -> str:
        """A hash of the sources and the declared bounds, 16 digits; taken when first asked for."""
        return self.library.source_hash(self.functions, self.structs)


class Library:
    """All shading functions below one source folder. Functions are lowered when first asked for."""

    def __init__(self, root: Path, extra: tuple[Path, ...] = ()) -> None:
        """Raises UserError or SourceError for sources that cannot be read.

        extra  further folders of sources, each a section of its own named like the folder. They may use and
               vary what is below `root`, and declare their bounds beside them
        """
        self.root = root
        self.extra = extra
        self.resolver = Resolver(root, extra)
        self._added: dict[str, Function] = {}
        self._base: Library | None = None
        self._bounds_below: dict[Path, dict[str, list[Bound]]] = {}

    def with_functions(self, functions: Iterable[Function]) -> Library:
        """This library and further functions that no source holds, made by passes for instance.

        They may call each other and what is here, and stand in for functions of the same name. Emission,
        execution, evaluation and intervals take them by name like any other.
        """
        extended = Library.__new__(Library)
        extended.root, extended.extra, extended.resolver = self.root, self.extra, self.resolver
        extended._added = {**self._added, **{f.name: f for f in functions}}
        extended._base = self._base or self
        extended._bounds_below = self._bounds_below
        return extended

    @functools.cached_property
    def functions(self) -> dict[str, Function]:
        """Every function by name, by section, base before variants and printed forms."""
        self.resolver.parse_all()
        found = [self.resolver.function(name) for name in self.resolver.function_names()]
        return {**{f.name: f for f in sorted(found, key=self._order)}, **self._added}

    @functools.cached_property
    def documented(self) -> dict[str, Function]:
        """The functions that are not helpers."""
        return {name: f for name, f in self.functions.items() if f.public}

    @functools.cached_property
    def public(self) -> dict[str, Function]:
        """Those of them whose arguments are numbers: what tests can draw."""
        return {name: f for name, f in self.documented.items() if not f.reads_textures}

    def function(self, name: str) -> Function:
        """One function; raises UserError with the nearest name if there is none."""
        if name in self._added:
            return self._added[name]
        if not self.resolver.defines(name):
            raise unknown("function", name, self.documented)
        return self.resolver.function(name)

    @functools.cached_property
    def structs(self) -> dict[str, StructDef]:
        """Every struct by name."""
        return {name: self.struct(name) for name in self.resolver.struct_names()}

    def struct(self, name: str) -> StructDef:
        """One struct; raises UserError if there is none."""
        file = self.resolver.where(name)
        if file is None or name not in file.structs:
            raise unknown("struct", name, self.resolver.struct_names())
        return self.resolver.struct(file, name)

    def variants(self, name: str) -> list[Function]:
        """Variants and printed forms of a function."""
        return [f for f in self.functions.values() if f.base == name]

    @functools.cached_property
    def bounds(self) -> dict[str, list[Bound]]:
        """Declared error bounds by function name, from shaderlib/<section>/bounds.toml."""
        if self._base is not None:
            return self._base.bounds
        folders = [*sorted(path.parent for path in self.root.glob("*/bounds.toml")), *self.extra]
        return {name: found for folder in folders for name, found in self._read_bounds(folder).items()}

    def bounds_of(self, name: str) -> list[Bound]:
        """The declared error bounds of one function; reads no file but the one of its section."""
        folder = self._section_folder(name)
        return [] if folder is None else self._read_bounds(folder).get(name, [])

    def _section_folder(self, name: str) -> Path | None:
        """The folder of the section that defines a function; None for an unknown name."""
        path = self.resolver.path_of(name)
        if path is None:
            return None
        beside = next((folder for folder in self.extra if path.is_relative_to(folder)), None)
        return beside or self.root / path.relative_to(self.root).parts[0]

    def _read_bounds(self, folder: Path) -> dict[str, list[Bound]]:
        """The bounds that a section declares; raises UserError for a file that is wrong."""
        if folder in self._bounds_below:
            return self._bounds_below[folder]
        path = folder / "bounds.toml"
        shown = f"{'shaderlib/' if path.is_relative_to(self.root) else ''}{folder.name}/{path.name}"
        try:
            data = tomllib.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}
        except tomllib.TOMLDecodeError as e:
            raise UserError(f"{shown}: not valid TOML: {e}") from None
        bounds = read_bounds(shown, data)
        for name in bounds:
            if not self.resolver.module_of(name):
                raise unknown(f"function in {shown}", name, self.resolver.function_names())
            if self._section_folder(name) != folder:
                raise UserError(f'{shown}: "{name}" is a function of another section')
        self._bounds_below[folder] = bounds
        return bounds

    def select(self, names: Iterable[str] | None = None) -> Selection:
        """These functions (all public ones if None) and what they need, dependencies first."""
        wanted = list(self.documented) if names is None else list(dict.fromkeys(names))
        ordered: dict[str, Function] = {}

        def visit(name: str) -> None:
            if name not in ordered:
                function = self.function(name)
                for callee in callees(function):
                    visit(callee)
                ordered[name] = function

        for name in wanted:
            visit(name)
        structs = self._structs_of(ordered.values())
        return Selection(tuple(ordered.values()), structs, tuple(wanted), self)

    def _structs_of(self, functions: Iterable[Function]) -> tuple[StructDef, ...]:
        needed: dict[str, StructDef] = {}

        def visit(type_: Type) -> None:
            if isinstance(type_, Struct) and not isinstance(type_, Array) and type_.name not in needed:
                for field in type_.fields:
                    visit(field.type)
                needed[type_.name] = self.struct(type_.name)

        for function in functions:
            for parameter in function.parameters:
                visit(parameter.type)
            visit(function.returns)
            for e in expressions(function.body):
                visit(e.type)
        return tuple(needed.values())

    def source_hash(self, functions: Iterable[Function], structs: Iterable[StructDef]) -> str:
        """A hash of the files that define these, of added functions' trees, and of the declared bounds."""
        added = [f for f in functions if f.name in self._added]
        names = [*(f.name for f in functions if f not in added), *(s.name for s in structs)]
        files = self.resolver.needed_files(self.resolver.module_of(name) for name in names)
        digest = hashlib.sha256()
        for module in sorted(files):
            digest.update(f"{module}\n{files[module].text}\n".encode())
        for name in sorted(names):
            digest.update("".join(f"{bound}\n" for bound in self.bounds_of(name)).encode())
        for function in sorted(added, key=lambda f: f.name):
            digest.update(f"{function.name} {function.parameters} {function.body}\n".encode())
        return digest.hexdigest()[:16]

    def _order(self, function: Function) -> tuple[int, str, str, int, int]:
        section = SECTIONS.index(function.module) if function.module in SECTIONS else len(SECTIONS)
        file = self.resolver.module_of(function.name)
        kinds = ("base", "helper", "variant", "printed")
        return section, function.module, file, kinds.index(function.kind), function.place.line


@functools.cache
def load_library(root: Path | None = None, extra: tuple[Path, ...] = ()) -> Library:
    """The library of the installed package, or of another source folder; parsed once per process.

    extra  folders of further sources, see Library
    """
    return Library(root or default_root(), extra)
