"""The overview as a picture for the README: every variant's time beside its error, one panel per driver."""

from __future__ import annotations

import io
from collections.abc import Mapping
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FixedLocator, FuncFormatter, NullFormatter
from matplotlib.transforms import Bbox

from conformance.plots import BLUE, INK, ORANGE, SOFT, lighten
from conformance.report.model import HALF_STEP, error_in, label

MODE, UNIT = "throughput", "steps"
EXACT, BEYOND = 1e-6, 1e3
"""Errors in steps between which marks stand where they belong: results without any error are drawn at the one
end, what is of no use as a colour at the other, with a mark of its own."""
KINDS = {
    "variant": ("variant", BLUE, "o"),
    "peer": ("a peer's form", ORANGE, "D"),
    "printed": ("as printed", SOFT, "x"),
}
BEYOND_MARK = "^"
PANEL_INCHES, HEIGHT_INCHES, DOTS_PER_INCH = 3.7, 4.1, 200
HALO = [withStroke(linewidth=2.0, foreground="white")]
"""Keeps names readable over lines."""
MARK = 8.0
"""Half the width of a mark, in pixels."""
NEAR = 5.0
"""From a mark to its name, in points."""
NAMED = 5
"""Variants per panel that bear their names: those that gain most without leaving half a step."""


def overview(report: Mapping[str, Any]) -> bytes:
    """The picture as PNG."""
    results = report["drivers"]
    with_points = [(label(r), points(r)) for r in results]
    size = max(PANEL_INCHES * len(results), 4.5), HEIGHT_INCHES
    figure = Figure(figsize=size, dpi=DOTS_PER_INCH, layout="constrained")
    panels = figure.subplots(1, len(results), sharex=True, sharey=True, squeeze=False)[0]
    every = [(x, y) for _, found in with_points for _, _, x, y in found]
    for axes in panels[:1]:  # all panels share its scales
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.scatter([x for x, _ in every], [y for _, y in every], alpha=0.0)
    for axes, (title, found) in zip(panels, with_points, strict=True):
        _panel(axes, title, found)
    panels[0].set_ylim(min((y for _, y in every), default=EXACT) / 2.0, BEYOND * 4.0)
    _legend(figure)
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
            found.append((f["name"], f["kind"], float(ratio), min(max(error, EXACT), 2.0 * BEYOND)))
    return found


def _panel(axes: Axes, title: str, found: list[tuple[str, str, float, float]]) -> None:
    axes.set_title(title, loc="left", fontsize=10.5, color=INK, fontweight="bold")
    lighten(axes)
    axes.axvline(1.0, color=SOFT, linewidth=0.8)
    axes.axhline(HALF_STEP, color=SOFT, linewidth=0.8, linestyle=(0, (2, 2)))
    axes.annotate(
        "half a step",
        (0.0, HALF_STEP),
        xycoords=("axes fraction", "data"),
        xytext=(3, 3),
        textcoords="offset points",
        fontsize=8,
        color=SOFT,
        path_effects=HALO,
    )
    for kind, (_, colour, marker) in KINDS.items():
        for beyond in (False, True):
            chosen = [(x, y) for _, k, x, y in found if k == kind and (y > BEYOND) == beyond]
            shape = BEYOND_MARK if beyond else marker
            across, up = [x for x, _ in chosen], [y for _, y in chosen]
            axes.scatter(across, up, s=20, marker=shape, color=colour, alpha=0.75, linewidths=1.0)
    plain = FuncFormatter(lambda v, _: f"{v:.6f}".rstrip("0").rstrip(".") if v < 1.0 else f"{v:g}")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(plain)
        axis.set_minor_formatter(NullFormatter())
    axes.yaxis.set_major_locator(FixedLocator([10.0**k for k in range(-6, 4)]))


def _legend(figure: Figure) -> None:
    """What the marks mean, above the panels."""
    rows = [(name, colour, marker) for name, colour, marker in KINDS.values()]
    rows.append((f"more than {BEYOND:g} steps", INK, BEYOND_MARK))
    marks = [
        Line2D([], [], linestyle="", marker=marker, color=colour, markersize=5, label=name)
        for name, colour, marker in rows
    ]
    figure.legend(
        handles=marks,
        loc="outside upper right",
        ncols=len(marks),
        frameon=False,
        fontsize=8.5,
        labelcolor=SOFT,
    )


def _name_best(axes: Axes, found: list[tuple[str, str, float, float]]) -> None:
    """Names beside the fastest variants within half a step, where they cover no mark, name or edge."""
    chosen = sorted((x, name, y) for name, kind, x, y in found if kind == "variant" and y <= HALF_STEP)
    marks = [(x, y) for _, _, x, y in found]
    dots: Any = axes.transData.transform(marks) if marks else []
    taken: list[Bbox] = [Bbox.from_bounds(x - MARK, y - MARK, 2 * MARK, 2 * MARK) for x, y in dots]
    (across, up), frame = axes.transData.transform((1.0, HALF_STEP)), axes.bbox
    taken += [
        Bbox.from_extents(across - 1.0, frame.y0, across + 1.0, frame.y1),
        Bbox.from_extents(frame.x0, up - 1.0, frame.x1, up + 1.0),
    ]
    named = 0
    for x, name, y in chosen:
        for place, side in ((NEAR, "left"), (-NEAR, "right")):
            text = axes.annotate(
                name,
                (x, y),
                xytext=(place, 0),
                textcoords="offset points",
                fontsize=7.5,
                color=INK,
                path_effects=HALO,
                va="center",
                ha=side,
            )
            text.set_in_layout(False)  # or the panels would make room for it
            box = text.get_window_extent()
            inside = axes.bbox.x0 <= box.x0 and box.x1 <= axes.bbox.x1
            if inside and not any(box.overlaps(other) for other in taken):
                taken.append(box)
                named += 1
                break
            text.remove()
        if named == NAMED:
            break
