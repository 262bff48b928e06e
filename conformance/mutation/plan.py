"""The plan of plan.toml, the planted faults of planted.toml and the equivalent mutants of
equivalent.toml and equivalent_shaders.toml."""

from __future__ import annotations

import ast
import re
import tomllib
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Any

from conformance.mutation import python_rules, shader_rules, table_rules
from conformance.mutation.isolated import Change
from conformance.mutation.sites import Mutant, mutants, mutated

FOLDER = Path(__file__).parent
ROOT = FOLDER.parents[1]
PLANTED = -1
"""Index of mutants that are planted by hand."""
SHADER_SOURCES = "shaderlib"


def read(name: str) -> dict[str, Any]:
    """A TOML file of this folder."""
    return tomllib.loads((FOLDER / name).read_text(encoding="utf-8"))


@dataclass(frozen=True)
class Subject:
    """A file with the tests that must notice a fault of it (none: `vair check`)."""

    path: str
    tests: tuple[str, ...]

    @cached_property
    def text(self) -> str:
        """What the file holds; read once, so that all mutants are of one version."""
        return (ROOT / self.path).read_text(encoding="utf-8")

    @property
    def is_module(self) -> bool:
        """Whether this is Python, and no table."""
        return self.path.endswith(".py")


@dataclass(frozen=True)
class Group:
    """What is mutated together: see plan.toml."""

    name: str
    what: str
    share: float
    sample: int
    sampled_share: float
    limit: float
    subjects: tuple[Subject, ...]
    first: tuple[int, int, int]
    second: tuple[int, int, int]
    without: tuple[str, ...] = ()
    warm: tuple[str, ...] = ()


def _group(name: str, data: dict[str, Any]) -> Group:
    subjects = [
        Subject(path, tuple(entry["tests"]))
        for entry in data.get("files", ())
        for pattern in entry["paths"]
        for path in sorted(p.relative_to(ROOT).as_posix() for p in ROOT.glob(pattern))
        if not path.endswith("__init__.py")
    ]
    if name == "library":
        found = sorted((ROOT / SHADER_SOURCES).glob("*/*.py"))
        subjects += [Subject(p.relative_to(ROOT).as_posix(), ()) for p in found if p.name != "__init__.py"]
    return Group(
        name,
        data["what"],
        float(data["share"]),
        int(data["sample"]),
        float(data["sampled_share"]),
        float(data.get("limit", 60)),
        tuple(subjects),
        tuple(data.get("first", (0, 0, 0))),
        tuple(data.get("second", (0, 0, 0))),
        tuple(data.get("without", ())),
        tuple(data.get("warm", ())),
    )


@cache
def groups() -> dict[str, Group]:
    """All groups by name."""
    return {name: _group(name, data) for name, data in read("plan.toml").items()}


def planted(group: str, path: str) -> list[Mutant]:
    """The faults planted in a file by hand."""
    return [
        Mutant(path, "", "planted", entry["fault"], entry["new"] or "nothing", PLANTED, 0)
        for entry in read("planted.toml").get(group, ())
        if entry["path"] == path
    ]


def _planted_tree(group: str, mutant: Mutant, text: str) -> ast.Module:
    for entry in read("planted.toml")[group]:
        if entry["path"] == mutant.path and entry["fault"] == mutant.before:
            if text.count(entry["old"]) != 1:
                raise ValueError(f"{mutant.path}: planted fault does not fit any more: {mutant.before}")
            return ast.parse(text.replace(entry["old"], entry["new"]))
    raise ValueError(f"no planted fault: {mutant}")


def _rule(group: str) -> Any:
    return shader_rules.rule if group == "library" else python_rules.rule


def mutants_of(group: Group, subject: Subject) -> list[Mutant]:
    """Every mutant of a file of a group."""
    if not subject.is_module:
        return table_rules.mutants(subject.path, subject.text)
    return [*planted(group.name, subject.path), *mutants(subject.path, subject.text, _rule(group.name))]


def tree_of(group: Group, subject: Subject, mutant: Mutant) -> ast.Module:
    """The module as the mutant has it."""
    if mutant.index == PLANTED:
        return _planted_tree(group.name, mutant, subject.text)
    return mutated(subject.text, _rule(group.name), mutant.index)


def change_of(group: Group, subject: Subject, mutant: Mutant) -> Change:
    """What a trial of the mutant puts in the file's place."""
    if not subject.is_module:
        return Change(subject.path, text=table_rules.mutated(subject.text, mutant.index))
    return Change(subject.path, tree_of(group, subject, mutant))


@dataclass(frozen=True)
class Excuse:
    """Why mutants cannot be killed: one that is named, or all whose description matches."""

    reason: str
    key: tuple[str, str, str, str] | None
    pattern: re.Pattern[str] | None

    def covers(self, mutant: Mutant) -> bool:
        """Whether the mutant is one of these."""
        if self.key is not None:
            return mutant.key == self.key
        assert self.pattern is not None
        text = f"{mutant.path} {mutant.place}: {mutant.operator}: {mutant.before} -> {mutant.after}"
        return self.pattern.fullmatch(text) is not None


@cache
def excuses() -> tuple[Excuse, ...]:
    """The entries of equivalent.toml and equivalent_shaders.toml."""
    files = [read(name) for name in ("equivalent.toml", "equivalent_shaders.toml")]
    named = [
        Excuse(e["reason"], (e["path"], e["place"], e["before"], e["after"]), None)
        for data in files
        for e in data.get("mutant", ())
    ]
    matching = [
        Excuse(e["reason"], None, re.compile(e["matches"])) for data in files for e in data.get("pattern", ())
    ]
    return (*named, *matching)


def excuse(mutant: Mutant) -> str:
    """Why the mutant is equivalent; empty where it is not."""
    return next((e.reason for e in excuses() if e.covers(mutant)), "")
