"""Half forms are made of the same sources, say what they are good for, and compile everywhere.

Plan.
  pass      f32 becomes f16; kept parameters stay; f32 text that half forms call has a name of its own;
            constants become the nearest half or what half.toml states, else the source is refused; every
            version is well-formed IR
  literals  shortest decimals that read back, for halves of every exponent
  evaluate  every operation rounded to half, denormals kept or flushed, overflow infinite or NaN
  text      the whole half library in every dialect, accepted by its compiler; its qualifiers and its header
  refusals  one sentence with the reason and the nearest usable function, status 2
  figures   what half.json says agrees with verdicts derived by hand, and holds on points drawn anew
Values on devices: execute/test_half.
"""

import json
import math
import random
import re
import struct
from pathlib import Path

import numpy as np
import pytest

from codegen.backends import dialect
from codegen.cli import run
from codegen.emit.dialect import Dialect, with_half
from codegen.emit.literal import literal, shortest
from codegen.emit.module import emit
from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.half import half_forms, half_rules
from codegen.ir import nodes as ir
from codegen.ir.types import F16, F32, HVEC3, VEC3
from codegen.ir.verify import verify
from codegen.library import Library, load_library
from codegen.passes.half import HalfRules, Version, half_versions, to_half
from conformance.check import measure
from conformance.half import table
from conformance.half.survey import LIMIT, half_sample
from conformance.unit.support.dialects import DIALECTS, dialect_id, validate
from conformance.unit.support.sources import library_of

SEED = 20260801
USABLE = [name for name, form in half_forms(load_library()).items() if not form.refused]
ALWAYS = ("sin_angle", "one_minus_exp_neg", "pow_one_minus", "fur_weights_slab", "strand_specular", "mirror")
"""Functions whose figures every run looks at."""

LOBE = """
def sine(a: V, b: V) -> f32:
    \"\"\"Sine.\"\"\"
    return length(cross(a, b))

def lobe(a: V, b: V, p: X) -> f32:
    \"\"\"A lobe.\"\"\"
    q = sine(a, b)
    scaled = 0.1 * q
    total = p * scaled
    return exp(-total)
"""


def versions_of(library: Library, name: str, rules: HalfRules) -> dict[str, Version]:
    return {v.function.name: v for v in half_versions(library, [name], rules)}


def checked(versions: tuple[Version, ...]) -> None:
    seen: dict[str, tuple[tuple[object, ...], object]] = {}
    for v in versions:
        verify(v.function, seen.get)  # type: ignore[arg-type]  # signatures of what has been seen
        seen[v.function.name] = (tuple(p.type for p in v.function.parameters), v.function.returns)


def constants(f: ir.Function) -> set[tuple[object, object]]:
    return {(e.type, e.value) for e in ir.expressions(f.body) if isinstance(e, ir.Const)}


def test_everything_becomes_half(tmp_path: Path) -> None:
    made = versions_of(library_of(tmp_path, LOBE), "lobe", HalfRules())
    assert list(made) == ["sine", "lobe"]
    f = made["lobe"].function
    assert [p.type for p in f.parameters] == [HVEC3, HVEC3, F16]
    assert f.returns == F16
    assert {e.type for e in ir.expressions(f.body)} == {F16, HVEC3}
    assert constants(f) == {(F16, to_half(0.1))}


def test_kept_parameters_stay_and_call_the_f32_text(tmp_path: Path) -> None:
    made = versions_of(library_of(tmp_path, LOBE), "lobe", HalfRules({}, {"lobe": frozenset("ab")}))
    assert list(made) == ["sine_single", "lobe"]
    f = made["lobe"].function
    assert [p.type for p in f.parameters] == [VEC3, VEC3, F16]
    types = {s.name: s.value.type for s in f.body if isinstance(s, ir.Let)}
    assert types == {"q": F32, "scaled": F32, "total": F16}
    assert [e.operand.type for e in ir.expressions(f.body) if isinstance(e, ir.Convert)] == [F32]
    assert made["sine_single"].function.body == made["sine_single"].source.body
    checked(tuple(made.values()))


@pytest.mark.parametrize("number", ["1.0e-30", "70000.0", "-1.0e-7"])
def test_constants_that_are_no_halves_are_refused(tmp_path: Path, number: str) -> None:
    library = library_of(tmp_path, f'def f(x: X) -> f32:\n    """F."""\n    return x + {number}\n')
    with pytest.raises(UserError, match=r"f has the constant .*, which (no half|halves)"):
        half_versions(library, ["f"], HalfRules())
    stated = {(abs(struct.unpack("<f", struct.pack("<f", float(number)))[0]), "f"): 6.2e-5}
    made = half_versions(library, ["f"], HalfRules(stated))[-1].function
    assert constants(made) == {(F16, math.copysign(to_half(6.2e-5), float(number)))}


