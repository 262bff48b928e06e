"""The slide on grid sampling, which leaves the weights out."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from conformance.printed.misprint import Drawing, Misprint, Pair, Quantity, value
from conformance.printed.places import Array, over_hemisphere

WIDTH, HEIGHT = 40, 20
FACE = 12
DISC = 26


def texel_centres(width: int, height: int) -> Array:
    """Centres (N, 2) of the texels of a map, in [0, 1]^2."""
    u, v = np.meshgrid((np.arange(width) + 0.5) / width, (np.arange(height) + 0.5) / height)
    return np.stack([u.ravel(), v.ravel()], axis=1)


def latlong_texels() -> Pair:
    """Directions (N, 3) and solid angles (N,) of a latitude-longitude map, poles along y."""
    uv = texel_centres(WIDTH, HEIGHT)
    return value("latlong_direction", uv=uv), value(
        "latlong_solid_angle", v=uv[:, 1], width=WIDTH, height=HEIGHT
    )


def cube_texels() -> Pair:
    """Directions and solid angles of a cube map, from all six faces."""
    uv = texel_centres(FACE, FACE)
    p = np.concatenate([2.0 * uv - 1.0, np.ones((len(uv), 1))], axis=1)
    faces = [sign * np.roll(p, axis, axis=1) for axis in range(3) for sign in (1.0, -1.0)]
    directions = np.concatenate(faces)
    angles = np.tile(value("cube_solid_angle", uv=uv, size=FACE), 6)
    return directions / np.linalg.norm(directions, axis=1, keepdims=True), angles


def paraboloid_texels() -> Pair:
    """Directions and solid angles of a dual-paraboloid map: the texels inside the two discs."""
    uv = texel_centres(DISC, DISC)
    uv = uv[np.sum((2.0 * uv - 1.0) ** 2, axis=1) <= 1.0]
    halves = [value("dual_paraboloid_direction", uv=uv, back=back, border=1.0) for back in (0.0, 1.0)]
    directions = np.concatenate(halves)
    size = {"width": DISC, "height": DISC, "border": 1.0}
    return directions, value("dual_paraboloid_solid_angle", z=directions[:, 2], **size)


def grid(texels: Callable[[], Pair], axis: int) -> Quantity:
    """Sums over the texels of a white map; z of the example is the given axis of the map."""
    directions, angles = texels()
    directions = np.roll(directions, 2 - axis, axis=1)
    even = np.full(len(angles), 4.0 * np.pi / len(angles))
    weights = np.stack([angles, even], axis=1)

    def cosines(n: Array) -> Array:
        products = n @ directions.T
        return np.asarray(np.maximum(products, 0.0, out=products))

    def quantity(n: Array, _: Array) -> Pair:
        sums = [cosines(rows) @ weights for rows in np.array_split(n, 1 + len(n) // 1024)]
        right, printed = np.concatenate(sums).T / np.pi
        return right, printed

    return quantity


def misprint(key: str, title: str, effect: str, setting: str, quantity: Quantity) -> Misprint:
    return Misprint(
        key=key,
        title=f"Grid sampling, {title}",
        slide="Grid Sampling",
        printed="sum of L f cos over the samples, all alike",
        right="sum of L f cos times the solid angle of the sample",
        effect=effect,
        setting=setting,
        over="n",
        places=over_hemisphere(),
        quantity=quantity,
        drawing=Drawing("light of a white wall over n", (0.0, 1.5), samples=1),
    )


MISPRINTS = (
    misprint(
        "grid-latlong",
        "latitude-longitude",
        "Samples crowd at the poles: walls that face a pole are too bright, walls that face the horizon "
        "too dark.",
        f"white map of {WIDTH} x {HEIGHT}, white Lambert surface; n from the pole",
        grid(latlong_texels, 1),
    ),
    misprint(
        "grid-cube",
        "cube map",
        "Samples crowd at the eight corners, where texels are small: the mildest of the three.",
        f"white map of 6 x {FACE} x {FACE}, white Lambert surface; n from the centre of a face",
        grid(cube_texels, 2),
    ),
    misprint(
        "grid-paraboloid",
        "dual paraboloid",
        "Samples crowd at the rim of the two discs, where a texel covers a quarter of the solid angle of the "
        "middle's: walls that face the axis are too dark.",
        f"white map of 2 x {DISC} x {DISC}, white Lambert surface; n from the axis",
        grid(paraboloid_texels, 2),
    ),
)
