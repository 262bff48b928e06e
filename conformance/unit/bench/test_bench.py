"""The benchmark measures: kernels build and keep their inputs, statistics are right, tables come out.

Plan. No test asserts a speed.
  kernels     all modes and the baseline build and run on every target, for a function of scalars, of
              vectors, of structs and of integers; eps = 0 leaves the result what the function gives
  measuring   a tiny case gives positive times and a ratio of 1 for the base; the self-checks are numbers
  statistics  quartiles and net ratios of synthetic rounds with a common drift; a lost reference gives none
  inputs      groups are complete; a bound cuts the domains that it names; inputs lie in all members' domains
              and lead to no number below the normal ones, which would take a hundred times as long
  records     rounding, names of files, the README's table and the cost of `vair list`, from a small result
  choice      errors over the base's whole domain know of narrower members and of declared bounds
Not covered here: when rounds stop (test_stopping.py), the report and its command (../report/test_report.py).
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from codegen.bounds import Bound
from codegen.costs import SCHEMA, costs, recorded
from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.evaluate.arrays import arithmetic, convert_inputs
from codegen.execute import Words, flatten, unflatten
from codegen.ir.domains import Interval
from codegen.ir.types import leaves
from codegen.library import Library, load_library
from codegen.readme import speed
from conformance import cases, peers
from conformance.bench import kernels
from conformance.bench.accuracy import ulps
from conformance.bench.emission import emit
from conformance.bench.figures import Figure
from conformance.bench.inputs import declared, groups, lanes, within
from conformance.bench.joining import timing
from conformance.bench.kernels import FLAT, LATENCY, THROUGHPUT, Mode
from conformance.bench.normal import normal_lanes
from conformance.bench.ratios import net_ratio, spread, straightness
from conformance.bench.record import (
    as_json,
    function_data,
    method_data,
    rounded,
    slug,
    timing_data,
)
from conformance.bench.run import Options, places, schedule
from conformance.bench.selfcheck import EXPECTED, self_checks
from conformance.bench.timing import Again, Bench, Effort
from conformance.bench.vectorised import by_construction, from_remarks
from conformance.bench.visits import BASELINE
from conformance.bench.whole import whole
from conformance.bench.worker import Job
from conformance.check.engine import backend
from conformance.unit.support.results import small_result
from targets import Device, TimedRuntime

SHAPES = ("safe_pow", "sin_angle", "fakefur_shade", "pcg_hash")
"""Scalars; vectors; structs; integers."""
TINY = Effort(rounds=3, most=3, seconds=2e-4, launches=0.0)
LANES = 64
STEPS = 3


@pytest.fixture(scope="module")
def library() -> Library:
    return load_library()


def words_of(library: Library, name: str) -> Words:
    function = library.function(name)
    drawn = cases.draw(function, cases.UNIFORM, LANES, 1)
    types = {p.name: p.type for p in function.parameters}
    arrays, count = convert_inputs(types, drawn, arithmetic("float32"), name)
    return flatten(list(arrays.values()), count)


@pytest.mark.parametrize("mode", [LATENCY, THROUGHPUT, FLAT], ids=lambda mode: mode.name)
@pytest.mark.parametrize("name", SHAPES)
def test_kernels_build_and_run(library: Library, runtime: TimedRuntime, name: str, mode: Mode) -> None:
    target = runtime.device.target
    given = kernels.words(words_of(library, name), STEPS)
    for text in (kernels.kernel(library, name, target, mode), kernels.baseline(library, name, target, mode)):
        prepared = runtime.prepare(text, given, 1)
        try:
            prepared.launch()
            assert prepared.read().shape == (1, LANES)
        finally:
            prepared.release()


@pytest.mark.parametrize("name", ["sin_angle", "pcg_hash"])
def test_a_chain_ends_with_the_functions_own_value(
    library: Library, runtime: TimedRuntime, name: str
) -> None:
    """eps and the mask are 0, so that the last evaluation sees the inputs unchanged."""
    words = words_of(library, name)
    direct = kernels.kernel(library, name, runtime.device.target, FLAT_ONE)
    chained = kernels.kernel(library, name, runtime.device.target, LATENCY)
    once = runtime.run(direct, kernels.words(words, 1), 1)
    assert np.array_equal(runtime.run(chained, kernels.words(words, STEPS), 1), once)


FLAT_ONE = Mode("flat", 1, looped=False)


def test_tiny_measurement(library: Library, runtime: TimedRuntime) -> None:
    bench = Bench(library, runtime, TINY)
    (group,) = groups(library, ["strand_specular"])
    first = bench.group(group, THROUGHPUT)
    some = tuple(f.name for f in group.members[:2])
    second = bench.group(group, THROUGHPUT, again=Again(some, first.steps, first.lanes, 1))
    assert (second.steps, second.lanes) == (first.steps, first.lanes)
    assert list(second.rounds_ns) == [*some, BASELINE]
    found = timing([first.rounds_ns, second.rounds_ns], group.base.name).members
    assert {len(rounds) for rounds in first.rounds_ns.values()} == {TINY.rounds}
    assert set(found) == {f.name for f in group.members}
    for member in found.values():
        assert member.gross_ns > 0.0
        assert np.isfinite([member.net_ns.low, member.net_ns.median, member.net_ns.high]).all()
    own = found[group.base.name].ratio
    assert own is None or (own.low, own.median, own.high) == (1.0, 1.0, 1.0)


def test_self_checks_are_numbers(library: Library, runtime: TimedRuntime) -> None:
    (group,) = groups(library, ["sin_angle"])
    checks = self_checks(Bench(library, runtime, TINY), group)
    assert set(checks) == set(EXPECTED)
    assert np.isfinite(list(checks.values())).all()


def test_quartiles() -> None:
    found = spread([5.0, 1.0, 3.0, 2.0, 4.0])
    assert (found.low, found.median, found.high) == (2.0, 3.0, 4.0)


def test_net_ratio_ignores_a_common_drift() -> None:
    drift = np.linspace(1.0, 3.0, 20)
    found = net_ratio(list(7.0 * drift), list(5.0 * drift), list(1.0 * drift))
    assert found is not None
    assert np.allclose([found.low, found.median, found.high], 1.5)


def test_no_ratio_to_a_reference_that_is_lost() -> None:
    assert net_ratio([2.0, 2.0], [1.001, 0.999], [1.0, 1.0]) is None


def test_straightness() -> None:
    assert straightness((10, 20, 40), (1.0, 2.0, 4.0)) == pytest.approx(1.0)
    assert straightness((10, 20, 40), (1.0, 3.0, 4.0)) == pytest.approx(1.5)


def test_groups_are_complete(library: Library) -> None:
    found = groups(library)
    members = [f.name for group in found for f in group.members]
    assert len(members) == len(set(members))
    assert {f.name for f in library.public.values() if f.base is not None} <= set(members)
    assert groups(library, ["sin_angle_cosine"]) == groups(library, ["sin_angle"])


def test_a_bound_cuts_the_domains_it_names(library: Library) -> None:
    function = library.function("strand_specular")
    bounds = [
        Bound(function.name, "absolute", 1.0, "", "", where={"exponent": (1.0, 1.0)}),
        Bound(
            function.name,
            "absolute",
            1.0,
            "",
            "",
            where={"exponent": (1.0, 1000.0), "angle(l, t)": (0.1, 1.0)},
        ),
    ]
    inside, chosen = within(function, bounds)
    assert chosen is bounds[1]
    domain = next(p.domain for p in inside.parameters if p.name == "exponent")
    assert isinstance(domain, Interval)
    assert (domain.low, domain.high) == (1.0, 1000.0)
    assert within(function, bounds[:1]) == (function, None)


def test_inputs_suit_all_members(library: Library) -> None:
    for group in groups(library):
        words = lanes(library, group, LANES)
        slots = sum(len(leaves(p.type)) for p in group.base.parameters)
        assert words.shape == (slots, LANES), group.base.name
        drawn = cases.draw(declared(library, group)[0], cases.UNIFORM, LANES, 1)
        assert evaluate(library, group.base.name, drawn) is not None


def test_a_tiny_number_on_the_way_is_seen(library: Library) -> None:
    q = np.array([0.0, 1e-25, 1e-3, 0.9], np.float32)  # (q / 2)^2 is 2.5e-51 at the second
    assert normal_lanes(library, "log_one_minus", {"q": q}).tolist() == [True, False, True, True]


@pytest.mark.parametrize("name", ["log_one_minus", "fakefur_shade"])
def test_timing_inputs_give_normal_numbers(library: Library, name: str) -> None:
    [group] = groups(library, [name])
    words, values = lanes(library, group, 256), []
    for p in group.base.parameters:
        count = len(leaves(p.type))
        values.append(unflatten(p.type, words[:count]))
        words = words[count:]
    for f in group.members:
        given = dict(zip((p.name for p in f.parameters), values, strict=True))
        assert normal_lanes(library, f.name, given).all()


def test_recorded_results_reach_the_readme_and_the_list(library: Library, tmp_path: Path) -> None:
    result = small_result(library)
    assert slug(result["device"]) == "glsl-llvmpipe"
    assert speed(library, tmp_path / "nothing") == ""
    (tmp_path / "glsl-llvmpipe.json").write_text(json.dumps(result), encoding="utf-8")
    table = speed(library, tmp_path)
    assert "| `sin_angle` | relative | 1 ns | 1e-07 |" in table
    assert "| `sin_angle_half` | relative | x 0.50 | 1e-06 |" in table
    assert recorded(tmp_path)[0]["schema"] == SCHEMA
    (entry,) = costs(library, library.function("sin_angle"), tmp_path)
    assert entry["driver"] == "llvmpipe"
    assert entry["current"]
    assert costs(library, library.function("pcg_hash"), tmp_path) == []


def test_a_result_of_another_schema_is_refused(library: Library, tmp_path: Path) -> None:
    (tmp_path / "old.json").write_text('{"schema": 0}', encoding="utf-8")
    with pytest.raises(UserError, match=r"old\.json"):
        speed(library, tmp_path)


def test_rounding() -> None:
    assert rounded({"a": [1.23456789, float("inf")], "b": (3, None)}) == {"a": [1.235, None], "b": [3, None]}


def test_figures_are_met_up_to_their_goal() -> None:
    assert Figure("x", "", "", 1.0, 1.0, "").met is True
    assert Figure("x", "", "", 1.0, 1.1, "").met is False
    assert Figure("x", "", "", 1.0, float("nan"), "").met is False
    assert Figure("x", "", "", None, 1.0, "").met is None


def test_a_job_survives_the_way_to_its_worker() -> None:
    o = Options.quick(("sin_angle",))
    job = Job("glsl", "llvmpipe-compute", o.functions, o.effort, o.uniform, o.family, o.figures, o.seconds)
    assert Job.from_json(job.to_json()) == job


def test_timing_data_without_a_ratio(library: Library, runtime: TimedRuntime) -> None:
    bench = Bench(library, runtime, TINY)
    (group,) = groups(library, ["sin_angle"])
    found = timing([bench.group(group, LATENCY).rounds_ns], group.base.name)
    data = timing_data(found.members[group.base.name])
    assert set(data) == {
        "net_ns",
        "net_ns_quartiles",
        "gross_ns",
        "ratio",
        "ratio_quartiles",
        "ratio_by_visit",
    }
    assert method_data(bench)["rounds"] == [TINY.rounds, TINY.most]


def test_emission_is_measured_and_repeats() -> None:
    runs = [emit(["--target", "glsl", "--function", "sin_angle"], hash_seed=seed) for seed in ("0", "1")]
    assert runs[0].digest == runs[1].digest
    assert all(min(run.wall, run.user, run.megabytes) > 0.0 for run in runs)


def test_errors_over_the_whole_domain(library: Library) -> None:
    on = backend("numpy")
    sines = whole(library, groups(library, ["sin_angle"])[0], on, uniform=500, family=50)
    assert sines["sin_angle"].largest["absolute"] <= sines["sin_angle"].declared["absolute"]
    powers = whole(library, groups(library, ["pow_one_minus"])[0], on, uniform=500, family=50)
    narrow = powers["pow_one_minus_sq16"]
    assert narrow.narrower and not narrow.largest, "a variant that accepts less cannot stand for its base"
    printed = groups(library, ["strand_cosine"])[0]
    assert not any(library.function(n).kind == "printed" for n in whole(library, printed, on, 50, 10))


def test_ulp_of_vectors_are_those_of_the_largest_component() -> None:
    expected = np.array([[1.0, 1e-9, 0.0]])
    got = np.array([[1.0, 1e-9, 2.0**-23]], np.float32)
    assert ulps(got, expected, 2.0**-126) == pytest.approx([1.0])
    assert ulps(np.array([2.0**-40], np.float32), np.zeros(1), 2.0**-24) == pytest.approx([2.0**7])


@pytest.mark.parametrize(
    ("text", "lanes"),
    [
        ("<unknown>:0:0: vectorized loop (vectorization width: 8, interleaved count: 1)", 8),
        ("<unknown>:0:0: loop not vectorized: call instruction cannot be vectorized<unknown>:0:0: x", 1),
        ("", None),
    ],
)
def test_remarks_of_the_compiler(text: str, lanes: int | None) -> None:
    assert from_remarks(text).lanes == lanes


def test_software_drivers_vectorise_by_construction() -> None:
    mesa = Device("glsl", "OpenGL 4.5", "Mesa 22.3.6", "llvmpipe (LLVM 15.0.6, 256 bits)")
    assert by_construction(mesa).lanes == 8
    assert by_construction(Device("opencl", "OpenCL 3.0", "some GPU", "some GPU")).lanes is None


def test_drivers_are_queued_by_weight() -> None:
    queues = schedule(places(("glsl", "wgsl", "opencl"), ()), 2, 70.0)
    assert [[p.target for p, _ in queue] for queue in queues] == [["opencl"], ["wgsl", "glsl"]]
    assert all(sum(seconds for _, seconds in queue) == pytest.approx(70.0) for queue in queues)
    with pytest.raises(UserError, match="cannot be timed"):
        places((), ("softpipe-compute",))
    with pytest.raises(UserError, match='did you mean "lavapipe"'):
        places((), ("lavapip",))


def test_peers_are_members_that_stand_for_nothing() -> None:
    whole_library = peers.library()
    (group,) = groups(whole_library, ["sin_angle"])
    (foreign,) = [f for f in group.members if f.name in peers.PEERS]
    assert function_data(whole_library, foreign, "sin_angle")["kind"] == "peer"
    assert foreign.name not in whole(whole_library, group, backend("numpy"), 20, 5)


def test_a_recorded_file_has_a_line_per_function(library: Library) -> None:
    result = small_result(library)
    text = as_json(result)
    assert json.loads(text) == result
    for f in result["functions"]:
        assert sum(f'"name": "{f["name"]}"' in line for line in text.splitlines()) == 1
