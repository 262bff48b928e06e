"""Pictures of factored reflectances: `python -m conformance.picture.factored MATERIAL... -o FILE.png`

Sphere and bunny lit by two directional lights, shaded by the library's function that reads the factors; a
column per material. MATERIAL is a folder that `vair factor` wrote, or a material of the Waterloo repository.
"""

from __future__ import annotations

import sys
from pathlib import Path

import click
import numpy as np
import numpy.typing as npt

from codegen.errors import UserError
from codegen.factors.maps import FactorMaps, read_factor_maps
from codegen.library import load_library
from conformance.picture.backends import open_backend
from conformance.picture.from_maps.bodies import BODIES, Body, see_body
from conformance.picture.from_maps.plate import PLAN
from conformance.picture.image import contact_sheet, write_png
from conformance.picture.scene import Light
from conformance.picture.shade import Backend
from conformance.picture.tone import eight_bit, gradient, resolve
from conformance.picture.vectors import unit

Doubles = npt.NDArray[np.float64]
LIGHTS = (
    Light((-0.6, 0.7, 0.8), (1.0, 0.97, 0.92)),
    Light((0.9, 0.3, 0.2), (0.35, 0.42, 0.55)),
)
BACKGROUND = ((0.20, 0.21, 0.24), (0.05, 0.05, 0.06))
BRIGHT, SHARE = 0.8, 0.95
"""What the darkest 95 % of a body are exposed to: published factors have any scale."""


def shade_factored(backend: Backend, body: Body, maps: FactorMaps) -> Doubles:
    """Radiance (N, 3) of the covered samples, summed over the lights; tangents follow the strands."""
    view, total = body.view, np.zeros((len(body), 3))
    constants = {**maps.inputs(), "scale": np.broadcast_to(maps.scale, (len(body), 3)).copy()}
    for light in LIGHTS:
        l = body.to_local(unit(np.array(light.direction)))
        given = {**constants, "l": l.astype(np.float32), "v": view.v.astype(np.float32)}
        total += np.array(light.colour) * backend.evaluate(maps.function, given)
    return total


def picture(backend: Backend, body: Body, maps: FactorMaps) -> Doubles:
    """Linear light (height, width, 3), exposed."""
    shaded = shade_factored(backend, body, maps)
    exposure = BRIGHT / max(float(np.quantile(shaded.max(axis=1), SHARE)), 1e-30)
    return resolve(body.mask, shaded * exposure, gradient(body.size, *BACKGROUND))


@click.command()
@click.argument("materials", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, help="The PNG file to write.")
@click.option("--target", default="glsl", help="glsl, wgsl, opencl, numpy or numpy32.")
def main(materials: tuple[Path, ...], output: Path, target: str) -> None:
    """Draw sphere and bunny with factored reflectances."""
    try:
        chosen = [read_factor_maps(path) for path in materials]
        backend = open_backend(target, load_library())
        panels = []
        for kind in reversed(BODIES):
            body = see_body(kind, PLAN["body"][kind])
            for maps in chosen:
                short = maps.name.split(",")[0]
                panels.append((f"{short}: {kind}", eight_bit(picture(backend, body, maps))))
        write_png(output, contact_sheet(panels, len(chosen)))
    except UserError as error:
        print(f"factored: {error}", file=sys.stderr)
        sys.exit(2)
    print(f"{output}: {backend.driver}")


if __name__ == "__main__":
    main()
