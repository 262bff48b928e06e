"""`python -m conformance.results`: write README.md, the parity matrix, from the recorded JSON files."""

from __future__ import annotations

from codegen.files import write_text
from conformance.drivers.matrix import page
from conformance.drivers.record import FOLDER, read_all


def main() -> None:
    """Write the page if it differs; print its name if it did."""
    path = FOLDER / "README.md"
    text = page(read_all())
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        write_text(path, text)
        print("regenerated conformance/results/README.md")


if __name__ == "__main__":
    main()
