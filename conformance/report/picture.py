"""The overview as a picture for the README: every variant's time beside its error, one panel per driver."""

from __future__ import annotations

import io
from collections.abc import Mapping
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter

from conformance.report.model import HALF_STEP, error_in, label

MODE, UNIT = "throughput", "steps"
INK, SOFT, LINE, ACCENT, OTHER = "#1d1c1a", "#5f5d58", "#dedcd5", "#2563b8", "#b4540a"
EXACT = 1e-6
"""Where results without any error are drawn."""
PANEL_INCHES, HEIGHT_INCHES, DOTS_PER_INCH = 3.7, 3.9, 200
NAMED = 5
"""Variants per panel that bear their names: those that gain most without leaving half a step."""


def overview(report: Mapping[str, Any]) -> bytes:
    """The picture as PNG."""
    results = report["drivers"]
    with_points = [(label(r), points(r)) for r in results]
    figure = Figure(figsize=(max(PANEL_INCHES * len(results), 4.5), HEIGHT_INCHES), layout="constrained")
    panels = figure.subplots(1, len(results), sharex=True, sharey=True, squeeze=False)[0]
    for axes, (title, found) in zip(panels, with_points, strict=True):
        _panel(axes, title, found)
    panels[0].set_ylabel("largest error in 8-bit steps", color=SOFT)
    figure.supxlabel("time relative to the default form of the same function", color=SOFT, fontsize=10)
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
    axes.set_xscale("log")
    axes.set_yscale("log")
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
    gain = sorted((x, name, y) for name, kind, x, y in found if kind == "variant" and y <= HALF_STEP)
    for x, name, y in gain[:NAMED]:
        axes.annotate(
            name, (x, y), xytext=(5, 0), textcoords="offset points", fontsize=6.5, color=INK, va="center"
        )
