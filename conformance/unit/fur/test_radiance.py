"""The loop over the lights of fur: what is in it, what stands before it, and what a budget makes of it.

Plan.
  split     nothing before the loop reads a light; no name of the stages is declared; no call is left
  known     a coat without the body's shadow has no text for it; a whole coat has none for shares
  budget    forms within the scene's budget; none where the scene asks for exactness, or for another function
  no light  draws black hairs
"""

from pathlib import Path

import numpy as np
import pytest

from codegen.backends import dialect
from codegen.fur import budget
from codegen.fur.budget import cheaper_shading
from codegen.fur.radiance import BODY, TAKEN, fur_lighting
from codegen.fur.shading import SCALED, fur_shading
from codegen.fur.stages import stage_texts
from codegen.ir import nodes as ir
from codegen.library import load_library
from conformance.bench.fur.frames import FAKE_FUR, frame, studio
from conformance.picture.scene import SCENES
from conformance.unit.support.drivers import need

LIBRARY = load_library()
MODELS = ("fakefur_shade", "fakefur_shade_slab", "shell_shade", "scheuermann_shade", "kajiya_kay_shade")
COLOUR = 'budget = "half-step-8bit"'


@pytest.mark.parametrize("model", MODELS)
def test_what_all_lights_share_stands_before_the_loop(model: str) -> None:
    lighting = fur_lighting(LIBRARY, fur_shading(LIBRARY, model))
    every = lighting.before + lighting.each
    declared = {s.name for s in ir.statements(every) if isinstance(s, ir.Let | ir.For)}
    assert not declared & set(TAKEN)
    read = {e.name for e in ir.expressions(lighting.before) if isinstance(e, ir.Var)}
    assert not read & {"l", "light", "radiance"}
    inside = {e.name for e in ir.expressions(lighting.each) if isinstance(e, ir.Var)}
    assert {"l", "light", "radiance"} <= inside
    assert not any(isinstance(e, ir.Call | ir.Index) for e in ir.expressions(every))
    # Every value of the loop depends on the light at hand: what does not would have moved.
    moving = {"l", "light", "radiance"}
    for s in lighting.each:
        if isinstance(s, ir.Let):
            reads = {e.name for e in ir.walk(s.value) if isinstance(e, ir.Var)}
            assert reads & moving, s.name
            moving.add(s.name)


def test_what_is_known_leaves_no_text() -> None:
    shading = fur_shading(LIBRARY, "fakefur_shade")
    names = tuple(fur_lighting(LIBRARY, shading).texts(dialect("glsl", "330")).values())
    assert all(any(f"fur.{member}" in text for text in names) for member in BODY.values())
    known = {"body_shadow": 0.0, **dict.fromkeys(SCALED.values(), 1.0)}
    whole = type(shading)(shading.function, shading.material, known=known)
    texts = stage_texts(LIBRARY, whole, "wgsl", "wgsl")["fur.wgsl"]
    body = texts[texts.index("fn fur_radiance") : texts.index("@vertex")]
    assert not any(f"fur.{member}" in body for member in BODY.values())
    assert "share *" not in body and "* length_share" not in body and "vair_thinned" not in texts


def test_budgets_choose_cheaper_forms(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(budget, "POINTS", 2000)
    scene = SCENES / f"{FAKE_FUR}.toml"
    made = studio(LIBRARY, FAKE_FUR, 8, subdivide=0)
    given = LIBRARY, scene, made.shading, made.material
    found = cheaper_shading(*given, painted=False, lights=2, brightest=4.6)
    assert found is not None
    library, cheap = found
    assert cheap.material == () and library.function(cheap.function.name) == cheap.function
    costly = {e.op for e in ir.expressions(cheap.function.body) if isinstance(e, ir.Builtin)} & {"exp", "log"}
    assert not costly
    painted = cheaper_shading(*given, painted=True, lights=2, brightest=4.6)
    assert painted is not None and {slot.path for slot in painted[1].material} == set(SCALED)
    # No budget is left for each of very many lights; nothing is cheaper than what was asked for exactly.
    assert cheaper_shading(*given, painted=False, lights=10**6, brightest=4.6) is None
    exact = tmp_path / "exact.toml"
    exact.write_text(scene.read_text(encoding="utf-8").replace(COLOUR, 'budget = "exact"'), encoding="utf-8")
    assert cheaper_shading(LIBRARY, exact, *given[2:], painted=False, lights=2, brightest=4.6) is None
    other = fur_shading(LIBRARY, "shell_shade")
    assert cheaper_shading(LIBRARY, scene, other, {}, painted=False, lights=2, brightest=4.6) is None


def test_without_lights_hairs_are_black() -> None:
    need("glsl")
    made = studio(LIBRARY, FAKE_FUR, 24, subdivide=0)
    block = made.block.pack({**made.values("glsl"), "light_count": 0})
    scene = frame(made, "glsl").open("glsl")
    picture = scene.draw(block)
    scene.release()
    assert picture[..., 3].max() > 0.9 and not np.any(picture[..., :3])
