"""Where a syntax tree can be changed: one site is one small change of one node.

A rule looks at a node and offers replacements; the walk decides where rules may look. Annotations, type
aliases, docstrings, decorators, assertions and raised errors are left alone: a change there is no fault.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

SHOWN = 70
"""Most characters of a piece of source that a description shows."""

Offer = tuple[str, ast.AST]
"""The name of an operator and what it puts in a node's place."""
Rule = Callable[[ast.AST], Iterable[Offer]]

_UNTOUCHED_FIELDS = frozenset({"annotation", "returns", "decorator_list", "type_comment", "bases"})


_REFUSALS = frozenset({"fail", "error"})
"""Methods that raise: their sentences are left alone like those of raise."""
_LEFT_ALONE = (ast.Raise, ast.Assert, ast.Import, ast.ImportFrom, ast.Global)


@dataclass(frozen=True)
class Mutant:
    """One change of one file, described so that it can be found again when lines have moved.

    path      the file, from the root of the repository
    place     the function or class it is in ("" at top level)
    operator  the kind of change
    before    the changed piece of source
    after     what stands there instead
    index     its number among the changes that the rules offer for this file
    line      of the changed piece
    """

    path: str
    place: str
    operator: str
    before: str
    after: str
    index: int
    line: int

    @property
    def key(self) -> tuple[str, str, str, str]:
        """What an entry of equivalent.toml names: file, place, before and after."""
        return self.path, self.place, self.before, self.after

    def __str__(self) -> str:
        where = f"{self.path}:{self.line}" + (f" {self.place}" if self.place else "")
        return f"{where}: {self.operator}: {self.before} -> {self.after}"


@dataclass(frozen=True)
class Site:
    """A node that can be replaced, and where it hangs."""

    holder: Any
    slot: str | int
    node: ast.AST
    place: str
    operator: str
    replacement: ast.AST

    def apply(self) -> None:
        """Put the replacement into the tree."""
        if isinstance(self.slot, int):
            self.holder[self.slot] = self.replacement
        else:
            setattr(self.holder, self.slot, self.replacement)


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def _is_alias(node: ast.AST) -> bool:
    """Run = Callable[[int], int] or N = TypeVar("N", int, float) at top level."""
    if not isinstance(node, ast.Assign):
        return False
    made = node.value
    is_variable = isinstance(made, ast.Call) and isinstance(made.func, ast.Name) and made.func.id == "TypeVar"
    return is_variable or isinstance(made, ast.Subscript)


def _children(node: ast.AST) -> Iterator[tuple[Any, str | int, ast.AST]]:
    for name, value in ast.iter_fields(node):
        if name in _UNTOUCHED_FIELDS:
            continue
        if isinstance(value, ast.AST):
            yield node, name, value
        elif isinstance(value, list):
            for k, item in enumerate(value):
                if isinstance(item, ast.AST):
                    yield value, k, item


def sites(tree: ast.AST, rule: Rule, place: str = "") -> Iterator[Site]:
    """Every change that the rule offers below a node, in source order."""
    for holder, slot, node in _children(tree):
        if isinstance(node, _LEFT_ALONE) or _is_text(node) or (not place and _is_alias(node)):
            continue
        for operator, replacement in rule(node):
            if ast.dump(replacement) != ast.dump(node):  # vec3(0.0, 0.0, 1.0) with its arguments exchanged
                yield Site(holder, slot, node, place, operator, replacement)
        if isinstance(node, ast.Call) and getattr(node.func, "attr", "") in _REFUSALS:
            continue
        named = isinstance(node, ast.FunctionDef | ast.ClassDef)
        inner = f"{place}.{node.name}".lstrip(".") if named else place  # type: ignore[attr-defined]
        yield from sites(node, rule, inner)


def _shown(node: ast.AST) -> str:
    text = " ".join(ast.unparse(ast.fix_missing_locations(node)).split())
    return text if len(text) <= SHOWN else f"{text[: SHOWN - 4]} ..."


def mutants(path: str, text: str, rule: Rule) -> list[Mutant]:
    """Every mutant of a file."""
    found: list[Mutant] = []
    seen: dict[tuple[str, str], int] = {}
    for index, site in enumerate(sites(ast.parse(text), rule)):
        before, after = _shown(site.node), _shown(site.replacement)
        # The same change a second time in one place is told apart by its number there.
        repeated = seen[key] if (key := (site.place, f"{before} -> {after}")) in seen else 0
        seen[key] = repeated + 1
        after = f"{after} (no. {repeated + 1})" if repeated else after
        line = getattr(site.node, "lineno", 0)
        found.append(Mutant(path, site.place, site.operator, before, after, index, line))
    return found


def mutated(text: str, rule: Rule, index: int) -> ast.Module:
    """The tree of a file with its mutant of that number."""
    tree = ast.parse(text)
    for k, site in enumerate(sites(tree, rule)):
        if k == index:
            site.apply()
            return ast.fix_missing_locations(tree)
    raise IndexError(f"no mutant {index}")
