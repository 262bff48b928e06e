"""A scene with a [strands] table made ready, and opened on OpenGL or WebGPU with the generated stages."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from codegen.errors import UserError
from codegen.fur.layout import LEAST_LIGHTS, Block
from codegen.fur.shading import FurShading, member_name, strand_shading
from codegen.fur.stages import DIALECTS
from codegen.library import Library
from codegen.strands.ribbons import Ribbons, copied, ribbons
from codegen.strands.stages import ENTRIES, STATE, strand_block, strand_texts
from codegen.strands.tfx import MOST_POINTS, read_strands
from conformance.picture.backends import models
from conformance.picture.rasterise import ball, clip_space, light_arrays, open_scene, refuse_too_large
from conformance.picture.scene import Picture, Scene, read_scene
from conformance.picture.shade import bind
from conformance.picture.sky import lit_by_sky
from conformance.picture.strands.settings import Hair
from targets.raster import Draw
from targets.raster import Scene as Drawing


@dataclass(frozen=True)
class StrandStudio:
    """A scene with strands made ready: everything that does not depend on the target."""

    library: Library
    scene: Scene
    picture: Picture
    hair: Hair
    shading: FurShading
    material: Mapping[str, Any]
    ribbons: Ribbons

    @property
    def block(self) -> Block:
        """The uniform block of the stages."""
        return strand_block(self.shading)

    def values(self, target: str) -> dict[str, Any]:
        """Values by member of the uniform block."""
        bounds = ball(self.ribbons.vertices, self.hair.width)
        return {
            "view_projection": clip_space(self.picture, bounds, target),
            "eye": self.picture.camera.eye,
            "width": self.hair.width,
            "tip_share": self.hair.tip,
            "s_min": self.hair.s_min,
            **light_arrays(self.picture.lights),
            **{member_name(slot.path): self.material[slot.path] for slot in self.shading.material},
        }


def set_up_strands(library: Library, path: Path, **changes: Any) -> StrandStudio:
    """Read and check a scene file with strands, and the strands.

    changes  fields of [render] that are set otherwise than in the file
    errors   UserError
    """
    scene = read_scene(path)
    if scene.picture is None or scene.hair is None:
        missing = "[render]" if scene.picture is None else "[strands]"
        raise UserError(f"{path}: has no {missing} table, which a picture of strands needs")
    hair, picture = scene.hair, lit_by_sky(scene, replace(scene.picture, **changes))
    if picture.shadows:
        raise UserError(f"{path}: [render] shadows: strands cast no shadows; set it to false")
    refuse_too_large(path, picture)
    bound = bind(scene, models(library))
    shading = strand_shading(library, bound.function)
    shading = replace(shading, lights=max(LEAST_LIGHTS, len(picture.lights)))
    points = read_strands(hair.file)
    if points.shape[0] * points.shape[1] * hair.copies > MOST_POINTS:
        raise UserError(f"{path}: [strands] copies: {hair.copies} make more than {MOST_POINTS} points")
    made = ribbons(copied(points, hair.copies, hair.spread, hair.seed))
    return StrandStudio(library, scene, picture, hair, shading, bound.values, made)


def open_strands(studio: StrandStudio, target: str, dialect: str | None = None) -> Drawing:
    """The scene's draw call on a target's device.

    dialect  of the stages; the target's first one in which strands are written if None
    errors   UserError for targets that draw no strands, and without a driver
    """
    if target not in DIALECTS:
        raise UserError(f"target {target} draws no strands; {' and '.join(DIALECTS)} do")
    texts = strand_texts(studio.library, studio.shading, target, dialect or DIALECTS[target][0])
    stages = ENTRIES if target == "wgsl" else (texts["strand.vert"], texts["strand.frag"])
    draw = Draw(*stages, studio.ribbons.vertices, studio.ribbons.triangles, 1, STATE)
    return open_scene(target, texts, "strands.wgsl", [draw], studio.picture.samples)
