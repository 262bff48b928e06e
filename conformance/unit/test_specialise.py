"""What specialisation does to small sources, pass by pass: text before, text after.

Plan. Each pass has sources in which only it can make the difference; what is left is printed as GLSL, which a
person can read, and compared. Every result is verified. Control flow and powers: test_specialise_flow.py.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.backends import dialect
from codegen.emit.module import emit
from codegen.emit.stmt import StmtPrinter
from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.ir import nodes as ir
from codegen.ir.types import F32
from codegen.ir.verify import verify
from codegen.library import Library, load_library
from codegen.passes.analysis.operations import operations
from codegen.passes.rules.sums import cancellation
from codegen.passes.specialise import Specialised, specialise
from codegen.passes.ssa.values import Values
from conformance.unit.support.dialects import ONE_PER_TARGET, dialect_id, validate
from conformance.unit.support.sources import library_of
from conformance.unit.support.trees import no_function

GLSL = StmtPrinter(dialect("glsl", None))
LIBRARY = load_library()
REAL = 2.0**-21
"""Relative distance in float32 of forms that are the same real number, a few roundings each."""


def made(folder: Path, text: str, **known: Any) -> Specialised:
    found = specialise(library_of(folder, text), "f", new_name="f", **known)
    verify(found.function, no_function)
    return found


def lines(found: Specialised) -> list[str]:
    """The body as GLSL, without indentation of the outermost level."""
    return [line.removeprefix("    ") for line in GLSL.block(found.function.body, "    ")]


def body(folder: Path, text: str, **known: Any) -> list[str]:
    return lines(made(folder, text, **known))


STRUCT = '@struct\nclass Pair:\n    """A pair."""\n    first: X\n    second: D\n'


def test_calls_are_inlined_to_the_last(tmp_path: Path) -> None:
    text = (
        "@helper\ndef h(x: X) -> f32:\n    y = x * x\n    return y + 3.0\n"
        "@helper\ndef g(x: X) -> f32:\n    y = h(x)\n    return y * x\n"
        "def f(x: X, y: X) -> f32:\n    return g(x) + g(y)\n"
    )
    assert body(tmp_path, text) == ["return (x * x + 3.0) * x + (y * y + 3.0) * y;"]


def test_call_kept_by_request(tmp_path: Path) -> None:
    text = (
        "@helper\ndef h(x: X) -> f32:\n    return x * x\n"
        "@helper\ndef g(x: X) -> f32:\n    return h(x) + 1.0\n"
        "def f(x: X) -> f32:\n    return g(x) * 1.0\n"
    )
    found = specialise(library_of(tmp_path, text), "f", keep={"h"}, new_name="f")
    assert lines(found) == ["return h(x) + 1.0;"]


def test_kept_calls_may_take_structs_and_differ_by_their_name(tmp_path: Path) -> None:
    text = (
        STRUCT + "@helper\ndef g(pair: Pair) -> f32:\n    return pair.first * pair.second.x\n"
        "@helper\ndef h(pair: Pair) -> f32:\n    return pair.first + pair.second.x\n"
        "def f(x: X, d: D) -> f32:\n    pair = Pair(x, d)\n    return max(g(pair), 1.0) - h(pair)\n"
    )
    library = library_of(tmp_path, text)
    found = specialise(library, "f", keep={"g", "h"}, new_name="kept")
    inputs = {"x": np.array([3.0, -1.0], np.float32), "d": np.array([[0.6, 0.8, 0.0]] * 2, np.float32)}
    special = evaluate(library.with_functions([found.function]), "kept", inputs)
    assert set(ir.callees(found.function)) == {"g", "h"}
    np.testing.assert_array_equal(special, evaluate(library, "f", inputs))


@pytest.mark.parametrize("expression", ["u32(0) - n", "n * u32(0xFFFFFFFF)"])
def test_what_has_no_sign_is_not_negated(tmp_path: Path, expression: str) -> None:
    library = library_of(tmp_path, f"def f(n: u32) -> u32:\n    return {expression}\n")
    found = specialise(library, "f", new_name="g")
    inputs = {"n": np.array([0, 1, 7, 2**32 - 1], np.uint32)}
    special = evaluate(library.with_functions([found.function]), "g", inputs)
    np.testing.assert_array_equal(special, evaluate(library, "f", inputs))


def test_unit_vectors_have_length_one_when_asked(tmp_path: Path) -> None:
    text = "def f(t: D, n: D, x: X) -> f32:\n    return x * dot(t, n) + length(n)\n"
    known: dict[str, Any] = {"aliases": {"t": "n"}}
    assert body(tmp_path, text, **known) == ["return x * dot(n, n) + length(n);"]
    kinds = {"exact", "finite", "real", "unit"}
    assert body(tmp_path / "again", text, kinds=kinds, **known) == ["return x + 1.0;"]


def test_early_return_becomes_one_exit(tmp_path: Path) -> None:
    text = "def f(x: X) -> f32:\n    if x < 0.0:\n        return 0.0\n    y = x + 1.0\n    return y * y\n"
    found = made(tmp_path, text)
    returns = [s for s in ir.statements(found.function.body) if isinstance(s, ir.Return)]
    assert len(returns) == 1
    assert lines(found) == ["float y = x + 1.0;", "return x < 0.0 ? 0.0 : y * y;"]


def test_dear_side_of_a_branch_stays_inside_it(tmp_path: Path) -> None:
    text = (
        "def f(x: X, y: X) -> f32:\n    if x < 0.0:\n        return y\n"
        "    z = exp(y) * exp(y * y)\n    return z + exp(x)\n"
    )
    assert body(tmp_path, text) == [
        "float result = 0.0;",
        "if (x < 0.0) {",
        "    result = y;",
        "} else {",
        "    float z = exp(y) * exp(y * y);",
        "    result = z + exp(x);",
        "}",
        "return result;",
    ]


def test_decided_branch_leaves_one_side(tmp_path: Path) -> None:
    text = (
        "def f(x: X, k: X) -> f32:\n    y = x\n    if k > 0.0:\n        y = exp(x)\n    else:\n"
        "        y = log(x)\n    return y\n"
    )
    found = made(tmp_path, text, constants={"k": 1.0})
    assert lines(found) == ["return exp(x);"]
    assert [s.name for s in found.log if s.name == "branches"] == ["branches"]


def test_struct_parameter_becomes_its_needed_fields(tmp_path: Path) -> None:
    text = STRUCT + "def f(pair: Pair, x: X) -> f32:\n    return pair.first * x\n"
    found = made(tmp_path, text)
    assert [(p.name, p.type.name) for p in found.function.parameters] == [("first", "f32"), ("x", "f32")]
    assert found.parameters == {"pair.first": "first", "x": "x"}
    assert found.dropped == ("pair.second",)
    assert any(s.name == "dead" and "pair.second" in s.what for s in found.log)


def test_fields_that_clash_get_their_whole_path(tmp_path: Path) -> None:
    text = STRUCT + "def f(a: Pair, b: Pair, first: X) -> f32:\n    return a.first + b.first * first\n"
    assert list(made(tmp_path, text).parameters.values()) == ["a_first", "b_first", "first"]


def test_components_of_constructed_vectors(tmp_path: Path) -> None:
    text = (
        "def f(x: X, v: V) -> vec3:\n    a = vec3(x, v.y, v.z)\n"
        "    return vec3(a.y, a.z, a.y) + vec3(v.x, v.y, v.z)\n"
    )
    assert body(tmp_path, text) == ["return v.yzy + v;"]


def test_alike_components_are_computed_once(tmp_path: Path) -> None:
    text = "def f(x: X, y: X, v: V) -> vec3:\n    return (vec3(x) + vec3(y)) * v / vec3(y - x)\n"
    assert body(tmp_path, text) == ["return (x + y) * v / (y - x);"]


def test_constants_and_aliases_stand_for_parameters(tmp_path: Path) -> None:
    text = "def f(x: X, y: X, k: X) -> f32:\n    return (x - y) * exp(k) + x * k\n"
    found = made(tmp_path, text, constants={"k": 2.0}, aliases={"y": "x"})
    assert lines(found) == ["return x * 2.0;"]
    inputs = {"x": [1.0], "y": [5.0], "k": [9.0]}
    imposed = found.impose(inputs)
    assert imposed == {"x": [1.0], "y": [1.0], "k": 2.0}
    assert found.arguments(imposed) == {"x": [1.0]}
    assert inputs["y"] == [5.0]


def test_constants_fold_with_one_rounding(tmp_path: Path) -> None:
    text = "def f(x: X, k: X) -> f32:\n    return x * exp(k) + sqrt(k + k)\n"
    assert body(tmp_path, text, constants={"k": 0.5}) == ["return x * 1.6487212 + 1.0;"]
    assert float(np.float32(np.exp(0.5))) == float(np.float32(1.6487212))


def test_integers_fold_modulo_two_to_the_32(tmp_path: Path) -> None:
    text = "def f(n: u32, k: u32) -> u32:\n    return n ^ (k * k + u32(7) // u32(2))\n"
    assert body(tmp_path, text, constants={"k": 70000}) == [f"return n ^ {(70000**2 + 3) % 2**32}u;"]


def test_what_overflows_is_not_folded(tmp_path: Path) -> None:
    text = "def f(x: X, k: X) -> f32:\n    return min(x, k * k)\n"
    assert body(tmp_path, text, constants={"k": 1e30}) == ["return min(x, 1e30 * 1e30);"]


@pytest.mark.parametrize(
    ("expression", "left"),
    [
        ("(1.0 + k) * r + (1.0 - k) * r", "2.0 * r"),
        ("0.5 * (1.0 + k) * r + 0.5 * (1.0 - k) * r", "r"),
        ("(r + k) * (r - k) + k * k", "r * r"),
        ("r - (r - k)", "k"),
        ("(r + 4.0) - 4.0", "r + 4.0 - 4.0"),
        ("(r + k) + r", "r + k + r"),
        ("0.1 * (k + r) - 0.1 * k", "0.1 * r"),
    ],
)
def test_terms_with_variables_cancel_and_others_do_not(tmp_path: Path, expression: str, left: str) -> None:
    text = f"def f(r: X, k: X) -> f32:\n    return {expression}\n"
    assert body(tmp_path, text) == [f"return {left};"]
    random = np.random.default_rng(5)
    found = made(tmp_path / "again", text)
    x = {name: random.uniform(-1.0, 1.0, 200).astype(np.float32) for name in ("r", "k")}
    library = LIBRARY.with_functions([found.function])
    special = evaluate(library, "f", found.arguments(x), "float32")
    general = evaluate(library_of(tmp_path / "third", text), "f", x, "float64")
    assert isinstance(special, np.ndarray)
    assert np.abs(special - general).max() <= REAL


def test_kappa_goes_where_both_shares_are_one_variable() -> None:
    """The lecture's own form of the attenuation, not the library's, which is built to cancel."""
    found = specialise(
        LIBRARY, "fur_directional_attenuation", aliases={"rho_transmit": "rho_reflect"}, new_name="f"
    )
    assert lines(found) == ["return rho_reflect;"]
    assert "azimuth_cosine" in found.dropped


def test_guard_goes_where_a_range_proves_it_idle(tmp_path: Path) -> None:
    text = "def f(x: Annotated[f32, Interval(0.0, 10.0)]) -> f32:\n    return 1.0 / max(x, 0.001)\n"
    assert body(tmp_path, text) == ["return 1.0 / max(x, 0.001);"]
    found = made(tmp_path / "again", text, ranges={"x": (0.5, 2.0)})
    assert lines(found) == ["return 1.0 / x;"]
    (step,) = [s for s in found.log if s.name == "ranges"]
    assert "[0.5, 2]" in step.why
    assert step.where.startswith("f:")


def test_guard_stays_where_rounding_could_reach_it(tmp_path: Path) -> None:
    text = "def f(x: Annotated[f32, Interval(0.0, 1.0)]) -> f32:\n    return max(x * x, 0.49)\n"
    assert body(tmp_path, text, ranges={"x": (0.7, 1.0)}) == ["return max(x * x, 0.49);"]
    assert body(tmp_path / "again", text, ranges={"x": (0.70001, 1.0)}) == ["return x * x;"]


def test_fact_removes_the_guard_it_speaks_of(tmp_path: Path) -> None:
    text = "def f(n: D, v: D, l: D) -> f32:\n    return max(dot(n, v), 0.0) + max(dot(l, n), 0.0)\n"
    assert body(tmp_path, text, facts=[("dot(n, v)", 0.05, 1.0)]) == [
        "return dot(n, v) + max(dot(l, n), 0.0);"
    ]
    assert body(tmp_path / "again", text, facts=[("dot(n, v)", 0.0, 1.0)]) == [
        "return max(dot(n, v), 0.0) + max(dot(l, n), 0.0);"
    ]


def test_products_with_zeros_of_a_constant_direction(tmp_path: Path) -> None:
    text = "def f(n: D, v: D) -> vec3:\n    return cross(v, n) * dot(v, n)\n"
    assert body(tmp_path, text, constants={"n": (0.0, 0.0, 1.0)}) == ["return vec3(v.y, -v.x, 0.0) * v.z;"]


def test_common_values_are_computed_once_under_their_own_name(tmp_path: Path) -> None:
    text = (
        "def f(a: V, x: X, y: X) -> f32:\n    first = sqrt(dot(a, a)) * x\n"
        "    size = sqrt(dot(a, a))\n    return first + size * y\n"
    )
    assert body(tmp_path, text) == [
        "float size = sqrt(dot(a, a));",
        "return size * x + size * y;",
    ]


def test_unused_values_are_dropped(tmp_path: Path) -> None:
    text = "def f(x: X, y: X) -> f32:\n    z = exp(y)\n    w = z * 2.0\n    return x + w * 0.0\n"
    found = made(tmp_path, text)
    assert lines(found) == ["return x;"]
    assert found.dropped == ("y",)


def test_variant_stands_in_wherever_its_base_is_called() -> None:
    found = specialise(
        LIBRARY, "strand_specular", variants={"pow_one_minus": "pow_one_minus_from4"}, new_name="f"
    )
    assert any(s.name == "variants" for s in found.log)
    assert "log(" not in "".join(lines(found))


def test_log_says_what_why_and_where() -> None:
    found = specialise(LIBRARY, "fakefur_shade", constants={"optics.rho_surface": 0.0}, new_name="f")
    steps = {s.what: s for s in found.log}
    assert steps["optics.rho_surface = 0"].why == "given as a constant"
    gone = [s for s in found.log if s.name == "dead"]
    assert {s.what.split()[1] for s in gone} == {"optics.cos_dark", "optics.cos_lit"}
    assert all(s.why and s.where.partition(":")[2].isdigit() for s in found.log)
    assert any(s.where.startswith("fur_surface_attenuation:") for s in found.log)


def test_operations_shrink_with_what_is_known() -> None:
    general = operations(LIBRARY.function("fakefur_shade"), LIBRARY)
    found = specialise(
        LIBRARY,
        "fakefur_shade",
        constants={"optics.rho_surface": 0.0, "optics.k_specular": (0.0, 0.0, 0.0)},
        aliases={"optics.rho_transmit": "optics.rho_reflect"},
        new_name="f",
    )
    left = operations(found.function)
    assert all(left[kind] <= general[kind] for kind in general)
    assert sum(left.values()) < 0.6 * sum(general.values())
    assert {"optics.exponent", "optics.k_specular"} <= set(found.dropped)


@pytest.mark.parametrize("target", ONE_PER_TARGET, ids=dialect_id)
def test_specialised_function_is_emitted_like_any_other(target: Any) -> None:
    found = specialise(LIBRARY, "fakefur_shade", ranges={"optics.exponent": (16.0, 64.0)}, new_name="fur")
    text = emit(LIBRARY.with_functions([found.function]), target, ["fur"])
    assert "vair_fur(" in text
    validate(text, target)


def test_hash_tells_specialised_functions_apart() -> None:
    libraries = [
        LIBRARY.with_functions([specialise(LIBRARY, "sin_angle", known, new_name="f").function])
        for known in ({}, {"a": (1.0, 0.0, 0.0)}, {})
    ]
    hashes = [library.select(["f"]).source_hash for library in libraries]
    assert hashes[0] == hashes[2] != hashes[1]


def test_added_functions_do_not_reach_the_library_they_were_added_to() -> None:
    found = specialise(LIBRARY, "sin_angle", new_name="other")
    extended = LIBRARY.with_functions([found.function])
    assert isinstance(extended, Library)
    assert "other" in extended.functions
    assert "other" not in LIBRARY.functions
    with pytest.raises(UserError, match='unknown function "other"'):
        LIBRARY.function("other")


@pytest.mark.parametrize("reverse", [False, True])
def test_products_are_rebuilt_in_the_order_of_the_source_wherever_values_lie(reverse: bool) -> None:
    """Ids order values by their place in memory, which differs from run to run."""
    places = sorted((ir.Var(F32, "?") for _ in range(4)), key=id, reverse=reverse)
    for place, name in zip(places, "abcd", strict=True):
        object.__setattr__(place, "name", name)
    values = Values(rules=(cancellation(),))
    a, b, c, d = map(values.intern, places)
    product = values.binary("*", values.binary("*", c, d), a)
    doubled = values.binary("*", values.number(2.0, F32), values.binary("+", product, b))
    left = values.binary("-", doubled, values.binary("*", values.number(2.0, F32), b))
    assert values.show(left) == "((2 * c) * d) * a"
