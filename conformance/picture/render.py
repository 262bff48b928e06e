"""From a scene file to a picture: `vair render` and the demonstration use this."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError
from codegen.library import Library
from conformance.picture.backends import models, open_backend
from conformance.picture.fur.draw import draw_fur
from conformance.picture.fur.studio import FurStudio, set_up_fur
from conformance.picture.image import write_png
from conformance.picture.mesh import Mesh, read_mesh
from conformance.picture.rasterise import Singles, develop
from conformance.picture.scene import Picture, Scene, read_scene
from conformance.picture.shade import Backend, Models, Shading, bind, shade
from conformance.picture.sky import lit_by_sky
from conformance.picture.strands.draw import draw_strands
from conformance.picture.strands.studio import StrandStudio, set_up_strands
from conformance.picture.tone import eight_bit, gradient, resolve
from conformance.picture.visibility import Visibility, see

Doubles = npt.NDArray[np.float64]
Made = TypeVar("Made", FurStudio, StrandStudio)


@dataclass(frozen=True)
class Studio:
    """A scene made ready: everything of its picture that does not depend on the backend."""

    scene: Scene
    picture: Picture
    shading: Shading
    mesh: Mesh

    @cached_property
    def seen(self) -> Visibility:
        """The visibility buffer, the same for all backends."""
        return see(
            self.mesh,
            self.picture.camera,
            self.picture.samples,
            self.picture.brush,
            [light.direction for light in self.picture.lights],
            self.picture.shadows,
        )

    def shade(self, backend: Backend) -> Doubles:
        """Linear light (N, 3) of the covered samples."""
        return shade(backend, self.shading, self.seen, self.picture.lights)

    def develop(self, shaded: Doubles) -> Doubles:
        """The picture (height, width, 3) in linear light, over the background."""
        background = gradient(self.picture.size, self.picture.top, self.picture.bottom)
        return resolve(self.seen.mask, shaded, background)

    @property
    def covered(self) -> npt.NDArray[np.bool_]:
        """The pixels (height, width) that show some of the mesh."""
        width, height = self.picture.size
        side = self.picture.supersample
        return np.asarray(self.seen.mask.reshape(height, side, width, side).any(axis=(1, 3)))


def set_up(path: Path, available: Models) -> Studio:
    """Read and check a scene file, and its mesh; `available` are the functions that can shade."""
    scene = read_scene(path)
    if scene.picture is None:
        raise UserError(f"{path}: has no [render] table, which a picture needs")
    shading, picture = bind(scene, available), lit_by_sky(scene, scene.picture)
    return Studio(scene, picture, shading, read_mesh(picture.mesh, picture.subdivide))


def render(library: Library, scene: Path, target: str | None, output: Path) -> tuple[str, str]:
    """Shade a scene on a target (the scene's first one if None), write the PNG, return target and driver.

    A scene with a [fur] table is drawn as shells and fins, by the stages that `vair fur` writes, one with a
    [strands] table as ribbons.

    errors  UserError for a fault in the scene, the mesh or the output, and without a driver
    """
    found = read_scene(scene)
    if found.fur is not None:
        return _drawn(set_up_fur(library, scene), draw_fur, target, output)
    if found.hair is not None:
        return _drawn(set_up_strands(library, scene), draw_strands, target, output)
    studio = set_up(scene, models(library))
    backend = open_backend(target or studio.scene.targets[0], library)
    write_png(output, eight_bit(studio.develop(studio.shade(backend))))
    return backend.name, backend.driver


def _drawn(
    studio: Made, draw: Callable[[Made, str], tuple[Singles, str]], target: str | None, output: Path
) -> tuple[str, str]:
    chosen = target or studio.scene.targets[0]
    samples, driver = draw(studio, chosen)
    write_png(output, eight_bit(develop(studio.picture, samples)))
    return chosen, driver
