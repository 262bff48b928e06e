"""The tests notice planted faults: a fixed sample of every group, and the machinery that plants them.

Plan.
  shares     of the sample in plan.toml, each group's share is killed (python -m conformance.mutation: all)
  planted    every planted fault still fits its file, and the oracle's are all killed
  machinery  a mutant is one change; a harmless change survives, a deadly one is killed, an endless one too
  excuses    every entry of equivalent.toml excuses some mutant; those of shading functions change no result
  symmetric  functions whose arguments are not exchanged give the same either way
The trials run in a fresh process: forks of a process that has opened drivers would inherit their threads.
"""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from codegen.errors import SourceError, UserError
from codegen.evaluate import evaluate
from codegen.ir.verify import MalformedIRError
from codegen.library import load_library
from conformance.check.draws import draw
from conformance.mutation import python_rules, shader_rules
from conformance.mutation.plan import (
    PLANTED,
    Group,
    Subject,
    excuse,
    excuses,
    groups,
    mutants_of,
    planted,
    tree_of,
)
from conformance.mutation.report import confidence
from conformance.mutation.shaders import names_in, points, public_users, with_source
from conformance.mutation.sites import Mutant, mutants, mutated

ROOT = Path(__file__).parents[2]
SEED = 20261123


def outcomes(folder: Path, *arguments: str) -> list[dict[str, Any]]:
    told = folder / "outcomes.json"
    command = [sys.executable, "-m", "conformance.mutation", "--json", str(told), *arguments]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode in (0, 1), done.stdout[-3000:] + done.stderr[-3000:]
    found: list[dict[str, Any]] = json.loads(told.read_text(encoding="utf-8"))
    return found


@pytest.mark.nightly  # a minute of processor time
@pytest.mark.parametrize("name", groups())
def test_share_of_a_sample_is_killed(name: str, tmp_path: Path) -> None:
    rows = outcomes(tmp_path, "--sampled", name)
    survivors = [str(Mutant(**row["mutant"])) for row in rows if row["outcome"] == "survived"]
    tried = [row for row in rows if row["outcome"] != "refused"]
    assert len(tried) >= groups()[name].sample * 3 // 4
    assert len(survivors) <= (1.0 - groups()[name].sampled_share) * len(tried), "\n".join(survivors)


def test_every_planted_fault_fits() -> None:
    found = [(g, s, m) for g in groups().values() for s in g.subjects for m in planted(g.name, s.path)]
    assert len(found) > 20
    for group, subject, mutant in found:
        assert ast.dump(tree_of(group, subject, mutant)) != ast.dump(ast.parse(subject.text)), mutant


SOURCE = '''
"""Text."""
Alias = dict[str, int]
def f(a: int, b: int = 1) -> int:
    """Text."""
    assert a < b
    if a < b:
        raise ValueError("no" + "thing")
    return min(a - 1, b)
'''


def described(found: list[Mutant]) -> set[tuple[str, str, str]]:
    return {(m.operator, m.before, m.after) for m in found}


def test_mutants_of_a_module() -> None:
    found = mutants("a.py", SOURCE, python_rules.rule)
    assert {m.place for m in found} == {"f"}
    assert described(found) >= {
        ("comparison", "a < b", "a <= b"),
        ("comparison", "a < b", "a >= b"),
        ("operator", "a - 1", "a + 1"),
        ("name exchanged", "min", "max"),
        ("number", "1", "2"),
    }
    assert not [m for m in found if m.before in ("'Text.'", "'no'", "'thing'") or "assert" in m.before]
    assert len({(m.place, m.before, m.after) for m in found}) == len(found)


def test_mutant_is_one_change() -> None:
    original = ast.unparse(ast.parse(SOURCE)).splitlines()
    for m in mutants("a.py", SOURCE, python_rules.rule):
        lines = ast.unparse(mutated(SOURCE, python_rules.rule, m.index)).splitlines()
        assert lines != original
        assert len(set(lines) ^ set(original)) <= 3, m


