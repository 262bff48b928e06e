"""Whether the harness measures what it says. Reported beside the figures, never asserted."""

from __future__ import annotations

import numpy as np

from codegen.execute import Words
from conformance.bench import kernels
from conformance.bench.inputs import Group
from conformance.bench.kernels import LATENCY, THROUGHPUT, Mode
from conformance.bench.ratios import net, straightness
from conformance.bench.timing import Bench

EXPECTED = {"straight": 1.0, "same": 1.0, "doubled latency": 2.0, "doubled throughput": 2.0}
MEANING = {
    "straight": "time at the middle of three step counts over the chord between the outer two",
    "same": "time of a text over that of the same text",
    "doubled latency": "net time with every evaluation made twice over that with one, one chain",
    "doubled throughput": "the same with eight chains; a short function partly hides in the loop",
}


def self_checks(bench: Bench, group: Group) -> dict[str, float]:
    """The checks on one function."""
    library, name, target = bench.library, group.base.name, bench.runtime.device.target
    single = kernels.kernel(library, name, target, THROUGHPUT)
    words = bench.words(group, THROUGHPUT)
    steps = max(bench.steps(single, words, THROUGHPUT), 2)
    with bench.prepared({"one": single, "other": single}, words, steps) as ready:
        times = bench.rounds(ready)
    return {
        "straight": _straight(bench, single, words, (steps // 2, steps, 2 * steps)),
        "same": float(np.median(np.divide(times["other"], times["one"]))),
        "doubled latency": _doubled(bench, group, LATENCY),
        "doubled throughput": _doubled(bench, group, THROUGHPUT),
    }


def _doubled(bench: Bench, group: Group, mode: Mode) -> float:
    library, name, target = bench.library, group.base.name, bench.runtime.device.target
    texts = {}
    for repeats in (1, 2):
        texts[f"full {repeats}"] = kernels.kernel(library, name, target, mode, repeats)
        texts[f"empty {repeats}"] = kernels.baseline(library, name, target, mode, repeats)
    words = bench.words(group, mode)
    with bench.prepared(texts, words, bench.steps(texts["full 1"], words, mode)) as ready:
        times = bench.rounds(ready)
    once, twice = (net(times[f"full {n}"], times[f"empty {n}"]) for n in (1, 2))
    return float(np.median(twice) / np.median(once))


def _straight(bench: Bench, text: str, words: Words, counts: tuple[int, int, int]) -> float:
    ready = {str(n): bench.runtime.prepare(text, kernels.words(words, n), 1) for n in counts}
    try:
        times = bench.rounds(ready)
    finally:
        for one in ready.values():
            one.release()
    return straightness(counts, [float(np.median(times[str(n)])) for n in counts])
