"""`python -m conformance.bench.fur`: frames of fur by Vair's stages and by hand-written ones, in turns."""

from __future__ import annotations

import os
import sys
import time
from typing import Any

import click
from rich.console import Console
from rich.table import Table

from codegen.files import write_text
from codegen.fur.stages import DIALECTS
from codegen.library import load_library
from conformance.bench.fur.fragments import fragments
from conformance.bench.fur.frames import FAKE_FUR, SHELL_LIGHTING, studio
from conformance.bench.fur.measure import measured
from conformance.bench.fur.page import FIGURE, RESULTS, draw_figure, read_results, update_readme
from conformance.bench.fur.rounds import THREADS
from conformance.bench.record import as_json, slug
from conformance.command_line import run
from targets import TargetUnavailable

FRAGMENTS_SIDE = 96


@click.command()
@click.option("--target", "targets", multiple=True, type=click.Choice(tuple(DIALECTS)), help="Repeatable.")
@click.option("--side", default=1024, show_default=True, help="Pixels along a side of the picture.")
@click.option("--rounds", default=3, show_default=True, help="Of all frames, forwards and backwards.")
@click.option("--record", is_flag=True, help="Keep the results, the figure and the table of the README.")
def main(targets: tuple[str, ...], side: int, rounds: int, record: bool) -> None:
    """Time and error of a frame of fur, and its cost against shells and pixels."""
    os.environ.update(THREADS)
    console, library, begin = Console(width=110), load_library(), time.monotonic()
    scenes = FAKE_FUR, SHELL_LIGHTING
    found = {name: fragments(studio(library, name, FRAGMENTS_SIDE)) for name in scenes}
    kept: list[dict[str, Any]] = []
    for target in targets or tuple(DIALECTS):
        try:
            data = measured(library, target, found, side, rounds, lambda text: print(text, file=sys.stderr))
        except TargetUnavailable as reason:
            console.print(f"{target}: {reason}")
            continue
        kept.append(data)
        show(console, data)
    if record and kept:
        for data in kept:
            RESULTS.mkdir(exist_ok=True)
            path = RESULTS / f"{slug(data['device'])}.json"
            write_text(path, as_json(data))
            console.print(f"{path}")
        draw_figure(read_results(), FIGURE)
        update_readme()
    console.print(f"{time.monotonic() - begin:.0f} s")


def show(console: Console, data: dict[str, Any]) -> None:
    """One driver's times and ratios on the terminal."""
    for name, scene in data["scenes"].items():
        shown = Table(title=f"{name}, {data['device']['short']}", title_justify="left")
        for column in ("stages", "ms [quartiles]", "error: largest", "p99.9", "median"):
            shown.add_column(column, justify="left" if column == "stages" else "right")
        for key, ms in scene["ms"].items():
            error = scene.get("error", {}).get(key, {})
            figures = [f"{error[e]:.3g}" if e in error else "" for e in ("max", "p999", "median")]
            low, high = ms["quartiles"]
            shown.add_row(key, f"{ms['median']:.0f} [{low:.0f}-{high:.0f}]", *figures)
        console.print(shown)
        for entry in scene["ratios"]:
            net = f"; of the lighting alone {entry['net']['median']:.2f}" if "net" in entry else ""
            low, high = entry["ratio"]["quartiles"]
            ratio = f"{entry['ratio']['median']:.3f} [{low:.3f}-{high:.3f}]"
            console.print(f"{entry['of']} over {entry['over']}: {ratio}{net}")
    for key in ("layers", "pixels"):
        grown = data[key]
        console.print(
            f"{grown['slope']:.4g} ms per {grown['unit']}, {grown['intercept']:.4g} ms besides, "
            f"within {100 * grown['residual']:.1f} %"
        )


if __name__ == "__main__":
    run(main)
