"""The rules of the house that a reader of one file would not notice broken.

Plan. Every file that git tracks (or would track) is read once:
  size        Python files stay within 400 lines; shaderlib/lang.py is generated and exempt
  leftovers   no unfinished-work marks, no path of one machine, no package registry named
  text        shaderlib is ASCII, because it is emitted into shader comments
  scripts     dev and .ci/run can be executed
  licence     LICENSE is MIT, the package and every emitted file name it
  README      names the two commands
"""

import os
import re
import subprocess
import tomllib
from collections.abc import Iterator
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LONGEST_FILE = 400
GENERATED = {"shaderlib/lang.py"}
# The brackets keep these patterns from finding themselves.
MARKS = re.compile(r"\b(T[O]DO|F[I]XME|X[X]X)\b")
MACHINE_PATHS = re.compile(r"(?<![\w.])/(work|home|root|tmp|Users)/\w")
REGISTRIES = re.compile(
    r"(pypi|pythonhosted|npmjs|crates|golang|maven|debian|anaconda)[.](org|com|io)\b|index[-]url"
)


@cache
def files() -> tuple[str, ...]:
    """Every file of the repository that is or could be committed, relative to its root."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    if listed.returncode == 0:
        names = [name for name in listed.stdout.split("\0") if name]
    else:  # an unpacked archive: no history, but nothing ignored lies in these folders either
        tops = ["shaderlib", "codegen", "targets", "conformance", "examples", ".ci"]
        names = [path.relative_to(ROOT).as_posix() for top in tops for path in (ROOT / top).rglob("*")]
        names = [name for name in names if "__pycache__" not in name]
        names += ["dev", "README.md", "LICENSE", "pyproject.toml", ".gitignore"]
    return tuple(sorted(name for name in names if (ROOT / name).is_file()))


def texts() -> Iterator[tuple[str, str]]:
    for name in files():
        try:
            yield name, (ROOT / name).read_text(encoding="utf-8")
        except UnicodeDecodeError:  # a picture or another binary file
            continue


def matches(pattern: re.Pattern[str]) -> list[str]:
    return [
        f"{name}:{number}: {line.strip()[:120]}"
        for name, text in texts()
        for number, line in enumerate(text.splitlines(), 1)
        if pattern.search(line)
    ]


def report(lines: list[str]) -> str:
    return "\n".join(["", *lines])


def test_python_files_are_short() -> None:
    counted = {name: len(text.splitlines()) for name, text in texts() if name.endswith(".py")}
    long = [f"{name}: {n} lines" for name, n in counted.items() if n > LONGEST_FILE and name not in GENERATED]
    assert not long, report(long)


@pytest.mark.parametrize(
    "pattern", [MARKS, MACHINE_PATHS, REGISTRIES], ids=["marks", "machine-paths", "registries"]
)
def test_no_leftovers(pattern: re.Pattern[str]) -> None:
    found = matches(pattern)
    assert not found, report(found)


def test_shaderlib_is_ascii() -> None:
    foreign = [name for name, text in texts() if name.startswith("shaderlib/") and not text.isascii()]
    assert not foreign, report(foreign)


@pytest.mark.parametrize("name", ["dev", ".ci/run"])
def test_scripts_can_be_executed(name: str) -> None:
    assert os.access(ROOT / name, os.X_OK)
    assert (ROOT / name).read_text(encoding="utf-8").startswith("#!/usr/bin/env bash\n")


def project() -> dict[str, object]:
    with (ROOT / "pyproject.toml").open("rb") as file:
        table: dict[str, object] = tomllib.load(file)["project"]
    return table


def test_licence_is_mit_and_named() -> None:
    text = (ROOT / "LICENSE").read_text(encoding="utf-8")
    assert text.startswith("MIT License")
    assert "Vair contributors" in text
    assert project()["license"] == "MIT"


def test_emitted_files_carry_the_licence() -> None:
    emitted = [(name, text) for name, text in texts() if re.fullmatch(r"targets/\w+/include/.+", name)]
    bare = [
        name
        for name, text in emitted
        if "SPDX-License-Identifier: MIT" not in "\n".join(text.splitlines()[:12])
    ]
    assert emitted, "no emitted file is committed"
    assert not bare, report(bare)


def test_readme_names_the_two_commands() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert "./dev demo" in readme
    assert "./dev test" in readme


def pins() -> dict[str, str]:
    lines = (ROOT / ".ci/requirements.txt").read_text(encoding="utf-8").splitlines()
    return dict(line.split("==") for line in lines if not line.startswith("#"))


def normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def test_direct_dependencies_are_pinned_as_resolved() -> None:
    table = project()
    required = list(table["dependencies"])  # type: ignore[call-overload]  # a list of strings by specification
    extras: dict[str, list[str]] = table["optional-dependencies"]  # type: ignore[assignment]
    everything = extras["all"][0].removeprefix("vair[").removesuffix("]").split(",")
    for name in everything:
        required += extras[name]
    direct = dict(entry.split("==") for entry in required)
    resolved = {normal(name): pin for name, pin in pins().items()}
    assert {normal(name): pin for name, pin in direct.items()}.items() <= resolved.items()


def test_further_dependencies_are_pinned_exactly() -> None:
    """Those of groups that ./dev does not install."""
    extras: dict[str, list[str]] = project()["optional-dependencies"]  # type: ignore[assignment]
    assert [e for name, group in extras.items() if name != "all" for e in group if "==" not in e] == []


def test_this_environment_has_the_pinned_versions() -> None:
    """A result is only comparable when it comes from the pinned packages."""
    wrong = []
    for name, pin in pins().items():
        try:
            found = version(name)
        except PackageNotFoundError:
            found = "missing"
        if found != pin:
            wrong.append(f"{name}: pinned {pin}, found {found}")
    assert not wrong, report(wrong)
