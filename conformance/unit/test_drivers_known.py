"""Known failures: what is refused when they are read, and how results are judged by them.

Plan.
  format   every key is needed and typed; each refusal names entry and key; the committed list is well formed
  verdict  each verdict has its own entries; an expected failure is marked; a pass, a larger error and an
           expired entry are complaints; driver, version, mode and function decide together whether an entry
           speaks of a result
"""

from __future__ import annotations

import datetime
from pathlib import Path

import pytest

from codegen.errors import UserError
from conformance.check.interval import IntervalResult
from conformance.check.result import BoundResult, FunctionResult
from conformance.drivers.known import Judged, judge, name_of, read
from targets import Device
from targets.drivers import driver

ENTRY = """[[failure]]
function = ["log_*", "sin_angle"]
driver = "pocl 3.1*"
mode = "fast-relaxed"
verdict = "within bound"
reason = "the compiler divides with 2.6 ULP"
measured = 1.5
share = 0.5
date = 2026-01-10
expires = 2027-01-10
"""
DEVICE = Device("opencl", "OpenCL 3.0", "Portable Computing Language 3.1+debian", "pthread")
TODAY = datetime.date(2026, 6, 1)


def write(folder: Path, text: str) -> Path:
    path = folder / "known_failures.toml"
    path.write_text(text, encoding="utf-8")
    return path


def result(name: str, share: float) -> FunctionResult:
    """A result whose error is this share of its bound."""
    r = FunctionResult(name, "opencl", "a driver", backend="pocl+fast-relaxed")
    r.bounds = [BoundResult("b", 1e-6, share * 1e-6, failures=int(share > 1.0))]
    r.broken = "it errs" if share == float("inf") else ""
    r.lanes = 10
    return r


def outside(name: str, excess: float, count: int = 1) -> FunctionResult:
    """A result of which some are that far outside their interval, and all within their bound."""
    r = result(name, 0.5)
    r.permitted = IntervalResult("opencl_relaxed", 10, 10 - count, 0, count, 0, excess)
    return r


def run(*results: FunctionResult, mode: str = "fast-relaxed", whole: bool = True) -> Judged:
    return Judged(f"pocl {driver('pocl').version_of(DEVICE)}", mode, results, whole)


def test_committed_list_is_well_formed() -> None:
    read()


def test_entry_is_read(tmp_path: Path) -> None:
    (entry,) = read(write(tmp_path, ENTRY))
    assert entry.functions == ("log_*", "sin_angle")
    assert (entry.drivers, entry.modes) == (("pocl 3.1*",), ("fast-relaxed",))
    assert entry.expires == datetime.date(2027, 1, 10)
    assert read(write(tmp_path, "# nothing is known\n")) == []


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("[[failure]]", "[[failures]]", 'unknown table "failures"'),
        ("[[failure]]", "[[failure", "not valid TOML"),
        ("reason =", "reasons =", 'failure 1: unknown key "reasons"; did you mean "reason"'),
        ("measured = 1.5\n", "", 'failure 1: the key "measured" is missing'),
        ("1.5", '"much"', "\"measured\" is 'much', which is of the wrong type"),
        ("1.5", "true", '"measured" is True, which is of the wrong type'),
        ("1.5", "0.5", '"measured" is how far out it is, above 1, not 0.5'),
        ("within bound", "within bounds", 'unknown verdict "within bounds"; did you mean "within bound"'),
        ("share = 0.5", "share = 0.0", '"share" is a share of the results'),
        ("share = 0.5", "share = 2", '"share" is a share of the results'),
        ('"fast-relaxed"', "[]", '"mode" is a text or a list of texts'),
        ("fast-relaxed", "fast-relaxd", 'unknown mode "fast-relaxd"; did you mean "fast-relaxed"'),
        ("2027-01-10", '"2027-01-10"', '"expires" is .* wrong type'),
        ("2027-01-10", "2025-01-10", '"expires" is not after "date"'),
        ("the compiler divides with 2.6 ULP", " ", '"reason" is empty'),
        ('["log_*", "sin_angle"]', "[1]", '"function" is a text or a list of texts'),
    ],
)
def test_bad_list_is_refused(tmp_path: Path, old: str, new: str, sentence: str) -> None:
    with pytest.raises(UserError, match=sentence):
        read(write(tmp_path, ENTRY.replace(old, new, 1)))


