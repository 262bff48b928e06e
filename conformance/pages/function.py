"""All that the page of one function shows."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from typing import Any

from codegen.backends import TARGETS, dialect
from codegen.describe import domain_text, half_text, signature
from codegen.emit.module import DEFAULT_PREFIX, definitions
from codegen.guarantees import SPECIFICATIONS, guarantees, phrase
from codegen.half import half_forms
from codegen.ir.nodes import Function, Parameter, callees
from codegen.ir.types import Array, Struct
from codegen.library import Library
from codegen.passes.analysis.operations import operations_by_cost
from conformance.pages import recorded
from conformance.pages.pareto import mark, picture
from conformance.pages.text import anchor, coloured, linked
from conformance.printed.catalogue import MISPRINTS

KINDS = {"base": "", "variant": "variant of", "printed": "as the lecture prints"}
ENTRIES = ("returns", "degenerate", "form", "source")


def view(library: Library, f: Function, address: Callable[[str], str | None]) -> Mapping[str, Any]:
    """What the template function.html.j2 shows.

    address  name of a function -> address of its page, seen from this one; None where it has none
    """
    base = f.base or f.name
    names = {p.name for p in f.parameters}
    form = half_forms(library).get(f.name)
    return {
        "name": f.name,
        "section": f.module,
        "kind": KINDS.get(f.kind, f.kind),
        "base": f.base if f.base != f.name else None,
        "summary": f.doc.summary,
        "signature": signature(f),
        "source": f"{f.place.path}:{f.place.line}",
        "parameters": [row for p in f.parameters for row in _rows(library, f, p)],
        "entries": [(key, f.doc.entries[key]) for key in ENTRIES if key in f.doc.entries],
        "further": [(k, v) for k, v in f.doc.entries.items() if k not in ENTRIES and k not in names],
        "bounds": [(b.describe(), b.origin) for b in library.bounds_of(f.name)],
        "drivers": recorded.on_drivers(library, f),
        "guaranteed": _guaranteed(library, f),
        "half": half_text(form) if form else "",
        "operations": operations_by_cost(f, library),
        "times": recorded.times(library, f),
        "mark": mark(f.name),
        "pictures": pictures(library, base),
        "variants": [v.name for v in library.variants(base) if v.name != f.name],
        "calls": callees(f),
        "errata": errata(library, f),
        "texts": texts(library, f, address),
    }


@functools.cache
def pictures(library: Library, base: str) -> list[str]:
    """Time against error of a group, one picture per driver; the same on the pages of all its members."""
    return [picture(points, base, driver) for driver, points in recorded.group_points(library, base).items()]


def errata(library: Library, f: Function) -> list[dict[str, str]]:
    """The lecture's misprints that this function, or a printed form of it, is about."""
    own = {f.name, *(v.name for v in library.variants(f.base or f.name) if v.kind == "printed")}
    return [
        {
            "title": m.title,
            "anchor": anchor(m.title),
            "printed": m.printed,
            "right": m.right,
            "effect": m.effect,
        }
        for m in MISPRINTS
        if own & set(m.functions)
    ]


def texts(library: Library, f: Function, address: Callable[[str], str | None]) -> list[dict[str, str]]:
    """The definition of the function alone on every target, other functions as links."""
    found = []
    for target in TARGETS:
        d = dialect(target)
        own = definitions(library, d, library.select([f.name]), DEFAULT_PREFIX)[-1]
        html = coloured("\n".join(own.code), target)
        found.append(
            {
                "title": d.title,
                "html": linked(html, lambda name: None if name == f.name else address(name)),
                "command": f"vair emit --target {target} --function {f.name}",
            }
        )
    return found


def _rows(library: Library, f: Function, p: Parameter) -> list[dict[str, Any]]:
    """The row of a parameter, and one for each field of a struct."""
    meaning, domain = f.doc.entries.get(p.name, ""), domain_text(p.domain)
    rows = [{"name": p.name, "type": p.type.name, "meaning": meaning, "domain": domain, "is_field": False}]
    if isinstance(p.type, Struct) and not isinstance(p.type, Array):
        told = library.struct(p.type.name).doc.entries
        rows += [
            {
                "name": f"{p.name}.{field.name}",
                "type": field.type.name,
                "meaning": told.get(field.name, ""),
                "domain": domain_text(field.domain),
                "is_field": True,
            }
            for field in p.type.fields
        ]
    return rows


def _guaranteed(library: Library, f: Function) -> list[tuple[str, str]]:
    found = guarantees(library).get(f.name)
    if found is None:
        return []
    bounds = library.bounds_of(f.name)
    return [
        (
            SPECIFICATIONS[table],
            phrase(table, g, bounds).replace(f" by the {SPECIFICATIONS[table]} specification", ""),
        )
        for table, g in found.tables.items()
    ]
