"""Drivers by name: the catalogue, modes, processes, and the same results in every form of harness.

Plan.
  catalogue  every entry is complete, a bad one is refused with its name, files are named after versions
  opening    what answers is held against the entry; a missing file or driver is told, not raised
  forms      every form of harness and source gives a function the same inputs, in the same order
  process    one process per driver gives results; one that dies, or takes too much, costs one function;
             an interrupt ends it; replay runs one lane
Not covered here: whether functions keep their bounds (vair check --driver).
"""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

from codegen.errors import UserError
from codegen.execute import execute
from codegen.kernels import KernelOptions
from codegen.library import load_library
from conformance import cases
from conformance.check.identity import Identity
from conformance.check.result import FunctionResult
from conformance.commands import check_drivers
from conformance.drivers import run as runner
from conformance.drivers.modes import modes, modes_of
from conformance.drivers.run import run_driver
from conformance.unit.support.tolerances import floor, tolerance
from targets import Device, TargetUnavailable, open_runtime
from targets.drivers import (
    Driver,
    catalogue,
    check_match,
    driver,
    environment_of,
    parse,
    present,
    probe_driver,
)

EVERY_RUN = ("llvmpipe-fragment", "swiftshader")
"""Drivers that answer in every run; the targets' own tests use the others, or these are like them."""
GOOD = {"title": "a driver", "target": "glsl", "install": "apt", "match": {"device": "llvmpipe"}}
LLVMPIPE = Device(
    "glsl", "OpenGL 4.5", "Mesa/X.org: 4.5 (Core Profile) Mesa 22.3.6", "llvmpipe (LLVM 15.0.6)"
)
FUNCTIONS = ("to_world", "frame_from_tangent", "hammersley")
"""Structs in and out, vectors, and whole numbers."""
LANES = 131
SEED = 5


def test_catalogue_names_the_software_drivers() -> None:
    assert {d.target for d in catalogue().values()} == {"glsl", "wgsl", "opencl"}
    for known in catalogue().values():
        assert known.install and known.title
        assert known.system or known.match


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"title": None}, "driver odd lacks title"),
        ({"colour": "red"}, "driver odd has the unknown key colour"),
        ({"target": "metal"}, "driver odd is of an unknown target metal"),
        ({"match": {"index": "0"}}, "driver odd must match some of api, driver, device"),
        ({"match": {}}, "driver odd must match some of api, driver, device"),
    ],
)
def test_bad_entry_is_refused(change: dict[str, Any], sentence: str) -> None:
    entry = {key: value for key, value in {**GOOD, **change}.items() if value is not None}
    with pytest.raises(ValueError, match=sentence):
        parse({"odd": entry}, "drivers.toml")


def test_unknown_driver_is_answered_with_the_nearest() -> None:
    with pytest.raises(ValueError, match='unknown driver "swiftshade"; did you mean "swiftshader"'):
        driver("swiftshade")


def test_results_are_named_after_driver_and_version() -> None:
    assert driver("llvmpipe-compute").slug(LLVMPIPE) == "llvmpipe-compute-22.3.6"
    gpu = Device("glsl", "OpenGL 4.6", "Maker: 4.6 (550.54)", "Board 9000/PCIe")
    assert driver("system-glsl").slug(gpu) == "glsl-board-9000-pcie-maker-4.6-550.54"


def test_another_driver_than_the_one_asked_for_is_refused() -> None:
    check_match(driver("llvmpipe-compute"), LLVMPIPE)
    with pytest.raises(
        TargetUnavailable, match=r"softpipe-compute did not answer, but one with device llvmpipe"
    ):
        check_match(driver("softpipe-compute"), LLVMPIPE)


def test_missing_file_is_named_with_what_brings_it() -> None:
    absent = Driver("odd", "", "wgsl", "apt-get install odd", files={"VK_DRIVER_FILES": ("/nowhere/*.json",)})
    with pytest.raises(TargetUnavailable, match=r"none of /nowhere/\*.json is here: apt-get install odd"):
        environment_of(absent)
    assert isinstance(probe_driver(absent), TargetUnavailable)


def test_driver_answers_a_probe_or_says_why_not() -> None:
    known = driver("softpipe-fragment")
    answer = present([known.name])[known.name]
    if isinstance(answer, Device):
        check_match(known, answer)
    else:
        assert known.install in str(answer)


