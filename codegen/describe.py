"""What is known of a function, for people and for programs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

from codegen.costs import costs
from codegen.guarantees import Guarantee, guarantees, phrase
from codegen.half import HalfForm, half_forms
from codegen.ir import nodes as ir
from codegen.ir.domains import Domain
from codegen.ir.nodes import Function
from codegen.library import Library
from codegen.ops import BUILTINS, OPERATORS


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
        text = f.doc.entries.get(p.name, "")
        domain = domain_text(p.domain)
        lines.append(f"  {p.name.ljust(width)}  {'; '.join(filter(None, (text, domain)))}")
    names = {p.name for p in f.parameters}
    for key, text in f.doc.entries.items():
        if key not in names:
            lines.append(f"  {key.ljust(width)}  {text}")
    for bound in library.bounds.get(f.name, ()):
        lines.append(f"  {'error'.ljust(width)}  {bound.describe()} [{bound.origin}]")
    for table, found in _guaranteed(library, f).items():
        text = phrase(table, found, library.bounds.get(f.name, ()))
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


def operations(library: Library, f: Function) -> dict[str, int]:
    """How many scalar operations of each cost class one evaluation writes down, calls included.

    Both sides of conditionals count; loop bodies count once per iteration. Speed is measured, not derived
    from this.
    """
    counts: Counter[str] = Counter()

    def width(e: ir.Expr) -> int:
        sizes = [getattr(t, "size", 1) for t in (e.type, *(c.type for c in ir.children(e)))]
        return max(sizes)

    def expression(root: ir.Expr, times: int) -> None:
        for e in ir.walk(root):
            if isinstance(e, ir.Unary | ir.Binary | ir.Builtin):
                op = BUILTINS[e.op] if isinstance(e, ir.Builtin) else OPERATORS[e.op]
                for cost, n in op.operations(width(e)).items():
                    counts[cost] += times * n
            elif isinstance(e, ir.Call):
                for cost, n in operations(library, library.function(e.function)).items():
                    counts[cost] += times * n

    def block(body: tuple[ir.Stmt, ...], times: int) -> None:
        for s in body:
            match s:
                case ir.If():
                    expression(s.condition, times)
                    block(s.then, times)
                    block(s.orelse, times)
                case ir.For():
                    block(s.body, times * max(s.stop - s.start, 0))
                case _:
                    expression(s.value, times)

    block(f.body, 1)
    counts.pop("free", None)
    return dict(sorted(counts.items()))


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
            for b in library.bounds.get(f.name, ())
        ],
        "guaranteed": {t: found.as_data() for t, found in _guaranteed(library, f).items()},
        "half": forms[f.name].as_data() if f.name in (forms := half_forms(library)) else None,
        "operations": operations(library, f),
        "cost": costs(library, f),
    }
