"""The plate that shows what each piece of fur buys: `python -m conformance.bench.fur.plate`.

Panels and their changes to the scene are data, in plate.toml. The time beside a caption is that of one
frame, drawn in turns with the other panels; on a software driver, the processor time of the process with the
driver on one thread. --record keeps the times as plate.json, from which the table of README.md is made.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from codegen.backends import open_runtime
from codegen.errors import UserError
from codegen.files import write_text
from codegen.fur.shading import fur_shading
from codegen.library import Library, load_library
from conformance.bench.clocks import Clock
from conformance.bench.fur.page import RECORDED_PLATE as RECORDED
from conformance.bench.fur.page import update_readme
from conformance.bench.fur.rounds import THREADS, frame_clock
from conformance.bench.record import as_json, described_device, machine_data, rounded
from conformance.picture.fur.studio import FurStudio, lit_shading, open_fur, set_up_fur
from conformance.picture.image import contact_sheet, write_png
from conformance.picture.rasterise import develop
from conformance.picture.scene import EXAMPLES, SCENES
from conformance.picture.tone import eight_bit
from targets.raster import Picture

PLATE = EXAMPLES / "pictures" / "fur-pieces.png"
COLUMNS = 4


@dataclass(frozen=True)
class Panel:
    """One picture of the plate: its caption, and the studio it is drawn in."""

    caption: str
    studio: FurStudio


def read_plan() -> dict[str, Any]:
    """What plate.toml says."""
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
        shading = lit_shading(fur_shading(library, entry["model"]), studio.picture, coat)
        missing = [slot.path for slot in shading.material if slot.path not in material]
        if missing:
            raise UserError(f'plate.toml: panel "{entry["caption"]}" lacks {", ".join(missing)}')
        chosen = {slot.path: material[slot.path] for slot in shading.material}
        made.append(Panel(entry["caption"], replace(studio, fur=coat, shading=shading, material=chosen)))
    return made


def draw_in_turns(
    made: list[Panel], target: str, rounds: int, clock: Clock = time.process_time
) -> tuple[list[Picture], list[float]]:
    """The samples of every panel, and the least time of one frame in seconds; others only add to it."""
    drawings = [open_fur(panel.studio, target) for panel in made]
    blocks = [panel.studio.block.pack(panel.studio.values(target)) for panel in made]
    pictures = [drawing.draw(block) for drawing, block in zip(drawings, blocks, strict=True)]
    seconds = np.empty((rounds, len(made)))
    for turn in range(rounds):
        order = range(len(made)) if turn % 2 == 0 else reversed(range(len(made)))
        for k in order:
            start = clock()
            drawings[k].render(blocks[k])
            seconds[turn, k] = clock() - start
    for drawing in drawings:
        drawing.release()
    return pictures, np.min(seconds, axis=0).tolist()


def draw_plate(path: Path, target: str) -> dict[str, Any]:
    """Draw the plate, write it as PNG, and return what was measured."""
    plan = read_plan()
    device = open_runtime(target).device
    clock, clock_name = frame_clock(device)
    made = panels(load_library(), plan)
    pictures, seconds = draw_in_turns(made, target, plan["rounds"], clock)
    shown = [
        (f"{panel.caption}  ({1000.0 * cost:.0f} ms)", eight_bit(develop(panel.studio.picture, picture)))
        for panel, picture, cost in zip(made, pictures, seconds, strict=True)
    ]
    write_png(path, contact_sheet(shown, COLUMNS))
    width, height = made[0].studio.picture.samples
    data: dict[str, Any] = rounded(
        {
            "date": datetime.now(UTC).date().isoformat(),
            "device": described_device(device),
            "machine": machine_data(),
            "method": {
                "clock": clock_name,
                "rounds": plan["rounds"],
                "picture": f"{width} x {height} samples",
            },
            "panels": [
                {"caption": panel.caption, "ms": 1000.0 * cost}
                for panel, cost in zip(made, seconds, strict=True)
            ],
        }
    )
    return data


def main() -> int:
    """Run; returns the exit status."""
    parser = argparse.ArgumentParser(description="Draw the plate that shows what each piece of fur buys.")
    parser.add_argument("-o", "--output", type=Path, default=PLATE, help="the PNG file to write")
    parser.add_argument("--target", default="glsl", help="glsl or wgsl")
    parser.add_argument("--record", action="store_true", help="keep the times, as data and in README.md")
    options = parser.parse_args()
    os.environ.update(THREADS)
    try:
        data = draw_plate(options.output, options.target)
    except UserError as error:
        print(f"plate: {error}", file=sys.stderr)
        return 2
    if options.record:
        write_text(RECORDED, as_json(data))
        update_readme()
    print(f"{options.output}: {data['device']['short']}, {data['method']['clock']}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
