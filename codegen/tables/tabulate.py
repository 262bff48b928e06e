"""The smallest bilinear table of a function of two arguments that stays within an error budget."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from codegen.errors import UserError
from codegen.maps.bilinear import at_places
from codegen.tables.axes import Axis

Array = npt.NDArray[np.float64]
Evaluated = Callable[[Array, Array], Array]

SMALLEST, LARGEST, LIMIT = 8, 1024, 8192
"""Texels along a side: at least, at most unless asked for more, at most."""
PROBE = 64
"""Size at which the warps are compared."""
INSIDE = (0.25, 0.5, 0.75)
"""Places within a cell, along both axes, at which the error is measured; the end cells also near the ends."""


@dataclass(frozen=True)
class Table:
    """values (rows of y, columns of x) float32; the first and last texel centres are the ends of the axes.

    The lookup of coordinates c in [0, 1] is at texture coordinates (c (size - 1) + 0.5) / size.
    """

    x: Axis
    y: Axis
    values: npt.NDArray[np.float32]
    error: float

    def value(self, a: Array, b: Array) -> Array:
        """Bilinear lookups at arguments."""
        height, width = self.values.shape
        x, y = self.x.coordinate(a) * (width - 1), self.y.coordinate(b) * (height - 1)
        return at_places(self.values[:, :, None], x, y)[..., 0]


def tabulate(x: Axis, y: Axis, function: Evaluated, budget: float, largest: int = LARGEST) -> Table:
    """The table with the fewest texels, sides powers of two, whose measured error is within the budget.

    The warps are those that serve best at a size of PROBE.

    raises  UserError where no table up to the largest size is good enough: says the best achievable; for a
            function that is not finite everywhere
    """
    if not budget > 0.0:
        raise UserError(f"budget {budget:g}: the largest error of a table is above 0")
    if not SMALLEST <= largest <= LIMIT:
        raise UserError(f"largest side {largest}: a table has {SMALLEST} to {LIMIT} texels along a side")
    warped = [(replace(x, warp=a), replace(y, warp=b)) for a in x.warps() for b in y.warps()]
    x, y = min(warped, key=lambda axes: made(axes[0], axes[1], function, PROBE, PROBE).error)
    size = SMALLEST
    table = made(x, y, function, size, size)
    while table.error > budget:
        if size >= largest:
            raise UserError(
                f"no table of {size} x {size} texels keeps within {budget:g}: its error is {table.error:.2g}"
            )
        size *= 2
        table = made(x, y, function, size, size)
    return _narrowed(table, function, budget)


def _narrowed(table: Table, function: Evaluated, budget: float) -> Table:
    """The table with either side halved as long as the error stays within the budget."""
    while True:
        height, width = table.values.shape
        sizes = [(width // 2, height)] * (width > SMALLEST) + [(width, height // 2)] * (height > SMALLEST)
        tried = [made(table.x, table.y, function, w, h) for w, h in sizes]
        fitting = [t for t in tried if t.error <= budget]
        if not fitting:
            return table
        table = min(fitting, key=lambda t: t.error)


def made(x: Axis, y: Axis, function: Evaluated, width: int, height: int) -> Table:
    """A table of the size, with its largest measured error."""
    a, b = np.meshgrid(x.value(np.linspace(0.0, 1.0, width)), y.value(np.linspace(0.0, 1.0, height)))
    finite = _finite(function, x, y)
    values = finite(a.ravel(), b.ravel()).reshape(height, width).astype(np.float32)
    table = Table(x, y, values, 0.0)
    a, b = np.meshgrid(x.value(_places(width)), y.value(_places(height)))
    worst = 0.0
    for rows_a, rows_b in zip(np.array_split(a, 16), np.array_split(b, 16), strict=True):
        flat_a, flat_b = rows_a.ravel(), rows_b.ravel()
        if flat_a.size:
            worst = max(worst, float(np.abs(table.value(flat_a, flat_b) - finite(flat_a, flat_b)).max()))
    return replace(table, error=worst)


def _finite(function: Evaluated, x: Axis, y: Axis) -> Evaluated:
    """The function, which is refused where it has no finite value."""

    def checked(a: Array, b: Array) -> Array:
        found = np.asarray(function(a, b))
        wrong = ~(np.abs(found) <= np.finfo(np.float32).max)
        if wrong.any():
            k = int(np.flatnonzero(wrong)[0])
            raise UserError(f"the function is {found[k]:g} at {x.name} = {a[k]:g}, {y.name} = {b[k]:g}")
        return found

    return checked


def _places(size: int) -> Array:
    """Coordinates inside every cell, and close to both ends of the axis."""
    cells = (np.arange(size - 1)[:, None] + np.array(INSIDE)[None, :]).ravel()
    near = np.array([0.02, 0.1])
    return np.sort(np.concatenate([near, cells, (size - 1) - near])) / (size - 1)
