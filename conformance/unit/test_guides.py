"""What the guides and the CI workflow say can be typed: every command is run, in order, in a fresh folder.

Plan. A fenced block of a guide is a step: `sh` is run, `sh nightly` at night only; `sh install` needs root
and a network, so its packages are compared with those of ./dev; a block with file=NAME is written, one with
file=+NAME appended. The guide about adding runs in a copy of the tree.
  by day    lines that call vair and nothing else run inside this process, which has read the library already
  by night  every block by bash, literally; one shard of the real work
  workflow  the commands of examples/ci/vair.yml, taken from the file, shard by shard and merged; at night
            a tenth of the first shard, not narrowed, by bash
"""

from __future__ import annotations

import os
import re
import runpy
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import yaml
from markdown_it import MarkdownIt

from codegen.cli import run

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "codegen" / "guides"
GUIDES = sorted(path.stem for path in FOLDER.glob("*.md"))
IN_THE_TREE = {"adding"}
WORKFLOW = ROOT / "examples" / "ci" / "vair.yml"
COPIED = ("shaderlib", "codegen", "targets", "conformance")
SHELL = {">", "|", "||", "&&", "2>&1"}
FEW = "--function sin_angle --function mirror --target numpy"
"""Narrows the workflow to seconds."""


@dataclass(frozen=True)
class Step:
    """One fenced block: its language, further words, and text."""

    language: str
    words: tuple[str, ...]
    text: str

    @property
    def file(self) -> str:
        return next((w.removeprefix("file=") for w in self.words if w.startswith("file=")), "")


def steps(name: str) -> list[Step]:
    tokens = MarkdownIt("commonmark").parse((FOLDER / f"{name}.md").read_text(encoding="utf-8"))
    fences = [(t.info.split(), t.content) for t in tokens if t.type == "fence"]
    return [Step(info[0] if info else "", tuple(info[1:]), text) for info, text in fences]


def environment(folder: Path, tree: Path) -> dict[str, str]:
    """Variables with which `vair` and `python` are those of a tree."""
    tools = folder / ".tools"
    tools.mkdir(exist_ok=True)
    for name, command in {"vair": "-m codegen.cli", "python": ""}.items():
        script = tools / name
        script.write_text(f'#!/bin/sh\nexec "{sys.executable}" {command} "$@"\n', encoding="utf-8")
        script.chmod(0o755)
    return {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "PYTHONPATH": str(tree)}


def bash(text: str, folder: Path, variables: dict[str, str]) -> None:
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", text],
        cwd=folder,
        env=variables,
        capture_output=True,
        text=True,
        timeout=400,
        check=False,
    )
    assert done.returncode == 0, f"{text}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}"


def type_in(line: str) -> bool:
    """Run a line here, if it calls vair or a script and nothing else; whether it did."""
    words = shlex.split(line)
    if set(words) & SHELL or words[:2] == ["vair", "doctor"]:
        return False
    if words[0] == "vair":
        assert run(words[1:]) == 0, line
    elif words[0] == "python":
        runpy.run_path(words[1])
    return words[0] in ("vair", "python")


def write(step: Step, folder: Path) -> None:
    """Write the file that a step holds, if it holds one."""
    if step.file:
        path = folder / step.file.removeprefix("+")
        path.parent.mkdir(parents=True, exist_ok=True)
        added = step.file.startswith("+")
        # What is added to a module stands two lines below what is there, as its formatter wants it.
        space = "\n\n" if added and path.suffix == ".py" else ""
        with path.open("a" if added else "w", encoding="utf-8") as file:
            file.write(space + step.text)


def follow(name: str, folder: Path) -> None:
    """Every step of a guide, by bash."""
    tree = folder if name in IN_THE_TREE else ROOT
    if name in IN_THE_TREE:
        for package in COPIED:
            ignored = shutil.ignore_patterns("__pycache__", "unit", "results")
            shutil.copytree(ROOT / package, folder / package, ignore=ignored)
    variables = environment(folder, tree)
    for step in steps(name):
        write(step, folder)
        if step.language == "sh" and step.words in ((), ("nightly",)):
            bash(step.text, folder, variables)


