"""What the results of a sweep depend on: a function's bounds, and the program of a target, comments aside.

Files hold several functions; a new one beside a function, or another word about it, leaves its results alone.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable

from codegen.kernels import kernel
from codegen.library import Library
from targets import TARGETS


def source_of(library: Library, name: str, target: str) -> str:
    """Hash of a function's bounds and its program on a target; of its source files where it has none."""
    program = kernel(library, name, target) if target in TARGETS else library.select([name]).source_hash
    return hash_of(program, [b.describe() for b in library.bounds.get(name, ())])


def hash_of(program: str, bounds: Iterable[str] = ()) -> str:
    """Hash of a program without its lines of comment, and of further lines."""
    lines = [line for line in program.splitlines() if line.strip() and not line.lstrip().startswith("//")]
    return hashlib.sha256("\n".join([*lines, *bounds]).encode()).hexdigest()[:16]
