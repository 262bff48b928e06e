"""What the results of a sweep depend on: a function's bounds, and the program of a target.

Files hold several functions; a new one beside a function, or another word about it, leaves its results alone.
So do the guards that keep a definition from being read twice: they are no code, and their names may change.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable

from codegen.kernels import kernel
from codegen.library import Library
from targets import TARGETS

NO_CODE = re.compile(r"//|#ifndef \w+$|#define \w+$|#endif$|$")
"""Lines without code: comments, guards, nothing."""


def source_of(library: Library, name: str, target: str) -> str:
    """Hash of a function's bounds and its program on a target; of its source files where it has none."""
    program = kernel(library, name, target) if target in TARGETS else library.select([name]).source_hash
    return hash_of(program, [b.describe() for b in library.bounds.get(name, ())])


def hash_of(program: str, bounds: Iterable[str] = ()) -> str:
    """Hash of the lines of code of a program, and of further lines."""
    return hashlib.sha256("\n".join([*code_of(program), *bounds]).encode()).hexdigest()[:16]


def code_of(program: str) -> list[str]:
    """The lines of code of a program."""
    return [line for line in program.splitlines() if not NO_CODE.match(line.strip())]