def test_there_are_guides() -> None:
    assert {"vendor", "generate", "conformance", "adding", "ci"} <= set(GUIDES)


@pytest.mark.parametrize("name", GUIDES)
def test_every_block_is_of_a_known_kind(name: str) -> None:
    kinds = {("sh",), ("sh", "nightly"), ("sh", "install")}
    found = steps(name)
    assert any(step.language == "sh" for step in found)
    assert [s for s in found if not s.file and (s.language, *s.words) not in kinds] == []


@pytest.mark.parametrize("name", [name for name in GUIDES if name not in IN_THE_TREE])
def test_a_guide_can_be_followed(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    ran = 0
    for step in steps(name):
        write(step, tmp_path)
        for line in step.text.splitlines() if step.language == "sh" and not step.words else ():
            ran += type_in(line)
    assert ran > 1, "nothing was left to run by day"


@pytest.mark.nightly
@pytest.mark.parametrize("name", GUIDES)
def test_a_guide_can_be_followed_literally(name: str, tmp_path: Path) -> None:
    follow(name, tmp_path)


def test_packages_are_those_that_the_setup_installs() -> None:
    script = (ROOT / "dev").read_text(encoding="utf-8")
    needed = set(re.findall(r'^    "([\w.-]+)\|', script, re.MULTILINE))
    texts = [s.text for s in steps("ci") if s.words == ("install",)]
    texts += [run for run in commands("software") if "apt-get" in run]
    assert len(texts) == 2 and needed
    for text in texts:
        assert needed <= set(text.split()), text


def workflow() -> dict[str, Any]:
    """The workflow as a runner reads it."""
    found: dict[str, Any] = yaml.safe_load(WORKFLOW.read_text(encoding="utf-8"))
    return found


def commands(job: str) -> list[str]:
    """What the steps of a job run."""
    return [step["run"] for step in workflow()["jobs"][job]["steps"] if "run" in step]


def vair_lines(job: str) -> str:
    """The lines of a job that call vair; others prepare the machine."""
    return "\n".join(line for run in commands(job) for line in run.splitlines() if line.startswith("vair "))


def of_shard(lines: str, shard: int) -> str:
    """Lines of a job with the value of its matrix put in, as a runner does before a shell reads them."""
    return lines.replace("${{ matrix.shard }}", str(shard))


def test_nothing_but_the_shard_is_for_the_runner_to_put_in() -> None:
    for job in workflow()["jobs"]:
        assert "${{" not in of_shard("\n".join(commands(job)), 1), job


def test_the_workflow_can_be_followed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    jobs = workflow()["jobs"]
    shards = jobs["software"]["strategy"]["matrix"]["shard"]
    lines = vair_lines("software").replace("$VAIR_CHECK", FEW).splitlines()
    for shard in shards:
        for line in lines:
            type_in(of_shard(line, shard))
    found = [f"shard-{shard}.json" for shard in shards]
    assert type_in(vair_lines("verdict").replace("shard-*.json", " ".join(found)))
    written = {p for step in jobs["verdict"]["steps"] for p in step.get("with", {}).get("path", "").split()}
    assert written == {"vair.json", "vair.xml"}
    assert all((tmp_path / name).stat().st_size > 0 for name in written)


@pytest.mark.nightly
def test_the_workflow_checks_everything(tmp_path: Path) -> None:
    """One shard of the real work, and the jobs of a GPU runner by what they name."""
    variables = {**environment(tmp_path, ROOT), **workflow()["env"]}
    lines = of_shard(vair_lines("software"), 1)
    assert "--shard 1/4 " in lines
    bash(lines.replace("--shard 1/4 ", "--shard 1/40 "), tmp_path, variables)
    assert (tmp_path / "shard-1.json").stat().st_size > 0
    assert "--driver system-glsl" in vair_lines("gpu")
