"""How to call a function on a target: the library's text, a harness to replace, and the call itself."""

from __future__ import annotations

from collections.abc import Sequence

from codegen.backends import complete_program, dialect
from codegen.emit.module import emit
from codegen.kernels import kernel_body
from codegen.library import Library

HARNESS_ENDS = {"glsl": "comp", "wgsl": "wgsl", "opencl": "cl"}


def stub_files(library: Library, target: str, names: Sequence[str]) -> dict[str, bytes]:
    """The files of one target, by path inside the kit.

    library.*   every function with what it needs, as `vair emit` writes it
    harness.*   a whole program around $library and $body, with load_T(k) and store_T(k, value)
    calls/*     the $body of one function: it loads the words of its arguments and stores its result's
    """
    chosen = dialect(target)
    end = chosen.extension
    files = {
        f"{target}/library.{end}": emit(library, chosen, names),
        f"{target}/harness.{HARNESS_ENDS[target]}": complete_program(target, "$library", "$body"),
        **{f"{target}/calls/{name}.{end}": kernel_body(library, name, target) + "\n" for name in names},
    }
    return {path: text.encode() for path, text in files.items()}