def test_expected_failure_is_marked(tmp_path: Path) -> None:
    failing, other = result("log_one_minus", 1.4), result("mirror", 1.4)
    verdict = judge([run(failing, other)], read(write(tmp_path, ENTRY)), TODAY)
    assert (verdict.expected, verdict.complaints) == (1, [])
    assert failing.known == {"within bound": "the compiler divides with 2.6 ULP"}
    assert failing.accepted and not failing.passed
    assert not other.accepted


@pytest.mark.parametrize(
    ("share", "sentence"),
    [
        (0.9, "sin_angle passes; remove it from the list"),
        (1.6, "sin_angle errs by 1.6 of its bound, more than the 1.5 known"),
        (float("inf"), "sin_angle errs by inf of its bound"),
    ],
)
def test_what_no_longer_fits_is_a_complaint(tmp_path: Path, share: float, sentence: str) -> None:
    odd = result("sin_angle", share)
    verdict = judge([run(odd)], read(write(tmp_path, ENTRY)), TODAY)
    assert len(verdict.complaints) == 1
    assert sentence in verdict.complaints[0]
    assert not odd.known


def test_expired_entry_is_a_complaint_once(tmp_path: Path) -> None:
    entries = read(write(tmp_path, ENTRY))
    runs = [run(result("sin_angle", 1.2), result("log_one_minus", 1.2))]
    assert judge(runs, entries, datetime.date(2027, 1, 10)).complaints == []
    (complaint,) = judge(runs, entries, datetime.date(2027, 1, 11)).complaints
    assert "expired on 2027-01-10" in complaint


@pytest.mark.parametrize(("old", "new"), [("pocl 3.1*", "pocl 3.0*"), ("pocl 3.1*", "rusticl*")])
def test_entry_of_another_driver_says_nothing(tmp_path: Path, old: str, new: str) -> None:
    failing = result("sin_angle", 1.2)
    verdict = judge([run(failing)], read(write(tmp_path, ENTRY.replace(old, new))), TODAY)
    assert verdict.complaints == [] and not failing.known


PERMITTED = ENTRY.replace("within bound", "permitted")


def test_entry_of_one_verdict_excuses_no_other(tmp_path: Path) -> None:
    both = outside("sin_angle", 1.2)
    both.bounds[0].failures = 1
    verdict = judge([run(both)], read(write(tmp_path, PERMITTED)), TODAY)
    assert (verdict.expected, verdict.complaints) == (1, [])
    assert list(both.known) == ["permitted"]
    assert not both.accepted
    both.bounds[0].failures = 0
    assert both.accepted and not both.passed


@pytest.mark.parametrize(
    ("bad", "sentence"),
    [
        (
            outside("sin_angle", 1.6),
            "sin_angle errs by 1.6 half widths of its interval, more than the 1.5 known",
        ),
        (outside("sin_angle", 1.2, 6), "sin_angle errs in 0.6 of the results, more than the 0.5 known"),
        (outside("sin_angle", 0.0, 0), "sin_angle passes; remove it from the list"),
        (result("sin_angle", 1.4), "sin_angle passes; remove it from the list"),
    ],
)
def test_results_outside_are_held_to_what_is_known(
    tmp_path: Path, bad: FunctionResult, sentence: str
) -> None:
    verdict = judge([run(bad)], read(write(tmp_path, PERMITTED)), TODAY)
    assert [sentence in complaint for complaint in verdict.complaints] == [True]
    assert not bad.known


def test_pass_of_a_few_inputs_is_no_unexpected_pass(tmp_path: Path) -> None:
    entries = read(write(tmp_path, PERMITTED))
    assert judge([run(outside("sin_angle", 0.0, 0), whole=False)], entries, TODAY).complaints == []
    assert judge([run(outside("sin_angle", 9.0), whole=False)], entries, TODAY).complaints


def test_result_that_is_not_finite_is_expected_where_it_is_listed(tmp_path: Path) -> None:
    odd = result("sin_angle", 0.5)
    odd.non_finite = 3
    entries = read(write(tmp_path, ENTRY.replace("1.5", "inf")))
    assert judge([run(odd)], entries, TODAY).complaints == []
    assert odd.known == {"finite": "the compiler divides with 2.6 ULP"}
    assert odd.accepted


def test_device_is_named_after_the_catalogue() -> None:
    assert name_of(DEVICE) == "pocl 3.1+debian"
    assert name_of(Device("glsl", "OpenGL 4.6", "Maker: 4.6 (550.54)", "Board 9000/PCIe")) == ""
    assert name_of(None) == ""


def test_entry_of_another_mode_says_nothing(tmp_path: Path) -> None:
    passing = result("sin_angle", 0.2)
    assert judge([run(passing, mode="default")], read(write(tmp_path, ENTRY)), TODAY).complaints == []
