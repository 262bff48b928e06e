"""How plots look: colours, and axes with a light grid behind and no frame."""

from __future__ import annotations

from matplotlib.axes import Axes

INK, SOFT, LINE = "#1d1c1a", "#5f5d58", "#dedcd5"
"""Of words, of words beside them, and of the grid."""
BLUE, ORANGE, GREEN, PURPLE = "#2563b8", "#b4540a", "#3b7a3e", "#7a3b76"
"""Of what is plotted, in this order."""


def lighten(axes: Axes, soft: str = SOFT, line: str = LINE, labels: float = 8.5) -> None:
    """Leave the axes an edge at the left and at the bottom, and a grid behind what is plotted.

    soft, line  colours of the numbers, and of edges and grid
    labels      size of the numbers
    """
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axes.spines[side].set_color(line)
    axes.grid(True, which="major", color=line, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.tick_params(colors=soft, labelsize=labels, which="both", length=0)
