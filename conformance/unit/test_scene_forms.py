"""Forms of a scene's function are equal as real numbers, cheaper, and taken only within a budget.

Plan. Each form of codegen.scene.reduction.loosen is applied to the function of the dense coat that is timed
beside hand-written ones, the gathering of constants to a function made for it; in float64 values agree before
and after. Together they take the dense coat to half the general function's operations. Each term that a
search may replace has two variants at least of fewer operations, with declared errors.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.ir import nodes as ir
from codegen.ir.verify import verify
from codegen.library import Library, load_library
from codegen.passes.analysis.operations import operations
from codegen.passes.rules.powers import LARGEST
from codegen.scene.description.document import HALF_STEP, read_scene
from codegen.scene.general import general_function
from codegen.scene.proof.errors import as_floats
from codegen.scene.proof.points import draw
from codegen.scene.reduction import loosen, scales
from codegen.scene.reduction.prices import Prices
from codegen.scene.reduction.reduce import Reducer
from conformance.bench.handwritten.beside import SCENE
from conformance.unit.support.sources import library_of
from conformance.unit.support.tolerances import tolerance

FORMS = {form.name: form for bundle in loosen.BUNDLES for form in bundle}
TERMS = {
    "sine": ["sin_angle", "strand_diffuse"],
    "highlight": ["strand_specular", "strand_specular_half"],
    "opacity": ["fur_opacity"],
    "transmittance": ["coat_transmittance"],
    "attenuation": ["fur_directional_attenuation", "fur_surface_attenuation"],
}

CONSTANTS = """
def gathered(x: Annotated[f32, Interval(0.1, 3.0)], n: Annotated[vec3, Unit()]) -> vec3:
    \"\"\"A function with constants in many places.

    x        a number
    n        a direction
    returns  three numbers
    source   elementary
    \"\"\"
    y = min(8.25, 4.5 * x)
    q = 1.0 - y * (0.0625 - 0.002 * y)
    w = (0.5 + 0.5 * q) * 0.7
    return (vec3(0.45, 0.3, 0.18) * x + vec3(0.3 * q)) * w + n * (max(0.25 * x, 0.125) / (3.0 * y))
"""


def ordinary(scene_file: Path = SCENE) -> tuple[Reducer, dict[str, np.ndarray]]:
    """The reducer of a scene, and its points that are no hard cases."""
    scene = read_scene(scene_file, load_library())
    general = general_function(scene)
    library = load_library().with_functions([general.function])
    points = draw(scene, general, 2000)
    made = Reducer.of(library, scene, general, points)
    inputs = {name: np.asarray(v, np.float64)[~points.hard] for name, v in points.inputs.items()}
    for name in ("t", "n", "v", "l"):  # forms agree for unit vectors, which float32 rounds
        inputs[name] /= np.linalg.norm(inputs[name], axis=1)[:, None]
    return made, inputs


def values(library: Library, function: ir.Function, inputs: dict[str, np.ndarray]) -> np.ndarray:
    given = {p.name: inputs[p.name] for p in function.parameters}
    return as_floats(evaluate(library.with_functions([function]), function.name, given, "float64"))


def count(function: ir.Function) -> int:
    return sum(operations(function).values())


@pytest.mark.parametrize("name", FORMS)
def test_a_form_is_the_same_number(name: str) -> None:
    made, inputs = ordinary()
    function = made.specialised({}, LARGEST).function
    if name == loosen.MIRROR.name:  # it looks for a cosine that is already a sum of two
        function = loosen.loosened(function, loosen.SPLIT) or function
    changed = loosen.loosened(function, FORMS[name])
    assert changed is not None
    verify(changed, lambda callee: None)
    before, after = (values(made.library, f, inputs) for f in (function, changed))
    np.testing.assert_allclose(after, before, rtol=0.0, atol=tolerance("forms"))


def test_constants_are_gathered(tmp_path: Path) -> None:
    library = library_of(tmp_path, CONSTANTS)
    function = library.function("gathered")
    changed = scales.gathered(function)
    assert changed is not None
    verify(changed, lambda callee: None)
    assert count(changed) < count(function)
    generator = np.random.default_rng(1)
    inputs = {"x": generator.uniform(0.1, 3.0, 500), "n": generator.normal(size=(500, 3))}
    before, after = (values(library, f, inputs) for f in (function, changed))
    np.testing.assert_allclose(after, before, rtol=tolerance("gathered"), atol=tolerance("gathered"))


def test_without_constants_nothing_is_gathered() -> None:
    library = load_library()
    assert scales.gathered(library.function("line_rejection")) is None


@pytest.mark.parametrize("target", ["glsl", "wgsl", "opencl"])
def test_the_dense_coat_takes_half_the_operations(target: str) -> None:
    """With operations as prices: by recorded times, PoCL prefers a form with more of them."""
    made, _ = ordinary()
    found = made.reduced(Prices(made.library, target), HALF_STEP)
    general = sum(operations(made.general.function, made.library).values())
    assert 2 * count(found.final.function) <= general
    assert found.error.largest <= 0.26 * HALF_STEP


@pytest.mark.parametrize("target", ["glsl", "wgsl", "opencl"])
@pytest.mark.parametrize("term", TERMS)
def test_each_term_has_two_cheaper_forms(term: str, target: str) -> None:
    library = load_library()
    prices = Prices(library, target)
    cheaper = [
        v.name
        for name in TERMS[term]
        for v in library.variants(name)
        if v.kind == "variant" and prices.weight(v.name) < prices.weight(name)
    ]
    assert len(cheaper) >= 2 * len(TERMS[term])
    assert all(library.bounds.get(name) for name in cheaper)


def test_an_exact_scene_keeps_its_forms() -> None:
    made, _ = ordinary()
    found = made.reduced(Prices.of(made.library, "glsl"), 0.0)
    assert found.final == found.exact
    assert not found.changes
