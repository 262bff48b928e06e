"""Typed access to the tables of a TOML file; whatever is wrong is said in one sentence with file and key."""

from __future__ import annotations

import sys
from collections.abc import Collection, Iterable, Sequence
from pathlib import Path
from typing import Any

from codegen.documents import read_toml
from codegen.errors import UserError, nearest


def read_tables(path: Path, valid: Iterable[str]) -> dict[str, Table]:
    """The top-level tables of a file, by name; one that is absent is empty. `valid` are all the names."""
    content = read_toml(path)
    names = list(valid)
    for name, value in content.items():
        if name not in names:
            raise UserError(f'{path}: unknown table or key "{name}"{nearest(name, names)}')
        if not isinstance(value, dict):
            raise UserError(f"{path}: {name} must be a table, written [{name}]")
    return {name: Table(path, name, content.get(name, {})) for name in names}


class Table:
    """One table; every key that is asked for counts as known, `close` refuses the others."""

    def __init__(self, path: Path, name: str, content: dict[str, Any]) -> None:
        self.path = path
        self.name = name
        self.content = content
        self._known: list[str] = []

    def __contains__(self, key: str) -> bool:
        return key in self.content

    def error(self, key: str, sentence: str) -> UserError:
        """The error for a key of this table."""
        return UserError(f"{self.path}: [{self.name}] {key}: {sentence}")

    def value(self, key: str, default: Any = None) -> Any:
        """The raw value; without a default the key has to be there."""
        self._known.append(key)
        if key in self.content:
            return self.content[key]
        if default is None:
            near = [name for name in self.content if name not in self._known]
            hint = nearest(key, near) if near else ""
            raise self.error(key, "is missing" + (hint if "did you mean" in hint else ""))
        return default

    def close(self) -> None:
        """Refuse keys that nobody asked for."""
        for key in self.content:
            if key not in self._known:
                raise UserError(
                    f'{self.path}: [{self.name}] has an unknown key "{key}"{nearest(key, self._known)}'
                )

    def text(self, key: str, default: str | None = None) -> str:
        """A string that is not empty."""
        value = self.value(key, default)
        if not isinstance(value, str) or not value:
            raise self.error(key, f"must be a text, not {show(value)}")
        return value

    def flag(self, key: str, default: bool) -> bool:
        """true or false."""
        value = self.value(key, default)
        if not isinstance(value, bool):
            raise self.error(key, f"must be true or false, not {show(value)}")
        return value

    def integer(self, key: str, low: int, high: int, default: int | None = None) -> int:
        """A whole number in [low, high]."""
        value = self.value(key, default)
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise self.error(key, f"must be a whole number from {low} to {high}, not {show(value)}")
        return value

    def number(self, key: str, low: float, high: float, default: float | None = None) -> float:
        """A number in [low, high]."""
        value = self.value(key, default)
        if not is_number(value) or not low <= value <= high:
            raise self.error(key, f"must be a number from {low:g} to {high:g}, not {show(value)}")
        return float(value)

    def number_or_name(
        self, key: str, names: Collection[str], low: float, high: float, default: str | None = None
    ) -> float | str:
        """A number in [low, high], or one of some names for numbers."""
        value = self.value(key, default)
        if not isinstance(value, str):
            return self.number(key, low, high)
        if value not in names:
            raise self.error(key, f'unknown {key} "{value}"{nearest(value, names)}, or a number')
        return value

    def choices(self, key: str, noun: str, valid: Sequence[str]) -> tuple[str, ...]:
        """Some of the valid names, each once; all where the key is absent. `noun` is what one is called."""
        value = self.value(key, tuple(valid))
        if not isinstance(value, list | tuple) or not value or not all(isinstance(x, str) for x in value):
            example = ", ".join(f'"{name}"' for name in valid[:2])
            raise self.error(key, f"must be an array of {noun}s, as [{example}], not {show(value)}")
        for name in value:
            if name not in valid:
                raise self.error(key, f'unknown {noun} "{name}"{nearest(name, valid)}')
        return tuple(dict.fromkeys(value))

    def triple(self, key: str, default: Sequence[float] | None = None) -> tuple[float, float, float]:
        """Three numbers."""
        value = self.value(key, default)
        if not isinstance(value, list | tuple) or len(value) != 3 or not all(map(is_number, value)):
            raise self.error(key, f"must be three numbers, [x, y, z], not {show(value)}")
        x, y, z = value
        return float(x), float(y), float(z)

    def direction(self, key: str, default: Sequence[float] | None = None) -> tuple[float, float, float]:
        """Three numbers, not all zero."""
        value = self.triple(key, default)
        if not any(value):
            raise self.error(key, "must be a direction, which [0, 0, 0] is not")
        return value

    def table(self, key: str) -> Table:
        """A table inside this one; empty where it is absent."""
        value = self.value(key, {})
        if not isinstance(value, dict):
            raise self.error(key, f"must be a table, written [{self.name}.{key}]")
        return Table(self.path, f"{self.name}.{key}", value)

    def tables(self, key: str) -> list[Table]:
        """The tables of an array inside this one."""
        value = self.value(key, [])
        if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
            raise self.error(key, f"must be an array of tables, each written [[{self.name}.{key}]]")
        return [Table(self.path, f"{self.name}.{key}", item) for item in value]


def is_number(value: object) -> bool:
    """Whether a TOML value is a number that a float holds."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= sys.float_info.max


def show(value: object) -> str:
    """A value as it may have been written, shortened."""
    if isinstance(value, bool):
        return "true" if value else "false"
    text = f'"{value}"' if isinstance(value, str) else str(value)
    return text if len(text) <= 40 else f"{text[:37]}..."
