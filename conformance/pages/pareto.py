"""Speed against error of a function and its variants on one driver, as SVG in the page's own colours."""

from __future__ import annotations

import io
import math
import re
from collections.abc import Sequence
from typing import Any

import matplotlib
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from conformance.plots import lighten

INCHES = (4.2, 3.0)
COLOURS = {
    "#111111": "var(--ink)",
    "#222222": "var(--soft)",
    "#333333": "var(--line)",
    "#444444": "var(--variant)",
    "#555555": "var(--front)",
}
"""Stand-ins that matplotlib draws with -> what the style sheet says, in light and in dark."""
INK, SOFT, LINE, VARIANT, FRONT = COLOURS
LEAST = 1e-9
"""Error at which results without any error are drawn."""


def _power(value: float, _: object) -> str:
    """1e-6, 1, 1e4."""
    exponent = round(math.log10(value))
    return f"1e{exponent}" if exponent else "1"


def mark(name: str) -> str:
    """The style property that fills a function's mark."""
    return f"--mark-{name}"


def picture(points: Sequence[dict[str, Any]], base: str, title: str) -> str:
    """An svg element: time across, error up. The style property `mark` of a function fills its mark.

    points  as conformance.pages.recorded.group_points gives them
    """
    with matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": "vair", "font.family": "sans-serif"}):
        # Fixed margins and no minor ticks: fitting and measuring them takes most of the time.
        figure = Figure(figsize=INCHES)
        axes = figure.add_axes((0.16, 0.17, 0.8, 0.72))
        axes.set_xscale("log")
        axes.set_yscale("log")
        best = sorted((p["ns"], max(p["error"], LEAST)) for p in points if p["front"])
        axes.step([x for x, _ in best], [y for _, y in best], where="post", color=FRONT, linewidth=1.4)
        filled: dict[str, str] = {}
        for k, p in enumerate(points):
            x, y = p["ns"], max(p["error"], LEAST)
            colour = INK if p["name"] == base else VARIANT
            face = f"#77{k:04x}"
            filled[face] = f"var({mark(p['name'])}, none)"
            axes.plot([x], [y], "o", markersize=6, color=colour, markerfacecolor=face)
            label = p["name"].removeprefix(base).strip("_") or "default"
            axes.annotate(label, (x, y), xytext=(6, 4), textcoords="offset points", fontsize=8, color=SOFT)
        axes.margins(0.22)
        lighten(axes, SOFT, LINE, labels=8)
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))
        axes.yaxis.set_major_formatter(FuncFormatter(_power))
        axes.xaxis.set_minor_locator(NullLocator())
        axes.yaxis.set_minor_locator(NullLocator())
        axes.set_xlabel("ns per evaluation", color=SOFT, fontsize=8.5)
        axes.set_ylabel(f"largest {points[0]['measure']} error", color=SOFT, fontsize=8.5)
        axes.set_title(title, loc="left", fontsize=9.5, color=INK)
        stream = io.StringIO()
        figure.savefig(stream, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    text = stream.getvalue()
    text = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg") :], flags=re.DOTALL)
    for drawn, styled in (COLOURS | filled).items():
        text = text.replace(drawn, styled)
    return text
