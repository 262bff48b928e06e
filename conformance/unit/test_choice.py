"""`vair emit --max-error` picks the cheapest recorded variant within an error.

Plan. Recorded files are made up here: three candidates of sin_angle on one or two drivers.
  choice       the cheapest within the limit; a declared bound counts before a measured one; a narrower
               variant never; of several drivers the largest error and the mean time
  front        what a cheaper one matches in error is not on it
  messages     nothing recorded, nothing within the limit (with the best there is), older sources, no variants
  command      the chosen variant under its own name in the emitted text, the front on standard error
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from codegen import costs
from codegen.choice import choose_all, describe, front
from codegen.commands.emit import command
from codegen.costs import SCHEMA
from codegen.errors import UserError
from codegen.library import Library, load_library

BASE, CHEAP, CHEAPEST, NARROW = "sin_angle", "sin_angle_half", "sin_angle_cross", "sin_angle_cosine"


@pytest.fixture(scope="module")
def library() -> Library:
    return load_library()


def recorded_function(library: Library, name: str, ns: float, **whole: Any) -> dict[str, Any]:
    facts = {"largest": {}, "declared": {}, "non_finite": 0, "count": 9, "narrower": [], **whole}
    return {
        "name": name,
        "base": BASE,
        "source_hash": library.select([name]).source_hash,
        "speed": {"throughput": {"net_ns": ns, "gross_ns": 10.0 * abs(ns)}},
        "whole": facts,
    }


def functions(library: Library) -> list[dict[str, Any]]:
    return [
        recorded_function(library, BASE, 4.0, declared={"absolute": 1e-6}, largest={"absolute": 2e-7}),
        recorded_function(library, CHEAP, 3.0, largest={"absolute": 1e-4, "ulp": None}),
        recorded_function(library, CHEAPEST, 2.0, largest={"absolute": 1e-3}),
        recorded_function(library, NARROW, 1.0, narrower=["a length in [1, 2]"]),
    ]


@pytest.fixture
def folder(library: Library, tmp_path: Path) -> Path:
    keep(tmp_path, "llvmpipe", functions(library))
    return tmp_path


def keep(folder: Path, driver: str, found: list[dict[str, Any]]) -> None:
    result = {"schema": SCHEMA, "device": {"target": "glsl", "short": driver}, "functions": found}
    (folder / f"glsl-{driver}.json").write_text(json.dumps(result), encoding="utf-8")
    costs.recorded.cache_clear()


@pytest.mark.parametrize(
    ("limit", "chosen"), [(1e-6, BASE), (9e-5, BASE), (1e-4, CHEAP), (1e-3, CHEAPEST), (1.0, CHEAPEST)]
)
def test_the_cheapest_within_the_limit(library: Library, folder: Path, limit: float, chosen: str) -> None:
    (choice,) = choose_all(library, "glsl", [BASE], limit, "absolute", folder)
    assert choice.chosen == chosen
    assert [c.name for c in front(choice.candidates)] == [CHEAPEST, CHEAP, BASE]


def test_a_variant_stands_for_its_base(library: Library, folder: Path) -> None:
    choices = choose_all(library, "glsl", [CHEAP, BASE], 1.0, "absolute", folder)
    assert [c.chosen for c in choices] == [CHEAPEST]


def test_a_declared_bound_counts_before_a_measured_error(library: Library, folder: Path) -> None:
    with pytest.raises(UserError, match=r"stays within absolute 5e-7 .* best is sin_angle with 1e-6"):
        choose_all(library, "glsl", [BASE], 5e-7, "absolute", folder)


def test_the_worst_driver_counts(library: Library, folder: Path) -> None:
    other = functions(library)
    other[2]["whole"]["largest"]["absolute"] = 0.5
    keep(folder, "zink", other)
    (choice,) = choose_all(library, "glsl", [BASE], 1e-2, "absolute", folder)
    assert choice.chosen == CHEAP
    assert choice.candidates[0].ns == {"llvmpipe": 1.0, "zink": 1.0}


def test_messages(library: Library, folder: Path) -> None:
    with pytest.raises(UserError, match="nothing is recorded for wgsl"):
        choose_all(library, "wgsl", [BASE], 1.0, "absolute", folder)
    with pytest.raises(UserError, match="nothing is recorded of strand_specular for glsl"):
        choose_all(library, "glsl", ["strand_specular"], 1.0, "absolute", folder)
    with pytest.raises(UserError, match="none has a bounded error"):
        choose_all(library, "glsl", [BASE], 1.0, "ulp", folder)
    (choice,) = choose_all(library, "glsl", ["pcg_hash"], 0.0, "absolute", folder)
    assert (choice.chosen, choice.candidates) == ("pcg_hash", ())
    assert describe(choice, "glsl", 0.0, "absolute") == ["pcg_hash has no variants to choose from"]


def test_an_older_source_is_said(library: Library, folder: Path) -> None:
    old = functions(library)
    old[0]["source_hash"] = "0"
    keep(folder, "llvmpipe", old)
    (choice,) = choose_all(library, "glsl", [BASE], 1.0, "absolute", folder)
    assert "older sources: sin_angle" in choice.note


def test_all_functions_keep_their_default_where_nothing_fits(library: Library, folder: Path) -> None:
    choices = {c.function: c for c in choose_all(library, "glsl", None, 1e-4, "absolute", folder)}
    assert set(choices) == {f.name for f in library.public.values() if f.kind == "base"}
    assert choices[BASE].chosen == CHEAP
    assert choices["strand_specular"].chosen == "strand_specular"
    assert "the default stays" in choices["strand_specular"].note
    assert describe(choices["pcg_hash"], "glsl", 1e-4, "absolute") == [], "silence where there is no choice"


def test_the_command(library: Library, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(costs, "results_folder", lambda: folder)
    costs.recorded.cache_clear()
    arguments = ["--target", "glsl", "--function", BASE, "--max-error", "1e-4"]
    answer = CliRunner().invoke(command, arguments)
    costs.recorded.cache_clear()
    assert f"float vair_{CHEAP}(" in answer.stdout
    assert f"vair_{BASE}(" not in answer.stdout
    assert f"  > {CHEAP}: 3 ns, 0.0001 measured" in answer.stderr.splitlines()
    assert f"    {NARROW}: 1 ns, accepts only a length in [1, 2], not on the front" in answer.stderr


def test_bad_limits_are_refused() -> None:
    for bad in ("-1", "x"):
        assert CliRunner().invoke(command, ["--target", "glsl", "--max-error", bad]).exit_code == 2
    half = ["--target", "wgsl", "--max-error", "1", "--precision", "half"]
    assert isinstance(CliRunner().invoke(command, half).exception, UserError)
