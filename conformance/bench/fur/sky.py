"""Ways of lighting a coat by an environment map: error and cost; `python -m conformance.bench.fur.sky`.

An error is the root mean square of what hairs send to the camera under the map alone, over that of the sum
over the texels of the map, in float64. The cost is the processor time of a frame with its listed lights and
so many of the map, over that with the listed ones alone, drawn in turns.

lights   the map as a few directional lights, the model evaluated for each: what `vair render` does
lookup   one lookup in the map prefiltered for a Lambert surface, as a single light along the normal
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.library import load_library
from codegen.maps import mipmap, prefilter
from codegen.scene.environment import COARSE, Texels, median_cut, read_map, texels
from conformance.bench.fur.plate import Panel, draw_in_turns
from conformance.picture.backends import open_backend
from conformance.picture.fur.march import March, Varyings
from conformance.picture.fur.studio import FurStudio, lit_shading, set_up_fur
from conformance.picture.scene import SCENES, Light
from conformance.picture.vectors import dot, unit

Doubles = npt.NDArray[np.float64]

COUNTS = (2, 4, 8, 14, 32)
POINTS, SEED, FACING = 48, 2024, 0.15
ROUNDS, SIDE = 9, 200


@dataclass(frozen=True)
class Errors:
    """Relative errors: by number of lights, and of the one lookup."""

    by_lights: dict[int, float]
    lookup: float


def hairs(studio: FurStudio, count: int) -> Varyings:
    """Points of the coat that the camera sees, drawn evenly over vertices and heights."""
    rng = np.random.default_rng(SEED)
    vertices = studio.mesh.vertices
    towards = unit(np.asarray(studio.picture.camera.eye) - vertices["position"].astype(np.float64))
    seen = np.flatnonzero(dot(vertices["normal"].astype(np.float64), towards) > FACING)
    chosen = vertices[rng.choice(seen, count, replace=False)]
    height = rng.uniform(0.3, 1.0, count)
    bend = {"n": chosen["normal"], "comb": chosen["comb"], "force": np.tile(studio.fur.force, (count, 1))}
    tangent = np.asarray(evaluate(studio.library, "shell_tangent", {**bend, "height": height}, "float32"))
    return {
        "position": chosen["position"],
        "normal": chosen["normal"],
        "tangent": tangent,
        "share": np.stack([chosen["length_share"], chosen["density_share"]], axis=1),
        "height": height[:, None].astype(np.float32),
    }


def radiance(studio: FurStudio, points: Varyings, lights: Sequence[Light]) -> Doubles:
    """What the points (N, 3) send to the camera under these lights, without shadows of the body."""
    shading = replace(studio.shading, shadowed=False)
    lit = replace(studio, shading=shading, picture=replace(studio.picture, lights=tuple(lights)))
    return March(lit, open_backend("numpy", studio.library))._radiance(points)


def constant_lights(found: Texels) -> list[Light]:
    """Texels as lights of a picture."""
    return [Light(_triple(d), _triple(c)) for d, c in zip(found.directions, found.colours, strict=True)]


def errors(studio: FurStudio, counts: Sequence[int], points: int = POINTS, rows: int = COARSE // 2) -> Errors:
    """Errors by number of lights, and of the lookup.

    rows  of the map whose texels are the truth
    """
    sky = studio.picture.sky
    if sky is None:
        raise UserError(f"{studio.scene.path}: [lights] environment: is missing")
    rgb = read_map(sky.map, f"{studio.scene.path}: [lights] environment")
    at = hairs(studio, points)
    truth = radiance(studio, at, constant_lights(texels(mipmap.reduced(rgb, rows))))

    def error(found: Doubles) -> float:
        return float(np.sqrt(np.mean((found - truth) ** 2) / np.mean(truth**2)))

    by_count = {}
    for count in counts:
        few = [Light(light.direction, light.colour) for light in median_cut(rgb, count)]
        by_count[count] = error(radiance(studio, at, few))
    gathered = prefilter.convolved(rgb, 1.0, unit(at["normal"].astype(np.float64)))
    looked_up = [
        radiance(studio, {name: value[k : k + 1] for name, value in at.items()}, [alone])
        for k, alone in enumerate(constant_lights(Texels(at["normal"].astype(np.float64), gathered)))
    ]
    return Errors(by_count, error(np.concatenate(looked_up)))


def costs(studio: FurStudio, counts: Sequence[int], target: str) -> dict[int, float]:
    """Processor time of a frame by number of the map's lights, over that without the map."""
    listed = studio.picture.lights[: len(studio.picture.lights) - _of_sky(studio)]
    made = []
    for count in (0, *counts):
        lights = (*listed, *[Light((0.0, 1.0, 0.0), (0.1, 0.1, 0.1))] * count)
        picture = replace(studio.picture, lights=lights)
        shading = lit_shading(studio.shading, picture, studio.fur)
        made.append(Panel(str(count), replace(studio, picture=picture, shading=shading)))
    _, seconds = draw_in_turns(made, target, ROUNDS)
    return {count: cost / seconds[0] for count, cost in zip(counts, seconds[1:], strict=True)}


def _of_sky(studio: FurStudio) -> int:
    assert studio.scene.picture is not None
    return len(studio.picture.lights) - len(studio.scene.picture.lights)


def _triple(values: npt.NDArray[Any]) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z


def main() -> int:
    """Run; returns the exit status."""
    parser = argparse.ArgumentParser(description="Ways of lighting a coat by a map, with error and cost.")
    parser.add_argument("--scene", type=Path, default=SCENES / "dawn-bunny.toml", help="a scene file")
    parser.add_argument("--target", default="glsl", help="glsl or wgsl, for the cost")
    options = parser.parse_args()
    try:
        changes: dict[str, Any] = {"size": (SIDE, SIDE), "supersample": 1, "subdivide": 0}
        studio = set_up_fur(load_library(), options.scene, **changes)
        found, times = errors(studio, COUNTS), costs(studio, COUNTS, options.target)
    except UserError as error:
        print(f"sky: {error}", file=sys.stderr)
        return 2
    for count in COUNTS:
        print(f"{count:3} lights  error {found.by_lights[count]:.3f}  time x {times[count]:.2f}")
    print(f"one lookup  error {found.lookup:.3f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
