"""Write README.md and the pictures of this folder; what is right already is left alone."""

from __future__ import annotations

import time

import numpy as np
from PIL import Image

from codegen.files import write_text
from conformance.picture.image import write_png
from conformance.printed.catalogue import MISPRINTS
from conformance.printed.picture import picture
from conformance.printed.report import PICTURES, README, report


def main() -> None:
    """Measure, draw and write."""
    begin = time.perf_counter()
    write_text(README, report())
    PICTURES.mkdir(exist_ok=True)
    names = {f"{misprint.key}.png" for misprint in MISPRINTS}
    for stale in sorted(path for path in PICTURES.glob("*.png") if path.name not in names):
        stale.unlink()
    drawn = 0
    for misprint in MISPRINTS:
        path, pixels = PICTURES / f"{misprint.key}.png", picture(misprint)
        # Pixels are compared, not files: another version of the compressor writes other bytes.
        if not path.exists() or not np.array_equal(np.asarray(Image.open(path)), pixels):
            write_png(path, pixels)
            drawn += 1
    print(f"{len(MISPRINTS)} misprints measured, {drawn} pictures new, {time.perf_counter() - begin:.1f} s")


if __name__ == "__main__":
    main()
