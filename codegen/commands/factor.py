"""`vair factor`: a reflectance as products of textures."""

from __future__ import annotations

import json
from pathlib import Path

import click
from rich.console import Console

from codegen.errors import UserError
from codegen.factors.homomorphic import Factors, FitError, Settings, error, factorise
from codegen.factors.maps import SHADES
from codegen.factors.samples import read_samples
from codegen.factors.source import draw_samples
from codegen.factors.waterloo import read_waterloo, waterloo_files
from codegen.files import write_folder
from codegen.library import load_library
from codegen.maps.undated import undated_exr
from codegen.version import VERSION

FRESH = 40_000
"""Samples of a function that judge the fit and took no part in it."""
FORMATS = ("exr", "waterloo")


@click.command("factor")
@click.argument("source", metavar="FUNCTION|FILE")
@click.option("-o", "--output", required=True, type=click.Path(path_type=Path), help="The folder to write.")
@click.option(
    "--set", "settings", multiple=True, metavar="NAME=VALUE", help="A parameter's value; repeatable."
)
@click.option("--diffuse", default=0.0, show_default=True, help="Fit this + (1 - this) times the function.")
@click.option("--samples", default=60_000, show_default=True, help="Pairs of directions that are drawn.")
@click.option("--size-p", default=16, show_default=True, help="Texels along a side of p(v) and p(l).")
@click.option("--size-q", default=32, show_default=True, help="Texels along a side of q(h).")
@click.option("--size-r", default=0, show_default=True, help="Texels along a side of r; 0: no r.")
@click.option("--angles", default=Settings.angles, show_default=True, help="What r follows: along or across.")
@click.option(
    "--emphasis", default=Settings.emphasis, show_default=True, help="Relative 0 ... 1 absolute error."
)
@click.option("--smoothness", default=Settings.smoothness, show_default=True)
@click.option("--format", "kind", default="exr", show_default=True, help="exr, or waterloo (8 bit).")
def command(
    source: str,
    output: Path,
    settings: tuple[str, ...],
    diffuse: float,
    samples: int,
    size_p: int,
    size_q: int,
    size_r: int,
    angles: str,
    emphasis: float,
    smoothness: float,
    kind: str,
) -> None:
    """Fit p(v) q(h) p(l) to a library FUNCTION of l and v, or h, or to samples in a FILE.

    A FILE is a .csv or .npz of samples, or a material of the Waterloo repository, which is only converted.
    Writes p, q and r as images, and factors.json with the scale and the error of the fit.
    """
    if kind not in FORMATS:
        raise UserError(f'unknown format "{kind}"; valid names: {", ".join(FORMATS)}')
    console = Console(stderr=True)
    how = Settings(size_p, size_q, size_r, smoothness, angles=angles, emphasis=emphasis)
    with console.status("fitting"):
        factors, measured, name = fitted(source, numbers(settings), diffuse, samples, how)
    write_folder(output, files(factors, measured, name, kind))
    if console.is_terminal and measured is not None:
        console.print(
            f"{name}: rms {100 * measured.rms:.2g} % of the mean, "
            f"{100 * measured.seen:.2g} % with the cosine, median {100 * measured.median:.2g} %",
            highlight=False,
        )


def fitted(
    source: str, settings: dict[str, float], diffuse: float, samples: int, how: Settings
) -> tuple[Factors, FitError | None, str]:
    """The factors of a function, a file of samples or a material; their error; a name."""
    path = Path(source)
    if path.suffix in (".csv", ".npz"):
        read = read_samples(path)
        factors = factorise(read, how)
        return factors, error(factors, read), path.stem
    if path.exists() or path.suffix == ".txt" or len(path.parts) > 1:
        material = read_waterloo(path)
        return material.factors, None, material.name
    if not 1000 <= samples <= 10_000_000:
        raise UserError(f"--samples {samples}: a fit takes 1000 to 10000000")
    library = load_library()
    drawn = draw_samples(library, source, settings, samples, diffuse=diffuse)
    factors = factorise(drawn, how)
    fresh = draw_samples(library, source, settings, FRESH, diffuse=diffuse, seed=2)
    return factors, error(factors, fresh), source


def files(factors: Factors, measured: FitError | None, name: str, kind: str) -> dict[str, bytes]:
    """The files that are written, by name."""
    if kind == "waterloo":
        return waterloo_files(name, "factors", factors)
    images = {"p.exr": undated_exr(factors.p), "q.exr": undated_exr(factors.q)}
    if factors.r is not None:
        images["r.exr"] = undated_exr(factors.r)
    angles = factors.angles if factors.r is not None else ""
    manifest = {
        "schema": 2,
        "version": VERSION,
        "name": name,
        "formula": "scale p(v) q(h) p(l)" + (" r" if factors.r is not None else ""),
        "frame": "x tangent, z normal; p and q over parabolic_uv; the ends of r are at texel centres",
        "function": SHADES[angles],
        "angles": angles,
        "scale": [float(f"{x:.9g}") for x in factors.scale],
        "error": None if measured is None else {k: _short(x) for k, x in vars(measured).items()},
    }
    return images | {"factors.json": (json.dumps(manifest, indent=1) + "\n").encode()}


def _short(value: float | int) -> float | int:
    return value if isinstance(value, int) else float(f"{value:.4g}")


def numbers(settings: tuple[str, ...]) -> dict[str, float]:
    """The numbers of --set NAME=NUMBER options by name; raises UserError for one that is none."""
    found = {}
    for setting in settings:
        name, equals, value = setting.partition("=")
        try:
            found[name.strip()] = float(value)
        except ValueError:
            raise UserError(
                f'--set "{setting}": it is NAME=NUMBER{"" if equals else ", with an ="}'
            ) from None
    return found
