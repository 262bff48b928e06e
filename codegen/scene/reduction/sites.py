"""Call sites: where a function's tree of calls may take a variant, and the function with variants taken.

A site is a path of call numbers: (2, 0) is the first call inside what the third call of the root calls. Two
calls of one function are two sites, since what is known of their arguments differs.
"""

from __future__ import annotations

import functools
import hashlib
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from codegen.ir import nodes as ir
from codegen.ir.domains import Interval
from codegen.library import Library

_COPY = re.compile(r"_at(_\d+)+")
"""What marks copies of functions between the root and a chosen variant."""

Path = tuple[int, ...]
Choices = Mapping[Path, str]
"""Site -> name of the function that is called there instead."""

Known = dict[str, tuple[float, float]]
"""Least and largest value of scalar parameters, where they are known."""


@dataclass(frozen=True)
class Site:
    """One call, with what may stand in its place.

    caller   function whose text holds the call, as the library names it
    callee   what is called there now
    options  variants whose domains cover what is known of the arguments
    """

    path: Path
    caller: str
    callee: str
    options: tuple[str, ...]


def sites(
    library: Library,
    root: ir.Function,
    choices: Choices,
    known: Known,
    settled: frozenset[str] = frozenset(),
) -> Iterator[Site]:
    """Every call below the root with these choices made, in order.

    settled  powers that become multiplications where their exponent is a constant whole number: no sites
    """

    def visit(f: ir.Function, path: Path, known: Known) -> Iterator[Site]:
        definitions, calls = _definitions(f.body), _calls(f.body)
        for k, call in enumerate(calls):
            here = (*path, k)
            callee = library.function(choices.get(here, call.function))
            passed = _passed(callee, call, known, definitions)
            written = library.function(call.function)
            if callee.name in settled and _is_whole(callee, passed):
                continue
            options = tuple(
                o for o in variants_of(library, written) if o != callee.name and _covers(library, o, passed)
            )
            if callee.name != written.name:
                options = (written.name, *options)
            yield Site(here, f.name, callee.name, options)
            yield from visit(callee, here, passed)

    yield from visit(root, (), known)


def _is_whole(callee: ir.Function, passed: Known) -> bool:
    """Whether the last parameter, the exponent of a power, is one whole number from 1 on."""
    low, high = passed.get(callee.parameters[-1].name, (0.5, 0.5))
    return low == high == int(low) and low >= 1.0


def variants_of(library: Library, f: ir.Function) -> list[str]:
    """Functions that may be called in this one's place: the base and its variants with equal parameters."""
    base = f.base if f.kind == "variant" and f.base else f.name
    # Variants stand in their base's file or in one named after it: only these are parsed.
    family = map(library.function, library.resolver.family(base))
    shape = [(p.name, p.type) for p in f.parameters]
    return [
        g.name
        for g in family
        if (g.name == base or (g.base == base and g.kind == "variant"))
        and g.name != f.name
        and [(p.name, p.type) for p in g.parameters] == shape
        and g.returns == f.returns
    ]


def _covers(library: Library, name: str, passed: Known) -> bool:
    """Whether a function's domain holds the known range of each argument.

    What is not known may be anything that the caller's own domain allows; a parameter that is narrower than
    its base's is then refused.
    """
    f = library.function(name)
    base = library.function(f.base) if f.base else f
    for p in f.parameters:
        if not isinstance(p.domain, Interval):
            continue
        wide = next((q.domain for q in base.parameters if q.name == p.name), None)
        if p.name in passed:
            low, high = passed[p.name]
            if low < p.domain.low or high > p.domain.high:
                return False
        elif isinstance(wide, Interval) and (p.domain.low > wide.low or p.domain.high < wide.high):
            return False
    return True


def _passed(callee: ir.Function, call: ir.Call, known: Known, definitions: Mapping[str, ir.Expr]) -> Known:
    """What is known of a callee's scalar parameters and struct fields (as "parameter.field")."""
    found: Known = {}
    for p, a in zip(callee.parameters, call.args, strict=True):
        for field, expression in _scalars(a, definitions):
            bounds = _range(expression, known, definitions)
            if bounds is not None:
                found[f"{p.name}{field}"] = bounds
        if isinstance(a, ir.Var) and a.name not in definitions:
            prefix = a.name + "."
            found |= {
                p.name + "." + n.removeprefix(prefix): r for n, r in known.items() if n.startswith(prefix)
            }
    return found


def _scalars(e: ir.Expr, definitions: Mapping[str, ir.Expr]) -> Iterator[tuple[str, ir.Expr]]:
    """A scalar expression, or the fields of a constructed struct, by their path."""
    if isinstance(e, ir.Var) and e.name in definitions:
        e = definitions[e.name]
    if isinstance(e, ir.Construct) and hasattr(e.type, "fields"):
        for f, a in zip(e.type.fields, e.args, strict=True):
            yield f".{f.name}", a
    elif not hasattr(e.type, "fields"):
        yield "", e


