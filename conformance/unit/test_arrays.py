"""Arrays: many lights as one parameter, numbered by a loop, and tables of constants.

Plan. A function that sums over an array of directions and colours is built by hand, since sources name no
arrays. It verifies, evaluates to the sum, its intervals hold every result, each target's compiler takes it
(dynamic numbers of parameters and of local tables included), and specialising keeps the loop, takes constant
elements, and knows what facts say of every element.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from codegen.backends import dialect
from codegen.emit.dialect import Dialect
from codegen.emit.module import emit
from codegen.emit.stmt import StmtPrinter
from codegen.errors import Place, UserError
from codegen.evaluate import evaluate
from codegen.intervals import TABLES, permitted
from codegen.ir import nodes as ir
from codegen.ir.types import F32, I32, U32, VEC3, array_of, half_of, leaves
from codegen.ir.verify import MalformedIRError, verify
from codegen.kernels import kernel
from codegen.library import load_library
from codegen.passes.analysis.operations import operations
from codegen.passes.specialise import specialise
from conformance.cases.domains import UNIT_TOLERANCE
from conformance.cases.drawing import draw
from conformance.unit.support.dialects import DIALECTS, ONE_PER_TARGET, dialect_id, validate
from conformance.unit.support.lights import LANES, LIGHTS, inputs, lambert_sum
from conformance.unit.support.tolerances import tolerance
from conformance.unit.support.trees import no_function

LIBRARY = load_library()
GLSL = StmtPrinter(dialect("glsl", None))


EXTENDED = LIBRARY.with_functions([lambert_sum()])


def test_leaves_are_the_elements_in_order() -> None:
    assert [path for path, _ in leaves(array_of(VEC3, 2))] == [
        "[0].x",
        "[0].y",
        "[0].z",
        "[1].x",
        "[1].y",
        "[1].z",
    ]
    assert half_of(array_of(VEC3, 2)).name == "hvec3[2]"


def test_sum_over_an_array_and_its_intervals() -> None:
    x = inputs()
    verify(lambert_sum(), no_function)
    exact = np.einsum(
        "ni,nic->nc", np.maximum(np.einsum("nc,nic->ni", x["n"], x["l"], dtype=np.float64), 0.0), x["light"]
    )
    double = evaluate(EXTENDED, "lambert_sum", x, "float64")
    assert isinstance(double, np.ndarray)
    np.testing.assert_allclose(double, exact, rtol=tolerance("summed"))
    single = evaluate(EXTENDED, "lambert_sum", x)
    for table in TABLES:
        allowed = permitted(EXTENDED, "lambert_sum", x, table)
        assert allowed.guaranteed.all()
        assert allowed.contains(single).all()


def test_one_array_may_stand_for_all_lanes() -> None:
    x = inputs()
    one = {"l": np.asarray(x["l"])[0], "light": np.asarray(x["light"])[0]}
    assert one["l"].shape == (LIGHTS, 3)
    lanes = {name: np.repeat(value[None], LANES, axis=0) for name, value in one.items()}
    every, alone = (evaluate(EXTENDED, "lambert_sum", {**x, **given}) for given in (lanes, one))
    np.testing.assert_array_equal(every, alone)
    with pytest.raises(UserError, match=rf"l has shape .*, but .* needs \(N, {LIGHTS}, 3\)$"):
        evaluate(EXTENDED, "lambert_sum", {**x, "l": one["l"][:, :2]})


def test_elements_are_drawn_from_their_domain() -> None:
    drawn = draw(lambert_sum(), "uniform", LANES, 7)
    assert list(drawn["l"]) == [str(k) for k in range(LIGHTS)]
    assert np.abs(np.linalg.norm(drawn["l"]["3"], axis=-1) - 1.0).max() < UNIT_TOLERANCE
    single = evaluate(EXTENDED, "lambert_sum", drawn)
    assert permitted(EXTENDED, "lambert_sum", drawn, "wgsl").contains(single).all()


def test_arrays_of_numbers_go_in_as_columns() -> None:
    """One row for each lane, or one for all."""
    type_ = array_of(F32, 2)
    elements = [ir.Index(F32, ir.Var(type_, "a"), ir.Const(I32, k)) for k in (0, 1)]
    body = (ir.Return(ir.Binary(F32, "-", elements[0], elements[1])),)
    parameters = (ir.Parameter("a", type_, None),)
    f = ir.Function("gap", "", "base", None, parameters, F32, body, ir.Doc("", {}), Place("", 1))
    extended = LIBRARY.with_functions([f])
    a = np.array([[3.0, 1.0], [0.5, 8.0], [2.0, -2.0]], np.float32)
    np.testing.assert_array_equal(evaluate(extended, "gap", {"a": a}), [2.0, -7.5, 4.0])
    np.testing.assert_array_equal(evaluate(extended, "gap", {"a": a[1]}), [-7.5])
    with pytest.raises(UserError) as caught:
        evaluate(extended, "gap", {"a": a.T})
    assert str(caught.value) == "gap: a has shape (2, 3), but f32[2] needs (N, 2)"


def test_index_that_lanes_choose() -> None:
    """An element by a parameter: what a lane names, and the hull where a table leaves the number open."""
    type_ = array_of(F32, 4)
    table = ir.Construct(type_, tuple(ir.Const(F32, float(k * k)) for k in range(4)))
    body = (ir.Let("squares", table), ir.Return(ir.Index(F32, ir.Var(type_, "squares"), ir.Var(U32, "k"))))
    f = ir.Function(
        "pick", "", "base", None, (ir.Parameter("k", U32, None),), F32, body, ir.Doc("", {}), Place("", 1)
    )
    extended = LIBRARY.with_functions([f])
    for some in ([3], [1, 2]):
        few = np.array(some, np.uint32)
        np.testing.assert_array_equal(evaluate(extended, "pick", {"k": few}), few.astype(np.float32) ** 2)
    k = np.array([0, 1, 2, 3, 2], np.uint32)
    np.testing.assert_array_equal(evaluate(extended, "pick", {"k": k}), k.astype(np.float32) ** 2)
    assert permitted(extended, "pick", {"k": k}, "wgsl").contains(k.astype(np.float32) ** 2).all()
    made = specialise(extended, "pick", new_name="g")
    assert GLSL.block(made.function.body, "") == [
        "float squares[4] = float[4](0.0, 1.0, 4.0, 9.0);",
        "return squares[k];",
    ]
    assert GLSL.block(specialise(extended, "pick", {"k": 3}, new_name="g").function.body, "") == [
        "return 9.0;"
    ]


@pytest.mark.parametrize("target", [d for d in DIALECTS if d in ONE_PER_TARGET], ids=dialect_id)
def test_compilers_take_arrays(target: Dialect) -> None:
    known = {"light": [[1.0, 0.5, 0.25]] * LIGHTS}
    table = specialise(EXTENDED, "lambert_sum", constants=known, new_name="table_sum").function
    both = EXTENDED.with_functions([table])
    text = emit(both, target, ["lambert_sum", "table_sum"])
    assert "[i]" in text
    validate(text, target)


@pytest.mark.parametrize("target", ["glsl", "wgsl", "opencl"])
def test_kernels_load_arrays_word_by_word(target: str) -> None:
    assert f"load_f32({3 * (1 + 2 * LIGHTS) - 1}" in kernel(EXTENDED, "lambert_sum", target)


def test_loop_is_kept_or_unrolled() -> None:
    x = inputs()
    general = evaluate(EXTENDED, "lambert_sum", x)
    for unroll in (8, 16):
        made = specialise(EXTENDED, "lambert_sum", new_name="g", unroll=unroll)
        verify(made.function, no_function)
        assert any(isinstance(s, ir.For) for s in made.function.body) == (unroll < LIGHTS)
        again = evaluate(LIBRARY.with_functions([made.function]), "g", made.arguments(x))
        np.testing.assert_array_equal(again, general)


def test_fact_speaks_of_every_element() -> None:
    made = specialise(EXTENDED, "lambert_sum", facts=[("dot(n, l)", 0.1, 1.0)], new_name="g")
    assert "max(" not in "".join(GLSL.block(made.function.body, ""))
    (step,) = [s for s in made.log if s.name == "ranges"]
    assert "dot(n, l[i" in step.what


def test_constant_direction_for_every_light() -> None:
    made = specialise(EXTENDED, "lambert_sum", {"l": [[0.0, 0.0, 1.0]] * LIGHTS}, new_name="g", unroll=16)
    assert list(made.parameters) == ["n", "light"]
    assert "dot(" not in "".join(GLSL.block(made.function.body, ""))


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ([[0.0, 0.0, 1.0]] * 3, "l needs 12 elements"),
        ([[0.0, 0.0, 2.0]] * LIGHTS, r"l\[0\] is \(0, 0, 2\), which is no unit vector"),
        (1.0, "l needs 12 elements"),
    ],
)
def test_wrong_constants(given: object, sentence: str) -> None:
    with pytest.raises(UserError, match=sentence):
        specialise(EXTENDED, "lambert_sum", {"l": given})


def test_wrong_shape_of_an_input() -> None:
    with pytest.raises(UserError, match=r"l has shape \(50, 3\), but vec3\[12\] needs \(N, 12, 3\)"):
        evaluate(EXTENDED, "lambert_sum", {**inputs(), "l": inputs()["n"]})


def test_index_of_no_array_is_malformed() -> None:
    bad = ir.Index(F32, ir.Var(VEC3, "n"), ir.Const(I32, 0))
    f = ir.Function(
        "f",
        "",
        "base",
        None,
        (ir.Parameter("n", VEC3, None),),
        F32,
        (ir.Return(bad),),
        ir.Doc("", {}),
        Place("", 1),
    )
    with pytest.raises(MalformedIRError, match="Index is marked f32 but gives None"):
        verify(f, no_function)


def test_what_all_lights_share_stands_before_the_loop() -> None:
    """The whole fur shader under an array of lights: the view's sine, depth and exponentials once."""
    shader = LIBRARY.function("fakefur_shade")
    vectors = array_of(VEC3, LIGHTS)
    arguments = tuple(
        ir.Index(VEC3, ir.Var(vectors, p.name), ir.Var(I32, "i"))
        if p.name in ("l", "light")
        else ir.Var(p.type, p.name)
        for p in shader.parameters
    )
    total = ir.Var(VEC3, "total")
    added = ir.Binary(VEC3, "+", total, ir.Call(VEC3, "fakefur_shade", arguments))
    body = (
        ir.Let("total", ir.Construct(VEC3, (ir.Const(F32, 0.0),)), True),
        ir.For("i", 0, LIGHTS, (ir.Assign("total", added),)),
        ir.Return(total),
    )
    parameters = tuple(replace(p, type=vectors) if p.name in ("l", "light") else p for p in shader.parameters)
    function = replace(shader, name="fur_lights", parameters=parameters, body=body)
    extended = LIBRARY.with_functions([function])
    made = specialise(extended, "fur_lights", {"optics.rho_surface": 0.0}, new_name="scene")
    verify(made.function, no_function)
    before = [s.name for s in made.function.body if isinstance(s, ir.Let)]
    (loop,) = (s for s in made.function.body if isinstance(s, ir.For))
    inside = [s.name for s in loop.body if isinstance(s, ir.Let)]
    assert {"sin_v", "hair_cover", "clear_view", "opacity"} <= set(before)
    assert {"sin_l", "defect", "clear_light"} <= set(inside)
    unrolled = specialise(
        extended, "fur_lights", {"optics.rho_surface": 0.0}, new_name="scene", unroll=LIGHTS
    )
    kept, flat = operations(made.function), operations(unrolled.function)
    assert kept == {**flat, "arithmetic": flat["arithmetic"] + 3}  # the loop also adds the first light to 0
    own = {name: a for name, a in inputs().items() if name != "n"}
    given = made.impose({**draw(shader, "uniform", LANES, 5), **own})
    got = evaluate(LIBRARY.with_functions([made.function]), "scene", made.arguments(given))
    assert permitted(extended, "fur_lights", given, "wgsl").contains(got).all()
