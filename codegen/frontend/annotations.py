"""Types and domains as signatures state them: names, `Annotated[type, domain]`, and aliases of those."""

from __future__ import annotations

import ast
import math

from codegen.errors import nearest
from codegen.frontend import constants
from codegen.frontend.scope import Names
from codegen.frontend.source import LANG, SourceFile
from codegen.ir.domains import EDGES, MARKERS, SCALES, Domain, Edges, Interval, Length, Unit
from codegen.ir.types import F32, TEXTURE, VALUE_TYPES, Type, Vector

_NAMED: dict[str, Type] = {**VALUE_TYPES, TEXTURE.name: TEXTURE}


def read(
    resolver: Names, file: SourceFile, node: ast.expr | None, owner: ast.AST
) -> tuple[Type, Domain | None]:
    """The type and domain of an annotation; raises SourceError where it is missing or unknown."""
    match node:
        case None:
            raise file.error(owner, "state the type, for instance f32 or Annotated[f32, Interval(0.0, 1.0)]")
        case ast.Name(id=name):
            return _named(resolver, file, node, name)
        case ast.Subscript(value=ast.Name(id="Annotated"), slice=ast.Tuple(elts=[base, *markers])):
            type_, _ = read(resolver, file, base, owner)
            for marker in markers:
                domain = _marker(resolver, file, marker)
                if domain is not None:
                    _check_domain(file, marker, type_, domain)
                    return type_, domain
            raise file.error(node, f"Annotated needs a domain: {', '.join(MARKERS)}")
        case _:
            raise file.error(node, "a type is a name or Annotated[type, domain]")


def _named(resolver: Names, file: SourceFile, node: ast.expr, name: str) -> tuple[Type, Domain | None]:
    where, original = resolver.find(file, name) or (None, name)
    if where is None and original in _NAMED and file.imports.get(name, (LANG, name))[0] == LANG:
        return _NAMED[original], None
    if where is not None and original in where.structs:
        return resolver.struct(where, original).type, None
    if where is not None and original in where.values:
        with resolver.defining(where, original, where.values[original]):
            return read(resolver, where, where.values[original], node)
    names = [*_NAMED, *file.imports, *file.structs]
    raise file.error(node, f'unknown type "{name}"{nearest(name, names)}')


def _check_domain(file: SourceFile, node: ast.expr, type_: Type, domain: Domain) -> None:
    if isinstance(domain, Edges) != (type_ == TEXTURE):
        raise file.error(node, f"Edges is the domain of Texture, and of nothing else; this is {type_.name}")
    if isinstance(domain, Edges):
        for edge in (domain.u, domain.v):
            if edge not in EDGES:
                raise file.error(node, f'unknown edge "{edge}"{nearest(str(edge), EDGES)}')
    if isinstance(domain, Unit | Length) and not (isinstance(type_, Vector) and type_.element == F32):
        raise file.error(node, f"{type(domain).__name__} is a domain of vectors, not of {type_.name}")
    if isinstance(domain, Interval | Length) and not -math.inf < domain.low <= domain.high < math.inf:
        raise file.error(node, "a domain needs finite ends, the lower one first")
    if isinstance(domain, Interval) and domain.scale not in SCALES:
        raise file.error(node, f'unknown scale "{domain.scale}"{nearest(domain.scale, SCALES)}')


def _marker(resolver: Names, file: SourceFile, node: ast.expr) -> Domain | None:
    if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Name)):
        return None
    kind = MARKERS.get(node.func.id)
    if kind is None:
        raise file.error(node, f'unknown domain "{node.func.id}"{nearest(node.func.id, MARKERS)}')

    def value(argument: ast.expr) -> float | str:
        if isinstance(argument, ast.Constant) and isinstance(argument.value, str):
            return argument.value
        number = constants.fold(argument, lambda n: resolver.constant(file, n))
        if number is None:
            raise file.error(argument, "a domain is stated in numbers")
        return float(number)

    try:  # the dataclass itself checks how many there are
        return kind(*map(value, node.args), **{k.arg or "": value(k.value) for k in node.keywords})  # type: ignore[arg-type]
    except TypeError:
        raise file.error(node, f"wrong arguments for {node.func.id}") from None