def _range(e: ir.Expr, known: Known, definitions: Mapping[str, ir.Expr]) -> tuple[float, float] | None:
    """The range of an expression that is a constant, a parameter, a field, or such a one times a constant."""
    match e:
        case ir.Const():
            return (float(e.value), float(e.value))
        case ir.Var():
            if e.name in known:
                return known[e.name]
            return _range(definitions[e.name], known, definitions) if e.name in definitions else None
        case ir.Member() if isinstance(e.value, ir.Var):
            return known.get(f"{e.value.name}.{e.name}")
        case ir.Binary(op="*"):
            a, b = _range(e.left, known, definitions), _range(e.right, known, definitions)
            if a is None or b is None:
                return None
            ends = [x * y for x in a for y in b]
            return min(ends), max(ends)
        case _:
            return None


@functools.lru_cache(4096)
def _definitions(body: tuple[ir.Stmt, ...]) -> Mapping[str, ir.Expr]:
    """The locals of a function with their values."""
    return {s.name: s.value for s in ir.statements(body) if isinstance(s, ir.Let)}


@functools.lru_cache(4096)
def _calls(body: tuple[ir.Stmt, ...]) -> list[ir.Call]:
    """The calls of a function in the order in which `_with_calls` meets them."""
    found: list[ir.Call] = []

    def note(e: ir.Expr) -> ir.Expr:
        if isinstance(e, ir.Call):
            found.append(e)
        return e

    ir.map_body(body, note)
    return found


Copies = dict[str, list[ir.Function]]
"""Name of a copy -> the copies below it, and itself."""


def substituted(
    library: Library, root: ir.Function, choices: Choices, name: str, known: Copies | None = None
) -> list[ir.Function]:
    """The root under another name with the choices made, after copies of what lies between.

    Copies are named after where they are and what is chosen below, so that a name means one function.

    known  copies that were made before for this root; those of this call are added
    """
    copies = {} if known is None else known

    def visit(f: ir.Function, path: Path, new_name: str) -> list[ir.Function]:
        made: list[ir.Function] = []
        changed = {p[len(path)] for p in choices if p[: len(path)] == path and len(p) > len(path)}
        names: dict[int, str] = {}
        for k, call in enumerate(_calls(f.body)):
            if k not in changed:
                continue
            here = (*path, k)
            callee = choices.get(here, call.function)
            below = [(p, c) for p, c in choices.items() if p[: len(here)] == here and len(p) > len(here)]
            names[k] = callee
            if below:
                copy = names[k] = f"{callee}_at_{'_'.join(map(str, here))}_{_number(below)}"
                if copy not in copies:
                    copies[copy] = visit(library.function(callee), here, copy)
                made += copies[copy]
        made.append(replace(f, name=new_name, kind="helper", base=None, body=_with_calls(f, names)))
        return made

    return visit(root, (), name)


def _number(choices: list[tuple[Path, str]]) -> int:
    """A number that tells these choices from others."""
    return int.from_bytes(hashlib.sha256(repr(sorted(choices)).encode()).digest()[:8], "big")


def _with_calls(f: ir.Function, names: Mapping[int, str]) -> tuple[ir.Stmt, ...]:
    """The body of a function with other names for some of its calls, by their numbers."""
    number = -1

    def change(e: ir.Expr) -> ir.Expr:
        nonlocal number
        if not isinstance(e, ir.Call):
            return e
        number += 1
        return replace(e, function=names[number]) if number in names else e

    body: list[ir.Stmt] = []
    for s in f.body:
        following = number + len(_calls((s,)))
        if any(number < k <= following for k in names):
            body += ir.map_body((s,), change)
        else:
            body.append(s)
            number = following
    return tuple(body)


def plainly_named(f: ir.Function) -> ir.Function:
    """The function with locals named after copies of functions named after the functions themselves."""
    names = {s.name for s in ir.statements(f.body) if isinstance(s, ir.Let | ir.For)}
    taken = names | {p.name for p in f.parameters}
    new: dict[str, str] = {}
    for name in sorted(names):
        plain = _COPY.sub("", name)
        if plain != name:
            stem, k = plain, 1
            while plain in taken:
                k += 1
                plain = f"{stem}_{k}"
            taken.add(plain)
            new[name] = plain

    def rename(e: ir.Expr) -> ir.Expr:
        return replace(e, name=new[e.name]) if isinstance(e, ir.Var) and e.name in new else e

    def block(body: tuple[ir.Stmt, ...]) -> tuple[ir.Stmt, ...]:
        made: list[ir.Stmt] = []
        for s in body:
            if isinstance(s, ir.If):
                s = replace(s, then=block(s.then), orelse=block(s.orelse))
            elif isinstance(s, ir.For):
                s = replace(s, body=block(s.body))
            elif isinstance(s, ir.Let | ir.Assign) and s.name in new:
                s = replace(s, name=new[s.name])
            made.append(s)
        return tuple(made)

    return replace(f, body=block(ir.map_body(f.body, rename))) if new else f
