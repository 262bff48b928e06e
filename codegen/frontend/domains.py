"""Domains as sources state them: `Interval(0.0, 1.0)` and its like, read and held against a type."""

from __future__ import annotations

import ast
import json
import math
from dataclasses import MISSING, Field, fields

from codegen.errors import nearest
from codegen.frontend import constants
from codegen.frontend.scope import Names
from codegen.frontend.source import SourceFile
from codegen.ir.domains import EDGES, MARKERS, SCALES, Domain, Edges, Interval, Length, Unit, number
from codegen.ir.types import BOOL, F32, I32, TEXTURE, U32, Struct, Type, Vector

_REACH = {
    F32.name: ("-3.4028235e38", "3.4028235e38"),
    I32.name: ("-2147483648", "2147483647"),
    U32.name: ("0", "4294967295"),
}
"""The ends of types as people write them; that of f32 rounds to its largest number."""


def read(resolver: Names, file: SourceFile, node: ast.expr) -> Domain | None:
    """The domain that a marker of Annotated states; None where the marker is something else."""
    if isinstance(node, ast.Name) and node.id in MARKERS:
        raise file.error(node, f"a domain is called: write {_shape(node.id)}")
    if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Name)):
        return None
    name = node.func.id
    if name not in MARKERS:
        raise file.error(node, f'unknown domain "{name}"{nearest(name, MARKERS)}')
    given = _given(file, node, name)
    values = {
        f.name: _value(resolver, file, given[f.name], name, f) for f in _fields(name) if f.name in given
    }
    return MARKERS[name](**values)  # type: ignore[arg-type]  # _value has read what each field holds


def check(file: SourceFile, node: ast.expr, type_: Type, domain: Domain) -> None:
    """Refuse a domain that is none, or none of this type."""
    if isinstance(domain, Edges) != (type_ == TEXTURE):
        raise file.error(node, f"Edges is the domain of Texture, and of nothing else; this is {type_.name}")
    if isinstance(type_, Struct):
        raise file.error(node, "a struct has the domains of its fields, and none of its own")
    match domain:
        case Edges():
            for edge in (domain.u, domain.v):
                if edge not in EDGES:
                    raise file.error(node, f'unknown edge "{edge}"{nearest(edge, EDGES)}')
        case Unit() | Length() if not (isinstance(type_, Vector) and type_.element == F32):
            raise file.error(node, f"{type(domain).__name__} is a domain of vectors, not of {type_.name}")
        case Interval() | Length():
            _check_ends(file, node, type_, domain)


def _check_ends(file: SourceFile, node: ast.expr, type_: Type, domain: Interval | Length) -> None:
    element = type_.element if isinstance(type_, Vector) else type_
    low, high = domain.low, domain.high
    if element == BOOL:
        raise file.error(node, "Interval is a domain of numbers, not of bool")
    if not -math.inf < low <= high < math.inf:
        raise file.error(node, "a domain needs finite ends, the lower one first")
    least, most = _REACH[element.name]
    if low < float(least) or high > float(most):
        raise file.error(node, f"{element.name} reaches from {least} to {most}; the ends lie beyond")
    if element != F32 and math.ceil(low) > math.floor(high):
        raise file.error(node, f"no whole number lies in [{number(low)}, {number(high)}]")
    if isinstance(domain, Length):
        if low < 0.0 or high == 0.0:
            raise file.error(node, "a length is 0 or more, and the larger one more than 0")
        return
    if domain.scale not in SCALES:
        raise file.error(node, f'unknown scale "{domain.scale}"{nearest(domain.scale, SCALES)}')
    if not 0.0 <= domain.least <= max(-low, high):
        raise file.error(node, '"least" of Interval is a magnitude, from 0 to the larger end')


def _fields(name: str) -> tuple[Field[float | str], ...]:
    return fields(MARKERS[name])


def _shape(name: str) -> str:
    """How a domain is written: 'Length(low, high)'."""
    said = (f.name if f.default is MISSING else f"{f.name}={json.dumps(f.default)}" for f in _fields(name))
    return f"{name}({', '.join(said)})"


def _given(file: SourceFile, node: ast.Call, name: str) -> dict[str, ast.expr]:
    """The arguments by the names of their fields; each once, and all that are needed."""
    known = [f.name for f in _fields(name)]
    given = dict(zip(known, node.args, strict=False))
    given |= {k.arg: k.value for k in node.keywords if k.arg in known}
    needed = {f.name for f in _fields(name) if f.default is MISSING}
    unpacked = any(isinstance(a, ast.Starred) for a in node.args)
    if unpacked or len(given) < len(node.args) + len(node.keywords) or not needed <= given.keys():
        raise file.error(node, f"wrong arguments for {name}; write {_shape(name)}")
    return given


def _value(
    resolver: Names, file: SourceFile, node: ast.expr, name: str, place: Field[float | str]
) -> float | str:
    is_text = isinstance(node, ast.Constant) and isinstance(node.value, str)
    if place.type == "str":
        if is_text:
            return str(ast.literal_eval(node))
        raise file.error(node, f'"{place.name}" of {name} is a text in quotation marks; write {_shape(name)}')
    value = "a text" if is_text else constants.fold(node, lambda n: resolver.constant(file, n))
    if isinstance(value, str | bool):
        raise file.error(node, f'"{place.name}" of {name} is a number, not {value}; write {_shape(name)}')
    if value is None:
        raise file.error(node, "a domain is stated in numbers")
    try:
        return float(value)
    except OverflowError:  # a whole number beyond double precision: no end is infinite
        return math.inf
