"""Factored shades beside the direct functions on one driver: time and error, interleaved."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.evaluate import evaluate
from codegen.evaluate.arrays import arithmetic, convert_inputs
from codegen.execute import Words, execute, on_device
from codegen.factors.maps import factor_maps
from codegen.factors.samples import directions
from codegen.library import Library
from codegen.tables.arguments import two_arguments
from codegen.tables.axes import Axis
from codegen.tables.tabulate import made
from conformance.bench import kernels
from conformance.bench.kernels import LATENCY, THROUGHPUT, Mode
from conformance.bench.ratios import net, net_ratio, spread
from conformance.bench.record import described_device, method_data, quartiles
from conformance.bench.timing import MOST_STEPS, Bench, Effort
from conformance.factored.plan import Fit, Plan
from targets import TimedRuntime
from targets.protocol import Prepared

Array = npt.NDArray[Any]

JUDGED = 20_000
"""Points at which the error is measured."""
TABLE = 256
"""Texels along a side of the strand cosine's table."""
FLOOR = "baseline of "
"""Before a member's name: the kernel that adds up its inputs in the function's place."""
MODES = (THROUGHPUT, LATENCY)


@dataclass(frozen=True)
class Member:
    """A function with the inputs that it has beside the directions: maps, scale, parameters."""

    name: str
    held: Mapping[str, Any]
    what: str


@dataclass(frozen=True)
class Rival:
    """Functions of the same value; the first is direct, and ratios are relative to it."""

    name: str
    members: tuple[Member, ...]
    drawn: Mapping[str, Array]
    exact: Array


def rivals(library: Library, plan: Plan) -> list[Rival]:
    """Every reflectance of the plan that is timed, with all its factorisations; and the table."""
    by_name: dict[str, list[Fit]] = {}
    for fit in plan.fits:
        if fit.direct:
            by_name.setdefault(fit.name, []).append(fit)
    found = [_reflectance(library, plan, name, fits) for name, fits in by_name.items()]
    return [*found, table_rival(library)]


def _reflectance(library: Library, plan: Plan, name: str, fits: list[Fit]) -> Rival:
    l, v = (w.astype(np.float32) for w in directions(JUDGED, seed=5))
    one = {"scale": np.ones(3, np.float32)}
    members = []
    for form in fits[0].direct:
        own = {p.name for p in library.function(form).parameters}
        values = {**fits[0].set, **({"diffuse": fits[0].diffuse} if "diffuse" in own else {})}
        members.append(Member(form, {**one, **{k: np.float32(x) for k, x in values.items()}}, "direct"))
    for fit in fits:
        maps = factor_maps(fit.name, fit.factors(library, plan.samples))
        sizes = f"p {fit.p}, q {fit.q}" + (f", r {fit.r}" if fit.r else "")
        members.append(Member(maps.function, maps.inputs(), sizes))
    drawn = {"l": l, "v": v}
    first = members[0]
    exact = evaluate(library, first.name, {**drawn, **first.held}, "float64")
    return Rival(name, tuple(members), drawn, np.asarray(exact))


def table_rival(library: Library) -> Rival:
    """The strand cosine from a table, and as a sum of two products."""
    _, _, function = two_arguments(library, "strand_cosine", {})
    axis = Axis("", -1.0, 1.0, "angle")
    table = made(axis, axis, function, TABLE, TABLE)
    angles = np.random.default_rng(5).uniform(-np.pi / 2, np.pi / 2, (2, JUDGED))
    cos_l, cos_v = np.sin(angles).astype(np.float32)
    x, y = cos_l.astype(np.float64), cos_v.astype(np.float64)
    exact = np.sqrt((1.0 - x) * (1.0 + x) * (1.0 - y) * (1.0 + y)) - x * y
    members = (
        Member("direct_cosine", {}, "direct"),
        Member("strand_cosine_table", {"table": np.repeat(table.values[:, :, None], 4, axis=2)}, f"{TABLE}"),
    )
    return Rival("strand cosine of two cosines", members, {"cos_l": cos_l, "cos_v": cos_v}, exact)


def measure(
    library: Library, runtime: TimedRuntime, plan: Plan, effort: Effort, say: Callable[..., None]
) -> dict[str, Any]:
    """Time and error of all rivals on a driver, as data; says how far it is."""
    chosen = rivals(library, plan)
    say("started", total=len(chosen))
    bench = Bench(library, runtime, effort)
    found = []
    for rival in chosen:
        found.append(rows(bench, rival))
        say("done", what=rival.name)
    return {
        "device": described_device(runtime.device),
        "method": {**method_data(bench), "net": "above a kernel that adds up the function's inputs instead"},
        "samples": plan.samples,
        "judged": f"{JUDGED} pairs of directions uniform over the hemisphere, for the table of angles",
        "rivals": found,
    }


