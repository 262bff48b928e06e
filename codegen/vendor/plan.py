"""Options to texts: the files that would be written now, with their lock."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from codegen.describe import signature
from codegen.emit import wrap
from codegen.emit.definition import Definition
from codegen.emit.dialect import Dialect, file_name
from codegen.emit.frame import file_text, header
from codegen.emit.module import CONVENTIONS, DEFAULT_PREFIX, definitions, emitted_header
from codegen.errors import UserError
from codegen.guarantees import table_of
from codegen.ir.nodes import Function, StructDef
from codegen.ir.types import TEXTURE
from codegen.library import Library, Selection
from codegen.lines.linemap import as_json, map_of
from codegen.vendor.lock import NAME, Lock, Promise, file_hash, lock_text
from codegen.vendor.options import Options, key
from codegen.version import VERSION

STEM = "vair"


@dataclass(frozen=True)
class Plan:
    """Files by name with their texts, and the lock for them.

    library      that holds the functions
    definitions  what each file defines, and the dialect it is in
    """

    lock: Lock
    files: Mapping[str, str]
    library: Library
    definitions: Mapping[str, tuple[Dialect, Sequence[Definition]]]

    def maps(self) -> dict[str, str]:
        """A line map of each file as JSON, by the file's name and .json."""
        return {
            f"{name}.json": as_json(map_of(d, self.files[name], defined))
            for name, (d, defined) in self.definitions.items()
        }

    @functools.cached_property
    def lock_text(self) -> str:
        """What goes into vair.lock."""
        return lock_text(self.lock)


def plan_functions(library: Library, options: Options) -> Plan:
    """The files for chosen functions; raises UserError for unknown functions and prefixes that collide."""
    selection = library.select(options.functions or None)
    files: dict[str, str] = {}
    parts: dict[str, tuple[Dialect, Sequence[Definition]]] = {}
    printed: list[tuple[Dialect, list[Definition]]] = []
    for d in options.found_dialects():
        alike = [found for other, found in printed if _prints_alike(other, d)]
        found = alike[0] if alike else definitions(library, d, selection, options.prefix)
        printed += [] if alike else [(d, found)]
        if options.per_function:
            for name, text, own in _single_files(library, options, d, selection, found):
                files[name], parts[name] = text, (d, own)
        else:
            head = emitted_header(d, selection.source_hash, options.functions or None, options.prefix)
            name = file_name(d, STEM)
            files[name], parts[name] = file_text(d, head, found), (d, found)
    return Plan(locked(library, options, selection, files), files, library, parts)


def locked(library: Library, options: Options, selection: Selection, files: Mapping[str, str]) -> Lock:
    """The lock for the files of a selection."""
    return Lock(
        version=VERSION,
        source_hash=selection.source_hash,
        options=options,
        files={name: file_hash(text.encode("utf-8")) for name, text in files.items()},
        functions={name: promise(library, library.function(name)) for name in selection.names},
        structs={s.name: fields(s) for s in selection.structs},
    )


def dialect_of(options: Options, name: str) -> str:
    """The dialect ("glsl/430") of a file; raises UserError for a file that is of none of them."""
    for d in options.found_dialects():
        if name.startswith(f"{folder_name(d)}/") if "/" in name else name.endswith(file_name(d, "")):
            return key(d)
    raise UserError(f'{NAME}: [files] "{name}" is of no dialect that is listed')


def folder_name(d: Dialect) -> str:
    """The folder of a dialect's files of one function each."""
    return d.target if d.name == d.target else f"{d.target}-{d.name}"


def promise(library: Library, f: Function) -> Promise:
    """What a lock says of a function."""
    errors = tuple(b.describe() for b in library.bounds_of(f.name))
    return Promise(signature(f), errors, f.doc.entries.get("source", ""))


def fields(s: StructDef) -> str:
    """The fields of a struct in one line."""
    return ", ".join(f"{field.name}: {field.type.name}" for field in s.type.fields)


def _prints_alike(a: Dialect, b: Dialect) -> bool:
    """Whether two dialects have the same definitions; what is only said of them does not count."""

    def told(d: Dialect) -> tuple[str, Dialect]:
        return table_of(d), replace(d, name="", title="", precise="")

    return told(a) == told(b)


def _single_files(
    library: Library, options: Options, d: Dialect, selection: Selection, found: Sequence[Definition]
) -> Iterator[tuple[str, str, Sequence[Definition]]]:
    """Name, text and definitions of one file per function.

    Where there is no preprocessor, also of one for each struct that they need. Behind guards a file holds all it needs, so that any of them do in any order. Without, a file holds its
    own definition and names the files that must come with it.
    """
    folder = folder_name(d)
    by_name = {definition.name: definition for definition in found}
    names = selection.names if d.guard else [f.name for f in selection.functions]
    for name in names:
        own = library.select([name])
        head = emitted_header(d, own.source_hash, [name], options.prefix)
        needed = [by_name[n] for n in _needed(own, options.prefix, by_name)]
        if not d.guard:
            needed, others = needed[-1:], needed[:-1]
            files = [n.name.removeprefix(options.prefix) + f".{d.extension}" for n in others]
            head = _part_header(d, own.source_hash, options.prefix, files)
        yield f"{folder}/{name}.{d.extension}", file_text(d, head, needed), needed
    if not d.guard:
        for s in selection.structs:
            inner = [f.type.name for f in s.type.fields if options.prefix + f.type.name in by_name]
            files = [f"{name}.{d.extension}" for name in inner]
            head = _part_header(d, selection.source_hash, options.prefix, files)
            alone = [by_name[options.prefix + s.name]]
            yield f"{folder}/{s.name}.{d.extension}", file_text(d, head, alone), alone


def _needed(own: Selection, prefix: str, by_name: Mapping[str, Definition]) -> list[str]:
    """Names of the definitions of one function's file, dependencies first."""
    looks_up = any(p.type == TEXTURE for f in own.functions for p in f.parameters)
    lookups = [n for n in by_name if n.startswith(f"{prefix}lookup_")] if looks_up else []
    return [*lookups, *(prefix + s.name for s in own.structs), *(prefix + f.name for f in own.functions)]


def _part_header(d: Dialect, source_hash: str, prefix: str, files: Sequence[str]) -> list[str]:
    """The header of a file that holds one definition, and names the files that must come with it."""
    named = "" if prefix == DEFAULT_PREFIX else f" --prefix {prefix}"
    command = f"vair vendor --dialect {d.name} --per-function{named}"
    head = header(d, command, f"Source hash {source_hash}", CONVENTIONS)
    if files:
        head += ["//", *wrap.comment(f"Needs, in any order: {', '.join(files)}", "// ", "//   ")]
    return head
