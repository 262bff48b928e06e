"""vair.lock: what was asked for, what was written, and what the functions promised then."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomlkit

from codegen.documents import read_toml
from codegen.errors import UserError, nearest
from codegen.vendor.options import Options

NAME = "vair.lock"
FORMAT = 1
"""Counts incompatible changes."""
LICENSE = "MIT"
_FILE = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]*(/[A-Za-z0-9][A-Za-z0-9_.-]*)?")
_HASH = re.compile(r"sha256:[0-9a-f]{64}")
_HEAD = (
    "Written by vair vendor beside the files that it lists. Keep it with them: vair verify compares.",
    "A hash is that of a file with Unix line ends.",
)


@dataclass(frozen=True)
class Promise:
    """What is known of a function.

    errors  declared bounds, one a line
    source  papers
    """

    signature: str
    errors: tuple[str, ...]
    source: str


@dataclass(frozen=True)
class Lock:
    """A written folder.

    source_hash  of sources and bounds
    files        hash by name, relative to the folder
    functions    those that were asked for
    structs      fields with their types, by name
    """

    version: str
    source_hash: str
    options: Options
    files: Mapping[str, str]
    functions: Mapping[str, Promise]
    structs: Mapping[str, str]


def file_hash(data: bytes) -> str:
    """The hash of a file, whatever line ends a version control system gave it."""
    return "sha256:" + hashlib.sha256(data.replace(b"\r\n", b"\n")).hexdigest()


def lock_text(lock: Lock) -> str:
    """The lock as TOML; the same for the same lock."""
    document = tomlkit.document()
    for line in _HEAD:
        document.add(tomlkit.comment(line))
    document.update(
        {"format": FORMAT, "version": lock.version, "license": LICENSE, "source_hash": lock.source_hash}
    )
    o = lock.options
    options = tomlkit.table()
    options.update({"dialects": list(o.dialects), "prefix": o.prefix, "per_function": o.per_function})
    options.update({"precision": o.precision} if o.half else {})
    options.update({"scene": o.scene} if o.scene else {"functions": list(o.functions)})
    document["options"] = options
    document["files"] = dict(sorted(lock.files.items()))
    if lock.structs:
        document["structs"] = dict(sorted(lock.structs.items()))
    functions = tomlkit.table(is_super_table=True)
    for name, promise in sorted(lock.functions.items()):
        entry = tomlkit.table()
        entry["signature"] = promise.signature
        if promise.errors:
            entry["errors"] = tomlkit.array().multiline(len(promise.errors) > 1)
            entry["errors"].extend(promise.errors)
        if promise.source:
            entry["source"] = promise.source
        functions[name] = entry
    document["functions"] = functions
    return tomlkit.dumps(document)


def read_lock(path: Path) -> Lock:
    """The lock in a file; raises UserError where it is none, or names a file outside of its folder."""
    reader = _Reader(path, read_toml(path))
    form = reader.value(reader.content, "format", int)
    if form != FORMAT:
        raise UserError(f"{path}: format {form} is not known here, only {FORMAT}; another version wrote it")
    options = reader.options()
    files = reader.texts("files")
    for name, digest in files.items():
        if not _FILE.fullmatch(name) or name == NAME:
            raise UserError(f"{path}: [files] {name!r} is no file of this folder")
        if not _HASH.fullmatch(digest):
            raise UserError(f'{path}: [files] "{name}" has no hash, written "sha256:..."')
    version = reader.value(reader.content, "version", str)
    source_hash = reader.value(reader.content, "source_hash", str)
    structs = reader.texts("structs") if "structs" in reader.content else {}
    return Lock(version, source_hash, options, files, reader.promises(), structs)


class _Reader:
    """Typed access to the content; whatever is wrong is said with file and key."""

    def __init__(self, path: Path, content: dict[str, Any]) -> None:
        self.path, self.content = path, content

    def value(self, table: dict[str, Any], key: str, kind: type, default: Any = None) -> Any:
        if key not in table and default is None:
            raise UserError(
                f'{self.path}: "{key}" is missing{nearest(key, table) if len(table) < 20 else ""}'
            )
        value = table.get(key, default)
        if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
            noun = {
                str: "a text",
                int: "a whole number",
                bool: "true or false",
                dict: "a table",
                list: "a list",
            }
            raise UserError(f'{self.path}: "{key}" must be {noun[kind]}')
        return value

    def list_of_texts(
        self, table: dict[str, Any], key: str, default: list[str] | None = None
    ) -> tuple[str, ...]:
        found = self.value(table, key, list, default)
        if not all(isinstance(item, str) for item in found):
            raise UserError(f'{self.path}: "{key}" must be a list of texts')
        return tuple(found)

    def texts(self, key: str) -> dict[str, str]:
        table: dict[str, Any] = self.value(self.content, key, dict)
        for name in table:
            self.value(table, name, str)
        return table

    def options(self) -> Options:
        table = self.value(self.content, "options", dict)
        try:
            options = Options(
                dialects=self.list_of_texts(table, "dialects"),
                functions=self.list_of_texts(table, "functions", []),
                scene=self.value(table, "scene", str, ""),
                prefix=self.value(table, "prefix", str),
                per_function=self.value(table, "per_function", bool, False),
                precision=self.value(table, "precision", str, "single"),
            )
            options.found_dialects()
        except UserError as e:
            sentence = str(e)
            raise (e if str(self.path) in sentence else UserError(f"{self.path}: {sentence}")) from None
        return options

    def promises(self) -> dict[str, Promise]:
        found = {}
        table = self.value(self.content, "functions", dict)
        for name in table:
            entry = self.value(table, name, dict)
            found[name] = Promise(
                self.value(entry, "signature", str),
                self.list_of_texts(entry, "errors", []),
                self.value(entry, "source", str, ""),
            )
        return found
