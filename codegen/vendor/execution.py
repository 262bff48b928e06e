"""Old and new text of a function on one driver, over the same points."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from codegen.backends import complete_program, dialect
from codegen.emit.module import DEFAULT_PREFIX, HALF_PREFIX
from codegen.errors import UserError
from codegen.evaluate.arrays import Value, arithmetic, convert_inputs
from codegen.execute import check_precision, on_device, rounded_halves, unflatten
from codegen.ir.types import leaves
from codegen.kernels import KernelOptions, called_type, kernel_body
from codegen.library import Library
from codegen.vendor.changes import FLOOR, Code, Difference

Inputs = Mapping[str, Any]


@dataclass(frozen=True)
class Execution:
    """What compares codes.

    library   of the new texts; it knows the function's types
    prefix    of both texts
    precision  single or half, of both
    runtimes  target -> runtime, or a sentence why there is none
    draw      function name -> inputs by parameter, or a sentence why there are none
    told      function name, inputs, lane -> the inputs in words
    refusal   what a runtime raises where its driver refuses a text
    say       hears what is executed
    """

    library: Library
    prefix: str
    runtimes: Callable[[str], Any]
    draw: Callable[[str], Inputs | str]
    told: Callable[[str, Inputs, int], str]
    refusal: type[Exception]
    say: Callable[[str], None] = lambda sentence: None
    precision: Literal["single", "half"] = "single"

    def compare(self, name: str, where: str, old: Code, new: Code) -> Difference | str:
        """The difference over the drawn points, or a sentence why nothing was executed."""
        target = where.partition("/")[0]
        runtime = self.runtimes(target)
        if isinstance(runtime, str):
            return runtime
        try:
            check_precision(runtime, self.options)
        except UserError as e:
            return str(e)
        inputs = self.draw(name)
        if isinstance(inputs, str):
            return inputs
        self.say(f"executing {name} on {target}")
        before = self._run(name, target, old, inputs, runtime)
        after = self._run(name, target, new, inputs, runtime)
        for which, found in (("the vendored text", before), ("the new text", after)):
            if isinstance(found, str):
                return f"{runtime.device.device} refuses {which}: {found}"
        assert not isinstance(before, str) and not isinstance(after, str)
        device = runtime.device
        return self._difference(name, f"{device.device}; {device.driver}", inputs, before, after)

    @property
    def options(self) -> KernelOptions:
        """How texts are called."""
        return KernelOptions(precision=self.precision)

    def _run(
        self, name: str, target: str, code: Code, inputs: Inputs, runtime: Any
    ) -> npt.NDArray[np.float64] | str:
        """Results as numbers, one row per scalar; a sentence where the driver refuses the text."""
        function = called_type(self.library, name, self.options)
        own = HALF_PREFIX if self.precision == "half" else DEFAULT_PREFIX
        body = re.sub(rf"\b{own}(?=\w)", self.prefix, kernel_body(self.library, name, target, self.options))
        enable = [dialect(target).half_enable] if self.precision == "half" else []
        text = "\n\n".join([*enable, *("\n".join(lines) for lines in code)]) + "\n"
        types = {p.name: p.type for p in function.parameters}
        arrays, count = convert_inputs(types, inputs, arithmetic("float32"), name)
        arrays = {p.name: rounded_halves(p.type, arrays[p.name]) for p in function.parameters}
        words, maps = on_device(function, arrays, count)
        further = {"textures": maps} if maps else {}
        try:
            out = runtime.run(
                complete_program(target, text, body), words, len(leaves(function.returns)), **further
            )
        except self.refusal as e:
            return " ".join(str(e).split())[:200]
        return _rows(unflatten(function.returns, out))

    def _difference(
        self,
        name: str,
        driver: str,
        inputs: Inputs,
        before: npt.NDArray[np.float64],
        after: npt.NDArray[np.float64],
    ) -> Difference:
        finite = np.isfinite(before) & np.isfinite(after)
        apart = np.where(finite, np.abs(np.where(finite, after, 0.0) - np.where(finite, before, 0.0)), 0.0)
        size = np.where(finite, np.maximum(np.abs(before), np.abs(after)), 1.0)
        relative = apart / np.maximum(size, FLOOR)
        lane = int(apart.max(axis=0).argmax())
        broken = [int((~np.isfinite(found)).any(axis=0).sum()) for found in (before, after)]
        return Difference(
            driver=driver,
            points=before.shape[1],
            absolute=float(apart.max()),
            relative=float(relative.max()),
            where=self.told(name, inputs, lane) if apart.max() > 0.0 else "",
            non_finite=(broken[0], broken[1]),
        )


def _rows(value: Value) -> npt.NDArray[np.float64]:
    if isinstance(value, dict):
        return np.concatenate([_rows(part) for part in value.values()])
    assert isinstance(value, np.ndarray)
    array = value.astype(np.float64)
    return array[None] if array.ndim == 1 else np.ascontiguousarray(array.T)
