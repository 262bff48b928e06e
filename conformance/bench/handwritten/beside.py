"""The function of a scene, the general one and two hand-written ones, timed and judged side by side."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.backends import dialect
from codegen.emit.module import DEFAULT_PREFIX, emit
from codegen.execute import flatten, unflatten
from codegen.ir import nodes as ir
from codegen.ir.types import leaves
from codegen.kernels import kernel
from codegen.library import Library
from codegen.passes.analysis.operations import operations
from codegen.scene.description.document import read_scene
from codegen.scene.general import general_function
from codegen.scene.proof.errors import as_floats
from codegen.scene.proof.points import draw
from codegen.scene.reduction.prices import Prices
from codegen.scene.reduction.reduce import Reducer
from codegen.scene.report import stopwatch

FOLDER = Path(__file__).parent
SCENE = FOLDER / "dense-fur.toml"
ENDINGS = {"glsl": "glsl", "wgsl": "wgsl", "opencl": "cl"}
BY_HAND, FIXED = "fur_by_hand", "fur_by_hand_fixed"
POINTS = 20_000
HALF_STEP = 1.0 / 510.0
"""Half a step of 8 bits: the unit of the errors."""


@dataclass(frozen=True)
class Row:
    """One function on one driver.

    ns, low, high        median and quartiles of nanoseconds per evaluation
    ordinary, hard       largest error in half steps of 8 bits over uniform points and over hard cases
    non_finite           results that are no number, of all points
    operations           of an emitted function and all that it calls, None of a hand-written one
    """

    function: str
    ns: float
    low: float
    high: float
    ordinary: float
    hard: float
    non_finite: int
    operations: int | None


def handwritten(target: str) -> str:
    """The hand-written functions in a target's language."""
    return (FOLDER / f"fakefur.{ENDINGS[target]}").read_text(encoding="utf-8")


def rows(library: Library, runtime: Any, target: str) -> list[Row]:
    """The general function, the scene's, and both hand-written ones, on one driver."""
    scene = read_scene(SCENE, library)
    general = general_function(scene)
    extended = library.with_functions([general.function])
    points = draw(scene, general, POINTS)
    reducer = Reducer.of(extended, scene, general, points)
    final = reducer.reduced(Prices.of(extended, target), scene.budget).final.function
    stand_ins = [stand_in(general.function, BY_HAND), stand_in(final, FIXED)]
    whole = extended.with_functions([final, *stand_ins])
    names = [general.function.name, final.name, BY_HAND, FIXED]
    ordinary = {key: np.asarray(value)[~points.hard] for key, value in points.inputs.items()}
    written = dict.fromkeys((BY_HAND, FIXED), prefixed(target))
    speeds = stopwatch.measure(whole, names, runtime, ordinary, texts=written)
    found = []
    for name in names:
        got = as_floats(values(whole, name, runtime, target, points.inputs, written.get(name)))
        finite: npt.NDArray[np.bool_] = np.asarray(np.isfinite(got).all(axis=1))
        off = np.abs(np.where(finite[:, None], got, 0.0) - reducer.reference.exact).max(axis=1) / HALF_STEP
        speed = speeds[name]
        found.append(
            Row(
                name,
                speed.ns,
                speed.low,
                speed.high,
                float(off[finite & ~points.hard].max()),
                float(off[finite & points.hard].max()),
                int((~finite).sum()),
                None if name in written else sum(operations(whole.function(name), whole).values()),
            )
        )
    return found


def stand_in(function: ir.Function, name: str) -> ir.Function:
    """A function with the parameters of another, whose text is written by hand."""
    return replace(function, name=name)


def prefixed(target: str) -> str:
    """The hand-written functions under the library's prefix, as kernels call them."""
    text = handwritten(target)
    return text.replace(f" {BY_HAND}", f" {DEFAULT_PREFIX}{BY_HAND}")


def values(
    library: Library,
    name: str,
    runtime: Any,
    target: str,
    inputs: Mapping[str, Any],
    written: str | None,
) -> Any:
    """A function's values on a device, in the text that is written for it or in the emitted one."""
    function = library.function(name)
    program = kernel(library, name, target)
    if written is not None:
        emitted = emit(library, dialect(target), [name])
        assert emitted in program
        program = program.replace(emitted, written)
    count = len(next(iter(inputs.values())))
    words = flatten([np.asarray(inputs[p.name]) for p in function.parameters], count)
    return unflatten(function.returns, runtime.run(program, words, len(leaves(function.returns))))
