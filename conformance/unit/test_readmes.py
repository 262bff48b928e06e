"""What is written for people names what is there.

Plan. Markdown files, and the words of sources where paths and modules are concerned:
  links     a relative link leads to a file or a folder
  tables    a table "file | idea" or "folder | idea" names what lies beside it, all of that and nothing else
  paths     a path from the root of the repository exists; one recipe makes files of its own
  notes     a Markdown file that a source names is one of the repository, or one that a command writes
  modules   what `python -m` is said to run can be run
  commands  `vair COMMAND --option` and `./dev COMMAND` exist; README.md tells of every command
"""

from __future__ import annotations

import fnmatch
import re
from collections.abc import Iterator
from functools import cache
from pathlib import PurePosixPath

import click
from markdown_it import MarkdownIt
from markdown_it.token import Token

from codegen.cli import COMMANDS, vair
from conformance.unit.test_repository import ROOT, files, report

MARKDOWN = [name for name in files() if name.endswith(".md")]
MAKES_FILES = "codegen/guides/adding.md"
SOURCES = [
    name
    for name in files()
    if name.endswith((".md", ".py", ".yml", ".sh")) or name == "dev" or name.startswith(".ci/")
    if not name.startswith(("conformance/unit/", "conformance/execute/", "conformance/mutation/test_"))
    if name != ".ci/requirements.txt"
]
WRITTEN = {"report.md"}
"""What commands write."""
TESTS_LINKS = "conformance/unit/report/test_documentation.py"
UNNAMED = {"README.md", "__init__.py", "__main__.py"}
PATH = re.compile(r"(?<![\w./\"-])(?:shaderlib|codegen|targets|conformance|examples)/[\w./*-]+")
MODULE = re.compile(r"python3? -m ((?:codegen|conformance|targets|examples)(?:\.\w+)*)")


def text(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


@cache
def tokens(name: str) -> tuple[Token, ...]:
    """A Markdown file's tokens, those within lines in their places."""
    parsed = MarkdownIt("commonmark").enable("table").parse(text(name))
    return tuple(inner for token in parsed for inner in (token, *(token.children or ())))


def exists(path: str) -> bool:
    return any(ROOT.glob(path))


@cache
def beside(name: str) -> frozenset[str]:
    """Files and folders beside a file."""
    folder = PurePosixPath(name).parent
    inside = [
        PurePosixPath(f).relative_to(folder) for f in files() if PurePosixPath(f).is_relative_to(folder)
    ]
    return frozenset(path.parts[0] for path in inside)


def test_links_lead_somewhere() -> None:
    broken = []
    for name in MARKDOWN:
        for token in tokens(name):
            link = str(token.attrGet("href") or token.attrGet("src") or "")
            path = link.partition("#")[0]
            if path and ":" not in path and not (ROOT / name).parent.joinpath(path).exists():
                broken.append(f"{name}: {link}")
    assert not broken, report(broken)


def tables() -> Iterator[tuple[str, str, set[str]]]:
    """README, what its table of contents is of (file or folder), and what its first column names."""
    for name in MARKDOWN:
        rows = re.findall(r"^\| (file|folder) \| idea \|\n\|[-|]+\n((?:\|.*\n)+)", text(name), re.MULTILINE)
        for kind, body in rows:
            first = "\n".join(row.split("|")[1] for row in body.splitlines())
            named = set(re.findall(r"`([^`]+)`", first))
            yield name, kind, {entry.rstrip("/") for entry in named}


def test_tables_of_contents_name_what_is_there() -> None:
    found = list(tables())
    wrong = []
    for name, kind, named in found:
        folder = PurePosixPath(name).parent
        wrong += [f"{name}: there is no {entry}" for entry in named if not exists(str(folder / entry))]
        firsts = {PurePosixPath(entry).parts[0] for entry in named}
        for entry in beside(name) - UNNAMED:
            is_asked = kind == "file" or (ROOT / folder / entry).is_dir()
            if is_asked and not any(fnmatch.fnmatch(entry, first) for first in firsts):
                wrong.append(f"{name}: does not name {entry}")
    assert len(found) > 12
    assert not wrong, report(sorted(wrong))


def test_paths_exist() -> None:
    wrong = [
        f"{name}: {path}"
        for name in SOURCES
        if name != MAKES_FILES
        for path in PATH.findall(text(name))
        if not exists(path.rstrip("."))
    ]
    assert not wrong, report(wrong)


def test_notes_that_are_named_are_here() -> None:
    """Origins of tolerances above all: nobody can look up a note that is elsewhere."""
    here = {PurePosixPath(name).name for name in MARKDOWN} | WRITTEN
    wrong = [
        f"{name}: {note}"
        for name in files()
        if name.endswith((".py", ".toml", ".md")) and name != TESTS_LINKS
        for note in re.findall(r"[\w-]+\.md\b", text(name))
        if note not in here
    ]
    assert not wrong, report(wrong)


def test_modules_can_be_run() -> None:
    named = {(name, module) for name in SOURCES for module in MODULE.findall(text(name))}
    wrong = []
    for name, module in sorted(named):
        path = module.replace(".", "/")
        found = [file for file in (f"{path}.py", f"{path}/__main__.py") if file in files()]
        if not found or '__name__ == "__main__"' not in text(found[0]):
            wrong.append(f"{name}: python -m {module}")
    assert len(named) > 20
    assert not wrong, report(wrong)


def code(name: str) -> Iterator[str]:
    """What a file says can be typed: in Markdown code within lines and in blocks, elsewhere in backticks."""
    if not name.endswith(".md"):
        yield from re.findall(r"`((?:vair|\./dev) [^`]+)`", text(name))
        return
    for token in tokens(name):
        if token.type in ("code_inline", "fence", "code_block"):
            yield token.content


@cache
def typed(name: str) -> tuple[list[str], ...]:
    """The words of each line that can be typed, up to a second command."""
    lines = (line for block in code(name) for line in block.replace("\\\n", " ").splitlines())
    commands = (re.split(r" (?:\|\||&&|;) ", line)[0] for line in lines)
    return tuple(re.sub(r"[][|]|(?<=\w)\.\.\.", " ", command).split() for command in commands)


def options(command: click.Command) -> set[str]:
    return {option for parameter in command.params for option in (*parameter.opts, "--help")}


def misspelt(name: str) -> Iterator[str]:
    """Commands and options of a file that are not there."""
    for words in typed(name):
        if len(words) > 1 and words[0] == "./dev" and f"\n    {words[1]}) " not in text("dev"):
            yield f"{name}: there is no ./dev {words[1]}"
        if len(words) < 2 or words[0] not in ("vair", ".venv/bin/vair") or not words[1].islower():
            continue
        command = vair.get_command(click.Context(vair), words[1])
        if command is None:
            yield f"{name}: there is no vair {words[1]}"
            continue
        known = options(command)
        if isinstance(command, click.Group):
            known |= {option for part in command.commands.values() for option in options(part)}
        for word in words[2:]:
            if word.startswith("-") and word.rstrip(",;.") not in known:
                yield f"{name}: vair {words[1]} has no {word}"


def test_commands_exist() -> None:
    assert sum(1 for name in SOURCES for words in typed(name) if words[:1] == ["vair"]) > 100
    wrong = [line for name in SOURCES for line in misspelt(name)]
    assert not wrong, report(wrong)


def test_readme_tells_of_every_command() -> None:
    told = {words[1] for words in typed("README.md") if len(words) > 1 and words[0] == "vair"}
    assert told >= set(COMMANDS)
