"""Visits in several processes decide an order only where it is reproducible. All timings are made up.

Plan.
  level       a machine that is twice as fast from one round on changes no net time's place among the others
  verdicts    what one, two, three and five visits decide; one disturbed visit is outvoted, mixed ones are not
  again       which members another visit is worth: close and disputed ones, never hopeless ones
  joining     the median of the visits, quartiles over all of them; an order never contradicts what is shown
  visiting    the second visit times everything, later ones what is open; time ends them
  two runs    over many pairs whose visits shift each by itself, two whole runs never contradict each other on
              a pair that differs by more than CLOSE
  records     the rounds of every visit, and the rest of the first visit's data as it was
  comparing   a report of single visits is told from one of several
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pytest

from conformance.bench.joining import timing
from conformance.bench.steady import Rounds, steady
from conformance.bench.stopping import CLOSE
from conformance.bench.timing import VISIT
from conformance.bench.visiting import all_visits
from conformance.bench.visits import (
    BASELINE,
    CLEAR,
    FAR,
    MOST_VISITS,
    Seen,
    joined,
    seen,
    to_visit,
    worth_another,
)
from conformance.bench.worker import Job
from conformance.commands.report import say_agreement, visited_once
from conformance.unit.support.tolerances import tolerance

SEED = 20_264
COUNT = VISIT.rounds


def rounds(net: Mapping[str, float], noise: float = 0.003, seed: int = SEED) -> dict[str, list[float]]:
    """A visit that finds these net times above a baseline of 1."""
    rng = np.random.default_rng(seed)
    times = {BASELINE: 0.0, **net}
    return {name: list((1.0 + t) * (1.0 + noise * rng.standard_normal(COUNT))) for name, t in times.items()}


def pair(*middles: float, width: float = 0.02) -> list[Seen]:
    """Visits that found these differences."""
    return [Seen(m, m - width, m + width) for m in middles]


def test_rounds_come_to_one_level() -> None:
    net = {"a": 1.0, "b": 1.3}
    slow = {
        name: [2.0 * t if k < COUNT // 2 else t for k, t in enumerate(v)] for name, v in rounds(net).items()
    }
    (found,) = steady([slow])
    for name, value in net.items():
        above = found[name] - found[BASELINE]
        assert above.max() < 1.1 * above.min(), "one level"
        assert np.median(above / found[BASELINE]) == pytest.approx(value, rel=tolerance("noisy_level"))
    ratio = np.asarray(slow["a"]) / np.asarray(slow["b"])
    assert found["a"] / found["b"] == pytest.approx(ratio), "ratios within a round stay"


def test_a_later_visit_of_some_members_comes_to_the_same_level() -> None:
    first, second = rounds({"a": 1.0, "b": 1.3, "c": 5.0}), rounds({"a": 1.0, "c": 5.0})
    quick = {name: [0.4 * t for t in times] for name, times in second.items()}
    levels = [np.median(visit["a"]) for visit in steady([first, quick])]
    assert levels[0] == pytest.approx(levels[1], rel=tolerance("noisy_level"))


@pytest.mark.parametrize(
    ("visits", "verdict"),
    [
        (pair(-0.9 * FAR), "undecided"),
        (pair(-1.2 * FAR), "first"),
        (pair(1.2 * FAR), "second"),
        (pair(-0.9 * CLEAR, -0.9 * CLEAR), "undecided"),
        (pair(-1.1 * CLEAR, -1.1 * CLEAR), "first"),
        (pair(-0.06, -0.06, -0.06), "first"),
        (pair(-0.06, 0.06, -0.06), "undecided"),
        (pair(-0.022, -0.022, -0.022), "undecided"),
        (pair(-0.06, -0.06, -0.06, 0.0), "first"),
        (pair(-0.06, -0.06, 0.06, -0.06, -0.06), "first"),
        (pair(-0.06, 0.06, 0.06, -0.06, -0.06), "undecided"),
        (pair(0.0, 0.01, width=0.01), "alike"),
        (pair(0.0, 0.06, width=0.01), "undecided"),
        (pair(-0.3, -0.3, 0.2), "undecided"),
    ],
)
def test_verdicts(visits: Sequence[Seen], verdict: str) -> None:
    assert joined(visits) == verdict
    mirrored = {"first": "second", "second": "first"}.get(verdict, verdict)
    assert joined([Seen(-s.middle, -s.high, -s.low) for s in visits]) == mirrored


@pytest.mark.parametrize(
    ("visits", "worth"),
    [
        (pair(-2.0), True),
        (pair(-1.1 * CLEAR, -1.1 * CLEAR), False),
        (pair(-0.06, -0.06), True),
        (pair(-0.01, -0.03), False),
        (pair(-0.06, 0.06), True),
        (pair(-0.06, 0.06, 0.06, -0.06), False),
        (pair(-0.06, -0.06, 0.0, 0.0), True),
        (pair(*[-0.06, 0.06, 0.06, -0.06, -0.06]), False),
    ],
)
def test_what_another_visit_is_worth(visits: Sequence[Seen], worth: bool) -> None:
    assert worth_another(visits) is worth


def test_a_pair_is_seen_in_the_visits_that_timed_it() -> None:
    visits = steady([rounds({"a": 1.0, "b": 1.2, "c": 9.0}), rounds({"a": 1.0, "c": 9.0})])
    assert len(seen(visits, "a", "b")) == 1
    assert len(seen(visits, "a", "c")) == 2
    assert seen(visits, "a", "b")[0].middle == pytest.approx(-0.2, abs=tolerance("noisy_level"))


def test_only_close_members_are_timed_again() -> None:
    visits = [rounds({"a": 1.0, "b": 1.07, "c": 9.0}, seed=k) for k in range(2)]
    assert to_visit(steady(visits[:1])) == ["a", "b", "c"], "one visit is not enough"
    assert to_visit(steady(visits)) == ["a", "b"]


def test_a_lost_net_time_divides_nothing_by_zero() -> None:
    visits = steady([rounds({"a": 0.0, "b": -0.01}, seed=k) for k in range(2)])
    assert all(np.isfinite(s.middle) for s in seen(visits, "a", "b"))


def test_figures_of_several_visits() -> None:
    visits = [rounds({"a": 1.0, "b": value}, noise=0.001) for value in (0.8, 0.9, 1.2)]
    found = timing(visits, "a")
    b = found.members["b"]
    assert b.ratio is not None
    assert b.ratio.median == pytest.approx(0.9, abs=tolerance("quiet_level"))
    assert b.ratio.low < 0.82 and b.ratio.high > 1.18, "the quartiles show the spread between visits"
    assert b.by_visit == pytest.approx((0.8, 0.9, 1.2), abs=tolerance("quiet_level"))
    assert found.undecided == [("a", "b")]


def test_an_order_never_contradicts_the_times_shown() -> None:
    """The base slows down for a while that the other member is not timed in."""
    rng = np.random.default_rng(SEED)
    for _ in range(100):
        visits = [rounds({"a": 1.0, "b": float(rng.uniform(0.8, 1.25))}, 0.05) for _ in range(3)]
        found = timing(visits, "a")
        verdict = joined(seen(steady(visits), "a", "b"))
        shown = found.members["a"].net_ns.median, found.members["b"].net_ns.median
        if verdict in ("first", "second") and not found.undecided:
            assert (shown[0] < shown[1]) == (verdict == "first")


class Machine:
    """Answers to jobs with made-up net times, which shift in every visit."""

    def __init__(self, net: Mapping[str, float], shift: float, seed: int) -> None:
        self.net = net
        self.shift = shift
        self.rng = np.random.default_rng(seed)
        self.asked: list[Job] = []

    def __call__(self, job: Job) -> dict[str, Any]:
        self.asked.append(job)
        names = job.again["a"]["throughput"].members if job.again else tuple(self.net)
        shifted = {name: self.net[name] * np.exp(self.shift * self.rng.standard_normal()) for name in names}
        data = {"rounds_ns": rounds(shifted, seed=int(self.rng.integers(1 << 31))), "steps": 7, "lanes": 8}
        groups = [{"base": "a", "modes": {"throughput": data}}]
        if job.again:
            return {"groups": groups}
        functions = [{"name": name, "base": "a", "speed": {}, "error": 1} for name in self.net]
        return {"functions": functions, "groups": groups, "left_out": []}


def run(machine: Machine, most: int = MOST_VISITS, seconds: float = 0.0) -> dict[str, Any]:
    job = Job("glsl", "", (), VISIT, 1, 1, 0, seconds)
    found = all_visits(job, most, machine)
    assert not isinstance(found, str)
    return found


def test_visits_go_on_where_the_order_is_open() -> None:
    machine = Machine({"a": 1.0, "b": 1.07, "c": 4.0}, 0.0, SEED)
    found = run(machine)
    timed = [job.again["a"]["throughput"].members for job in machine.asked[1:]]
    assert timed == [("a", "b", "c"), ("a", "b")]
    assert [job.again["a"]["throughput"].turn for job in machine.asked[1:]] == [1, 2]
    mode = found["groups"][0]["modes"]["throughput"]
    assert mode["undecided"] == []
    assert mode["visits"] == [{"rounds": COUNT, "members": n} for n in (3, 3, 2)]
    assert {name: len(times) // COUNT for name, times in mode["raw_ns"].items()} == {
        "a": 3,
        "b": 3,
        "c": 2,
        BASELINE: 3,
    }
    assert [f["error"] for f in found["functions"]] == [1, 1, 1]
    assert found["functions"][2]["speed"]["throughput"]["ratio"] == pytest.approx(
        4.0, rel=tolerance("noisy_level")
    )


def test_a_single_visit_leaves_close_pairs_open() -> None:
    found = run(Machine({"a": 1.0, "b": 1.1, "c": 4.0}, 0.0, SEED), most=1)
    assert found["groups"][0]["modes"]["throughput"]["undecided"] == [["a", "b"]]


def test_time_ends_the_visits_but_not_before_the_second() -> None:
    machine = Machine({"a": 1.0, "b": 1.07}, 0.0, SEED)
    clock = iter([0.0, 90.0, 200.0])
    all_visits(Job("glsl", "", (), VISIT, 1, 1, 0, 100.0), MOST_VISITS, machine, lambda: next(clock))
    assert len(machine.asked) == 2
    assert all(job.seconds > 0.0 for job in machine.asked)


def test_a_driver_that_is_not_here() -> None:
    job = Job("glsl", "", (), VISIT, 1, 1, 0, 0.0)
    assert all_visits(job, MOST_VISITS, lambda one: "no driver") == "no driver"


def test_a_later_visit_survives_the_way_to_its_worker() -> None:
    machine = Machine({"a": 1.0, "b": 1.07}, 0.0, SEED)
    run(machine)
    assert all(Job.from_json(job.to_json()) == job for job in machine.asked)


def test_a_comparison_says_that_a_report_rests_on_single_visits(capsys: pytest.CaptureFixture[str]) -> None:
    net = {"a": 1.0, "b": 1.5}
    head = {"device": {"target": "glsl", "short": "llvmpipe"}}
    once, twice = ({**run(Machine(net, 0.0, SEED), most=most), **head} for most in (1, 2))
    older = {"groups": [{"base": "a", "modes": {"throughput": {"undecided": []}}}]}
    assert [visited_once([r]) for r in (once, twice, older)] == [True, False, True]
    say_agreement([twice], [twice])
    assert "single visits" not in capsys.readouterr().out
    say_agreement([twice], [{**twice, **older}])
    assert "single visits in the earlier report" in capsys.readouterr().out


def order(data: Mapping[str, Any]) -> float | None:
    """Net time of b over a's; None where the order is open."""
    if data["groups"][0]["modes"]["throughput"]["undecided"]:
        return None
    a, b = (f["speed"]["throughput"]["net_ns"] for f in data["functions"])
    return float(b / a)


