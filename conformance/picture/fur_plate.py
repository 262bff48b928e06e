"""The plate that shows what each piece of fur buys: `python -m conformance.picture.fur_plate -o FILE.png`.

Panels and their changes to the scene are data, in fur_plate.toml. The time beside a caption is the processor
time of one frame, drawn in turns with the other panels; on a software driver it is what the frame costs.
"""

from __future__ import annotations

import argparse
import sys
import time
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from codegen.backends import open_runtime
from codegen.errors import UserError
from codegen.fur.shading import fur_shading
from codegen.library import Library, load_library
from conformance.picture.fur_render import FurStudio, develop, lit_shading, open_drawing, set_up_fur
from conformance.picture.image import contact_sheet, write_png
from conformance.picture.tone import eight_bit
from targets.raster import Picture

SCENES = Path(__file__).resolve().parents[2] / "examples" / "scenes"
COLUMNS = 4


@dataclass(frozen=True)
class Panel:
    """One picture of the plate: its caption, and the studio it is drawn in."""

    caption: str
    studio: FurStudio


def read_plan() -> dict[str, Any]:
    """What fur_plate.toml says."""
    return tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))


def panels(library: Library, plan: Mapping[str, Any], **changes: Any) -> list[Panel]:
    """The panels made ready; the fur is grown once. `changes` are of the scene's [render]."""
    scene = SCENES / f"{plan['scene']}.toml"
    sizes = {"size": tuple(plan["size"]), "supersample": plan["supersample"]}
    studio = set_up_fur(library, scene, **{**sizes, **changes})
    blended = float(studio.fur.layers - 1)
    made = []
    for entry in plan["panel"]:
        coat_changes: dict[str, Any] = {"authored_layers": blended}
        for key, value in entry.get("coat", {}).items():
            coat_changes[key] = tuple(value) if isinstance(value, list) else value
        coat = replace(studio.fur, **coat_changes)
        material = plan["materials"][entry["material"]] if "material" in entry else studio.material
        shading = lit_shading(fur_shading(library, entry["model"]), studio.picture)
        missing = [slot.path for slot in shading.material if slot.path not in material]
        if missing:
            raise UserError(f'fur_plate.toml: panel "{entry["caption"]}" lacks {", ".join(missing)}')
        chosen = {slot.path: material[slot.path] for slot in shading.material}
        made.append(Panel(entry["caption"], replace(studio, fur=coat, shading=shading, material=chosen)))
    return made


def draw_in_turns(made: list[Panel], target: str, rounds: int) -> tuple[list[Picture], list[float]]:
    """The samples of every panel, and the median processor time of one frame in seconds."""
    drawings = [open_drawing(panel.studio, target) for panel in made]
    blocks = [panel.studio.block.pack(panel.studio.values(target)) for panel in made]
    pictures = [drawing.draw(block) for drawing, block in zip(drawings, blocks, strict=True)]
    seconds = np.empty((rounds, len(made)))
    for turn in range(rounds):
        order = range(len(made)) if turn % 2 == 0 else reversed(range(len(made)))
        for k in order:
            start = time.process_time()
            drawings[k].draw(blocks[k])
            seconds[turn, k] = time.process_time() - start
    for drawing in drawings:
        drawing.release()
    return pictures, np.median(seconds, axis=0).tolist()


def write_plate(path: Path, target: str) -> None:
    """Draw the plate and write it as PNG."""
    plan = read_plan()
    made = panels(load_library(), plan)
    pictures, seconds = draw_in_turns(made, target, plan["rounds"])
    shown = [
        (f"{panel.caption}  ({1000.0 * cost:.0f} ms)", eight_bit(develop(panel.studio.picture, picture)))
        for panel, picture, cost in zip(made, pictures, seconds, strict=True)
    ]
    write_png(path, contact_sheet(shown, COLUMNS))
    device = open_runtime(target).device
    print(f"{path}: processor time of a frame on {device.driver}, {device.device}, {plan['rounds']} rounds")


def main() -> int:
    """Run; returns the exit status."""
    parser = argparse.ArgumentParser(description="Draw the plate that shows what each piece of fur buys.")
    parser.add_argument("-o", "--output", type=Path, required=True, help="the PNG file to write")
    parser.add_argument("--target", default="glsl", help="glsl or wgsl")
    options = parser.parse_args()
    try:
        write_plate(options.output, options.target)
    except UserError as error:
        print(f"fur_plate: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