def test_every_version_is_well_formed() -> None:
    library = load_library()
    for name in USABLE:
        checked(half_versions(library, [name], half_rules(library)))


def test_constants_round_to_the_nearest_half() -> None:
    rng = random.Random(SEED)
    for _ in range(2000):
        value = float(np.float32(rng.choice((-1, 1)) * 2.0 ** rng.uniform(-14, 15.9)))
        assert to_half(value) == float(np.float16(value)), value


def test_literals_read_back() -> None:
    every_exponent = np.arange(0, 0x7C00, 7, dtype=np.uint16).view(np.float16)
    for value in every_exponent.astype(float).tolist():
        text = shortest(value, "e")
        assert float(np.float16(float(text))) == value
        digits = len(text.split("e")[0].replace(".", "").strip("0"))
        shorter = f"{value:.{max(digits - 1, 1)}g}"
        assert digits <= 1 or float(np.float16(float(shorter))) != value, text
    assert literal(ir.Const(F16, 0.5), dialect("wgsl")) == "0.5h"
    assert literal(ir.Const(F16, 0.5), dialect("opencl")) == "0.5h"
    assert literal(ir.Const(F16, 0.5), dialect("glsl")) == "0.5"


def test_every_operation_is_rounded(tmp_path: Path) -> None:
    text = 'def f(x: X, y: X) -> f32:\n    """F."""\n    return sqrt(x * y + 0.1) / (x - y)\n'
    library = library_of(tmp_path, text)
    rng = np.random.Generator(np.random.PCG64(SEED))
    x, y = (rng.uniform(0.1, 10.0, 500).astype(np.float16) for _ in range(2))
    x = np.where(x == y, np.float16(11.0), x)
    got = evaluate(library, "f", {"x": x, "y": y}, "float16", rules=HalfRules())
    assert isinstance(got, np.ndarray)
    product = (x.astype(float) * y).astype(np.float16).astype(float)
    total = (product + float(np.float16(0.1))).astype(np.float16).astype(float)
    root = np.sqrt(total).astype(np.float16).astype(float)
    expected = (root / (x.astype(float) - y).astype(np.float16)).astype(np.float16)
    assert got.dtype == np.float16
    assert np.array_equal(got, expected)


def test_rules_are_the_librarys_unless_others_are_given(tmp_path: Path) -> None:
    library = library_of(tmp_path, 'def f(x: X) -> f32:\n    """F."""\n    return x * 1.0e-9\n')
    rules = HalfRules({(float(np.float32(1.0e-9)), ""): 0.5})
    assert evaluate(library, "f", {"x": np.array([3.0])}, "float16", rules=rules) == np.array([1.5])
    with pytest.raises(UserError, match="which halves lose"):
        evaluate(library, "f", {"x": np.array([3.0])}, "float16")


def test_strict_emulation_flushes_and_marks_overflow(tmp_path: Path) -> None:
    library = library_of(tmp_path, 'def f(x: X) -> f32:\n    """F."""\n    return x * abs(x)\n')
    x = np.array([1e-3, 0.5, 300.0, 2.0**-7, -1e-3, -0.5, -300.0, -(2.0**-7)])
    kept, strict = (
        evaluate(library, "f", {"x": x}, a, rules=HalfRules()) for a in ("float16", "float16-strict")
    )
    assert isinstance(kept, np.ndarray)
    assert isinstance(strict, np.ndarray)
    assert 0.0 < kept[0] < 2.0**-14
    assert strict[0] == 0.0
    assert kept[1] == strict[1] == 0.25
    assert kept[2] == np.inf
    assert np.isnan(strict[2])
    assert kept[3] == strict[3] == 2.0**-14  # the smallest normal half
    assert np.array_equal(kept[4:], -kept[:4])
    assert np.array_equal(strict[4:], -strict[:4], equal_nan=True)


def test_kept_vectors_are_computed_in_single_precision_and_rounded_once(tmp_path: Path) -> None:
    text = 'def f(a: V, x: X) -> vec3:\n    """F."""\n    return a * a * x\n'
    rules = HalfRules({}, {"f": frozenset("a")})
    library = library_of(tmp_path, text)
    a = np.array([[1.0 + 2.0**-12, 1.0 + 2.0**-20, 0.1]], np.float32)
    got = evaluate(library, "f", {"a": a, "x": [3.0]}, "float16", rules=rules)
    assert isinstance(got, np.ndarray)
    assert got.dtype == np.float16
    assert np.array_equal(got, (a * a).astype(np.float16) * np.float16(3.0))


