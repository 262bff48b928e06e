"""Terms that a number may stand for: the glance at all of them at once tells what each alone shows.

Plan. For every candidate of a scene with a loop over lights and one without: the error that all candidates'
common evaluation gives is that of the function without the term over the same points, to the bit.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from codegen.evaluate import evaluate
from codegen.library import load_library
from codegen.scene.description.document import read_scene
from codegen.scene.general import general_function
from codegen.scene.proof.errors import as_floats, distance, first
from codegen.scene.proof.points import draw
from codegen.scene.reduction.drops import GLANCE, errors_without, parts_of, terms, without
from codegen.scene.reduction.reduce import Reducer

LIBRARY = load_library()
SCENES = {
    "loop": '[shade]\nmodel = "fakefur"\n[lights]\ndirectional = 5\n',
    "single": '[shade]\nmodel = "brushed"\n[view]\nmin_n_dot_v = 0.05\n',
}
COUNT = 300


@pytest.mark.parametrize("name", SCENES)
def test_a_glance_at_all_terms_is_that_at_each(name: str, tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(SCENES[name], encoding="utf-8")
    scene = read_scene(tmp_path / "scene.toml", LIBRARY)
    general = general_function(scene)
    library = LIBRARY.with_functions([general.function])
    reducer = Reducer.of(library, scene, general, draw(scene, general, COUNT))
    function, reference = reducer.exact().function, reducer.reference
    few = first({p.name: reference.points.inputs[p.name] for p in function.parameters}, GLANCE)
    found = terms(library, function, few)
    assert len(found) > 1
    together = errors_without(library, function, found, reference)
    holds = parts_of(function)
    for term, error in zip(found, together, strict=True):
        alone = without(function, term, holds)
        inputs = {p.name: few[p.name] for p in alone.parameters}
        value = as_floats(evaluate(library.with_functions([alone]), alone.name, inputs))
        assert error == distance(value, reference.exact[:GLANCE], reference.single[:GLANCE])


def test_no_terms_take_no_evaluation() -> None:
    assert errors_without(LIBRARY, LIBRARY.function("safe_sqrt"), [], None) == []  # type: ignore[arg-type]
