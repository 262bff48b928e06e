"""Trees of dicts, lists and scalars as TOML and JSON."""

from __future__ import annotations

import json
import re
from typing import Any

_BARE = re.compile(r"[A-Za-z0-9_-]+")
_PLAIN = re.compile(r"[ !#-\[\]-~]*")
"""Text that is written between quotation marks as it is."""


def as_json(tree: Any) -> bytes:
    """JSON as Python writes it, NaN and Infinity included."""
    return json.dumps(tree).encode()


def as_toml(tree: Any) -> bytes:
    """Top-level tables with a header each, everything below in line; null, which TOML has not, as "null"."""
    if not isinstance(tree, dict):
        return f"value = {_inline(tree)}\n".encode()
    plain = [f"{_key(k)} = {_inline(v)}" for k, v in tree.items() if not isinstance(v, dict)]
    tables = [
        "\n".join([f"[{_key(name)}]", *(f"{_key(k)} = {_inline(v)}" for k, v in table.items())])
        for name, table in tree.items()
        if isinstance(table, dict)
    ]
    return ("\n".join([*plain, *tables]) + "\n").encode()


def _key(name: str) -> str:
    return name if _BARE.fullmatch(name) else _text(name)


def _text(text: str) -> str:
    if _PLAIN.fullmatch(text):
        return f'"{text}"'
    # A lone surrogate has no UTF-8; beyond the 16 bits of JSON's \\u TOML wants eight digits.
    clean = text.encode("utf-8", "replace").decode()
    escaped = "".join(c if " " <= c < "\x7f" and c not in '"\\' else f"\\U{ord(c):08x}" for c in clean)
    return f'"{escaped}"'


def _inline(value: Any) -> str:
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(k)} = {_inline(v)}" for k, v in value.items()) + "}"
    return '"null"'