def rows(bench: Bench, rival: Rival) -> dict[str, Any]:
    """Time and error of functions of one value, as data."""
    errors = [_error(bench, rival, member) for member in rival.members]
    speeds = {mode.name: _timed(bench, rival, mode) for mode in MODES}
    found = []
    for k, (member, error) in enumerate(zip(rival.members, errors, strict=True)):
        found.append(
            {
                "function": member.name,
                "maps": member.what,
                "error": error,
                "speed": {mode: speeds[mode][k] for mode in speeds},
            }
        )
    return {"name": rival.name, "members": found}


def _error(bench: Bench, rival: Rival, member: Member) -> dict[str, float]:
    """Error on the driver against the direct form in float64: rms over the mean, and the largest one."""
    inputs = {**rival.drawn, **member.held}
    got = np.asarray(execute(bench.library, member.name, inputs, bench.runtime), np.float64)
    off = np.abs(got - rival.exact)
    return {
        "rms": float(np.sqrt((off**2).mean()) / np.abs(rival.exact).mean()),
        "largest": float(off.max()),
        "not_finite": int((~np.isfinite(got)).sum()),
    }


def _timed(bench: Bench, rival: Rival, mode: Mode) -> list[dict[str, Any]]:
    """Nanoseconds per evaluation of all members above their baselines, and relative to the first."""
    given = [_given(bench, rival, member) for member in rival.members]
    steps = _steps(bench, rival, given, mode)
    with ExitStack() as stack:
        ready: dict[str, Prepared] = {}
        for k, (member, (words, maps)) in enumerate(zip(rival.members, given, strict=True)):
            ready[f"{k}"] = _prepared(bench, member.name, words, maps, steps, mode, stack)
            ready[f"{FLOOR}{k}"] = _prepared(bench, member.name, words, None, steps, mode, stack)
        rounds = bench.rounds(ready)
    scale = 1e9 / (2 * bench.lanes * mode.evaluations * steps)
    found = []
    for k in range(len(rival.members)):
        times, floor = rounds[f"{k}"], rounds[f"{FLOOR}{k}"]
        above = spread([t * scale for t in net(times, floor)])
        # Both members above their own baselines, round by round.
        mine = [t - f for t, f in zip(times, floor, strict=True)]
        first = [t - f for t, f in zip(rounds["0"], rounds[f"{FLOOR}0"], strict=True)]
        ratio = net_ratio(mine, first, [0.0] * len(mine))
        found.append(
            {
                "net_ns": above.median,
                "net_ns_quartiles": quartiles(above),
                "ratio": math.nan if ratio is None else ratio.median,
                "ratio_quartiles": None if ratio is None else quartiles(ratio),
                "rounds": len(times),
            }
        )
    return found


def _given(bench: Bench, rival: Rival, member: Member) -> tuple[Words, list[Any]]:
    function = bench.library.function(member.name)
    types = {p.name: p.type for p in function.parameters}
    inputs = {k: a[: bench.lanes] if bench.lanes <= len(a) else np.resize(a, (bench.lanes, *a.shape[1:]))
              for k, a in rival.drawn.items()}  # fmt: skip
    arrays, count = convert_inputs(types, {**inputs, **member.held}, arithmetic("float32"), member.name)
    return on_device(function, arrays, count)


def _prepared(
    bench: Bench, name: str, words: Words, maps: list[Any] | None, steps: int, mode: Mode, stack: ExitStack
) -> Prepared:
    """A kernel that evaluates the function, or its baseline where no maps are given."""
    make = kernels.baseline if maps is None else kernels.kernel
    text = make(bench.library, name, bench.runtime.device.target, mode)
    one = bench.runtime.prepare(text, kernels.words(words, steps), 1, maps or [])
    stack.callback(one.release)
    return one


def _steps(bench: Bench, rival: Rival, given: list[tuple[Words, list[Any]]], mode: Mode) -> int:
    """Steps that make a launch of the direct function last long enough."""
    steps, name = 1, rival.members[0].name
    while steps < MOST_STEPS:
        with ExitStack() as stack:
            one = _prepared(bench, name, *given[0], steps, mode, stack)
            one.launch()
            taken = min(bench.launch(one) for _ in range(2)) - bench.empty
        if taken >= 0.7 * bench.seconds:
            break
        steps = min(steps * int(np.clip(bench.seconds / max(taken, 1e-9), 2, 8)), MOST_STEPS)
    return steps
