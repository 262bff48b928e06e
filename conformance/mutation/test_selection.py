"""Which tests a mutant meets first, and what is changed in a table.

Plan.
  functions  the innermost function around a line, decorators included; the whole file outside of all
  order      the tests that call a function, quickest first; tests that open devices are left out, tests with
             a parameter by a fixture's name are not
  tables     a mutant is one row changed, and another table as far as it is read
"""

from __future__ import annotations

import ast
import importlib
import sys
from pathlib import Path

import pytest

from codegen.errors import UserError
from codegen.intervals.tables import FOLDER, read_table
from conformance.mutation import table_rules
from conformance.mutation.record import FILE_COLUMNS, draw_of
from conformance.mutation.report import overview
from conformance.mutation.run import Result
from conformance.mutation.seen import Seen, Watch, function_around, within
from conformance.mutation.sites import Mutant
from conformance.mutation.swapped import Alive

pytest_plugins = ["pytester"]

TEXT = """A = 1


@decorated
def outer(x):
    def inner(y):
        return y

    return inner(x)


def other():
    return A
"""


@pytest.mark.parametrize(
    ("line", "ends"), [(1, (0, 13)), (4, (4, 9)), (7, (6, 7)), (9, (4, 9)), (13, (12, 13)), (0, (0, 13))]
)
def test_function_around_a_line(line: int, ends: tuple[int, int]) -> None:
    assert function_around(TEXT, line) == ends


def test_tests_that_see_a_function_come_quickest_first() -> None:
    seen = Seen(
        {
            "slow": {"s": 3.0, "calls": {"a.py": [4, 6]}},
            "quick": {"s": 1.0, "calls": {"a.py": [6]}},
            "elsewhere": {"s": 0.5, "calls": {"a.py": [12]}},
            "blind": {"s": 0.1, "calls": {"b.py": [4]}},
        }
    )
    assert seen.by("a.py", TEXT, 7) == ["quick", "slow"]
    assert seen.by("a.py", TEXT, 13) == ["elsewhere"]
    assert seen.by("a.py", TEXT, 1) == ["elsewhere", "quick", "slow"]
    assert seen.seconds == 4.6


@pytest.mark.parametrize(
    ("called", "line", "expected"),
    [(6, 7, True), (4, 7, True), (4, 9, True), (12, 7, False), (12, 1, True)],
    ids=["the inner one", "outer", "its own", "another", "no function"],
)
def test_functions_that_run_at_import(called: int, line: int, expected: bool) -> None:
    """An inner function is made by the outer one: what that has made at import keeps its code."""
    seen = Seen({}, {"a.py": [called]})
    assert seen.runs_at_import("a.py", TEXT, line) is expected


SWAPPED = """
import functools
LIMIT = 2
class Class:
    field: int = 1
    def method(self):
        return self.field + 1
@functools.cache
def cached():
    return [n + 1 for n in (1, 2)]
def made():
    return (lambda: 5)()
pair = (lambda: 1, lambda: 2)
"""
CHANGES = {
    "method": ("self.field + 1", "self.field + 2", (3, [2, 3], 5)),
    "behind a decorator": ("n + 1", "n + 3", (2, [4, 5], 5)),
    "inner": ("lambda: 5", "lambda: 6", (2, [2, 3], 6)),
    "module": ("LIMIT = 2", "LIMIT = 3", None),
    "field": ("field: int = 1", "field: int = 2", None),
    "default": ("def made()", "def made(a=1)", None),
    "lambdas of one line": ("lambda: 1", "lambda: 4", None),
    "nothing": ("", "", None),
}


