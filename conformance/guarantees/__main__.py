"""Measures the guarantees, writes or checks guarantees.json, and lists what WGSL leaves open."""

from __future__ import annotations

import sys

from codegen.files import write_text
from codegen.library import Library, load_library
from conformance.guarantees.table import PATH, Guarantees, differences, measured, read, text

REPORTED = "wgsl"


def main(arguments: list[str]) -> int:
    """`--check`: compare only; other arguments: names of functions, which are only reported."""
    names = [a for a in arguments if not a.startswith("--")]
    library = load_library()
    found = measured(library, names)
    print("\n".join(report(library, found)))
    if names:
        return 0
    if "--check" in arguments:
        changed = differences(read(), found)
        print("\n".join(changed) or "guarantees.json is up to date")
        return 1 if changed else 0
    write_text(PATH, text(found))
    return 0


def report(library: Library, found: Guarantees) -> list[str]:
    """Share guaranteed per section, then every function that is not guaranteed everywhere, with causes."""
    lines = [f"guaranteed under {REPORTED}: random points, hard cases"]
    sections: dict[str, list[str]] = {}
    for name in found:
        sections.setdefault(library.function(name).module, []).append(name)
    for section, names in sections.items():
        rows = [found[name][REPORTED] for name in names]
        whole = sum(r.everywhere for r in rows)
        uniform, hard = (sum(getattr(r, k) for r in rows) / len(rows) for k in ("uniform", "hard"))
        lines.append(f"  {section:10} {uniform:.4f} {hard:.4f}  everywhere: {whole} of {len(rows)} functions")
    for name, by_table in found.items():
        g = by_table[REPORTED]
        if not g.everywhere:
            lines.append(f"{name}: {g.uniform:.4f} {g.hard:.4f}")
            lines += [f"    {share:8.2g}  {what}" for what, share in g.causes.items()]
    return lines


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
