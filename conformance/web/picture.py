"""A picture of the page, wide and on a phone: `python -m conformance.web.picture -o FILE.png`.

Needs Chromium and its driver; the page is drawn by software, so this takes a minute.
"""

from __future__ import annotations

import argparse
import io
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from PIL import Image

from codegen.errors import UserError
from codegen.files import write_bytes, write_folder
from codegen.library import load_library
from conformance.web.browser import drawn, missing, open_browser, served, view
from conformance.web.build import page_files

GAP = 24
GROUND = (128, 128, 128)
PATIENCE = 300.0
"""Seconds for a frame."""


@dataclass(frozen=True)
class Shot:
    """One view of the page: its size in CSS pixels, its colours, and what is chosen in its address."""

    width: int
    height: int
    dark: bool
    address: str


SHOTS = (
    Shot(1280, 860, False, "backend=webgpu&shading=fakefur_shade_slab&side=2"),
    Shot(390, 860, True, "backend=webgl2&shading=fakefur_shade_printed&side=2&yaw=0.7"),
)


def photograph(folder: Path, names: list[str], shots: tuple[Shot, ...] = SHOTS) -> Image.Image:
    """The views of a page side by side."""
    found = []
    with served(folder, names) as url, open_browser() as driver:
        for shot in shots:
            driver.get("about:blank")
            view(driver, shot.width, shot.height, dark=shot.dark)
            driver.get(f"{url}#{shot.address}")
            drawn(driver, timeout=PATIENCE)
            found.append(Image.open(io.BytesIO(driver.get_screenshot_as_png())).convert("RGB"))
    width = sum(image.width for image in found) + GAP * (len(found) - 1)
    sheet = Image.new("RGB", (width, max(image.height for image in found)), GROUND)
    left = 0
    for image in found:
        sheet.paste(image, (left, 0))
        left += image.width + GAP
    return sheet


def main() -> int:
    """Run; returns the exit status."""
    parser = argparse.ArgumentParser(description="Draw the page of `vair demo web`, wide and on a phone.")
    parser.add_argument("-o", "--output", type=Path, required=True, help="the PNG file to write")
    options = parser.parse_args()
    try:
        if missing():
            raise UserError(missing())
        files = page_files(load_library())
        with tempfile.TemporaryDirectory(prefix="vair-web-") as made:
            write_folder(Path(made), files)
            sheet = photograph(Path(made), list(files))
        data = io.BytesIO()
        sheet.save(data, "PNG", optimize=True)
        write_bytes(options.output, data.getvalue())
    except UserError as error:
        print(f"web.picture: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
