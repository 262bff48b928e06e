"""Results of several runs joined into one: the shards of one check, or the same check on several machines."""

from __future__ import annotations

import dataclasses
import typing
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from codegen.documents import read_json
from codegen.errors import UserError
from conformance.check.result import FunctionResult
from conformance.check.shard import Shard

PLAIN: dict[Any, Any] = {str: str, int: int, float: (int, float), bool: bool}
"""Type of a field -> what JSON holds there."""


@dataclass(frozen=True)
class Merged:
    """All results, the targets that were skipped, and what is missing for a verdict."""

    results: list[FunctionResult]
    skipped: list[str]
    missing: list[str]

    @property
    def passed(self) -> bool:
        return not self.missing and all(r.accepted for r in self.results)


def merge(paths: Iterable[Path]) -> Merged:
    """The results in these files, each function once per target and driver; a failed one stays.

    errors  UserError for a file that cannot be read, is no result of a check, or has other sources
    """
    files = {path: read(path) for path in paths}
    sources = {data.get("source", "") for data in files.values()}
    if len(sources) > 1:
        raise UserError(f"{', '.join(map(str, files))}: the results are of different sources; check again")
    found: dict[tuple[str, str, str], FunctionResult] = {}
    shards: set[Shard] = set()
    skipped: dict[str, None] = {}
    for path, data in files.items():
        shards.add(Shard.parse(data.get("shard") or "1/1"))
        skipped.update(dict.fromkeys(data.get("skipped", ())))
        for entry in data["results"]:
            try:
                result = FunctionResult.from_data(entry)
                check_types(result)
            except (ArithmeticError, AttributeError, KeyError, TypeError, ValueError) as e:
                raise UserError(f"{path}: a result lacks or misspells {e}") from None
            key = (result.function, result.backend, result.driver)
            if key not in found or found[key].accepted:
                found[key] = result
    return Merged(list(found.values()), list(skipped), lacking(shards))


def check_types(value: Any) -> None:
    """Raise TypeError where a field of a dataclass, or of those in it, holds no text or number as it says."""
    kind: Any = type(value)
    hints = _hints(kind)
    for field in dataclasses.fields(value):
        held, hint = getattr(value, field.name), hints[field.name]
        plain = PLAIN.get(hint)
        if plain is not None and not (isinstance(held, plain) and isinstance(held, bool) == (hint is bool)):
            raise TypeError(f"{field.name}: {held!r} is no {hint.__name__}")
        for part in held if isinstance(held, list | tuple) else [held]:
            if dataclasses.is_dataclass(part):
                check_types(part)


@cache
def _hints(kind: Any) -> dict[str, Any]:
    return typing.get_type_hints(kind)


def lacking(shards: set[Shard]) -> list[str]:
    """The shards that nobody brought: all of one division have to be there."""
    divisions = {shard.of for shard in shards}
    return [
        str(Shard(k, of)) for of in sorted(divisions) for k in range(1, of + 1) if Shard(k, of) not in shards
    ]


def _is_result(data: Any) -> bool:
    """Whether a value has what every result of a check has, as far as its own entries are not read."""
    if not isinstance(data, dict) or not isinstance(data.get("results"), list):
        return False
    texts = [data.get("source", ""), data.get("shard") or "", *_listed(data.get("skipped", []))]
    return all(isinstance(text, str) for text in texts)


def _listed(value: Any) -> list[Any]:
    return value if isinstance(value, list) else [None]


def read(path: Path) -> dict[str, Any]:
    """The data of a result file; raises UserError for anything else."""
    data: dict[str, Any] = read_json(path)
    if not _is_result(data):
        raise UserError(f"{path} is no result of vair check --json")
    return data
