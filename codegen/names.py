"""Names that no emitted file may use: keywords, built-ins and usual macros of every target and host."""

from __future__ import annotations

import functools
import json
from pathlib import Path

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


@functools.cache
def reserved() -> dict[str, str]:
    """Reserved word -> where it is reserved, for instance "a keyword of OpenCL C"."""
    lists = json.loads((Path(__file__).parent / "data" / "reserved-words.json").read_text("utf-8"))
    found: dict[str, list[str]] = {}
    for language, kinds in lists.items():
        for kind, entry in kinds.items():
            what = f"a {'built-in' if kind == 'builtin' else kind} of {LANGUAGE_NAMES[language]}"
            for word in entry["words"]:
                found.setdefault(word, []).append(what)
    return {word: " and ".join(where[:2]) for word, where in found.items()}


def check(name: str, kind: str, place: Place) -> None:
    """Raise SourceError where `name` cannot be emitted on every target."""
    if not name.isascii() or "__" in name or name.startswith("_"):
        raise SourceError(place, f'{kind} name "{name}" must be ASCII without leading or double underscore')
    where = reserved().get(name)
    if where is not None:
        raise SourceError(place, f'{kind} name "{name}" is {where}; choose another')


def check_emitted(name: str, prefix: str) -> None:
    """Raise UserError where a name has become reserved by its prefix."""
    where = reserved().get(name)
    if where is not None:
        raise UserError(f'prefix "{prefix}" makes "{name}", which is {where}')


def check_prefix(prefix: str) -> None:
    """Raise UserError where `prefix` cannot start an identifier on every target."""
    if not prefix or not prefix.isascii() or not prefix.isidentifier() or "__" in prefix:
        raise UserError(f'prefix "{prefix}" must be a plain ASCII identifier without double underscore')
    if prefix.startswith(("_", "gl_", "GL_", "cl_")):
        raise UserError(f'prefix "{prefix}" starts like a name that a target reserves')
