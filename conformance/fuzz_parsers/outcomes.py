"""Files that programs write and people hand on: results of checks and of foreign backends, reports."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

from codegen.errors import UserError
from codegen.kit.results import ABOUT, read_results
from codegen.kit.vectors import FORMAT
from codegen.library import load_library
from codegen.version import VERSION
from conformance.check.merge import merge
from conformance.check.replay import from_record, records
from conformance.fuzz_parsers.parser import Parser, json_parser, npz_parser
from conformance.report.model import read_report
from conformance.report.scenes import read_scene_report

SEEDS = Path(__file__).parent / "seeds"


def results() -> Parser:
    """What `vair check --json` wrote, as --merge and --replay read it."""
    library = load_library()
    whole = _seed("results")

    def read(path: Path) -> object:
        refused = None
        try:
            merge([path])
        except UserError as e:
            refused = e
        for record in records(path):
            from_record(library, path, record)
        if refused is not None:
            raise refused
        return None

    return json_parser("results.json", read, [whole, whole["results"][0]["failures"]])


def kit() -> Parser:
    """Results of somebody else's backend, as `vair check --results` reads them."""
    library = load_library()
    about = _about()
    about["functions"]["sin_angle"]["rows"] = [["3f800000", 1.0, 0, "nan"]]
    return json_parser("results.json", lambda path: read_results(library, path), [about])


def kit_npz() -> Parser:
    """The same as arrays."""
    library = load_library()
    rows = {"dtype": "float32", "shape": [1, 4], "values": [1.0, 0.0, 0.5]}
    words = {"dtype": "uint32", "shape": [4], "values": [0x3F800000]}
    about = json.dumps(_about())
    trees = [{ABOUT: about, "sin_angle": rows}, {ABOUT: about, "sin_angle": words, "unused": about}]
    return npz_parser("results.npz", lambda path: read_results(library, path), trees)


def _about() -> dict[str, Any]:
    return {
        "kit": {
            "format": FORMAT,
            "version": VERSION,
            "lanes": 4,
            "family": 4,
            "functions": ["sin_angle", "frame_from_normal"],
        },
        "target": "glsl",
        "driver": "own",
        "functions": {
            "sin_angle": {"vectors": "x"},
            "frame_from_normal": {"vectors": "y", "failed": "no"},
        },
    }


def report() -> Parser:
    """report.json of `vair report`, as --against reads it."""
    return json_parser("report.json", read_report, [_seed("report")])


def scene_report() -> Parser:
    """report.json of `vair scene`, as `vair report --scene` reads it."""
    whole = _seed("scene_report")
    unproven = copy.deepcopy(whole)
    unproven["targets"][0] |= {"executed": False, "speed": None}
    return json_parser("report.json", read_scene_report, [whole, unproven])


def _seed(name: str) -> Any:
    return json.loads((SEEDS / f"{name}.json").read_text(encoding="utf-8"))
