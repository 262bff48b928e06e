"""A reader under test: what is called, with which files to start from."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from conformance.fuzz_parsers.archives import as_npz
from conformance.fuzz_parsers.documents import as_json, as_toml


@dataclass(frozen=True)
class Parser:
    """A reader under test.

    file   the name that its files have
    read   what is called with the path; UserError is its only way out
    seeds  files to start from
    trees  the same parsed, where they are TOML, JSON or arrays by name
    write  a tree as a file; None where there are none
    """

    file: str
    read: Callable[[Path], object]
    seeds: tuple[bytes, ...]
    trees: tuple[Any, ...] = ()
    write: Callable[[Any], bytes] | None = None


def toml_parser(file: str, read: Callable[[Path], object], texts: Sequence[str]) -> Parser:
    """A parser of TOML."""
    return Parser(file, read, tuple(t.encode() for t in texts), tuple(map(tomllib.loads, texts)), as_toml)


def json_parser(file: str, read: Callable[[Path], object], trees: Sequence[Any]) -> Parser:
    """A parser of JSON."""
    return Parser(file, read, tuple(map(as_json, trees)), tuple(trees), as_json)


def npz_parser(file: str, read: Callable[[Path], object], trees: Sequence[Any]) -> Parser:
    """A parser of arrays by name."""
    return Parser(file, read, tuple(map(as_npz, trees)), tuple(trees), as_npz)
