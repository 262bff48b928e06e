"""Renews shaderlib/half.json: `python -m conformance.half [--all] [FUNCTION]...`.

Measures the named functions; none named: those whose half form has changed; `--all`: all of them. Where the
machine has a device that computes in half precision, these half forms also run there.
"""

from __future__ import annotations

import sys

from codegen.errors import unknown
from codegen.files import write_text
from codegen.half import form_of
from codegen.library import Library, load_library
from conformance.half.executed import devices, record
from conformance.half.table import measured, path, read, stale, text


def main(arguments: list[str]) -> int:
    """The command line; prints what was measured and what became of it."""
    names = [a for a in arguments if not a.startswith("--")]
    library = load_library()
    for name in names:
        if name not in library.public:
            raise SystemExit(str(unknown("function", name, library.public)))
    kept = read(library)
    todo = list(library.public) if "--all" in arguments else names or stale(library, kept)
    todo += [name for name in library.public if name not in kept and name not in todo]
    rows = measured(library, todo, kept)
    # First without what devices say: they run what the file declares.
    write_text(path(library), text(rows))
    library = Library(library.root)
    runtimes = devices()
    for name, row in rows.items():
        if "refused" not in row and runtimes and (name in todo or "executed" not in row):
            row["executed"] = [record(library, form_of(name, row), runtime) for runtime in runtimes]
    write_text(path(library), text(rows))
    for name in todo:
        print(f"{name}: {rows[name].get('refused') or rows[name]['domain']}")
    refused = sum("refused" in row for row in rows.values())
    print(f"{len(todo)} measured; {len(rows) - refused} functions have a half form, {refused} have none")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