def test_mutants_of_a_shading_function() -> None:
    text = (
        "def f(a: X, v: V) -> f32:\n    if a < 0.5:\n        return max(v.x * a, 0.0)\n    return 2.0 - a\n"
    )
    assert described(mutants("a.py", text, shader_rules.rule)) >= {
        ("comparison", "a < 0.5", "a >= 0.5"),
        ("components", "v.x", "v.y"),
        ("guard removed", "max(v.x * a, 0.0)", "v.x * a"),
        ("term dropped", "v.x * a", "a"),
        ("operands exchanged", "2.0 - a", "a - 2.0"),
        ("constant", "2.0", "2.04"),
    }


# What comes of each change: all that depends on it imported anew, and only functions exchanged.
CHANGES = {
    "the same": ("", ["survived", None]),
    "harmless": ("return int(text) -> return int(text) + 0", ["survived", "survived"]),
    "deadly": ("return int(text) -> return int(text) + 1", ["killed", "killed"]),
    "broken": ("import dataclass -> import nothing", ["killed", None]),
    "endless": ("parts = -> sum(1 for _ in iter(int, 1)); parts =", ["timed out", "timed out"]),
}
TRIALS = """
import ast, json, sys
from functools import partial
from conformance.mutation.isolated import ROOT, Change, Session, Trial, dependants
from conformance.mutation.swapped import Alive
from conformance.mutation.warm import collected

tests, told = (sys.argv[1],), {}
path = "conformance/check/identity.py"

def then(warm):
    session = Session(tests, frozenset(dependants("conformance.check.identity")))
    alive, text = Alive([ROOT / path]), open(path).read()
    chosen = [item.nodeid for item in warm.session.items]
    for name, change in json.loads(sys.argv[2]).items():
        old, _, new = change.partition(" -> ")
        tree = ast.parse(text.replace(old, new, 1) if change else text)
        limit = 20 if name != "endless" else 3
        anew = Trial(partial(session.run, Change(path, tree)), limit).wait()
        swap = alive.swap(ROOT / path, text, tree)
        swapped = swap and Trial(partial(warm.run, chosen, swap), limit).wait()
        told[name] = [anew, swapped]

assert not collected(tests, (), then)
print(json.dumps(told))
"""


@pytest.mark.nightly
def test_trials_tell_harmless_from_deadly(tmp_path: Path) -> None:
    test = tmp_path / "test_identity.py"
    test.write_text(
        "from conformance.check.identity import Identity\n"
        "def test_it() -> None:\n"
        "    assert Identity.parse('f/t/u/9/1/3').lane == 3\n",
        encoding="utf-8",
    )
    changes = json.dumps({name: change for name, (change, _) in CHANGES.items()})
    command = [sys.executable, "-c", TRIALS, str(test), changes]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert json.loads(done.stdout.splitlines()[-1]) == {name: o for name, (_, o) in CHANGES.items()}


def test_a_constant_is_tried_where_it_is_used() -> None:
    functions = "def f(x: X) -> X:\n    return x + A\n\ndef g(x: X) -> X:\n    return x\n"
    subject = SimpleNamespace(text=f"A = 1.0\nB = (\n    2.0\n)\n\n{functions}")
    found = mutants("a.py", subject.text, shader_rules.rule)
    tried = {m.before: names_in(m, subject) for m in found if not m.place}  # type: ignore[arg-type]
    assert tried == {"1.0": ["f"], "2.0": ["f", "g"]}


def test_a_constant_of_a_file_without_functions_is_tried_where_it_is_imported() -> None:
    path = "shaderlib/environment/domains.py"
    subject = next(s for s in groups()["library"].subjects if s.path == path)
    tried = {m.before: names_in(m, subject) for m in mutants_of(groups()["library"], subject)}
    assert {"env_disc", "env_lod"} <= set(tried["1.2"])
    assert "env_guarded_phong" in tried["0.5"]
    assert "env_grid_phong" not in tried["0.5"]
    assert all(tried.values())


DOUBLE_ROUNDING = 2.0**-48
"""What the rounding of sums and products in another order may differ by in double precision, relatively."""


