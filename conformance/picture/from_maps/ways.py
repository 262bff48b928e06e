"""Ways of lighting a body by an environment map, each as a backend computes it.

direct       the map as a few directional lights (median cut), the lobe evaluated for each
prefiltered  one lookup in a map convolved with a round lobe, at the mirror direction
filtered     filtered importance sampling
plain        importance sampling, looked up in the largest level
reference    filtered, with so many samples that neither noise nor filter are left to see

How far each is off is measured against the sum over all texels of the map, in float64, at some of the points.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.evaluate.textures import TextureMap
from codegen.scene.environment import ConstantLight, median_cut
from conformance.light import emitted, estimators, prefiltered
from conformance.light.environment import Environment
from conformance.light.lobes import Lobe
from conformance.picture.from_maps.bodies import Body
from conformance.picture.shade import Backend

Doubles = npt.NDArray[np.float64]


class Map:
    """An environment map made ready for every way; each part is prepared when it is first asked for."""

    def __init__(self, path: Path, lights: int) -> None:
        self.name = path.stem
        self.environment = Environment.read(path, weighted=True)
        self.pixels = self.environment.pixels
        self._count = lights
        self._convolved: dict[float, TextureMap] = {}

    @cached_property
    def texture(self) -> TextureMap:
        """The levels that the estimators read."""
        return emitted.texture(self.environment)

    @cached_property
    def lights(self) -> list[ConstantLight]:
        """The map as a few directional lights."""
        return median_cut(self.pixels, self._count)

    def convolved(self, exponent: float) -> TextureMap:
        """The map that env_prefiltered reads for a power of the cosine."""
        if exponent not in self._convolved:
            self._convolved[exponent] = emitted.texture(prefiltered.convolved(self.environment, exponent))
        return self._convolved[exponent]


@dataclass(frozen=True)
class Look:
    """A plate's material, and how many samples light it.

    exponent   of the prefiltered map that serves the lobe, or stands in for it
    samples    of the filtered and of the plain estimator
    reference  samples of the reference
    """

    lobe: Lobe
    exponent: float
    samples: int
    reference: int
    colour: tuple[float, ...]

    def parameters(self, names: list[str], count: int) -> dict[str, npt.NDArray[np.float32]]:
        """The lobe's parameters for so many points."""
        return {
            name: np.full(count, x, np.float32) for name, x in zip(names, self.lobe.parameters, strict=True)
        }


Way = Callable[[Backend, Body, Map, Look, list[str]], Doubles]


def direct(backend: Backend, body: Body, env: Map, look: Look, names: list[str]) -> Doubles:
    """Radiance (N, 3): the sum over the map's lights."""
    view, total = body.view, np.zeros((len(body), 3))
    for light in env.lights:
        local = body.to_local(light.direction)
        given = {"l": local.astype(np.float32), "v": view.v.astype(np.float32)}
        value = backend.evaluate(f"{look.lobe.name}_value", given | look.parameters(names, len(body)))
        radiance = {
            "brdf": np.repeat(np.asarray(value, np.float32)[:, None], 3, axis=1),
            "light": np.broadcast_to(np.array(light.colour, np.float32), (len(body), 3)).copy(),
            "n_dot_l": local[:, 2].astype(np.float32),
        }
        total += backend.evaluate("punctual_radiance", radiance)
    return total


def one_lookup(backend: Backend, body: Body, env: Map, look: Look, names: list[str]) -> Doubles:
    """Radiance (N, 3): one lookup at the mirror direction, scaled as a Phong lobe is at its peak."""
    held = Lobe("phong", (look.exponent,))
    w = prefiltered.directions(body.view, held).astype(np.float32)
    found = backend.evaluate(emitted.PREFILTERED, {"env": env.convolved(look.exponent), "w": w})
    return np.asarray(found * prefiltered.scale(body.view, held), np.float64)


def _sampled(estimator: str, samples: Callable[[Look], int]) -> Way:
    def way(backend: Backend, body: Body, env: Map, look: Look, names: list[str]) -> Doubles:
        given: dict[str, Any] = {
            "env": env.texture,
            "frame": body.frame,
            "v": body.v,
            "samples": np.full(len(body), samples(look), np.uint32),
            "shift": body.shifts,
        }
        function = emitted.function_of(estimator, look.lobe)
        found = backend.evaluate(function, given | look.parameters(names, len(body)))
        return np.asarray(found, np.float64)

    return way


WAYS: Mapping[str, Way] = {
    "direct": direct,
    "prefiltered": one_lookup,
    "filtered": _sampled("filtered", lambda look: look.samples),
    "plain": _sampled("monte_carlo", lambda look: look.samples),
    "reference": _sampled("filtered", lambda look: look.reference),
}


def truth(body: Body, env: Map, look: Look) -> Doubles:
    """Radiance (N, 3): the sum over the texels of the map, float64."""
    return estimators.quadrature(env.environment, body.view, look.lobe)


def background(backend: Backend, body: Body, env: Map, level: float) -> Doubles:
    """The map behind the body, (height, width, 3)."""
    lod = np.full(len(body.behind), level, np.float32)
    found = backend.evaluate("env_radiance", {"env": env.texture, "w": body.behind, "lod": lod})
    width, height = body.size
    return np.asarray(found, np.float64).reshape(height, width, 3)
