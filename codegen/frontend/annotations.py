"""Types and domains as signatures state them: names, `Annotated[type, domain]`, and aliases of those."""

from __future__ import annotations

import ast

from codegen.errors import nearest
from codegen.frontend import domains
from codegen.frontend.scope import Names
from codegen.frontend.source import LANG, SourceFile
from codegen.ir.domains import MARKERS, Domain
from codegen.ir.types import TEXTURE, VALUE_TYPES, Type

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
            found = [(m, d) for m in markers if (d := domains.read(resolver, file, m)) is not None]
            if not found:
                raise file.error(node, f"Annotated needs a domain: {', '.join(MARKERS)}")
            if len(found) > 1:
                raise file.error(found[1][0], "a type has one domain; this is a second")
            marker, domain = found[0]
            domains.check(file, marker, type_, domain)
            return type_, domain
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