def test_only_halves_are_flushed(tmp_path: Path) -> None:
    """What is kept in single precision may be smaller, and becomes a denormal half at the end."""
    library = library_of(tmp_path, 'def f(a: X, b: X) -> f32:\n    """F."""\n    return a * a * b\n')
    inputs = {"a": [2.0**-10, 2.0**-10], "b": [2.0**10, 1.0]}
    rules = HalfRules({}, {"f": frozenset("ab")})
    kept, strict = (
        np.asarray(evaluate(library, "f", inputs, a, rules=rules)) for a in ("float16", "float16-strict")
    )
    assert kept.tolist() == [2.0**-10, 2.0**-20]
    assert strict.tolist() == [2.0**-10, 0.0]


@pytest.mark.parametrize("base", DIALECTS, ids=dialect_id)
def test_compilers_accept_the_half_library(base: Dialect) -> None:
    text = emit(load_library(), with_half(base))
    assert "--precision half" in text
    assert "vair_half_sin_angle(" in text
    assert text.count("\nmediump ") > 50 if base.target == "glsl" else base.half_enable in text.splitlines()
    validate(text, base)


def test_half_and_single_stand_in_one_program() -> None:
    """Names and guards differ; WGSL's directive has to come first."""
    for target in ("glsl", "opencl"):
        base = dialect(target)
        validate(
            emit(load_library(), with_half(base), ["mirror"]) + emit(load_library(), base, ["mirror"]), base
        )


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("sin_angle_cosine", "cancels.*use sin_angle$"),
        ("pcg_hash", "no floating-point numbers; use --precision single$"),
        ("pow_one_minus_sq16", "squarings.*use pow_one_minus$"),
        ("safe_pow", "logarithm.*use pow_one_minus$"),
        ("no_such_function", "unknown function"),
    ],
)
def test_a_useless_half_is_refused(
    name: str, told: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out.wgsl"
    status = run(["emit", "--target", "wgsl", "--precision", "half", "--function", name, "-o", str(out)])
    error = capsys.readouterr().err
    assert status == 2
    assert error.count("\n") == 1
    assert re.search(told, error.strip()), error
    assert not out.exists()


def test_list_says_where_halves_are_valid(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["list", "--json"]) == 0
    found = {f["name"]: f["half"] for f in json.loads(capsys.readouterr().out)["functions"]}
    assert {name for name, half in found.items() if half is not None} == set(load_library().public)
    assert found["sin_angle"]["valid"]
    assert found["sin_angle"]["where"]["angle(a, b)"][0] > 0.0
    assert found["pcg_hash"] == {"valid": False, "why": "it has no floating-point numbers", "instead": None}


def test_every_function_has_a_verdict() -> None:
    old = table.stale(load_library(), table.read(load_library()))
    assert not old, f"python -m conformance.half has to measure {', '.join(old)}"
    forms = half_forms(load_library())
    for form in forms.values():
        assert not form.instead or not forms[form.instead].refused, form.function
        assert all(b.bound <= LIMIT * 1.05 for b in form.bounds)


def test_verdicts_agree_with_what_is_known() -> None:
    """Derived by hand: only sum-difference sines, exponentials rather than powers, selection for 1 - e^-x."""
    forms = half_forms(load_library())
    assert forms["sin_angle_cosine"].refused
    assert forms["safe_pow_exp2"].refused

    def least_angle(name: str) -> float:
        return (forms[name].where or {})["angle(a, b)"][0]

    assert least_angle("sin_angle") < least_angle("sin_angle_half") <= least_angle("sin_angle_cross")
    assert [b.measure for b in forms["one_minus_exp_neg"].bounds] == ["relative"]
    assert [b.measure for b in forms["one_minus_exp_neg_direct"].bounds] == ["absolute"]


def figures_hold(name: str) -> None:
    library = load_library()
    form = half_forms(library)[name]
    sample = half_sample(library, library.function(name), form.single, form.where)
    inside = sample.inside(dict(form.where or {}))
    assert inside.sum() > 100
    for arithmetic in ("float16", "float16-strict"):
        got = evaluate(library, name, sample.inputs, arithmetic)
        for bound in form.bounds:
            assert measure.error(bound, got, sample.truth)[inside].max() <= bound.bound


@pytest.mark.parametrize("name", ALWAYS)
def test_figures_hold(name: str) -> None:
    figures_hold(name)


@pytest.mark.nightly
@pytest.mark.parametrize("name", [name for name in USABLE if name not in ALWAYS])
def test_figures_of_all_functions_hold(name: str) -> None:
    figures_hold(name)
