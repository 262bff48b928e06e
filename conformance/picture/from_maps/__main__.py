"""Draw the plates: `python -m conformance.picture.from_maps -o FOLDER [--target T]... [--plate NAME]...`

Bunny and sphere under every map of examples/data, side by side: direct, prefiltered, filtered, plain,
reference. Writes one PNG per plate and backend, and prints by how much the backends differ. Exit status 1
where a pixel of two backends differs by the tolerance or more.
"""

from __future__ import annotations

import sys
from itertools import combinations
from pathlib import Path

import click
import numpy as np
from rich.console import Console

from codegen.backends import TARGETS
from codegen.errors import UserError, unknown
from codegen.library import load_library
from conformance.picture.backends import open_backend
from conformance.picture.from_maps.plate import PLAN, Plate, made_ready
from conformance.picture.image import write_png
from conformance.picture.tolerances import tolerance


@click.command()
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), required=True, help="The folder to write into."
)
@click.option("--target", "targets", multiple=True, help="Only this target; repeatable.")
@click.option("--plate", "plates", multiple=True, help="Only this plate; repeatable.")
@click.option("--size", type=click.IntRange(16, 1024), help="Pixels along a panel's side.")
def main(output: Path, targets: tuple[str, ...], plates: tuple[str, ...], size: int | None) -> None:
    """Draw the plates of bodies under environment maps."""
    console = Console(stderr=True)
    try:
        for name in plates:
            if name not in PLAN["plate"]:
                raise unknown("plate", name, PLAN["plate"])
        try:
            output.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise UserError(f'cannot write "{output}": {error.strerror}') from None
        library = load_library()
        backends = [open_backend(target, library) for target in targets or TARGETS]
        worst = 0.0
        for name in plates or PLAN["plate"]:
            with console.status(f"{name}: rays and reference"):
                plate = made_ready(name, library, size)
            drawn = []
            for backend in backends:
                with console.status(f"{name}: {backend.name}"):
                    drawn.append(plate.draw(backend))
                write_png(output / f"{name}-{backend.name}.png", Plate.sheet(drawn[-1], plate.columns))
                print(f"{output / f'{name}-{backend.name}.png'}: {backend.driver}")
            for (one, a), (other, b) in combinations(zip(backends, drawn, strict=True), 2):
                apart = max(Plate.apart(p, q) for p, q in zip(a, b, strict=True))
                worst = max(worst, apart)
                print(f"{name}: {one.name} and {other.name} differ by {apart:.2g} 8-bit steps at most")
    except UserError as error:
        print(f"from_maps: {error}", file=sys.stderr)
        sys.exit(2)
    sys.exit(int(not np.isfinite(worst) or worst >= tolerance("backend_steps")))


if __name__ == "__main__":
    main()
