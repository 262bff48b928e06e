"""Names that no emitted file may use: keywords, built-ins and usual macros of every target and host."""

from __future__ import annotations

import functools
import json
from pathlib import Path
from typing import Any

from codegen.errors import Place, SourceError, UserError

LANGUAGE_NAMES = {
    "glsl": "GLSL",
    "wgsl": "WGSL",
    "opencl": "OpenCL C",
    "hlsl": "HLSL",
    "msl": "Metal",
    "c": "C",
    "windows": "Windows headers",
    "x11": "X11 headers",
    "engines": "engines",
}


CASELESS = "caseless"
"""Kind of the words that a language takes as keywords in capitals, small letters or both."""
REFUSED_STARTS = ("_", "gl_", "webgl_", "cl_")
"""What names, and in capitals macros, of GLSL, WebGL (1.0.3 section 6.17) and OpenCL start with."""


@functools.cache
def reserved() -> dict[str, str]:
    """Reserved word -> where it is reserved, for instance "a keyword of OpenCL C"."""
    found: dict[str, list[str]] = {}
    for language, kinds in _lists().items():
        for kind, entry in kinds.items():
            word_kind = {"builtin": "built-in", CASELESS: "keyword"}.get(kind, kind)
            what = f"a {word_kind} of {LANGUAGE_NAMES[language]}"
            for word in entry["words"]:
                found.setdefault(word, []).append(what)
    return {word: " and ".join(where[:2]) for word, where in found.items()}


@functools.cache
def caseless() -> dict[str, str]:
    """Word in small letters -> where it is reserved in any case."""
    return {
        word.lower(): f"a keyword of {LANGUAGE_NAMES[language]} in any case"
        for language, kinds in _lists().items()
        for word in kinds.get(CASELESS, {"words": []})["words"]
    }


def where_reserved(name: str) -> str | None:
    """Where a name is reserved; None where it is free on every target."""
    return reserved().get(name) or caseless().get(name.lower())


@functools.cache
def _lists() -> dict[str, Any]:
    lists: dict[str, Any] = json.loads(
        (Path(__file__).parent / "data" / "reserved-words.json").read_text("utf-8")
    )
    return lists


def check(name: str, kind: str, place: Place) -> None:
    """Raise SourceError where `name` cannot be emitted on every target."""
    if not name.isascii() or "__" in name or name.startswith("_"):
        raise SourceError(place, f'{kind} name "{name}" must be ASCII without leading or double underscore')
    where = where_reserved(name)
    if where is not None:
        raise SourceError(place, f'{kind} name "{name}" is {where}; choose another')


def check_emitted(name: str, prefix: str) -> None:
    """Raise UserError where a name has become reserved by its prefix."""
    where = where_reserved(name)
    if where is not None:
        raise UserError(f'prefix "{prefix}" makes "{name}", which is {where}')


def check_prefix(prefix: str) -> None:
    """Raise UserError where `prefix` cannot start an identifier on every target."""
    if not prefix or not prefix.isascii() or not prefix.isidentifier() or "__" in prefix:
        raise UserError(f'prefix "{prefix}" must be a plain ASCII identifier without double underscore')
    if prefix.lower().startswith(REFUSED_STARTS):
        raise UserError(f'prefix "{prefix}" starts like a name that a target reserves')
