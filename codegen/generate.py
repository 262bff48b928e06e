"""Regenerates every generated file of the repository: `python -m codegen.generate`.

Prints the files that changed. CI runs it and fails if anything did.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from codegen.backends import TARGETS, dialects_of
from codegen.emit.dialect import Dialect, file_name
from codegen.emit.module import emit
from codegen.errors import UserError
from codegen.estimators import estimator_sources
from codegen.files import write_text
from codegen.guarantee_page import page
from codegen.library import default_root, load_library
from codegen.ops.stub import generate as lang_stub
from codegen.readme import with_generated_parts


def include_name(d: Dialect) -> str:
    """The file name of a dialect's include."""
    return file_name(d, "vair")


def generated_files() -> Iterator[tuple[Path, str]]:
    """Every generated file with the text it should have; what the sources themselves need comes first."""
    root = default_root().parent
    yield root / "shaderlib" / "lang.py", lang_stub()
    for path, text in estimator_sources():
        yield root / "shaderlib" / path, text
    library = load_library()
    for target in TARGETS:
        for d in dialects_of(target).values():
            yield root / "targets" / target / "include" / include_name(d), emit(library, d)
    yield root / "shaderlib" / "GUARANTEES.md", page(library)
    readme = root / "README.md"
    yield readme, with_generated_parts(readme.read_text(encoding="utf-8"), library)


def main() -> None:
    """Write what differs."""
    root = default_root().parent
    try:
        for path, text in generated_files():
            if not path.exists() or path.read_text(encoding="utf-8") != text:
                path.parent.mkdir(parents=True, exist_ok=True)
                write_text(path, text)
                print(f"regenerated {path.relative_to(root)}")
    except UserError as e:
        sys.exit(f"generate: {e}")


if __name__ == "__main__":
    main()
