"""Targets: where the generated library runs. Each folder holds one target's dialects and its runtime.

Importing this package imports no GPU package; a device is opened by open_runtime, once per process.
"""

import importlib
from threading import Lock
from typing import cast

from targets.programs import forget_programs
from targets.protocol import BuildFailed, Device, Runtime, TargetUnavailable, TimedRuntime

__all__ = [
    "TARGETS",
    "BuildFailed",
    "Device",
    "Runtime",
    "TargetUnavailable",
    "TimedRuntime",
    "forget_programs",
    "open_runtime",
    "probe",
]

TARGETS = ("glsl", "wgsl", "opencl")

_open: dict[tuple[str, tuple[tuple[str, object], ...]], TimedRuntime] = {}
_opening = Lock()


def open_runtime(name: str, **settings: object) -> TimedRuntime:
    """The runtime of a target, opened at the first call and shared by all later ones with the same settings.

    settings  keyword arguments of the target's own open_runtime, hashable; none for an ordinary run
    errors    TargetUnavailable names the missing driver or package; ValueError for a name not in TARGETS
    """
    if name not in TARGETS:
        raise ValueError(f"no target is called {name!r}; the targets are {', '.join(TARGETS)}")
    key = (name, tuple(sorted(settings.items())))
    with _opening:
        if key not in _open:
            module = importlib.import_module(f"targets.{name}.runtime")
            _open[key] = cast(TimedRuntime, module.open_runtime(**settings))
        return _open[key]


def probe(name: str) -> Device | TargetUnavailable:
    """The device of a target, or the reason why there is none (returned, not raised)."""
    try:
        return open_runtime(name).device
    except TargetUnavailable as reason:
        return reason