def test_driver_that_does_not_open_is_told() -> None:
    odd = Driver("pocl", "", "opencl", "apt-get install odd", environment={"VAIR_OPENCL_DEVICE": "no such"})
    assert isinstance(reason := probe_driver(odd), TargetUnavailable)
    assert "VAIR_OPENCL_DEVICE=no such" in str(reason) or "apt-get install" in str(reason)


def test_modes_fit_their_drivers() -> None:
    def names(driver_name: str) -> list[str]:
        return [m.name for m in modes_of(driver(driver_name), ["all"])]

    assert names("llvmpipe-compute") == ["default", "pair", "uniform", "literal", "precise"]
    assert names("llvmpipe-fragment") == ["default", "literal"]
    assert names("softpipe-compute") == ["default", "pair", "uniform", "literal"]
    assert names("lavapipe") == ["default", "pair", "uniform", "literal"]
    assert names("pocl") == [*names("lavapipe"), "fast-relaxed", "contract-off"]


@pytest.mark.parametrize("how", ["pair", "uniform", "literal"])
@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_form_gives_the_same_results(target: str, name: str, how: str) -> None:
    """Close, not equal: a compiler may reorder differently where it sees constants."""
    library = load_library()
    lanes = 11 if how == "literal" else LANES
    inputs = cases.draw(library.function(name), "uniform", lanes, SEED)
    plain = execute(library, name, inputs, open_runtime(target))
    mode = modes()[how]
    options = KernelOptions(form=mode.form, source=mode.source)  # type: ignore[arg-type]  # a table's strings
    other = execute(library, name, inputs, open_runtime(target, **mode.settings()), options=options)
    for a, b in zip(leaves(plain), leaves(other), strict=True):
        assert a.shape == b.shape
        np.testing.assert_allclose(
            a, b, rtol=tolerance("forms_of_a_program"), atol=floor("forms_of_a_program")
        )


def leaves(value: Any) -> list[Any]:
    return [x for part in value.values() for x in leaves(part)] if isinstance(value, dict) else [value]


def test_two_lanes_at_once_take_any_number_of_lanes(target: str) -> None:
    library = load_library()
    for count in (1, 2, 65):
        inputs = cases.draw(library.function("sin_angle"), "uniform", count, SEED)
        pair = execute(library, "sin_angle", inputs, open_runtime(target), options=KernelOptions(form="pair"))
        plain = execute(library, "sin_angle", inputs, open_runtime(target))
        assert np.array_equal(np.asarray(pair), np.asarray(plain))


def own_process() -> Iterator[Any]:
    """Every driver by name, some of them in the nightly run only."""
    for name, known in catalogue().items():
        if not known.system:
            yield name if name in EVERY_RUN else pytest.param(name, marks=pytest.mark.nightly)


def check(name: str, mode: str, **points: Any) -> FunctionResult:
    """sin_angle on a driver, or a skip where it does not open. The probe is left out, for time."""
    try:
        run = run_driver(driver(name), LLVMPIPE, modes()[mode], ["sin_angle"], **points)
    except TargetUnavailable as reason:
        pytest.skip(f"{name}: {reason}")
    (result,) = run.results
    return result


@pytest.mark.parametrize("name", [*own_process()])
def test_driver_checks_a_function_in_its_own_process(name: str) -> None:
    result = check(name, "default", uniform=200, family=20)
    assert result.passed, result.broken or result.failures[0].lines()
    assert result.backend == f"{name}+default"
    assert result.lanes > 200


def test_process_that_ends_costs_one_function(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runner, "MODULE", "conformance.unit.support.dying_worker")
    run = run_driver(driver("llvmpipe-compute"), LLVMPIPE, modes()["default"], ["sin_angle", "mirror"])
    assert [(r.function, r.stage) for r in run.results] == [("sin_angle", "execute"), ("mirror", "execute")]
    assert "the driver's process ended with status 3 the driver gave up" in run.results[0].broken


