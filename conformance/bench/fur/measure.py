"""Everything that is measured of fur on one driver, as data."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from datetime import UTC, datetime
from typing import Any

from codegen.backends import open_runtime
from codegen.library import Library
from codegen.version import VERSION
from conformance.bench.clocks import Clock
from conformance.bench.fur.fragments import Fragments, errors
from conformance.bench.fur.frames import (
    BY_HAND,
    FAKE_FUR,
    FIXED,
    FLOOR,
    GENERAL,
    SHELL_LIGHTING,
    TYPED_IN,
    Frame,
    frames,
    studio,
)
from conformance.bench.fur.rounds import as_data, drawn_in_turns, frame_clock, net_of, ratio, summary
from conformance.bench.fur.scaling import against_layers, against_pixels
from conformance.bench.record import described_device, machine_data, rounded
from targets import Device

SCHEMA = 1
PAIRS = ((GENERAL, BY_HAND), (FIXED, TYPED_IN), (FIXED, BY_HAND), (GENERAL, FIXED))
Say = Callable[[str], None]


def measured(
    library: Library, target: str, found: Mapping[str, Fragments], side: int, rounds: int, say: Say
) -> dict[str, Any]:
    """Times, ratios and errors of both scenes, and how the cost grows.

    found  fragments of each scene
    side   of the picture in pixels
    """
    runtime: Any = open_runtime(target)
    device: Device = runtime.device
    clock, clock_name = frame_clock(device)
    load = os.getloadavg()
    scenes = {}
    for name, turns in ((FAKE_FUR, rounds), (SHELL_LIGHTING, max(rounds - 1, 1))):
        say(f"{target}: {name}")
        made = frames(studio(library, name, side), target)
        scenes[name] = scene_data(made, target, turns, clock)
        shaded = {key: one for key, one in made.items() if key != FLOOR}
        scenes[name]["error"] = {key: errors(one, target, found[name]) for key, one in shaded.items()}
    say(f"{target}: shells and pixels")
    few = max(rounds // 2, 1)
    result = {
        "schema": SCHEMA,
        "version": VERSION,
        "date": datetime.now(UTC).date().isoformat(),
        "device": described_device(device),
        "machine": machine_data(),
        "load_average": {"before": list(load), "after": list(os.getloadavg())},
        "method": {
            "clock": clock_name,
            "order": "every frame forwards and backwards in each round (A B B A), the first one changing",
            "rounds": rounds,
            "picture": f"{side} x {side} pixels, one sample each, 32 layers, half floats",
            "net": "above a frame in one colour with the same hairs",
            "error": "of linear RGB in half steps of 8 bits, at the fragments of the shells, against float64",
        },
        "scenes": scenes,
        "layers": against_layers(library, target, few, clock),
        "pixels": against_pixels(library, target, few, clock),
    }
    data: dict[str, Any] = rounded(result)
    return data


def scene_data(made: dict[str, Frame], target: str, rounds: int, clock: Clock) -> dict[str, Any]:
    """Times of one scene's frames and the ratios of pairs."""
    times = drawn_in_turns(made, target, rounds, clock)
    ratios = []
    for first, second in PAIRS:
        if first in times and second in times:
            entry = {"of": first, "over": second, "ratio": as_data(ratio(times[first], times[second]))}
            if FLOOR in times:
                entry["net"] = as_data(net_of(times[first], times[second], times[FLOOR]))
            ratios.append(entry)
    return {"ms": summary(times), "ratios": ratios}
