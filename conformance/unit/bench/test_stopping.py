"""Rounds stop when the order of every two members is known; two such runs agree. Timings are synthetic.

Plan.
  one pair      clear differences are decided, equal members are alike, noise or few rounds leave it open
  two runs      over many pairs with the noise, outliers and drift of a busy machine, two runs that stop by
                the rule never contradict each other on a pair that differs by more than CLOSE
  cost          wide quartiles ask for more rounds than narrow ones
  reports       agreement() finds contradictions, and passes over pairs that are open
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from conformance.bench.stopping import CLOSE, compare, median_interval, settled, undecided
from conformance.report.agreement import agreement

LEAST, MOST = 16, 48
BASELINE = ""
SEED = 20_263


def rounds(
    rng: np.random.Generator, net: dict[str, float], noise: float, count: int
) -> dict[str, list[float]]:
    """Seconds per round: a common drift, noise of every launch, and one launch in twelve disturbed."""
    drift = 1.0 + 0.2 * np.sin(np.linspace(0.0, 6.0, count))
    found = {}
    for name, value in {BASELINE: 0.0, **net}.items():
        times = (1.0 + value) * drift * (1.0 + noise * rng.standard_normal(count))
        disturbed = rng.random(count) < 1.0 / 12.0
        found[name] = list(np.where(disturbed, times * rng.uniform(1.1, 2.0, count), times))
    return found


def run(rng: np.random.Generator, net: dict[str, float], noise: float) -> tuple[dict[str, list[float]], int]:
    """A measurement that stops by the rule: its rounds, and how many they are."""
    whole = rounds(rng, net, noise, MOST)
    for count in range(LEAST, MOST + 1):
        so_far = {name: times[:count] for name, times in whole.items()}
        if settled(so_far, BASELINE):
            break
    return so_far, count


def test_the_interval_of_a_median() -> None:
    assert median_interval([1.0] * 7) == (-np.inf, np.inf), "seven rounds tell too little"
    assert median_interval(list(range(8))) == (0.0, 7.0)
    low, high = median_interval(list(range(48)))
    assert 0.0 < low < 23.5 < high < 47.0


def test_one_pair() -> None:
    floor = [1.0] * 20
    assert compare([2.0] * 20, [2.2] * 20, floor) == "first"
    assert compare([2.2] * 20, [2.0] * 20, floor) == "second"
    assert compare([2.0] * 20, [2.0] * 20, floor) == "alike"
    wild = list(np.tile([1.5, 2.5], 10))
    assert compare(wild, [2.0] * 20, floor) == "undecided"
    assert compare([2.0] * 4, [2.2] * 4, floor[:4]) == "undecided"


def test_two_runs_agree() -> None:
    rng = np.random.default_rng(SEED)
    differing, decided = 0, 0
    for _ in range(150):
        net = {
            "a": 1.0,
            "b": float(np.exp(rng.uniform(-0.5, 0.5))),
            "c": float(np.exp(rng.uniform(-0.5, 0.5))),
        }
        noise = float(rng.choice([0.002, 0.01, 0.03]))
        first, second = (run(rng, net, noise)[0] for _ in range(2))
        for a, b in (("a", "b"), ("a", "c"), ("b", "c")):
            if max(net[a] / net[b], net[b] / net[a]) <= 1.0 + CLOSE:
                continue
            differing += 1
            verdicts = [compare(r[a], r[b], r[BASELINE]) for r in (first, second)]
            assert set(verdicts) != {"first", "second"}, f"{net}, noise {noise}"
            decided += "undecided" not in verdicts and "alike" not in verdicts
    assert decided > 0.8 * differing


def test_noise_asks_for_more_rounds() -> None:
    net = {"a": 1.0, "b": 1.1}
    quiet, busy = (
        np.mean([run(np.random.default_rng([SEED, k]), net, noise)[1] for k in range(20)])
        for noise in (0.002, 0.04)
    )
    assert LEAST <= quiet < busy


def test_open_pairs_are_named() -> None:
    times = rounds(np.random.default_rng(SEED), {"a": 1.0, "b": 1.001, "c": 3.0}, 0.02, LEAST)
    assert ("a", "b") in undecided(times, BASELINE)
    assert ("a", "c") not in undecided(times, BASELINE)


def result(net: dict[str, float], open_pairs: list[list[str]]) -> dict[str, Any]:
    speed = {name: {"throughput": {"net_ns": value}} for name, value in net.items()}
    return {
        "device": {"target": "glsl", "short": "llvmpipe"},
        "functions": [{"name": name, "base": "a", "speed": s} for name, s in speed.items()],
        "groups": [{"base": "a", "modes": {"throughput": {"undecided": open_pairs}}}],
    }


@pytest.mark.parametrize(
    ("before", "open_pairs", "differ", "contradictions"),
    [
        ({"a": 1.0, "b": 2.0}, [], 1, 0),
        ({"a": 1.0, "b": 0.9}, [], 1, 1),
        ({"a": 1.0, "b": 0.9}, [["a", "b"]], 1, 0),
        ({"a": 1.0}, [], 0, 0),
    ],
)
def test_agreement_of_two_reports(
    before: dict[str, float], open_pairs: list[list[str]], differ: int, contradictions: int
) -> None:
    found = agreement([result({"a": 1.0, "b": 1.2}, [])], [result(before, open_pairs)])
    assert found.differ == differ
    assert len(found.contradictions) == contradictions


def test_close_pairs_may_come_in_any_order() -> None:
    found = agreement([result({"a": 1.0, "b": 1.02}, [])], [result({"a": 1.0, "b": 0.98}, [])])
    assert found.differ == 0
