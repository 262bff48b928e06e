"""Statements and definitions in every language, and how long lines are broken.

Plan.
  statements  one source with every kind of statement becomes the text of data/statements.toml, which was
              checked by hand against the languages' specifications
  lines       a broken line reads the same without its breaks, keeps the width where it can, and is broken
              only at commas and operators of the shallowest depth; its later lines are indented further
  comments    wrapped at the width, first and later lines with their own beginnings
"""

import random
import tomllib
from pathlib import Path
from typing import Any

import pytest

from codegen.backends import dialect
from codegen.emit import wrap
from codegen.emit.dialect import with_precise
from codegen.emit.module import emit
from codegen.emit.wrap import WIDTH, code, comment
from conformance.unit.support.sources import library_of

DATA: dict[str, Any] = tomllib.loads(
    (Path(__file__).parent / "data/statements.toml").read_text(encoding="utf-8")
)
SEED = 20260730


def entry_id(entry: dict[str, Any]) -> str:
    return f"{entry['target']}-{entry['dialect']}"


@pytest.mark.parametrize("entry", DATA["emitted"], ids=entry_id)
def test_every_statement(entry: dict[str, Any], tmp_path: Path) -> None:
    chosen = dialect(entry["target"], entry["dialect"])
    text = emit(library_of(tmp_path, DATA["source"]), with_precise(chosen) if entry["precise"] else chosen)
    lines = [line for line in text.splitlines() if not line.startswith(("//", "#"))]
    blocks = "\n".join(lines).strip().split("\n\n")
    assert "\n\n".join(b.strip("\n") for b in blocks if b.strip()) == entry["text"].strip()


SHORT = "x" * 40
LINES = {
    "fits": ("a" * (WIDTH - 4), "    ", ["    " + "a" * (WIDTH - 4)]),
    "no place to break": ("a" * WIDTH, "    ", ["    " + "a" * WIDTH]),
    "after a comma": (f"f({SHORT}, {SHORT}, {SHORT});", "", [f"f({SHORT}, {SHORT},", f"    {SHORT});"]),
    "before an operator": (f"{SHORT} + {SHORT} + {SHORT};", "", [f"{SHORT} + {SHORT}", f"    + {SHORT};"]),
    "the shallowest place": (
        f"{SHORT} * g({SHORT}, {SHORT}, b);",
        "",
        [SHORT, f"    * g({SHORT}, {SHORT}, b);"],
    ),
    "not inside brackets of any kind": (
        f"{SHORT} = (S){{{'y' * 20} + a, {'y' * 20}}} - v[{'z' * 20} + b];",
        "",
        [f"{SHORT} = (S){{{'y' * 20} + a, {'y' * 20}}}", f"    - v[{'z' * 20} + b];"],
    ),
    "between the brackets of a cast and of its parts is no place": (
        f"{SHORT} + (float3)({SHORT}, {'y' * 15}, {'z' * 15});",
        "",
        [SHORT, f"    + (float3)({SHORT}, {'y' * 15}, {'z' * 15});"],
    ),
    "a comparison and a sign stay": (
        f"b = {SHORT} < -{SHORT} && c < {SHORT};",
        "    ",
        [f"    b = {SHORT} < -{SHORT}", f"        && c < {SHORT};"],
    ),
    "not near the beginning": (
        f"a, f({'p' * 30}, {SHORT}, {SHORT});",
        "",
        [f"a, f({'p' * 30}, {SHORT},", f"    {SHORT});"],
    ),
    "further lines hang by one step": (
        f"{SHORT}, {SHORT}, {SHORT};",
        " " * 20,
        [" " * 20 + f"{SHORT},", " " * 24 + f"{SHORT},", " " * 24 + f"{SHORT};"],
    ),
    "names with underscores are of one piece": (
        f"{SHORT} + f(a_b, {SHORT}, {'x' * 20});",
        "",
        [SHORT, f"    + f(a_b, {SHORT}, {'x' * 20});"],
    ),
    "a full line is kept": (
        f"{'a' * (WIDTH - 5)} + b, c;",
        "",
        [f"{'a' * (WIDTH - 5)} + b,", "    c;"],
    ),
}


@pytest.mark.parametrize("name", LINES)
def test_long_line(name: str) -> None:
    line, indent, expected = LINES[name]
    assert code(line, indent) == expected


def test_broken_lines_read_the_same() -> None:
    rng = random.Random(SEED)
    for _ in range(300):
        words = [
            "w" * rng.randint(1, 25) + rng.choice(["", ",", " +", " *", " &&", " ?", " :", " |"])
            for _ in range(20)
        ]
        line, indent = " ".join(words) + ";", " " * 4 * rng.randint(0, 5)
        lines = code(line, indent)
        assert " ".join(part.strip() for part in lines) == line
        assert all(len(part) <= WIDTH for part in lines)
        assert all(part.startswith(indent) for part in lines)
        assert not any(part.rstrip().endswith(("+", "*", "&&", "?", ":", "|")) for part in lines)


def test_comments_are_wrapped() -> None:
    words = " ".join(["long-word"] * 30)
    lines = comment(words, "// a ", "//   ")
    assert lines[0].startswith("// a long-word long-word")
    assert all(line.startswith("//   long-word") for line in lines[1:])
    assert all(WIDTH - 10 < len(line) <= WIDTH for line in lines[:-1])
    assert " ".join(line[5:] for line in lines) == words
    assert comment("", "// ", "// ") == ["//"]
    long = "w" * (WIDTH + 5)
    assert long in comment(f"a {long} b", "// ", "// ")[1]
    assert wrap.WIDTH == 100
