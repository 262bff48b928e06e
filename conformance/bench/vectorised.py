"""Whether a kernel works on several work items at once.

Mesa's software drivers and SwiftShader do so by construction. PoCL does so only where LLVM's loop vectoriser
manages the loop over the work items; with POCL_VECTORIZER_REMARKS=1 it says so, or why not, on the standard
output of C when it compiles. Its cache must be empty at first, for a kernel from the cache is not compiled.
"""

from __future__ import annotations

import ctypes
import os
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from targets import Device

REMARKS, CACHE = "POCL_VECTORIZER_REMARKS", "POCL_CACHE_DIR"
"""Variables that make PoCL tell; set before it is loaded."""
STANDARD_OUTPUT = 1

_WIDTH = re.compile(r"vectorized loop \(vectorization width: (\d+)")
_REASON = re.compile(r"loop not vectorized: ([^<\n]+)")
_BITS = re.compile(r"(\d+) bits")
FLOAT_BITS = 32


@dataclass(frozen=True)
class Vectorised:
    """What is known of one kernel.

    lanes  work items computed together; 1: one at a time; None: not known
    how    where this is known from, or why it is not so
    """

    lanes: int | None
    how: str


def by_construction(device: Device) -> Vectorised:
    """What a driver does with every kernel."""
    name = f"{device.driver} {device.device}".lower()
    if "llvmpipe" in name:
        bits = _BITS.search(device.device)
        lanes = int(bits.group(1)) // FLOAT_BITS if bits else None
        return Vectorised(lanes, "by construction: the driver's vectors, as its name says")
    if "swiftshader" in name:
        return Vectorised(4, "by construction: the driver's SIMD width")
    if "softpipe" in name:
        return Vectorised(4, "by construction: an interpreter of quads")
    return Vectorised(None, "the driver was not asked")


def tells(device: Device, environment: Mapping[str, str] = os.environ) -> bool:
    """Whether the driver says of each kernel whether it was vectorised."""
    pocl = "portable computing" in device.driver.lower()
    return pocl and environment.get(REMARKS) == "1"


def from_remarks(text: str) -> Vectorised:
    """What the compiler's remarks say of the loop over the work items."""
    widths = [int(width) for width in _WIDTH.findall(text)]
    if widths:
        return Vectorised(max(widths), "remark of the compiler: vectorised across work items")
    reasons = dict.fromkeys(reason.strip() for reason in _REASON.findall(text))
    if reasons:
        return Vectorised(1, f"remark of the compiler: not vectorised, {'; '.join(reasons)}")
    return Vectorised(None, "the compiler said nothing")


def remarks(compile_: Callable[[], None]) -> str:
    """What a compilation writes to C's standard output, which must be a file."""
    begin = _written()
    compile_()
    return os.pread(STANDARD_OUTPUT, _written() - begin, begin).decode(errors="replace")


def _written() -> int:
    """Bytes of the file behind standard output, all that C holds back included."""
    ctypes.CDLL(None).fflush(None)
    return os.fstat(STANDARD_OUTPUT).st_size
