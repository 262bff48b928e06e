"""Mutants of the library under `vair check`: the changed source goes through the front end.

A mutant is first checked on few points, and on more points and in its callers where that shows nothing;
last, it may not lose what WGSL guarantees of the function (conformance.guarantees). Functions that read maps
are held to their references on maps of conformance.textures instead, those that no public function reaches to
the formulas of conformance.check.parts. What sources promise beside a bound is checked for all of them, see
conformance.check.promises and conformance.textures.estimators.
"""

from __future__ import annotations

import ast
import functools
from collections.abc import Iterable, Set

import numpy as np

from codegen.errors import SourceError, UserError
from codegen.frontend.source import ROOT_PACKAGE
from codegen.intervals import permitted
from codegen.ir.nodes import callees
from codegen.ir.verify import MalformedIRError
from codegen.library import Library, default_root, load_library
from conformance.check import engine, parts, promises
from conformance.check.engine import Draw
from conformance.execute.further import codomains, leaves_codomain, with_further_bounds
from conformance.mutation.isolated import KILLED, REFUSED, SURVIVED
from conformance.mutation.plan import Group, Subject, tree_of
from conformance.mutation.sites import Mutant
from conformance.reference import PROPERTY_ONLY
from conformance.textures import estimators, readers

TABLE = "wgsl"
"""Whose guarantees a mutant must not lose: many a guard is there for what other targets may do."""


def with_source(path: str, tree: ast.Module) -> Library:
    """The library with one source replaced."""
    library = with_further_bounds(Library(default_root()))
    module = path.removesuffix(".py").replace("/", ".")
    assert module.startswith(ROOT_PACKAGE)
    file = library.resolver.file(module)
    for node in tree.body:
        match node:
            case ast.FunctionDef(name=name):
                file.functions[name] = node
            case (
                ast.Assign(targets=[ast.Name(id=name)], value=value)
                | ast.AnnAssign(target=ast.Name(id=name), value=ast.expr() as value)
            ):
                file.values[name] = value
    return library


@functools.cache
def callers() -> dict[str, list[str]]:
    """Function -> the functions that call it."""
    found: dict[str, list[str]] = {}
    for f in load_library().functions.values():
        for name in callees(f):
            found.setdefault(name, []).append(f.name)
    return found


def public_users(name: str, limit: int) -> list[str]:
    """The public functions that reach a function, the function itself if it is public.

    The nearest first, and of those with the fewest parameters first, in which most of it shows.
    """
    public = load_library().documented
    found: list[str] = []
    waiting, seen = [name], {name}
    while waiting:
        current = waiting.pop(0)
        if current in public:
            found.append(current)
        for caller in sorted(callers().get(current, ()), key=_number_of_parameters):
            if caller not in seen:
                seen.add(caller)
                waiting.append(caller)
    return found[:limit]


def _number_of_parameters(name: str) -> int:
    return len(load_library().function(name).parameters)


@functools.lru_cache(maxsize=64)
def points(name: str, uniform: int, family: int) -> list[Draw]:
    """The points of the unchanged function."""
    return list(engine.draws(load_library().function(name), uniform, family))


def notices(library: Library, names: Iterable[str], uniform: int, family: int) -> bool:
    """Whether the check of any of these functions fails."""
    return any(
        not readers.passes(library, name)
        if load_library().function(name).reads_textures
        else _fails(library, name, points(name, uniform, family))
        for name in names
    )


def _fails(library: Library, name: str, draws: list[Draw]) -> bool:
    on = engine.backend("numpy")
    if any(leaves_codomain(name, on.run(library, name, d.inputs)) for d in draws if name in codomains()):
        return True
    if name in PROPERTY_ONLY:  # its reference would be the mutant; test_recorded_pattern.py keeps the pattern
        return any(
            not np.array_equal(
                np.asarray(on.run(library, name, d.inputs)),
                np.asarray(on.run(load_library(), name, d.inputs)),
            )
            for d in draws
        )
    # The intervals of a mutant are its own; what they should be is asked in loses_guarantees.
    return not engine.check_function(library, name, on, draws, intervals=False).passed


def loses_guarantees(library: Library, name: str, draws: list[Draw]) -> bool:
    """Whether a specification guarantees the function at fewer points than it was guaranteed at."""

    def guaranteed(of: Library, d: Draw) -> int:
        return int(permitted(of, name, d.inputs, TABLE, follow_forks=False).guaranteed.sum())

    return any(guaranteed(library, d) < guaranteed(load_library(), d) for d in draws)


def names_in(mutant: Mutant, subject: Subject) -> list[str]:
    """The functions that a mutant changes: one, or those that mention a constant, or all of the file.

    Of a file without functions: those that mention the constant where it is imported.
    """
    place = mutant.place.partition(".")[0]
    if place:
        return [place]
    body = ast.parse(subject.text).body
    assigned = {
        part.id
        for n in body
        if not isinstance(n, ast.FunctionDef) and n.lineno <= mutant.line <= (n.end_lineno or n.lineno)
        for part in ast.walk(n)
        if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store)
    }
    functions = [n for n in body if isinstance(n, ast.FunctionDef)]
    if not functions:
        return _importing(subject.path, assigned)
    return _mentioning(functions, assigned) or [f.name for f in functions]


def _mentioning(functions: Iterable[ast.FunctionDef], wanted: Set[str]) -> list[str]:
    return [
        f.name
        for f in functions
        if any(isinstance(part, ast.Name) and part.id in wanted for part in ast.walk(f))
    ]


def _importing(path: str, wanted: Set[str]) -> list[str]:
    """The functions of other files that mention a constant of this one."""
    module = path.removesuffix(".py").replace("/", ".")
    resolver = load_library().resolver
    files = {resolver.module_of(name): resolver.where(name) for name in resolver.function_names()}
    found: list[str] = []
    for file in filter(None, files.values()):
        seen = {
            local for local, (source, name) in file.imports.items() if source == module and name in wanted
        }
        found += _mentioning(file.functions.values(), seen)
    return found


def judge(group: Group, subject: Subject, mutant: Mutant) -> str:
    """KILLED, SURVIVED or REFUSED."""
    try:
        library = with_source(subject.path, tree_of(group, subject, mutant))
        changed = names_in(mutant, subject)
        for name in changed:
            library.function(name)
    except (SourceError, UserError, MalformedIRError):
        return REFUSED
    if any(not parts.passes(library, name) for name in changed if name in parts.PARTS):
        return KILLED
    users = list(dict.fromkeys(user for name in changed for user in public_users(name, 50)))
    own = [name for name in users if name in changed] or users[:1]
    others = [name for name in users if name not in own]
    if not all(promises.keeps(library, name) for name in dict.fromkeys([*changed, *users])):
        return KILLED
    uniform, family, _ = group.first
    if notices(library, own, uniform, family):
        return KILLED
    if not all(estimators.keeps_promises(library, name) for name in own if estimators.is_estimator(name)):
        return KILLED
    uniform, family, more = group.second
    if notices(library, own, uniform, family):
        return KILLED
    uniform, family, _ = group.first
    if notices(library, others[:more], uniform, family):
        return KILLED
    drawn = [name for name in own if not load_library().function(name).reads_textures]
    if any(loses_guarantees(library, name, points(name, uniform, family)) for name in drawn):
        return KILLED
    return SURVIVED
