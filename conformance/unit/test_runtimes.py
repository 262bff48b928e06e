"""Every runtime moves words unchanged, computes, reports what fails, and says what it runs on."""

import sys
import weakref
from concurrent.futures import ThreadPoolExecutor
from importlib import import_module
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from targets import (
    TARGETS,
    BuildFailed,
    TargetUnavailable,
    TimedRuntime,
    forget_programs,
    open_runtime,
)
from targets.harness import complete_program
from targets.lanes import GROUP_LANES, MAX_GROUPS, UNWRITTEN, chunk_lanes
from targets.programs import Programs
from targets.words import Words

COPY = "    store_u32(0, load_u32(0));\n"
SQUARE_ROOT = "    store_f32(0, sqrt(load_f32(0)));\n"
LANES = 1_000_000
SEED = 20240607

# WGSL and Vulkan derive sqrt from 1 / inverseSqrt, 2 ulp and the 2.5 ulp of a division; OpenCL promises 3.
SQUARE_ROOT_ULP = 5.0

PACKAGES = {"glsl": "moderngl", "wgsl": "wgpu", "opencl": "pyopencl"}
DEBIAN_PACKAGES = {"glsl": "libegl1 libgl1", "wgsl": "mesa-vulkan-drivers", "opencl": "pocl-opencl-icd"}

LIBRARIES = {
    "glsl": "float twice(float x)\n{\n    return x + x;\n}\n",
    "wgsl": "fn twice(x: f32) -> f32 {\n    return x + x;\n}\n",
    "opencl": "static float twice(float x)\n{\n    return x + x;\n}\n",
}


def added(target: str, number: int) -> str:
    """A program that adds a number to every word."""
    return complete_program(target, "", f"    store_u32(0, load_u32(0) + {number}u);\n")


def every_kind_of_word() -> Words:
    """Zeros, denormals, normals, infinities, quiet and signalling NaNs of both signs; random words."""
    kinds = np.array(
        [
            *(0x00000000, 0x00000001, 0x00400000, 0x007FFFFF, 0x00800000, 0x3F800000, 0x7F7FFFFF),
            *(0x7F800000, 0x7F800001, 0x7FBFFFFF, 0x7FC00000, 0x7FC12345, 0x7FFFFFFF, UNWRITTEN),
        ],
        np.uint32,
    )
    random = np.random.default_rng(SEED).integers(0, 2**32, 1000, dtype=np.uint32)
    return np.concatenate([kinds, kinds | np.uint32(0x80000000), random])[np.newaxis]


def finite_floats(count: int) -> Words:
    """Normal numbers of both signs over many magnitudes, as words."""
    generator = np.random.default_rng(SEED)
    values = generator.choice([-1.0, 1.0], count) * 2.0 ** generator.uniform(-120.0, 120.0, count)
    return values.astype(np.float32).view(np.uint32)[np.newaxis]


def test_words_pass_unchanged(target: str, runtime: TimedRuntime) -> None:
    words = every_kind_of_word()
    body = COPY + "    store_i32(1, load_i32(0));\n    store_bool(2, load_bool(0));\n"
    out = runtime.run(complete_program(target, "", body), words, 3)
    assert np.array_equal(out[0], words[0])
    assert np.array_equal(out[1], words[0])
    assert np.array_equal(out[2], (words[0] != 0).astype(np.uint32))


def test_finite_floats_pass_unchanged(target: str, runtime: TimedRuntime) -> None:
    words = finite_floats(1000)
    out = runtime.run(complete_program(target, "", "    store_f32(0, load_f32(0));\n"), words, 1)
    assert np.array_equal(out, words)


def test_square_roots_of_a_million_lanes(target: str, runtime: TimedRuntime) -> None:
    values = np.abs(finite_floats(LANES).view(np.float32))
    out = runtime.run(complete_program(target, "", SQUARE_ROOT), values.view(np.uint32), 1).view(np.float32)
    exact = np.sqrt(values.astype(np.float64))
    assert np.all(np.abs(out - exact) <= SQUARE_ROOT_ULP * np.spacing(exact.astype(np.float32)))


def test_library_function_is_called(target: str, runtime: TimedRuntime) -> None:
    program = complete_program(target, LIBRARIES[target], "    store_f32(0, twice(load_f32(0)));\n")
    words = finite_floats(100)
    assert np.array_equal(runtime.run(program, words, 1).view(np.float32), 2 * words.view(np.float32))


@pytest.mark.parametrize("count", [0, 1, GROUP_LANES - 1, GROUP_LANES, GROUP_LANES + 1, 1000])
def test_any_number_of_lanes(target: str, runtime: TimedRuntime, count: int) -> None:
    words = finite_floats(count)
    out = runtime.run(complete_program(target, "", COPY), words, 1)
    assert out.dtype == np.uint32
    assert np.array_equal(out, words)


