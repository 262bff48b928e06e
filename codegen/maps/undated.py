"""OpenEXR files without the moment of writing: the same pixels are the same bytes, on any day."""

from __future__ import annotations

import re

import numpy.typing as npt

from codegen.maps.image import exr

WRITTEN = b"2000:01:01 00:00:00"
"""What stands in every file; OpenImageIO would put the second in which it writes there."""
_DATE = re.compile(rb"(?<=capDate\0string\0\x13\0\0\0)\d{4}:\d\d:\d\d \d\d:\d\d:\d\d")


def undated_exr(pixels: npt.ArrayLike) -> bytes:
    """(height, width) or (height, width, channels) floats as the bytes of a 32-bit OpenEXR file.

    raises  UserError where the library cannot write it
    """
    return _DATE.sub(WRITTEN, exr(pixels), count=1)
