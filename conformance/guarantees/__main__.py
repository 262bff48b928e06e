"""Surveys the guarantees, writes or checks shaderlib/guarantees.json, and lists what WGSL leaves open."""

from __future__ import annotations

import sys

from codegen.files import write_text
from codegen.library import Library, load_library
from conformance.guarantees.table import (
    MADE_WITH,
    PATH,
    Found,
    differences,
    made_with,
    read,
    stale,
    surveyed,
    text,
)

REPORTED = "wgsl"
USAGE = "python -m conformance.guarantees [--all | --check | FUNCTION...]"


def main(arguments: list[str]) -> int:
    """No argument: survey what changed; names of functions: report only."""
    options = [a for a in arguments if a.startswith("--")]
    names = [a for a in arguments if not a.startswith("--")]
    if not set(options) <= {"--all", "--check"} or (options and names):
        print(USAGE, file=sys.stderr)
        return 2
    library = load_library()
    if names:
        print("\n".join(report(library, surveyed(library, names))))
        return 0
    before = read()
    if "--check" in options:
        changed = differences(before, surveyed(library, library.public))
        print("\n".join(changed) or f"{PATH.name} is up to date")
        return 1 if changed else 0
    renewed = surveyed(library, library.public if options else stale(library, before))
    found = {name: renewed.get(name, before.get(name)) for name in library.public}
    whole = {name: entry for name, entry in found.items() if entry is not None}
    print("\n".join(report(library, whole)))
    print(f"surveyed {len(renewed)} functions")
    write_text(PATH, text(whole))
    write_text(MADE_WITH, made_with() + "\n")
    return 0


def report(library: Library, found: Found) -> list[str]:
    """Share guaranteed per section, then every function that is not guaranteed everywhere, with causes."""
    lines = [f"guaranteed under {REPORTED}: random points, hard cases"]
    sections: dict[str, list[str]] = {}
    for name in found:
        sections.setdefault(library.function(name).module, []).append(name)
    for section, names in sections.items():
        rows = [found[name].tables[REPORTED] for name in names]
        whole = sum(r.everywhere for r in rows)
        uniform, hard = (sum(getattr(r, k) for r in rows) / len(rows) for k in ("uniform", "hard"))
        lines.append(f"  {section:10} {uniform:.4f} {hard:.4f}  everywhere: {whole} of {len(rows)} functions")
    for name, entry in found.items():
        for table, g in entry.tables.items():
            if table == REPORTED and not g.everywhere:
                lines.append(f"{name}: {g.uniform:.4f} {g.hard:.4f}")
                lines += [f"    {share:8.2g}  {what}" for what, share in g.causes.items()]
    return lines


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
