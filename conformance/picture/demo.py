"""The demonstration of examples/demo.py: emit the library, check it on this machine, render a bunny with it.

Writes into build/demo (or the folder given with -o): the library for the three targets, a picture of the
brushed bunny by every backend, and a picture of their differences. The check covers the functions that the
picture is made of, so that the demonstration stays short; with --all it covers the whole library, as
`vair check` does. Exit status 0 if everything holds, 1 if a check failed, a picture is further off than its
tolerance, or there is no driver; 2 for bad input.
"""

from __future__ import annotations

import argparse
import statistics
import subprocess
import sys
import time
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from rich.console import Console
from rich.table import Table

from codegen.errors import UserError
from codegen.library import Library, load_library
from conformance.picture.backends import models, open_backend
from conformance.picture.image import difference_sheet, write_png
from conformance.picture.render import Studio, set_up
from conformance.picture.tolerances import tolerance
from conformance.picture.tone import eight_bit, steps_apart
from targets import TARGETS, TargetUnavailable, probe

ROOT = Path(__file__).resolve().parents[2]
SCENE = ROOT / "examples" / "scenes" / "brushed-bunny.toml"
FILES = {"glsl": "vair.glsl", "wgsl": "vair.wgsl", "opencl": "vair.cl"}
REFERENCE = "numpy"
WARM_RUNS = 3

Doubles = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Shot:
    """One backend's picture in linear light, and the seconds it took to shade its samples."""

    backend: str
    driver: str
    linear: Doubles
    first: float
    warm: float


def main() -> int:
    """Run the demonstration; returns the exit status."""
    parser = argparse.ArgumentParser(description="Emit the library, check it, render a bunny with it.")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "build" / "demo", metavar="FOLDER")
    parser.add_argument("--all", action="store_true", help="check all functions, not only those rendered")
    options = parser.parse_args()
    folder: Path = options.output
    try:
        folder.mkdir(parents=True, exist_ok=True)
        return demonstrate(folder, Console(), options.all)
    except UserError as error:
        print(f"demo: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f'demo: cannot write "{folder}": {error.strerror}', file=sys.stderr)
        return 2


def demonstrate(folder: Path, console: Console, check_all: bool) -> int:
    """Emit, check and render into a folder."""
    console.rule("Emit", align="left")
    for target, name in FILES.items():
        vair("emit", "--target", target, "-o", str(folder / name))
        lines = (folder / name).read_text(encoding="utf-8").count("\n")
        console.print(f"{target:7} {shown(folder / name)}, {lines} lines", highlight=False)

    console.rule("Check", align="left")
    available = []
    for target in TARGETS:
        answer = probe(target)
        if isinstance(answer, TargetUnavailable):
            console.print(f"{target:7} skipped: {answer}", highlight=False)
        else:
            available.append(target)
    if not available:
        console.print("No driver is available; vair doctor says what to install.")
        return 1
    library = load_library()
    studio = set_up(SCENE, models(library))
    behind = [] if check_all else behind_the_picture(library, studio)
    if behind:
        console.print(
            f"{len(behind)} functions that the picture is made of; all {len(library.public)} with --all",
            highlight=False,
        )
    checked = vair("check", *repeated("--target", available), *repeated("--function", behind), fails=True)

    console.rule("Render", align="left")
    with console.status("casting rays"):
        start = time.perf_counter()
        samples = len(studio.seen.n)
        seconds = time.perf_counter() - start
    console.print(f"visibility buffer: {samples} samples on the mesh, {seconds:.1f} s", highlight=False)
    shots = []
    for name in (REFERENCE, *available):
        with console.status(f"shading with {name}"):
            shots.append(shoot(studio, library, name))
        write_png(folder / f"bunny-{name}.png", eight_bit(shots[-1].linear))
    reference, *others = shots
    apart = {shot.backend: steps_apart(shot.linear, reference.linear) for shot in others}
    sheet = difference_sheet([(name, steps.max(axis=2)) for name, steps in apart.items()])
    write_png(folder / "differences.png", sheet)

    goal = tolerance("backend_steps")
    console.print(results(shots, {name: steps[studio.covered] for name, steps in apart.items()}, goal))
    console.print(f"Pictures: {shown(folder)}/bunny-*.png and differences.png", highlight=False)
    near = all(steps.max() < goal for steps in apart.values())
    return 0 if checked == 0 and near else 1


def behind_the_picture(library: Library, studio: Studio) -> list[str]:
    """The shading function and the public functions that it calls, directly or not."""
    return [f.name for f in library.select([studio.shading.function]).functions if f.public]


def repeated(option: str, values: Iterable[str]) -> list[str]:
    """An option of the command line given once per value."""
    return [word for value in values for word in (option, value)]


def shoot(studio: Studio, library: Library, name: str) -> Shot:
    """Shade the picture once with the building of the program included, then warm."""
    start = time.perf_counter()
    backend = open_backend(name, library)
    shaded = studio.shade(backend)
    first = time.perf_counter() - start
    warm = []
    for _ in range(WARM_RUNS):
        start = time.perf_counter()
        studio.shade(backend)
        warm.append(time.perf_counter() - start)
    return Shot(name, backend.driver, studio.develop(shaded), first, statistics.median(warm))


def results(shots: list[Shot], apart: dict[str, Doubles], goal: float) -> Table:
    """The table of differences and times; `apart` holds the differences of the pixels that show the bunny."""
    table = Table(caption=f"Differences in 8-bit steps before rounding; goal: below {goal:g} everywhere.")
    table.add_column("backend")
    table.add_column("driver", overflow="fold")
    for heading in ("largest", "mean", "first call", "warm"):
        table.add_column(heading, justify="right")
    for shot in shots:
        steps = apart.get(shot.backend)
        differences = ("reference", "") if steps is None else (f"{steps.max():.2g}", f"{steps.mean():.2g}")
        table.add_row(shot.backend, shot.driver, *differences, f"{shot.first:.2f} s", f"{shot.warm:.2f} s")
    return table


def vair(*arguments: str, fails: bool = False) -> int:
    """Run the command line; a failure ends the demonstration unless `fails` allows status 1."""
    status = subprocess.run([sys.executable, "-m", "codegen.cli", *arguments], check=False).returncode
    if status and not (fails and status == 1):
        raise UserError(f"vair {' '.join(arguments)} ended with status {status}")
    return status


def shown(path: Path) -> str:
    """A path as a reader of the terminal can use it."""
    return str(path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path)