def test_process_that_ends_before_it_reads_its_job_costs_the_function(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A broken pipe would otherwise read as a reader of our own output that left: no failure."""
    monkeypatch.setattr(runner, "MODULE", "conformance.drivers")  # a package, which cannot be run
    more_than_a_pipe_holds = "0" * 2**20
    run = run_driver(
        driver("llvmpipe-compute"), LLVMPIPE, modes()["default"], ["sin_angle"], words=more_than_a_pipe_holds
    )
    (result,) = run.results
    assert "the driver's process ended with status 1" in result.broken


def test_process_that_someone_ends_is_no_failure_of_the_driver(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runner, "MODULE", "conformance.unit.support.dying_worker")
    monkeypatch.setenv("VAIR_TEST_SIGNAL", "SIGTERM")
    with pytest.raises(
        UserError, match="the process of llvmpipe-compute was ended from outside, by signal 15"
    ):
        run_driver(driver("llvmpipe-compute"), LLVMPIPE, modes()["default"], ["sin_angle"])


def limited(limit: str) -> tuple[int, str]:
    """Status and last line of a process that meets a limit in two ways, one after the other."""
    code = (
        "from conformance.drivers import limits\n"
        f"{limit}\n"
        "print('begins', flush=True)\n"
        "held = []\n"
        "while True:\n"
        "    held = [*held, bytearray(2**24)] if len(held) < 64 else held\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout == "begins\n"
    return done.returncode, (done.stderr.splitlines() or [""])[-1]


def test_process_is_ended_where_a_function_takes_too_long() -> None:
    assert limited("limits.limit_time(1)") == (-signal.SIGXCPU, "")


def test_process_gets_no_more_memory_than_it_may_hold() -> None:
    assert limited("limits.limit_memory(2**29)") == (1, "MemoryError")


def test_driver_that_takes_too_long_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runner, "MODULE", "conformance.unit.support.dying_worker")
    monkeypatch.setenv("VAIR_TEST_SIGNAL", "SIGXCPU")
    run = run_driver(driver("llvmpipe-compute"), LLVMPIPE, modes()["default"], ["sin_angle"])
    assert run.results[0].broken == "does not execute: the driver took more than 120 s of processor time"


def test_processes_are_ended_where_the_check_is_interrupted(monkeypatch: pytest.MonkeyPatch) -> None:
    """A driver deep in its own code hears no interrupt: it would go on, and hold its memory, alone."""
    monkeypatch.setattr(runner, "MODULE", "conformance.unit.support.dying_worker")
    monkeypatch.setenv("VAIR_TEST_SIGNAL", "none")
    monkeypatch.setattr(check_drivers, "find_drivers", lambda _: ({"llvmpipe-compute": LLVMPIPE}, []))
    started: list[Future[Any]] = []

    class Interrupted(ThreadPoolExecutor):
        def map(self, function: Any, *arguments: Any, **_: Any) -> Any:  # type: ignore[override]
            started.extend(self.submit(function, name) for name in arguments[0])
            while not runner._RUNNING:
                time.sleep(0.01)
            raise KeyboardInterrupt

    monkeypatch.setattr(check_drivers, "ThreadPoolExecutor", Interrupted)
    with pytest.raises(KeyboardInterrupt):
        check_drivers.check_drivers(
            check_drivers.Plan(load_library(), ["sin_angle"]), ("llvmpipe-compute",), ()
        )
    assert "was ended from outside, by signal 15" in str(started[0].exception())
    assert not runner._RUNNING


def test_replay_runs_one_lane() -> None:
    identity = Identity("sin_angle", "llvmpipe-compute+pair", "uniform", 50, SEED, 7)
    assert Identity.parse(str(identity)) == identity
    result = check("llvmpipe-compute", "pair", replay=identity)
    assert result.lanes == 1
    assert result.passed


def test_replay_runs_the_input_of_a_record() -> None:
    """A record brings its words, so that it outlives the family that it was drawn from."""
    identity = Identity("sin_angle", "llvmpipe-compute+default", "gone", 50, SEED, 7)
    words = "a=3f800000 00000000 00000000;b=00000000 3f800000 00000000"
    result = check("llvmpipe-compute", "default", replay=identity, words=words)
    assert (result.lanes, result.passed) == (1, True)
    assert next(b.worst for b in result.bounds if b.lanes).startswith("a = (1, 0, 0) [3f800000")
    assert result.permitted is not None
    assert (result.permitted.table, result.permitted.inside) == ("glsl", 1)


@pytest.mark.parametrize(("mode", "table"), [("default", "opencl"), ("fast-relaxed", "opencl_relaxed")])
def test_mode_chooses_the_table(mode: str, table: str) -> None:
    result = check("pocl", mode, uniform=100, family=10)
    assert result.permitted is not None
    assert result.permitted.table == table
    assert result.passed
