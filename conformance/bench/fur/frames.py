"""The frames that are timed: furry bunnies by Vair's stages, by hand-written ones, and without lighting."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from codegen.backends import open_runtime
from codegen.fur.stages import DIALECTS, STAGES, stage_texts
from codegen.library import Library
from conformance.bench.fur.by_hand import by_hand, floor
from conformance.picture.fur_render import FurStudio, set_up_fur
from targets.raster import Draw, Scene

SCENES = Path(__file__).resolve().parents[3] / "examples" / "scenes"
FAKE_FUR, SHELL_LIGHTING = "furry-bunny", "shell-lit-bunny"
GENERAL, FIXED, BY_HAND, TYPED_IN, FLOOR = (
    "vair",
    "vair --fixed",
    "by hand",
    "by hand, typed in",
    "one colour",
)


@dataclass(frozen=True)
class Frame:
    """One way to draw a picture.

    texts   of the stages, by file name
    block   content of the uniform block
    studio  mesh, coat and size
    """

    texts: Mapping[str, str]
    block: bytes
    studio: FurStudio

    def open(self, target: str) -> Scene:
        """The frame on the target's device, ready to be drawn as often as wanted."""
        return open_scene(
            target, self.texts, self.studio.draws(stage_names(target, self.texts)), self.studio.drawn_size
        )


def stage_names(target: str, texts: Mapping[str, str]) -> dict[str, tuple[str, str]]:
    """Vertex and fragment stage by pass: texts, or entry points of a WGSL module."""
    if target == "wgsl":
        return {stage: (f"{stage}_vertex", f"{stage}_fragment") for stage in STAGES}
    return {stage: (texts[f"{stage}.vert"], texts[f"{stage}.frag"]) for stage in STAGES}


def open_scene(
    target: str, texts: Mapping[str, str], draws: list[Draw], size: tuple[int, int], bits: int = 16
) -> Scene:
    """Draw calls on the target's device; `bits` of the picture's floats."""
    runtime: Any = open_runtime(target)
    if target == "wgsl":
        from targets.wgsl.raster import WgslScene

        return WgslScene(runtime, texts["fur.wgsl"], draws, size, bits)
    from targets.glsl.raster import GlslScene

    return GlslScene(runtime, draws, size, bits)


def studio(library: Library, scene: str, side: int, **changes: Any) -> FurStudio:
    """A scene of examples/scenes, one sample to a pixel; `changes` are of [render]."""
    return set_up_fur(library, SCENES / f"{scene}.toml", size=(side, side), supersample=1, **changes)


def frame(made: FurStudio, target: str) -> Frame:
    """A studio's frame by the stages that Vair writes."""
    texts = stage_texts(made.library, made.shading, target, DIALECTS[target][0])
    return Frame(texts, made.block.pack(made.values(target)), made)


def frames(made: FurStudio, target: str) -> dict[str, Frame]:
    """All ways to draw a scene; by hand only where it is fake fur."""
    general = frame(made, target)
    found = {GENERAL: general, FIXED: frame(made.fixed(), target)}
    if made.shading.function.name == "fakefur_shade":
        found[BY_HAND] = replace(general, texts=by_hand(target))
        found[TYPED_IN] = replace(general, texts=by_hand(target, made.material))
    return {**found, FLOOR: replace(general, texts=floor(target))}
