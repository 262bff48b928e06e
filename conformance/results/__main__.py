"""`python -m conformance.results`: write README.md, the parity matrix, from the recorded JSON files.

`python -m conformance.results --stale` lists what was recorded of other sources than the present ones.
"""

from __future__ import annotations

import sys

from codegen.files import write_text
from codegen.library import load_library
from conformance.drivers.matrix import page
from conformance.drivers.record import FOLDER, read_all, stale


def main() -> None:
    """Write the page if it differs and print its name if it did; or list what is stale."""
    recorded = read_all()
    if sys.argv[1:] == ["--stale"]:
        for stem, mode, functions in stale(load_library(), recorded):
            print(f"{stem} ({mode}): {', '.join(functions)}")
        return
    path = FOLDER / "README.md"
    text = page(recorded)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        write_text(path, text)
        print("regenerated conformance/results/README.md")


if __name__ == "__main__":
    main()
