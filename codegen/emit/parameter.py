"""What a comment or a listing says of a parameter: its documentation and its domain, none of it twice."""

from __future__ import annotations

import re
import struct

from codegen.ir.domains import Domain, Interval, Length

_NUMBER = r"(-?\d[\d.]*(?:e-?\d+)?)"
_INTERVAL = re.compile(rf"\[{_NUMBER}, {_NUMBER}([\])])|\b{_NUMBER} to {_NUMBER}(?!\w)")
"""[0, 1e5], [0, 1), 0 to 1."""


def described(text: str, domain: Domain | None) -> str:
    """The documentation of a parameter and, where it does not state it, the domain."""
    if domain is None or _states(text, domain):
        return text
    return f"{text}; {domain.describe()}" if text else domain.describe()


def _states(text: str, domain: Domain) -> bool:
    if domain.describe() in text:
        return True
    if not isinstance(domain, Interval | Length):
        return False
    ends = _single(domain.low), _single(domain.high)
    return any(_ends(*found) == ends for found in _INTERVAL.findall(text))


def _ends(low: str, high: str, closing: str, first: str, last: str) -> tuple[float, float]:
    """The float32 ends of an interval as written; below an open one lies the next number."""
    ends = _single(float(low or first)), _single(float(high or last))
    return (ends[0], _below(ends[1])) if closing == ")" else ends


def _single(x: float) -> float:
    """The nearest float32; beyond all of them the number itself."""
    try:
        rounded: float = struct.unpack("f", struct.pack("f", x))[0]
    except OverflowError:
        return x
    return rounded


def _below(x: float) -> float:
    """The float32 number below a positive one; others stay."""
    if x <= 0.0:
        return x
    word: int = struct.unpack("I", struct.pack("f", x))[0]
    below: float = struct.unpack("f", struct.pack("I", word - 1))[0]
    return below
