"""README.md of this folder: the table of the misprints, their pictures and the figures known before."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from textwrap import fill

from conformance.printed.catalogue import MISPRINTS
from conformance.printed.figures import figures
from conformance.printed.misprint import Error, Misprint, measure, measure_every_light

FOLDER = Path(__file__).parent
README = FOLDER / "README.md"
PICTURES = FOLDER / "pictures"
WIDTH = 116

HEAD = """<!-- Written by "python -m conformance.printed"; changes by hand do not last. -->
# What the lecture's misprints do

The library keeps what the lecture prints beside what is right: `*_printed` functions are the slides to the
letter, kept for comparison and never chosen automatically. This page says how far off each misprint is. Every
number is computed in float64 from the library itself by `python -m conformance.printed`.

- **Directions** are degrees from the normal n and azimuth from x: 90°, 0° is x. `l` points to the light, `v`
  to the viewer, `t` along the strand.
- **Largest and mean** are absolute errors of the value over the hemisphere about n: a grid of whole degrees,
  zenith and horizon included, each direction weighted with the solid angle of its cell. Of colours, the
  component that is off most. For the shadow of shells they are over its 16 shells.
- **Where** is the direction of the largest error, the first of several that are equally bad.
- **Every light**: mean over an even lattice of 65536 pairs of l and v; the largest of these and of a coarse
  grid with zenith and horizon. Elsewhere l is the example's.
- **Pictures** show the hemisphere from above in an equal-area projection: n in the middle, the horizon at
  the rim, x to the right. In the differences blue is printed too dark, orange too bright.
"""

TAIL = """## Misprints without a figure

- *Terminology*: the tangent space has the dimension of the object, n, not k. Nothing is computed from it.
- *Vector Projections*: |x_T| = |x.t|; x.t has a sign.
- *Specular Reflection*: a power of a negative base is undefined in the shading languages; every power here
  is 0 there, in the printed forms too.
- *Fermat's Principle*: l_N = r_N holds; its other half, r_T = -l_T, is missing, and with it the sign above.
- *Shells and Fins*: drawn "with w = 0 and w = 1", the vertices need w = 1 again before they are projected.
"""


@dataclass(frozen=True)
class Row:
    """A misprint with its errors."""

    misprint: Misprint
    error: Error
    every_light: tuple[float, float] | None

    @property
    def largest(self) -> str:
        return "no bound" if self.misprint.unbounded else number(self.error.largest)

    @property
    def mean(self) -> str:
        return "no bound" if self.misprint.unbounded else number(self.error.mean)

    @property
    def where(self) -> str:
        place = self.error.where
        return place if place.startswith("shell") else f"{self.misprint.over} {place}"


def number(x: float) -> str:
    """Three significant digits, no rounding noise."""
    return "0" if abs(x) < 1e-12 else f"{x:.3g}"


def rows() -> list[Row]:
    """Every misprint, measured."""
    return [Row(m, measure(m), measure_every_light(m)) for m in MISPRINTS]


def table(measured: list[Row]) -> list[str]:
    """The table of all misprints."""
    lines = [
        "| | as printed | right | largest | mean | where | every light: largest, mean |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in measured:
        m, light = row.misprint, row.every_light
        cells = (
            f"[{m.title}](#{anchor(m.title)})",
            code(m.printed),
            code(m.right),
            row.largest,
            row.mean,
            row.where,
            "" if light is None else f"{number(light[0])}, {number(light[1])}",
        )
        lines.append(f"| {' | '.join(cells)} |")
    return lines


def section(row: Row) -> list[str]:
    """One misprint with its picture."""
    m = row.misprint
    example = f"Slide *{m.slide}*. Example: {m.setting}."
    if m.unbounded:
        example += f" The error is above 1 for {row.error.above_one:.0%} of the hemisphere."
    if m.functions:
        example += f" In the library: {', '.join(f'`{name}`' for name in m.functions)}."
    lines = [f"### {m.title}", "", fill(m.effect, WIDTH), "", fill(example, WIDTH)]
    lines += ["", f"![right, as printed, difference: {m.drawing.shows}](pictures/{m.key}.png)", ""]
    if m.parts:
        lines += ["| one misprint alone | largest | mean | where | every light: largest, mean |"]
        lines += ["|---|---|---|---|---|"]
        for label, quantity in m.parts:
            error, light = measure(m, quantity), measure_every_light(m, quantity)
            assert light is not None
            cells = (label, number(error.largest), number(error.mean), f"{m.over} {error.where}")
            lines.append(f"| {' | '.join(cells)} | {number(light[0])}, {number(light[1])} |")
        lines.append("")
    return lines


def known_figures() -> list[str]:
    """The figures known before, beside those computed here."""
    lines = ["| | known | here |", "|---|---|---|"]
    for figure in figures():
        known, here = (
            " ".join(f"{x if abs(x) >= 1e-12 else 0.0:.{figure.digits}f}" for x in values)
            for values in (figure.known, figure.computed())
        )
        lines.append(f"| {figure.says} | {known} | {here} |")
    return lines


def anchor(title: str) -> str:
    """The anchor that a heading gets when the page is shown."""
    kept = "".join(c for c in title.lower() if c.isalnum() or c in " -")
    return kept.replace(" ", "-")


def code(formula: str) -> str:
    """A formula in a cell of a table."""
    return "`" + formula.replace("|", "\\|") + "`"


def report() -> str:
    """The whole page."""
    measured = rows()
    lines = [
        HEAD,
        "## The table",
        "",
        *table(measured),
        "",
        "## Figures known before",
        "",
        *known_figures(),
        "",
    ]
    lines += ["## One by one", ""]
    for row in measured:
        lines += section(row)
    return "\n".join([*lines, TAIL])
