"""Validates an OpenCL C library by the device's own compiler, language version by language version."""

from targets import open_runtime
from targets.opencl.runtime import OpenclRuntime
from targets.protocol import TargetUnavailable

LANGUAGES = {"1.2": (1, 2), "3.0": (3, 0)}

# Some compilers reject a program without a kernel.
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
    newest = runtime.newest_language
    if newest < LANGUAGES[dialect]:
        raise TargetUnavailable(
            f"{runtime.device.device} compiles OpenCL C up to {newest[0]}.{newest[1]}, not {dialect}"
        )
    runtime.build(SHELL.format(library=text), (f"-cl-std=CL{dialect}", "-Werror"))
