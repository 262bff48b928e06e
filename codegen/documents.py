"""Reading files that people hand over: TOML and JSON, whatever is in them, or one sentence why not."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from codegen.errors import UserError

LARGEST = 64 * 2**20
"""Bytes beyond which a file is no description that a person or a program here has written."""


def read_text(path: Path) -> str:
    """A text file in UTF-8; raises UserError where there is none."""
    try:
        if not path.exists():
            raise UserError(f"{path}: there is no such file")
        if not path.is_file():
            raise UserError(f"{path}: cannot be read (it is no file)")
        if path.stat().st_size > LARGEST:
            raise UserError(f"{path}: is larger than {LARGEST >> 20} MiB")
        return path.read_text(encoding="utf-8")
    except (OSError, ValueError) as e:
        if isinstance(e, UnicodeDecodeError):
            raise UserError(f"{path}: is not a text file in UTF-8") from None
        reason = getattr(e, "strerror", None) or e
        raise UserError(f"{path}: cannot be read ({reason})") from None


def read_toml(path: Path) -> dict[str, Any]:
    """The content of a TOML file; raises UserError where it has none."""
    found: dict[str, Any] = _parsed(path, "TOML", tomllib.loads)
    return found


def read_json(path: Path) -> Any:
    """The value in a JSON file; raises UserError where it has none."""
    return _parsed(path, "JSON", json.loads)


def _parsed(path: Path, language: str, loads: Callable[[str], Any]) -> Any:
    text = read_text(path)
    try:
        return loads(text)
    except ValueError as e:  # beside errors of syntax: whole numbers of thousands of digits
        sentence = " ".join(str(e).split())
        raise UserError(f"{path}: is not valid {language}: {sentence}") from None
    except RecursionError:
        raise UserError(f"{path}: is nested too deeply") from None
