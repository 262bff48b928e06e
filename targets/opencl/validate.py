"""Validates an OpenCL C library by the device's own compiler, language version by language version.

Text in half precision is compiled by clang, for no device in particular, where the device has no halves.
"""

import tempfile
from pathlib import Path

from targets import open_runtime
from targets.opencl.runtime import HALF_EXTENSION, OpenclRuntime
from targets.packages import find_tool, run_tool
from targets.protocol import BuildFailed, TargetUnavailable

LANGUAGES = {"1.2": (1, 2), "3.0": (3, 0)}

# Some compilers reject a program without a kernel.
CLANGS = ("clang", "clang-19", "clang-18", "clang-17", "clang-16", "clang-15", "clang-14")
MISSING_HALF = "the OpenCL device has no cl_khr_fp16, and clang is not installed: apt-get install clang"
SHELL = "{library}\n__kernel void vair_validation(__global uint *words) {{ words[0] = 0u; }}\n"


def validator_available() -> str | None:
    """None where validation can run, else the reason why it cannot."""
    try:
        open_runtime("opencl")
    except TargetUnavailable as reason:
        return str(reason)
    return None


def validate(text: str, dialect: str = "1.2") -> None:
    """Check a library text; a warning of the compiler counts as an error.

    errors  BuildFailed with the compiler's log; TargetUnavailable without a device for that language version;
            ValueError for an unknown dialect
    """
    if dialect not in LANGUAGES:
        names = ", ".join(LANGUAGES)
        raise ValueError(f"no dialect of OpenCL C is called {dialect!r}; the dialects are {names}")
    runtime = open_runtime("opencl")
    assert isinstance(runtime, OpenclRuntime)
    if HALF_EXTENSION in text and not runtime.half_arithmetic:
        _validate_by_clang(text, dialect)
        return
    newest = runtime.newest_language
    if newest < LANGUAGES[dialect]:
        raise TargetUnavailable(
            f"{runtime.device.device} compiles OpenCL C up to {newest[0]}.{newest[1]}, not {dialect}"
        )
    runtime.build(SHELL.format(library=text), (f"-cl-std=CL{dialect}", "-Werror"))


def _validate_by_clang(text: str, dialect: str) -> None:
    clang = find_tool(*CLANGS)
    if clang is None:
        raise TargetUnavailable(MISSING_HALF)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "library.cl"
        file.write_text(SHELL.format(library=text), encoding="utf-8")
        front = ("-Xclang", "-finclude-default-header", "-fsyntax-only", "-Wno-unused-function")
        status, log = run_tool(
            clang, "-x", "cl", f"-cl-std=CL{dialect}", "-target", "spir64", *front, "-Werror", str(file)
        )
        if status != 0:
            raise BuildFailed(log.replace(str(file), file.name).strip())
