"""Options to texts: the files that would be written now, with their lock."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from codegen.bounds import Bound
from codegen.describe import signature
from codegen.emit import wrap
from codegen.emit.definition import Definition, reached
from codegen.emit.dialect import Dialect, file_name
from codegen.emit.frame import file_text, header
from codegen.emit.module import (
    CONVENTIONS,
    HALF_NOTE,
    chosen,
    default_prefix,
    definitions,
    emitted_header,
    source_hash,
)
from codegen.errors import UserError
from codegen.guarantees import table_of
from codegen.half import half_forms, half_hash, half_rules
from codegen.ir.nodes import StructDef
from codegen.library import Library, Selection
from codegen.lines.linemap import as_json, map_of
from codegen.passes.half import half_structs, half_versions
from codegen.vendor.lock import NAME, Lock, Promise, file_hash, lock_text
from codegen.vendor.options import Options, key
from codegen.version import VERSION

STEM, HALF_STEM = "vair", "vair-half"


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
    dialects = options.found_dialects()
    if not dialects:
        raise UserError("there is no dialect to write")
    selection = chosen(library, dialects[0], options.functions or None)
    stem = HALF_STEM if options.half else STEM
    files: dict[str, str] = {}
    parts: dict[str, tuple[Dialect, Sequence[Definition]]] = {}
    printed: list[tuple[Dialect, list[Definition]]] = []
    for d in dialects:
        alike = [found for other, found in printed if _prints_alike(other, d)]
        found = alike[0] if alike else definitions(library, d, selection, options.prefix)
        printed += [] if alike else [(d, found)]
        if options.per_function:
            for name, text, own in _single_files(library, options, d, selection, found):
                files[name], parts[name] = text, (d, own)
        else:
            hashed = source_hash(library, d, selection)
            head = emitted_header(d, hashed, options.functions or None, options.prefix)
            name = file_name(d, stem)
            files[name], parts[name] = file_text(d, head, found), (d, found)
    return Plan(locked(library, options, selection, files), files, library, parts)


def locked(library: Library, options: Options, selection: Selection, files: Mapping[str, str]) -> Lock:
    """The lock for the files of a selection."""
    hashed = half_hash(library, selection.source_hash) if options.half else selection.source_hash
    structs = half_structs(selection.structs) if options.half else selection.structs
    return Lock(
        version=VERSION,
        source_hash=hashed,
        options=options,
        files={name: file_hash(text.encode("utf-8")) for name, text in files.items()},
        functions={name: promise(library, name, half=options.half) for name in selection.names},
        structs={s.name: fields(s) for s in structs},
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


def promise(library: Library, name: str, *, half: bool = False) -> Promise:
    """What a lock says of a function, or of its half form."""
    f = library.function(name)
    bounds = half_forms(library)[name].bounds if half else library.bounds_of(name)
    called = half_versions(library, [name], half_rules(library))[-1].function if half else f
    return Promise(
        signature(replace(called, name=name)),
        tuple(map(Bound.describe, bounds)),
        f.doc.entries.get("source", ""),
    )


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

    Where there is no preprocessor, also of one for all that they need. Behind guards a file holds all it
    needs, so that any of them do in any order. Without, a file holds its own definition and names the files
    that must come with it.
    """
    folder = folder_name(d)
    if d.guard:
        for name in selection.names:
            own = library.select([name])
            head = emitted_header(d, source_hash(library, d, own), [name], options.prefix)
            needed = reached(options.prefix + name, found)
            yield f"{folder}/{name}.{d.extension}", file_text(d, head, needed), needed
        return
    for part in found:
        own = library.select([part.source]) if part.source else selection
        others = [_file(options, d, other) for other in reached(part.name, found) if other is not part]
        head = _part_header(d, source_hash(library, d, own), options, others)
        yield f"{folder}/{_file(options, d, part)}", file_text(d, head, [part]), [part]


def _file(options: Options, d: Dialect, part: Definition) -> str:
    return f"{part.name.removeprefix(options.prefix)}.{d.extension}"


def _part_header(d: Dialect, hashed: str, options: Options, files: Sequence[str]) -> list[str]:
    """The header of a file that holds one definition, and names the files that must come with it."""
    named = "" if options.prefix == default_prefix(d) else f" --prefix {options.prefix}"
    half = " --precision half" if options.half else ""
    command = f"vair vendor --dialect {d.name} --per-function{half}{named}"
    head = header(d, command, f"Source hash {hashed}", CONVENTIONS)
    if options.half:
        # What enables halves stands once, before everything else, where there are no guards.
        head += [
            *wrap.comment(HALF_NOTE, "// ", "// "),
            f'// Needs "{d.half_enable}" at the head of the module.',
        ]
    if files:
        head += ["//", *wrap.comment(f"Needs, in any order: {', '.join(files)}", "// ", "//   ")]
    return head