def test_several_words_per_lane_are_not_mixed_up(target: str, runtime: TimedRuntime) -> None:
    words = np.arange(3 * 77, dtype=np.uint32).reshape(3, 77)
    body = "".join(f"    store_u32({k}, load_u32({(k + 1) % 3}));\n" for k in range(3))
    out = runtime.run(complete_program(target, "", body), words, 3)
    assert np.array_equal(out, words[[1, 2, 0]])


def test_columns_of_a_larger_array_are_accepted(target: str, runtime: TimedRuntime) -> None:
    words = np.arange(200, dtype=np.uint32).reshape(2, 100)[:, 10:90:2]
    body = COPY + "    store_u32(1, load_u32(1));\n"
    assert np.array_equal(runtime.run(complete_program(target, "", body), words, 2), words)


def test_program_without_input(target: str, runtime: TimedRuntime) -> None:
    program = complete_program(target, "", "    store_i32(0, -7);\n")
    out = runtime.run(program, np.empty((0, 70), np.uint32), 1)
    assert np.array_equal(out.view(np.int32), np.full((1, 70), -7))


def test_word_that_nothing_writes_is_marked(target: str, runtime: TimedRuntime) -> None:
    out = runtime.run(complete_program(target, "", COPY), finite_floats(70), 2)
    assert np.array_equal(out[1], np.full(70, UNWRITTEN, np.uint32))