def test_two_runs_agree_where_visits_shift() -> None:
    rng = np.random.default_rng(SEED)
    differing, decided = 0, 0
    for k in range(120):
        shift = float(rng.choice([0.01, 0.02, 0.04]))
        net = {"a": 1.0, "b": float(np.exp(rng.uniform(-0.4, 0.4)))}
        first, second = (order(run(Machine(net, shift, SEED + 2 * k + n))) for n in range(2))
        found = [q for q in (first, second) if q is not None]
        if len(found) == 2 and any(max(q, 1.0 / q) > 1.0 + CLOSE for q in found):
            assert (found[0] - 1.0) * (found[1] - 1.0) > 0.0, f"{net}, shift {shift}"
        if max(net["b"], 1.0 / net["b"]) > 1.0 + CLOSE:
            differing += 1
            decided += len(found) == 2
    assert decided > 0.9 * differing, "real differences are decided"


def test_a_visit_that_contradicts_the_others_leaves_the_pair_open() -> None:
    """PoCL's kernels without a loop, as two visits have been seen to find them: 0.90 and 1.14."""
    visits: list[Rounds] = [rounds({"a": 1.0, "b": value}, seed=k) for k, value in enumerate((0.90, 1.14))]
    assert timing(visits, "a").undecided == [("a", "b")]
    more = [rounds({"a": 1.0, "b": 0.90}, seed=k) for k in (2, 3)]
    assert timing([*visits, *more], "a").undecided == [("a", "b")]
    assert timing([*visits, *more, rounds({"a": 1.0, "b": 0.91}, seed=4)], "a").undecided == []
