"""shaderlib/half.json: what the survey found of every function; writing and comparing."""

from __future__ import annotations

import hashlib
import json
import math
from pathlib import Path
from typing import Any

from codegen.backends import dialect
from codegen.emit.dialect import with_half
from codegen.emit.stmt import StmtPrinter
from codegen.errors import UserError
from codegen.half import MEASURED, declared
from codegen.ir.domains import Unit, number
from codegen.library import Library
from codegen.passes.half import half_versions
from conformance.half.survey import CONFIRM_COUNT, Found, rules_with, survey

ORIGIN = (
    f"float16 emulation, denormals kept and flushed; hard cases and {CONFIRM_COUNT} random points or more"
)


def path(library: Library) -> Path:
    return library.root / MEASURED


def read(library: Library) -> dict[str, Any]:
    """The rows on file; none where there is no file."""
    file = path(library)
    rows: dict[str, Any] = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
    return rows


def program(library: Library, name: str) -> str:
    """A hash of the half forms that the survey looks at: it changes with arithmetic, not with comments."""
    function = library.function(name)
    printer = StmtPrinter(with_half(dialect("wgsl")))
    units = tuple(p.name for p in function.parameters if isinstance(p.domain, Unit))
    texts = [f"{p.name} {p.type.name} {p.domain}" for p in function.parameters]
    try:
        for single in ((), units):
            versions = half_versions(library, [name], rules_with(library, name, single))
            texts += [line for v in versions for line in printer.function(v.function)]
    except UserError as e:
        texts.append(str(e))
    texts.append(declared(library).get("refused", {}).get(name, ""))
    return hashlib.sha256("\n".join(texts).encode()).hexdigest()[:12]


def stale(library: Library, rows: dict[str, Any]) -> list[str]:
    """The public functions whose row is missing or of another program."""
    return [name for name in library.public if rows.get(name, {}).get("program") != program(library, name)]


def measured(library: Library, names: list[str], kept: dict[str, Any]) -> dict[str, Any]:
    """The rows of all public functions: of these names measured, of the others as they are."""
    refused = declared(library).get("refused", {})
    found = {
        name: Found((), {}, "", 0.0, 0.0, 0, refused[name]) if name in refused else survey(library, name)
        for name in names
    }
    rows = {name: row(found[name]) if name in found else dict(kept[name]) for name in library.public}
    for name in names:
        rows[name]["program"] = program(library, name)
    for name in rows:
        if "refused" in rows[name]:
            rows[name]["instead"] = nearest_usable(library, name, rows)
    return rows


def row(f: Found) -> dict[str, Any]:
    """One finding as data."""
    if f.refused:
        return {"refused": f.refused, "instead": ""}
    error: dict[str, Any] = {"measure": f.measure, "bound": rounded_up(f.error)}
    if f.floor:
        error["floor"] = f.floor
    return {
        "single": list(f.single),
        "where": {key: list(value) for key, value in f.where.items()},
        "errors": [error],
        "domain": words(f),
        "origin": ORIGIN,
    }


def nearest_usable(library: Library, name: str, rows: dict[str, Any]) -> str:
    """What half.toml names; the base, or else the variant that errs least; "" if none is of use."""
    named = declared(library).get("instead", {}).get(name)
    if named is not None:
        return str(named)
    function = library.function(name)
    base = function.base or name
    family = [base, *(v.name for v in library.variants(base) if v.kind == "variant")]
    usable = [n for n in family if n in rows and "refused" not in rows[n]]
    if base in usable:
        return base
    return min(usable, key=lambda n: float(rows[n]["errors"][0]["bound"]), default="")


def words(f: Found) -> str:
    """The range as a phrase for the emitted comment."""
    parts = []
    for feature, (low, high) in f.where.items():
        if feature.startswith("angle"):
            parts.append(f"{feature} from {number(low)} rad")
        elif feature.startswith("dot(n") or (feature.endswith(".z") and high > 1.0 and high < 1.1):
            parts.append(f"{feature} from {number(low)}")
        else:
            parts.append(f"{feature} in [{number(low)}, {number(high)}]")
    if f.single:
        parts.append(f"{', '.join(f.single)} in f32")
    return "inputs that are halves" + "".join(f"; {part}" for part in parts)


def rounded_up(x: float) -> float:
    """Two significant digits, not below x."""
    if x == 0.0:
        return x
    step = 10.0 ** (math.floor(math.log10(x)) - 1)
    return float(f"{math.ceil(x / step - 1e-9) * step:.2g}")


def text(rows: dict[str, Any]) -> str:
    """The file: one function a line."""
    lines = [f"  {json.dumps(name)}: {json.dumps(row)}" for name, row in rows.items()]
    return "{\n" + ",\n".join(lines) + "\n}\n"