def test_chunks_make_no_difference(
    target: str, runtime: TimedRuntime, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(runtime, "chunk_bytes", 4 * 2 * GROUP_LANES)
    words = np.arange(2 * 1000, dtype=np.uint32).reshape(2, 1000)
    body = COPY + "    store_u32(1, load_u32(1));\n"
    assert np.array_equal(runtime.run(complete_program(target, "", body), words, 2), words)


def test_two_programs_take_turns(target: str, runtime: TimedRuntime) -> None:
    copy = complete_program(target, "", COPY)
    invert = complete_program(target, "", "    store_u32(0, ~load_u32(0));\n")
    words = every_kind_of_word()
    for _ in range(2):
        assert np.array_equal(runtime.run(copy, words, 1), words)
        assert np.array_equal(runtime.run(invert, words, 1), ~words)


def test_text_is_built_once(target: str, runtime: TimedRuntime) -> None:
    kept: Programs[Any, Any] = vars(runtime)["_programs"]
    program = added(target, 12345)
    words = every_kind_of_word()
    runtime.run(program, words, 1)
    before = list(vars(kept)["_kept"].values())
    runtime.run(program, words, 1)
    assert list(map(id, vars(kept)["_kept"].values())) == list(map(id, before))


def test_few_programs_are_kept(target: str, runtime: TimedRuntime, monkeypatch: pytest.MonkeyPatch) -> None:
    kept: Programs[Any, Any] = Programs(most=2)
    monkeypatch.setattr(runtime, "_programs", kept)
    words = every_kind_of_word()
    first = runtime.prepare(added(target, 0), words, 1)
    dropped = []
    for number in range(5):
        out = runtime.run(added(target, number), words, 1)
        assert np.array_equal(out, words + np.uint32(number))
        assert len(kept) <= 2
        dropped.append(weakref.ref(next(reversed(vars(kept)["_kept"].values()))))
    assert [reference() is None for reference in dropped[1:]] == [True, True, False, False]
    first.launch()  # dropped from what is kept, and still held by what was prepared with it
    assert np.array_equal(first.read(), words)
    first.release()


def test_programs_are_forgotten(target: str, runtime: TimedRuntime, monkeypatch: pytest.MonkeyPatch) -> None:
    kept: Programs[Any, Any] = Programs()
    monkeypatch.setattr(runtime, "_programs", kept)
    words = every_kind_of_word()
    for number in (0, 1):
        runtime.run(added(target, number), words, 1)
    (first, second) = (weakref.ref(program) for program in vars(kept)["_kept"].values())
    forget_programs()
    assert len(kept) == 0 and first() is None and second() is None
    assert np.array_equal(runtime.run(added(target, 1), words, 1), words + np.uint32(1))
    assert len(kept) == 1


def test_the_program_not_asked_for_longest_is_dropped() -> None:
    kept: Programs[str, object] = Programs(most=2)
    built: list[str] = []
    for key in ("a", "b", "a", "c", "a", "b"):
        kept.find(key, lambda key=key: built.append(key))  # type: ignore[misc]
    assert built == ["a", "b", "c", "b"]
    assert len(kept) == 2


def test_threads_share_a_runtime(target: str, runtime: TimedRuntime) -> None:
    programs = [
        complete_program(target, "", f"    store_u32(0, load_u32(0) ^ {number}u);\n") for number in range(4)
    ]
    words = every_kind_of_word()
    with ThreadPoolExecutor(max_workers=4) as threads:
        results = list(threads.map(lambda program: runtime.run(program, words, 1), programs))
    for number, out in enumerate(results):
        assert np.array_equal(out, words ^ np.uint32(number))


def test_prepared_program_launches_again(target: str, runtime: TimedRuntime) -> None:
    words = every_kind_of_word()
    prepared = runtime.prepare(complete_program(target, "", COPY), words, 1)
    try:
        prepared.launch()
        prepared.launch()
        assert np.array_equal(prepared.read(), words)
    finally:
        prepared.release()


def test_build_failure_has_the_log(target: str, runtime: TimedRuntime) -> None:
    program = complete_program(target, "", "    store_u32(0, undeclared_name);\n")
    line = program[: program.index("undeclared_name")].count("\n") + 1
    with pytest.raises(BuildFailed) as failure:
        runtime.run(program, every_kind_of_word(), 1)
    assert "undeclared_name" in failure.value.log
    assert f":{line}" in failure.value.log


def test_runtime_survives_a_build_failure(target: str, runtime: TimedRuntime) -> None:
    words = every_kind_of_word()
    with pytest.raises(BuildFailed):
        runtime.run(complete_program(target, "this is no library", COPY), words, 1)
    assert np.array_equal(runtime.run(complete_program(target, "", COPY), words, 1), words)


def test_device_is_described(target: str, runtime: TimedRuntime) -> None:
    device = runtime.device
    assert device.target == target
    assert device.api and device.driver and device.device


@pytest.mark.parametrize("words", [np.zeros((1, 4), np.float32), np.zeros(4, np.uint32)])
def test_anything_but_rows_of_words_is_refused(target: str, runtime: TimedRuntime, words: Any) -> None:
    with pytest.raises(ValueError, match="words are uint32 of shape"):
        runtime.run(complete_program(target, "", COPY), words, 1)


def test_runtime_is_opened_once(target: str) -> None:
    assert open_runtime(target) is open_runtime(target)


def test_glsl_program_names_its_version() -> None:
    assert complete_program("glsl", "", COPY).startswith("#version 430\n")
    assert complete_program("glsl", "", COPY, version="310 es").startswith("#version 310 es\n")


def test_chunks_are_whole_groups_within_the_limits() -> None:
    assert chunk_lanes(1, 1, 4 * 1000) == 15 * GROUP_LANES
    assert chunk_lanes(10, 3, 4 * 10 * GROUP_LANES) == GROUP_LANES
    assert chunk_lanes(1, 1, 1 << 40) == MAX_GROUPS * GROUP_LANES


def test_unknown_target_is_refused() -> None:
    with pytest.raises(ValueError, match="the targets are glsl, wgsl, opencl"):
        open_runtime("metal")


@pytest.mark.parametrize("name", TARGETS)
def test_missing_package_is_named(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, PACKAGES[name], None)
    with pytest.raises(TargetUnavailable, match=f"pip install {PACKAGES[name]}"):
        import_module(f"targets.{name}.runtime").open_runtime()


def fail(*_: object, **__: object) -> None:
    """What a library does that finds no driver."""
    raise RuntimeError("no driver")


DRIVERLESS_PACKAGES = {
    "glsl": SimpleNamespace(create_standalone_context=fail),
    "wgsl": SimpleNamespace(gpu=SimpleNamespace(enumerate_adapters_sync=fail)),
    "opencl": SimpleNamespace(get_platforms=fail, Error=RuntimeError),
}


@pytest.mark.parametrize("name", TARGETS)
def test_missing_driver_is_named(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, PACKAGES[name], DRIVERLESS_PACKAGES[name])
    with pytest.raises(TargetUnavailable, match=f"no driver.*apt-get install {DEBIAN_PACKAGES[name]}"):
        import_module(f"targets.{name}.runtime").open_runtime()


@pytest.mark.parametrize(
    ("name", "variable"), [("wgsl", "VAIR_WGPU_ADAPTER"), ("opencl", "VAIR_OPENCL_DEVICE")]
)
def test_unknown_device_is_answered_with_those_here(
    name: str, variable: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip(PACKAGES[name])
    module = import_module(f"targets.{name}.runtime")
    monkeypatch.delenv(variable, raising=False)
    try:
        module.open_runtime()
    except TargetUnavailable as reason:
        pytest.skip(f"{name}: {reason}")
    monkeypatch.setenv(variable, "no such device")
    with pytest.raises(TargetUnavailable, match=f"{variable}=no such device .* here are: .+"):
        module.open_runtime()
