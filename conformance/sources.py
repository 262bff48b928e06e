"""Hashes of sources: whether what was recorded was made with the files that are here now."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from pathlib import Path

PROJECT = Path(__file__).parents[1]
CODE = (".py", ".toml")


def hash_of(folders: Iterable[str], suffixes: tuple[str, ...] = CODE, more: str = "") -> str:
    """16 hex digits of a text and of all files below some folders of the project that end in a suffix."""
    digest = hashlib.sha256(more.encode())
    for folder in folders:
        for path in sorted(p for p in (PROJECT / folder).rglob("*") if p.suffix in suffixes):
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