@pytest.mark.parametrize("name", sorted(shader_rules.SYMMETRIC_OF_THE_LIBRARY))
def test_functions_that_are_called_symmetric_are(name: str) -> None:
    function = load_library().function(name)
    first, second = (p.name for p in function.parameters[:2])
    for family in ("uniform", "domain_ends"):
        given = {key: _wide(value) for key, value in draw(function, family, 400, SEED).inputs.items()}
        exchanged = {**given, first: given[second], second: given[first]}
        one, other = (np.asarray(evaluate(load_library(), name, x, "float64")) for x in (given, exchanged))
        assert (np.abs(one - other) <= DOUBLE_ROUNDING * np.maximum(np.abs(one), np.abs(other))).all()
        assert family != "uniform" or len(np.unique(one)) > 1


def _wide(value: Any) -> Any:
    return value.astype(np.float64) if value.dtype.kind == "f" else value


def test_symmetric_functions_are_called() -> None:
    called = {
        part.func.id
        for s in groups()["library"].subjects
        for part in ast.walk(ast.parse(s.text))
        if isinstance(part, ast.Call) and isinstance(part.func, ast.Name)
    }
    assert called >= shader_rules.SYMMETRIC_OF_THE_LIBRARY


ROUNDING = 2.0**-40
"""A root in closed form against SciPy's quantile: both are of double precision, to a few roundings."""
FOUR_DIGITS = 0.5e-4
"""Ends of an interval that are quoted to four digits."""
HALF_OF_THIRTY = (0.3130, 0.6870)
"""The interval for 15 of 30 at 95 %, as scipy.stats.binomtest(15, 30) gives it."""


def test_confidence_of_a_sample() -> None:
    """All of 30 killed: more than 88.4 % of all (0.025^(1/30)); half of them: between 31 % and 69 %."""
    assert confidence(30, 30) == pytest.approx((0.025 ** (1 / 30), 1.0), abs=ROUNDING)
    assert confidence(0, 30) == pytest.approx((0.0, 1.0 - 0.025 ** (1 / 30)), abs=ROUNDING)
    assert confidence(15, 30) == pytest.approx(HALF_OF_THIRTY, abs=FOUR_DIGITS)


@pytest.mark.nightly
def test_every_excuse_excuses_something() -> None:
    every = [m for g in groups().values() for s in g.subjects for m in mutants_of(g, s)]
    idle = [e for e in excuses() if not any(e.covers(m) for m in every)]
    assert not idle
    assert all(e.reason for e in excuses())
    assert not [m for m in every if m.index == PLANTED and any(e.covers(m) for e in excuses())]


DRAWN, OF_A_FAMILY = 2000, 300
NOTICEABLE = 2e-6
"""Relative to a result, or to 1 where that is more: some roundings of float32, 2^-24 each."""


def _changes(group: Group, subject: Subject, mutant: Mutant) -> float:
    """How far the results of the nearest function with numbers as arguments are from the original's.

    0 for a change that the front end refuses, and where no such function is near.
    """
    original = load_library()
    try:
        library = with_source(subject.path, tree_of(group, subject, mutant))
        users = [u for name in names_in(mutant, subject) for u in public_users(name, 50)]
        near = next((u for u in users if not original.function(u).reads_textures), None)
        if near is None:
            return 0.0
        library.function(near)
    except (SourceError, UserError, MalformedIRError):
        return 0.0
    worst = 0.0
    for d in points(near, DRAWN, OF_A_FAMILY):
        with np.errstate(all="ignore"):
            one, other = (_flat(evaluate(of, near, d.inputs)) for of in (original, library))
        same = (one == other) | (np.isnan(one) & np.isnan(other))
        off = np.where(same, 0.0, np.abs(one - other) / np.maximum(np.abs(one), 1.0))
        worst = max(worst, float(np.nan_to_num(off, nan=np.inf).max()))
    return worst


def _flat(value: Any) -> Any:
    parts = value.values() if isinstance(value, dict) else (value,)
    return np.concatenate([np.ravel(np.asarray(part, np.float64)) for part in parts])


@pytest.mark.nightly  # a minute of processor time
def test_excused_shaders_change_nothing() -> None:
    group = groups()["library"]
    excused = [(s, m) for s in group.subjects for m in mutants_of(group, s) if excuse(m)]
    assert len(excused) > 100
    changed = {str(m): change for s, m in excused if (change := _changes(group, s, m)) > NOTICEABLE}
    assert not changed, "\n".join(f"{m}: {change:.1e}" for m, change in changed.items())
