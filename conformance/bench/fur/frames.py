"""The frames that are timed: furry bunnies by Vair's stages, by hand-written ones, and without lighting."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from codegen.fur.stages import DIALECTS, stage_texts
from codegen.library import Library
from conformance.bench.fur.by_hand import by_hand, floor
from conformance.picture.fur.studio import FurStudio, set_up_fur, stage_names
from conformance.picture.rasterise import open_scene
from conformance.picture.scene import SCENES
from targets.raster import Scene

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
        draws = self.studio.draws(stage_names(target, self.texts))
        return open_scene(target, self.texts, "fur.wgsl", draws, self.studio.picture.samples)


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
