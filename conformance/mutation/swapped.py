"""A mutant inside a function: code is exchanged in the function objects that are there, nothing is imported.

That spares a trial the import of all that depends on a changed module, and the collection of its tests.
It serves where a change touches functions alone, and none that runs while modules are imported.
"""

from __future__ import annotations

import ast
import gc
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

Place = tuple[str, int]
"""Qualified name and first line of a function."""


@dataclass(frozen=True)
class Swap:
    """Functions and the code that each is given."""

    pairs: tuple[tuple[FunctionType, CodeType], ...]

    def put(self) -> None:
        """From now on this process runs the other code. Raises ValueError where the closures differ."""
        for function, code in self.pairs:
            function.__code__ = code


class Alive:
    """The function objects of some files that exist now."""

    def __init__(self, files: Iterable[Path]) -> None:
        names = {str(file) for file in files}
        self.found: dict[str, dict[Place, list[FunctionType]]] = {name: {} for name in names}
        for thing in gc.get_objects():
            if isinstance(thing, FunctionType) and (code := thing.__code__).co_filename in names:
                self.found[code.co_filename].setdefault(_place(code), []).append(thing)

    def swap(self, file: Path, text: str, tree: ast.Module) -> Swap | None:
        """What makes of the loaded module the one of a tree; None where more than functions differ."""
        before, after = (compile(source, str(file), "exec") for source in (ast.parse(text), tree))
        old, new = _functions(before), _functions(after)
        if _outside(before) != _outside(after) or set(old) != set(new):
            return None
        alive = self.found[str(file)]
        differing = [place for place in new if new[place] != old[place]]
        if not differing or any(place not in alive or len(new[place]) > 1 for place in differing):
            return None
        pairs = [(function, code) for place in differing for code in new[place] for function in alive[place]]
        if any(len(f.__closure__ or ()) != len(code.co_freevars) for f, code in pairs):
            return None
        return Swap(tuple(pairs))


def _place(code: CodeType) -> Place:
    return code.co_qualname, code.co_firstlineno


def _is_body(code: CodeType) -> bool:
    """Whether this is the body of a class, which like that of the module runs once, at import."""
    return "__qualname__" in code.co_names and "__module__" in code.co_names


def _parts(code: CodeType) -> list[CodeType]:
    return [part for part in code.co_consts if isinstance(part, CodeType)]


def _functions(code: CodeType) -> dict[Place, list[CodeType]]:
    """The functions that a module or class body defines, those of its classes among them.

    Only of lambdas can several stand in one place.
    """
    found: dict[Place, list[CodeType]] = {}
    for part in _parts(code):
        for place, codes in (_functions(part) if _is_body(part) else {_place(part): [part]}).items():
            found.setdefault(place, []).extend(codes)
    return found


def _outside(code: CodeType) -> list[Any]:
    """What a module and its classes do themselves, without what their functions do."""
    constants = [c if not isinstance(c, CodeType) else _place(c) for c in code.co_consts]
    own = (code.co_code, code.co_names, code.co_varnames, repr(constants))
    return [own, *(_outside(part) for part in _parts(code) if _is_body(part))]
