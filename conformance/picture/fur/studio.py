"""A scene with a [fur] table made ready, and opened on OpenGL or WebGPU with the generated stages."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from codegen.errors import UserError
from codegen.fur.budget import cheaper_shading
from codegen.fur.coat import FurMesh, grow
from codegen.fur.kit import kit_files
from codegen.fur.layout import LEAST_LIGHTS, Block, uniform_block
from codegen.fur.radiance import BODY
from codegen.fur.shading import FurShading, fixed_shading, folded_into, fur_shading
from codegen.fur.stages import DIALECTS, STAGES, stage_texts
from codegen.fur.states import pass_states
from codegen.library import Library
from conformance.picture.backends import models
from conformance.picture.fur.frame import frame_values
from conformance.picture.fur.settings import Fur
from conformance.picture.fur.shadow import with_shadows
from conformance.picture.rasterise import ball, clip_space, open_scene, refuse_too_large
from conformance.picture.scene import Picture, Scene, read_scene
from conformance.picture.shade import bind
from conformance.picture.sky import lit_by_sky
from targets.raster import Draw
from targets.raster import Scene as Drawing

INTERFACES = {"opengl": "glsl", "webgpu": "wgsl"}


@dataclass(frozen=True)
class FurStudio:
    """A scene with fur made ready: everything that does not depend on the target."""

    library: Library
    scene: Scene
    picture: Picture
    fur: Fur
    shading: FurShading
    material: Mapping[str, Any]
    mesh: FurMesh

    @property
    def block(self) -> Block:
        """The uniform block of the stages."""
        material = ((slot.name, slot.type) for slot in self.shading.material)
        return uniform_block(material, self.shading.lights)

    def values(self, target: str) -> dict[str, Any]:
        """Values by member of the uniform block."""
        picture, bounds = self.picture, ball(self.mesh.vertices, self.fur.length)
        material = {slot.path: self.material[slot.path] for slot in self.shading.material}
        frame = frame_values(self.fur, self.mesh, picture.camera, picture.lights, material)
        return {"view_projection": clip_space(picture, bounds, target), **frame}

    def fixed(self) -> FurStudio:
        """The same with what the scene states folded into the lighting, as cheap as its budget permits."""
        material = {path: value if len(value) > 1 else value[0] for path, value in self.material.items()}
        painted, lights = any(self.fur.channels), self.picture.lights
        brightest = max((max(light.colour) for light in lights), default=1.0)
        made = cheaper_shading(
            self.library, self.scene.path, self.shading, material, painted, len(lights), brightest
        )
        library, folded = made or fixed_shading(self.library, self.shading, material, painted)
        known = dict(zip(BODY, self.fur.surface, strict=True))
        return replace(self, library=library, shading=folded_into(folded, self.shading, painted, known))

    def kit(self, dialects: Mapping[str, tuple[str, ...]] = DIALECTS) -> dict[str, bytes]:
        """The files that an engine needs, see codegen.fur.kit."""
        matrices = {name: self.values(target)["view_projection"] for name, target in INTERFACES.items()}
        frame = {name: value for name, value in self.values("wgsl").items() if name != "view_projection"}
        camera = self.picture.camera
        scene = {
            "name": self.scene.name,
            "size": list(self.picture.size),
            "camera": {
                "eye": camera.eye,
                "target": camera.target,
                "up": camera.up,
                "field_of_view": camera.field_of_view,
            },
            "background": {"top": self.picture.top, "bottom": self.picture.bottom},
            "layers": self.fur.layers,
            "fins": self.fur.fins,
        }
        mesh, shading = self.mesh, self.shading
        return kit_files(self.library, shading, self.block, mesh, frame, matrices, scene, dialects)

    def draws(self, stages: Mapping[str, tuple[str, str]]) -> list[Draw]:
        """The draw calls: base, shells from the inner to the outer one, fins.

        stages  vertex and fragment stage by pass
        """
        mesh, states = self.mesh, pass_states(closed=self.mesh.findings["border edges"] == 0)
        fins = int(self.fur.fins and self.fur.layers > 1)
        calls = [
            Draw(*stages["base"], mesh.vertices, mesh.triangles, 1, states["base"]),
            Draw(*stages["shell"], mesh.vertices, mesh.triangles, self.fur.layers - 1, states["shell"]),
            Draw(*stages["fin"], mesh.fin_vertices, mesh.fin_triangles, fins, states["fin"]),
        ]
        return [call for call in calls if call.instances > 0]


def set_up_fur(library: Library, path: Path, *, pictured: bool = True, **changes: Any) -> FurStudio:
    """Read and check a scene file with fur, and grow the fur on its mesh.

    pictured  whether a picture is to be drawn; otherwise it may have any size
    changes   fields of [render] that are set otherwise than in the file
    errors    UserError
    """
    scene = read_scene(path)
    if scene.picture is None or scene.fur is None:
        missing = "[render]" if scene.picture is None else "[fur]"
        raise UserError(f"{path}: has no {missing} table, which a picture of fur needs")
    picture = replace(scene.picture, **changes)
    if pictured:
        refuse_too_large(path, picture)
    bound = bind(scene, models(library))
    picture = lit_by_sky(scene, picture)
    shading = lit_shading(fur_shading(library, bound.function), picture, scene.fur)
    mesh = grow(picture.mesh, scene.fur.spacing, scene.fur.combing, picture.subdivide, scene.fur.channels)
    if picture.shadows:
        mesh = with_shadows(mesh, picture.lights, scene.fur.length)
    return FurStudio(library, scene, picture, scene.fur, shading, bound.values, mesh)


def lit_shading(shading: FurShading, picture: Picture, fur: Fur) -> FurShading:
    """The lighting of fur with room for a picture's lights, with their shadows and the body's, if any."""
    known = {} if fur.surface[0] else {next(iter(BODY)): 0.0}
    return replace(
        shading, lights=max(LEAST_LIGHTS, len(picture.lights)), shadowed=picture.shadows, known=known
    )


def open_fur(studio: FurStudio, target: str, dialect: str | None = None) -> Drawing:
    """The scene's draw calls on a target's device.

    dialect  of the stages; the target's first one in which fur is written if None
    errors   UserError for targets that draw no fur, and without a driver
    """
    if target not in DIALECTS:
        raise UserError(f"target {target} draws no fur; {' and '.join(DIALECTS)} do")
    texts = stage_texts(studio.library, studio.shading, target, dialect or DIALECTS[target][0])
    draws = studio.draws(stage_names(target, texts))
    return open_scene(target, texts, "fur.wgsl", draws, studio.picture.samples)


def stage_names(target: str, texts: Mapping[str, str]) -> dict[str, tuple[str, str]]:
    """Vertex and fragment stage by pass: texts, or entry points of a WGSL module."""
    if target == "wgsl":
        return {stage: (f"{stage}_vertex", f"{stage}_fragment") for stage in STAGES}
    return {stage: (texts[f"{stage}.vert"], texts[f"{stage}.frag"]) for stage in STAGES}