@pytest.mark.parametrize("name", CHANGES)
def test_code_of_functions_is_exchanged(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What it does to the three functions of SWAPPED; None where more than functions would differ."""
    old, new, expected = CHANGES[name]
    file = tmp_path / "swapped_module.py"
    file.write_text(SWAPPED, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.delitem(sys.modules, "swapped_module", raising=False)
    module = importlib.import_module("swapped_module")
    swap = Alive([file]).swap(file, SWAPPED, ast.parse(SWAPPED.replace(old, new, 1)))
    assert (swap is None) == (expected is None)
    if swap is not None:
        swap.put()
        assert (module.Class().method(), module.cached(), module.made()) == expected


def test_tests_within_an_effort() -> None:
    """As many of the quickest as fit, and always one."""
    assert within([1.0, 2.0, 4.0], 3.0) == 2
    assert within([1.0, 2.0, 4.0], 0.5) == 1
    assert within([1.0, 2.0, 4.0], 70.0) == 3


TESTS = """
import pytest
from watched import called

@pytest.fixture(params=["one"])
def target(request):
    return request.param

def test_calls():
    assert called() == 1

def test_does_not():
    pass

def test_opens_a_device(target):
    pass

@pytest.mark.parametrize(("target", "other"), [("a", 1)])
def test_has_a_parameter_of_that_name(target, other):
    pass
"""


def test_calls_are_noted_and_devices_left_out(pytester: pytest.Pytester, tmp_path: Path) -> None:
    watched = pytester.makepyfile(watched="def called():\n    return 1\n")
    pytester.makepyfile(test_it=TESTS)
    notes = tmp_path / "seen.json"
    pytester.makeconftest(
        "from pathlib import Path\n"
        "from conformance.mutation.seen import Selection, Watch\n"
        f"WATCH = Watch(Path({str(watched.parent)!r}), ['watched.py'])\n"
        "def pytest_configure(config):\n"
        "    config.pluginmanager.register(Selection())\n"
        "    config.pluginmanager.register(WATCH)\n"
        "def pytest_unconfigure(config):\n"
        f"    WATCH.write(Path({str(notes)!r}))\n"
    )
    pytester.runpytest_subprocess("-p", "no:cacheprovider").assert_outcomes(passed=3)
    found = Seen.read(notes).tests
    assert sorted(name.partition("::")[2] for name in found) == [
        "test_calls",
        "test_does_not",
        "test_has_a_parameter_of_that_name[a-1]",
    ]
    assert [t["calls"] for name, t in found.items() if name.endswith("test_calls")] == [{"watched.py": [1]}]
    assert [t["calls"] for name, t in found.items() if name.endswith("test_does_not")] == [{}]


def test_watch_follows_no_other_file() -> None:
    assert set(Watch(Path("/place"), ["a.py"]).paths) == {"/place/a.py"}


@pytest.mark.parametrize("name", ["wgsl", "opencl_relaxed"])
def test_mutants_of_a_table(name: str) -> None:
    text = (FOLDER / f"{name}.toml").read_text(encoding="utf-8")
    table = read_table(name, name, text)
    found = table_rules.mutants("a.toml", text)
    assert {m.operator for m in found} >= {"kind", "halved", "doubled", "setting"}
    for mutant in found:
        changed = table_rules.mutated(text, mutant.index)
        try:
            other = read_table(name, name, changed)
        except UserError:
            continue
        rows = [op for op in table.rows if table.rows[op] != other.rows[op]]
        named = ("rounding", "flush", "fused", "as_accurate")
        settings = [s for s in named if getattr(table, s) != getattr(other, s)]
        assert len(rows) + len(settings) == 1, mutant


def test_a_draw_is_counted_and_shown() -> None:
    def result(line: int, outcome: str) -> Result:
        return Result(Mutant("codegen/a.py", "f", "number", "0", "1", line, line), outcome, 2.0)

    draw = draw_of([result(1, "killed"), result(2, "survived"), result(3, "refused")], 7, 90)
    assert (draw["killed"], draw["survived"], draw["refused"], draw["of"]) == (1, 1, 1, 90)
    assert draw["files"] == {"codegen/a.py": [2, 1, 0, 1]}
    assert len(FILE_COLUMNS) == 4
    assert draw["survivors"] == ["codegen/a.py:2 f: number: 0 -> 1"]
    lines = overview({"oracle": [{**draw, "seed": 6}, draw]})
    assert [line.split(" | ")[2] for line in lines[2:]] == ["7", "6"]
    assert lines[2].startswith("| oracle |")
