"""What computes a function in float32: a target's device, or the evaluator."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from codegen.evaluate import evaluate
from codegen.execute import execute
from codegen.intervals import DEFAULT_TABLES
from codegen.kernels import kernel
from codegen.library import Library
from targets import Device, open_runtime

LOOSEST_TABLE = "wgsl"
"""Judges what is computed without a device: float32 arithmetic with numpy's functions."""

Run = Callable[[Library, str, Mapping[str, Any]], Any]
Text = Callable[[Library, str], str]


@dataclass(frozen=True)
class Backend:
    """Something that computes a function in float32.

    driver  what it says of itself
    name    as a replay identity carries it: the target, or a driver with its mode
    table   the accuracy table whose intervals judge it; that of the target if empty
    text    the program that it is given for a function, if it is given one
    device  the device behind it, if there is one
    """

    target: str
    driver: str
    run: Run
    name: str = ""
    table: str = ""
    text: Text | None = None
    device: Device | None = None

    @property
    def judged_by(self) -> str:
        """Name of the accuracy table."""
        return self.table or DEFAULT_TABLES.get(self.target, LOOSEST_TABLE)


def backend(target: str) -> Backend:
    """A target's backend, or "numpy": the IR evaluated op by op in float32. Raises TargetUnavailable."""
    if target == "numpy":
        return Backend("numpy", f"numpy {np.__version__}, float32 op by op", evaluate)
    runtime = open_runtime(target)

    def run(library: Library, name: str, inputs: Mapping[str, Any]) -> Any:
        return execute(library, name, inputs, runtime)

    def text(library: Library, name: str) -> str:
        return kernel(library, name, target)

    return Backend(target, told(runtime.device), run, text=text, device=runtime.device)


def told(device: Device) -> str:
    """What a device says of itself, in one line."""
    return f"{device.api}; {device.driver}; {device.device}"
