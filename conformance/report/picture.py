"""The overview as a picture for the README: every variant's time beside its error, one panel per driver."""

from __future__ import annotations

import io
from collections.abc import Mapping
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter
from matplotlib.transforms import Bbox

from conformance.report.model import HALF_STEP, error_in, label

MODE, UNIT = "throughput", "steps"
INK, SOFT, LINE, ACCENT, OTHER = "#1d1c1a", "#5f5d58", "#dedcd5", "#2563b8", "#b4540a"
EXACT = 1e-6
"""Where results without any error are drawn."""
PANEL_INCHES, HEIGHT_INCHES, DOTS_PER_INCH = 3.7, 3.9, 200
MARK = 4.0
"""Half the width of a mark, in pixels of the layout."""
NEAR = 5.0
"""From a mark to its name, in points."""
NAMED = 5
"""Variants per panel that bear their names: those that gain most without leaving half a step."""


def overview(report: Mapping[str, Any]) -> bytes:
    """The picture as PNG."""
    results = report["drivers"]
    with_points = [(label(r), points(r)) for r in results]
    figure = Figure(figsize=(max(PANEL_INCHES * len(results), 4.5), HEIGHT_INCHES), layout="constrained")
    panels = figure.subplots(1, len(results), sharex=True, sharey=True, squeeze=False)[0]
    every = [(x, y) for _, found in with_points for _, _, x, y in found]
    for axes in panels[:1]:  # all panels share its scales
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.scatter([x for x, _ in every], [y for _, y in every], alpha=0.0)
    for axes, (title, found) in zip(panels, with_points, strict=True):
        _panel(axes, title, found)
    panels[0].set_ylabel("largest error in 8-bit steps", color=SOFT)
    figure.supxlabel("time relative to the default form of the same function", color=SOFT, fontsize=10)
    figure.draw_without_rendering()  # places the panels, so that names can be measured
    for axes, (_, found) in zip(panels, with_points, strict=True):
        _name_best(axes, found)
    stream = io.BytesIO()
    # No date and no version in the file: the same figures give the same bytes.
    figure.savefig(stream, format="png", dpi=DOTS_PER_INCH, metadata={"Software": None})
    return stream.getvalue()


def points(result: Mapping[str, Any]) -> list[tuple[str, str, float, float]]:
    """Name, kind, ratio to the base and error of everything beside the defaults."""
    found = []
    for f in result["functions"]:
        ratio, error = f["speed"][MODE]["ratio"], error_in(f, UNIT)
        if f["name"] != f["base"] and ratio is not None and ratio > 0.0 and error is not None:
            found.append((f["name"], f["kind"], float(ratio), max(error, EXACT)))
    return found


def _panel(axes: Axes, title: str, found: list[tuple[str, str, float, float]]) -> None:
    axes.set_title(title, loc="left", fontsize=10.5, color=INK, fontweight="bold")
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axes.spines[side].set_color(LINE)
    axes.grid(True, which="major", color=LINE, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(colors=SOFT, labelsize=8.5, which="both", length=0)
    axes.axvline(1.0, color=SOFT, linewidth=0.8)
    axes.axhline(HALF_STEP, color=SOFT, linewidth=0.8, linestyle=(0, (2, 2)))
    axes.annotate(
        "half a step",
        (1.0, HALF_STEP),
        xycoords=("axes fraction", "data"),
        xytext=(-2, 2),
        textcoords="offset points",
        ha="right",
        fontsize=7.5,
        color=SOFT,
    )
    for kind, colour, marker in (("variant", ACCENT, "o"), ("peer", OTHER, "D"), ("printed", SOFT, "x")):
        across = [x for _, k, x, _ in found if k == kind]
        up = [y for _, k, _, y in found if k == kind]
        axes.scatter(across, up, s=22, marker=marker, color=colour, alpha=0.8, linewidths=1.0)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())


def _name_best(axes: Axes, found: list[tuple[str, str, float, float]]) -> None:
    """Names beside the fastest variants within half a step, where they cover no mark, name or edge."""
    chosen = sorted((x, name, y) for name, kind, x, y in found if kind == "variant" and y <= HALF_STEP)
    marks = [(x, y) for _, _, x, y in found]
    dots: Any = axes.transData.transform(marks) if marks else []
    taken: list[Bbox] = [Bbox.from_bounds(x - MARK, y - MARK, 2 * MARK, 2 * MARK) for x, y in dots]
    named = 0
    for x, name, y in chosen:
        for place, side in ((NEAR, "left"), (-NEAR, "right")):
            text = axes.annotate(
                name,
                (x, y),
                xytext=(place, 0),
                textcoords="offset points",
                fontsize=6.5,
                color=INK,
                va="center",
                ha=side,
            )
            box = text.get_window_extent()
            inside = axes.bbox.x0 <= box.x0 and box.x1 <= axes.bbox.x1
            if inside and not any(box.overlaps(other) for other in taken):
                taken.append(box)
                named += 1
                break
            text.remove()
        if named == NAMED:
            break
