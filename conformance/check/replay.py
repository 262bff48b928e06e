"""Cases to run again: an identity, which draws the input anew, or a file of records.

A file may be a result of `vair check --json`, of which every failure is run, one record, or a list of them.
Records hold the words of the inputs, so they outlive changes of the families that inputs are drawn from.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codegen.documents import read_json
from codegen.errors import UserError
from codegen.ir.nodes import Function
from codegen.library import Library
from conformance.cases import found
from conformance.check.draws import Draw, draw, length, only_lane
from conformance.check.identity import Identity

RECORDED = "recorded"
"""Family of an input that a record brings itself."""


@dataclass(frozen=True)
class Case:
    """One input of one function on one target (or driver with its mode).

    draw      gives the input
    identity  names it, and draws it on a driver
    words     the input itself, where a record brings it
    remarks   what to say before it is run
    """

    function: str
    target: str
    draw: Callable[[], Draw]
    identity: Identity
    words: str = ""
    remarks: tuple[str, ...] = ()


def cases_of(library: Library, text: str) -> list[Case]:
    """The cases that an identity or a file names; raises UserError for anything else."""
    path = Path(text)
    if text and path.is_file():
        return [from_record(library, path, record) for record in records(path)]
    identity = Identity.parse(text)
    function = library.function(identity.function)

    return [Case(identity.function, identity.target, lambda: lane_of(function, identity), identity)]


def lane_of(function: Function, identity: Identity, words: str = "") -> Draw:
    """The one input that an identity names, or that the words of a record hold.

    raises  UserError where the family has no such lane any more
    """
    if words:
        return Draw(RECORDED, 1, identity.seed, found.inputs_of(function, [words]))
    whole = draw(function, identity.family, identity.count, identity.seed)
    if identity.lane >= length(whole.inputs):
        raise UserError(
            f'replay identity "{identity}" names lane {identity.lane} of {length(whole.inputs)}; '
            "a file of --json holds the inputs themselves"
        )
    return only_lane(whole, identity.lane)


def records(path: Path) -> list[Mapping[str, Any]]:
    """The records in a file; raises UserError where there are none."""
    data = read_json(path)
    if isinstance(data, dict) and "results" in data:
        try:
            data = [failure for result in data["results"] for failure in result["failures"]]
        except (KeyError, TypeError):
            raise UserError(f"{path} is no result of vair check --json") from None
    listed = data if isinstance(data, list) else [data]
    if not listed or not all(isinstance(record, dict) and "words" in record for record in listed):
        raise UserError(f"{path} holds no failure to replay")
    return listed


def from_record(library: Library, path: Path, record: Mapping[str, Any]) -> Case:
    """A record as a case; raises UserError where it does not fit the function any more."""
    if not all(isinstance(record.get(key), str) for key in ("function", "identity", "words")):
        raise UserError(f"{path}: a record does not fit: function, identity and words are texts")
    try:
        function = library.function(record["function"])
        identity = Identity.parse(record["identity"])
        recorded = lane_of(function, identity, record["words"])
        target = str(record.get("backend") or record["target"])
    except (KeyError, ValueError) as e:
        raise UserError(f"{path}: a record does not fit: {e}") from None
    remarks = [
        f"recorded   {record.get('got', '')} on {record.get('driver', '')}: {record.get('reason', '')}"
    ]
    if record.get("source") != library.select([function.name]).source_hash:
        remarks.append("           the sources have changed since")
    return Case(function.name, target, lambda: recorded, identity, record["words"], tuple(remarks))
