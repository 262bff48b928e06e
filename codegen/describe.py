"""What is known of a function, for people and for programs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from codegen.costs import costs
from codegen.emit.parameter import described
from codegen.guarantees import Guarantee, guarantees, phrase
from codegen.half import HalfForm, half_forms
from codegen.ir.domains import Domain
from codegen.ir.nodes import Function
from codegen.library import Library
from codegen.passes.analysis.operations import operations_by_cost


def signature(f: Function) -> str:
    """`name(a: vec3, b: vec3) -> f32`."""
    parameters = ", ".join(f"{p.name}: {p.type.name}" for p in f.parameters)
    return f"{f.name}({parameters}) -> {f.returns.name}"


def domain_text(domain: Domain | None) -> str:
    """The domain in words; empty for none."""
    return domain.describe() if domain is not None else ""


def describe(library: Library, f: Function) -> list[str]:
    """Lines for `vair show`."""
    note = {
        "variant": f"variant of {f.base}",
        "printed": f"as the lecture prints {f.base}",
        "helper": "helper",
    }
    kind = f" ({note[f.kind]})" if f.kind in note else ""
    lines = [signature(f), f"  {f.module}{kind}; {f.place.path}:{f.place.line}", "", f"  {f.doc.summary}", ""]
    width = max((len(key) for key in [*f.doc.entries, "guaranteed"]), default=5)
    for p in f.parameters:
        lines.append(f"  {p.name.ljust(width)}  {described(f.doc.entries.get(p.name, ''), p.domain)}")
    names = {p.name for p in f.parameters}
    for key, text in f.doc.entries.items():
        if key not in names:
            lines.append(f"  {key.ljust(width)}  {text}")
    for bound in library.bounds_of(f.name):
        lines.append(f"  {'error'.ljust(width)}  {bound.describe()} [{bound.origin}]")
    for table, found in _guaranteed(library, f).items():
        text = phrase(table, found, library.bounds_of(f.name))
        lines.append(f"  {'guaranteed'.ljust(width)}  {text}")
    form = half_forms(library).get(f.name)
    if form is not None:
        lines.append(f"  {'half'.ljust(width)}  {half_text(form)}")
    variants = [v.name for v in library.variants(f.name)]
    if variants:
        lines.append(f"  {'variants'.ljust(width)}  {', '.join(variants)}")
    return lines


def half_text(form: HalfForm) -> str:
    """What is known of a function's half form, as one phrase."""
    if form.refused:
        return f"none: {form.refused}" + (f"; use {form.instead}" if form.instead else "")
    return "; ".join(f"{b.describe()} [{b.origin}]" for b in form.bounds)


def _guaranteed(library: Library, f: Function) -> Mapping[str, Guarantee]:
    """Table -> guarantee; its errors go with the declared ones in turn. Empty for what was not surveyed."""
    found = guarantees(library).get(f.name)
    return {} if found is None else found.tables


def as_data(library: Library, f: Function) -> dict[str, Any]:
    """The same as plain data, for `vair list --json`."""
    return {
        "name": f.name,
        "section": f.module,
        "kind": f.kind,
        "base": f.base,
        "signature": signature(f),
        "parameters": [
            {"name": p.name, "type": p.type.name, "domain": domain_text(p.domain) or None}
            for p in f.parameters
        ],
        "returns": f.returns.name,
        "summary": f.doc.summary,
        "variants": [v.name for v in library.variants(f.name)],
        "source": {"file": f.place.path, "line": f.place.line},
        "error": [
            {
                "measure": b.measure,
                "bound": b.bound,
                "floor": b.floor,
                "field": b.field or None,
                "targets": list(b.targets) or None,
                "where": {k: list(v) for k, v in b.where.items()},
                "domain": b.domain,
                "origin": b.origin,
            }
            for b in library.bounds_of(f.name)
        ],
        "guaranteed": {t: found.as_data() for t, found in _guaranteed(library, f).items()},
        "half": forms[f.name].as_data() if f.name in (forms := half_forms(library)) else None,
        "operations": operations_by_cost(f, library),
        "cost": costs(library, f),
    }
