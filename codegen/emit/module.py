"""A whole file: header, structs, functions, dependencies first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from string import Template

from codegen.bounds import Bound
from codegen.emit import comment, wrap
from codegen.emit.collisions import check_collisions
from codegen.emit.definition import Definition, plain, read_definitions
from codegen.emit.dialect import Dialect
from codegen.emit.frame import DIRECTIONS, FINITE, file_text, header
from codegen.emit.stmt import StmtPrinter
from codegen.guarantees import guarantees, phrase, table_of
from codegen.half import check_half, half_forms, half_hash, half_rules
from codegen.ir.nodes import StructDef
from codegen.ir.types import TEXTURE
from codegen.ir.unit import Unit
from codegen.library import Library, Selection
from codegen.names import check_prefix
from codegen.passes import run_passes
from codegen.passes.half import Version, half_structs, half_versions

DEFAULT_PREFIX = "vair_"
HALF_PREFIX = "vair_half_"
"""Of text in half precision, so that both stand in one program."""


def default_prefix(dialect: Dialect) -> str:
    """What names start with unless something else is asked for."""
    return HALF_PREFIX if dialect.arithmetic == "half" else DEFAULT_PREFIX


def emit(
    library: Library, dialect: Dialect, names: Sequence[str] | None = None, prefix: str | None = None
) -> str:
    """The text of one self-contained include; the parameters are those of `include`."""
    head, defined = include(library, dialect, names, prefix)
    return file_text(dialect, head, defined)


def include(
    library: Library,
    dialect: Dialect,
    names: Sequence[str] | None = None,
    prefix: str | None = None,
    further: str = "",
) -> tuple[list[str], list[Definition]]:
    """The header and the definitions of one self-contained include.

    names    functions to emit with what they need; None for all public ones (in half precision: that have it)
    prefix   put before every name, structs included; default_prefix if None
    further  options that the header names beside these
    raises   UserError for an unknown function, a prefix that cannot start a name, or a function that is of no
             use in half precision where the dialect asks for that
    """
    prefix = default_prefix(dialect) if prefix is None else prefix
    check_prefix(prefix)
    selection = chosen(library, dialect, names)
    defined = definitions(library, dialect, selection, prefix)
    return emitted_header(dialect, source_hash(library, dialect, selection), names, prefix, further), defined


def chosen(library: Library, dialect: Dialect, names: Sequence[str] | None) -> Selection:
    """The functions of these names; where None, all public ones, or all that have a half form.

    raises  UserError for an unknown function, and one that is of no use in half precision where that is asked
    """
    if dialect.arithmetic != "half":
        return library.select(names)
    asked = names
    if asked is None:
        asked = [name for name, form in half_forms(library).items() if not form.refused]
    check_half(library, asked)
    return library.select(asked)


def source_hash(library: Library, dialect: Dialect, selection: Selection) -> str:
    """The hash of all that the text of a selection is made of."""
    found = selection.source_hash
    return half_hash(library, found) if dialect.arithmetic == "half" else found


def emit_selection(library: Library, dialect: Dialect, selection: Selection, prefix: str) -> list[str]:
    """The definitions alone, with their comments and without guards."""
    return plain(definitions(library, dialect, selection, prefix))


def definitions(library: Library, dialect: Dialect, selection: Selection, prefix: str) -> list[Definition]:
    """What a selection defines, dependencies first; raises UserError for a prefix whose names collide."""
    looks_up = any(p.type == TEXTURE for f in selection.functions for p in f.parameters)
    library_text = dialect.lookup_library if looks_up else ""
    printer = StmtPrinter(replace(dialect, lookup=f"{prefix}lookup_level") if library_text else dialect)
    public_names = library.resolver.names
    rename = comment.renamer(public_names, prefix)
    versions = _versions(library, dialect, selection)
    unit = Unit(tuple(v.function for v in versions), _structs(dialect, selection))
    check_collisions(unit, dialect, prefix)
    unit = run_passes(unit, prefix, named_results=bool(dialect.local))
    found: list[Definition] = []
    if library_text:
        found += read_definitions(Template(library_text).substitute(prefix=prefix))
    for original, renamed in zip(selection.structs, unit.structs, strict=True):
        words = comment.struct_comment(original, rename)
        code = tuple(printer.struct(renamed.type))
        lines = (original.place.line,) * len(code)
        found.append(Definition(renamed.type.name, tuple(words), code, original.place.path, lines))
    for version, f in zip(versions, unit.functions, strict=True):
        bounds = bounds_of(library, version)
        promised = guaranteed_of(library, version, dialect)
        words = comment.function_comment(version.source, bounds, dialect.target, rename, promised)
        texts, lines = zip(*printer.traced_function(f), strict=True)
        places = [f.source_of(line) for line in lines] if f.origins else []
        numbers = tuple(place.line for place in places) or lines
        paths = tuple(place.path for place in places)
        source = version.source.name
        found.append(Definition(f.name, tuple(words), texts, f.place.path, numbers, paths, source))
    return found


def bounds_of(library: Library, version: Version) -> Sequence[Bound]:
    """What the comment states of a function's error."""
    if not version.is_half:
        return library.bounds_of(version.source.name)
    form = half_forms(library).get(version.source.name)
    return () if form is None else form.bounds


def guaranteed_of(library: Library, version: Version, dialect: Dialect) -> str:
    """What the comment states of a function's guarantee; empty where none was surveyed."""
    found = guarantees(library).get(version.source.name)
    if found is None or version.is_half:
        return ""
    table, bounds = table_of(dialect), library.bounds_of(version.source.name)
    return phrase(table, found.tables[table], bounds, dialect.target) if table in found.tables else ""


def _versions(library: Library, dialect: Dialect, selection: Selection) -> tuple[Version, ...]:
    if dialect.arithmetic == "half":
        return half_versions(library, selection.names, half_rules(library))
    return tuple(Version(f, f, is_half=False) for f in selection.functions)


def _structs(dialect: Dialect, selection: Selection) -> tuple[StructDef, ...]:
    return half_structs(selection.structs) if dialect.arithmetic == "half" else selection.structs


CONVENTIONS = (
    f"{DIRECTIONS} Angles are in radians, colours linear RGB. {FINITE} An error is declared: no driver "
    "measured exceeds it; guaranteed is what the specification permits at worst."
)
HALF_NOTE = (
    "Half precision: an error holds for the range beside it, and for inputs that are halves; outside of it "
    "nothing is promised. Results are finite inside. Functions that end in _single are the f32 text that "
    "others need."
)


def emitted_header(
    dialect: Dialect, hashed: str, names: Sequence[str] | None, prefix: str, further: str = ""
) -> list[str]:
    """The header of what `emit` gives."""
    command = f"vair emit --target {dialect.target} --dialect {dialect.name}"
    if dialect.arithmetic == "half":
        command += " --precision half"
    if dialect.local:
        command += " --precise"
    if prefix != default_prefix(dialect):
        command += f" --prefix {prefix}"
    command += further + "".join(f" --function {name}" for name in names or ())
    return [
        *header(dialect, command, f"Source hash {hashed}", CONVENTIONS),
        *half_lines(dialect),
    ]


def half_lines(dialect: Dialect) -> list[str]:
    """What a header says of half precision, and what enables it; nothing in single precision."""
    if dialect.arithmetic != "half":
        return []
    return [
        *wrap.comment(HALF_NOTE, "// ", "// "),
        *(["", dialect.half_enable] if dialect.half_enable else []),
    ]
