"""Statements and definitions in every language, and how long lines are broken.

Plan.
  statements  one source with every kind of statement becomes the text of data/statements.toml, which was
              checked by hand against the languages' specifications
  heads       of functions with many parameters are broken, too
  precise     before locals that hold a float anywhere
  loops       that a parameter ends, of both types of numbers
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


ENDED = """def probe(x: X, n: u32, k: Annotated[i32, Interval(0, 9)]) -> f32:
    total = x
    for i in range(min(n, 4)):
        total += x
    for m in range(min(k, 9)):
        total += x
    return total
"""
HEADS = {
    "glsl": [
        "for (uint i = 0u; i < min(n, 4u); i++) {",
        "for (int m = 0; m < min(k, 9); m++) {",
    ],
    "wgsl": [
        "for (var i = 0u; i < min(n, 4u); i++) {",
        "for (var m = 0; m < min(k, 9); m++) {",
    ],
    "opencl": [
        "for (uint i = 0u; i < min(n, 4u); i++) {",
        "for (int m = 0; m < min(k, 9); m++) {",
    ],
}


@pytest.mark.parametrize("target", HEADS)
def test_loops_that_a_parameter_ends(target: str, tmp_path: Path) -> None:
    """They are numbered by the parameter's type, and run no longer than their constant says."""
    lines = emit(library_of(tmp_path, ENDED), dialect(target)).splitlines()
    assert [line.strip() for line in lines if line.strip().startswith("for")] == HEADS[target]


MIXED = """@struct
class Count:
    number: u32
    share: X

@helper
def counted(direction_towards_light: V, direction_towards_viewer: V, number_of_strands: u32, x: X) -> Count:
    return Count(number_of_strands, x)

def probe(v: V, n: u32, x: X) -> f32:
    found = counted(v, v, n, x)
    most = found.number
    return found.share + f32(most)
"""


def test_long_heads_are_broken_as_statements_are(tmp_path: Path) -> None:
    lines = emit(library_of(tmp_path, MIXED), dialect("wgsl")).splitlines()
    at = next(k for k, line in enumerate(lines) if "fn vair_counted" in line)
    assert lines[at : at + 2] == [
        "fn vair_counted(direction_towards_light: vec3<f32>, direction_towards_viewer: vec3<f32>,",
        "    number_of_strands: u32, x: f32) -> vair_Count {",
    ]


def test_precise_stands_before_every_local_with_a_float(tmp_path: Path) -> None:
    """Also before a struct of which only a part is one, and before no whole number."""
    text = emit(library_of(tmp_path, MIXED), with_precise(dialect("glsl", "450")))
    assert "    precise vair_Count found = vair_counted(v, v, n, x);\n    uint most = found.number;\n" in text


SHORT = "x" * 40
LINES = {
    "fits": ("a" * (WIDTH - 4), "    ", ["    " + "a" * (WIDTH - 4)]),
    "fits, though it could be broken": (f"{'a' * 48}, {'b' * 46}", "    ", [f"    {'a' * 48}, {'b' * 46}"]),
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
    "the end of the first third is near the beginning": (
        f"{'a' * 33} + f({SHORT}, {SHORT});",
        "",
        [f"{'a' * 33} + f({SHORT},", f"    {SHORT});"],
    ),
    "what follows the first third is not": (
        f"{'a' * 34} + f({SHORT}, {SHORT});",
        "",
        ["a" * 34, f"    + f({SHORT}, {SHORT});"],
    ),
    "near the beginning where there is no other place": (f"a * {'x' * 99};", "", ["a", f"    * {'x' * 99};"]),
    "the outer one of two brackets": (
        f"f({SHORT}, g({'y' * 20}, {'z' * 20}, {'w' * 20}));",
        "",
        [f"f({SHORT},", f"    g({'y' * 20}, {'z' * 20}, {'w' * 20}));"],
    ),
    "after a bracket that is closed": (
        f"{SHORT} + f(a) + v[i] + {'x' * 20} + {SHORT};",
        "",
        [f"{SHORT} + f(a) + v[i] + {'x' * 20}", f"    + {SHORT};"],
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
    "names with underscores open nothing": (
        f"{SHORT} + a_b + {'x' * 30} + {SHORT};",
        "",
        [f"{SHORT} + a_b + {'x' * 30}", f"    + {SHORT};"],
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
    assert comment("a word ", "// ", "// ") == ["// a word"]
    long = "w" * (WIDTH + 5)
    assert long in comment(f"a {long} b", "// ", "// ")[1]
    assert wrap.WIDTH == 100
