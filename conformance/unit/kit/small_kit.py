"""A small kit of functions of every kind of value, and results that the evaluator computes of it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from codegen.cli import run
from codegen.evaluate import evaluate
from codegen.execute import flatten, unflatten
from codegen.kit.rows import hexadecimal, input_rows
from codegen.library import load_library

FUNCTIONS = ("sin_angle", "pcg3d", "strand_angles", "safe_pow")
"""A number, whole numbers, a struct, and a function of numbers alone."""
LANES = 16
Data = dict[str, Any]


def write_kit(folder: Path) -> Path:
    """The kit in a new folder."""
    names = [part for name in FUNCTIONS for part in ("--function", name)]
    assert run(["kit", "-o", str(folder), "--lanes", str(LANES), *names]) == 0
    return folder


def load(path: Path) -> Any:
    """The content of a JSON file."""
    return json.loads(path.read_text(encoding="utf-8"))


def compute(kit: Path) -> Data:
    """Results of the evaluator in float32, as a runner writes them."""
    functions = {}
    for name in FUNCTIONS:
        vectors = load(kit / "vectors" / f"{name}.json")
        function = load_library().function(name)
        words = np.array([[int(w, 16) for w in row["words"]] for row in vectors["inputs"]], np.uint32)
        parts, first = {}, 0
        for p in function.parameters:
            count = sum(row.path.split(".")[0] == p.name for row in input_rows(function))
            parts[p.name] = unflatten(p.type, words[first : first + count])
            first += count
        rows = flatten([evaluate(load_library(), name, parts)], vectors["lanes"])
        functions[name] = {"vectors": vectors["vectors"], "rows": [hexadecimal(row) for row in rows]}
    about = load(kit / "kit.json")["kit"]
    return {"kit": about, "target": "opencl", "driver": "an engine", "functions": functions}


def judged(path: Path, data: Any, *options: str) -> int:
    """Write results and have them judged; the exit status."""
    path.write_text(json.dumps(data), encoding="utf-8")
    return run(["check", "--results", str(path), *options])


def copy(data: Data) -> Data:
    """The same data, to be changed."""
    copied: Data = json.loads(json.dumps(data))
    return copied
