"""What was dropped, substituted, saved and lost: the report of a scene as data."""

from __future__ import annotations

import json
from typing import Any

from codegen.passes.ssa.values import Step
from codegen.scene.build import Outcome, TargetResult
from codegen.scene.description.document import HALF_STEP
from codegen.scene.description.settings import Alias, Constant, Range
from codegen.scene.proof.errors import MARGIN, Measured
from codegen.scene.proof.proof import Proof
from codegen.version import VERSION

SCHEMA = 1
GIVEN = "substitute"
"""The passes' name for what the scene states itself; it is listed as given, not as done."""


def as_data(outcome: Outcome) -> dict[str, Any]:
    """Everything as plain data."""
    scene = outcome.scene
    first = outcome.targets[0]
    return {
        "schema": SCHEMA,
        "version": VERSION,
        "scene": {
            "name": scene.name,
            "file": scene.path.name,
            "function": scene.function,
            "model": scene.model.function.name,
            "budget": scene.budget,
            "budget_stated": scene.budget_text,
            "given": {path: _setting(value) for path, value in scene.settings.items()},
            "facts": {f"{a}.{b}": list(ends) for (a, b), ends in scene.facts.items()},
            "lights": {
                "directional": scene.lights.directional,
                "point": scene.lights.point,
                "environment": scene.lights.environment.name if scene.lights.environment else None,
                "environment_lights": len(outcome.constant_lights),
                "per_light": list(scene.lights.per_light),
            },
        },
        "parameters": {
            "before": [p.name for p in outcome.general.function.parameters],
            "left": [
                {"name": p.name, "type": p.type.name, "domain": p.domain.describe() if p.domain else None}
                for p in first.reduced.final.function.parameters
            ],
            "gone": [
                p.name
                for p in outcome.general.function.parameters
                if p.name not in {q.name for q in first.reduced.final.function.parameters}
            ],
        },
        "exact_steps": _steps(first.reduced.exact.log),
        "targets": [_target(r, scene.budget) for r in outcome.targets],
        "remaining": [
            {"parameter": r.name, "operations_if_constant": r.operations} for r in outcome.remaining
        ],
        "environment": _environment(outcome),
        "proof_points": first.proof.points,
        "hard_points": outcome.hard_points,
        "margin": MARGIN,
    }


def _setting(value: Any) -> Any:
    match value:
        case Constant():
            return {"constant": list(value.value) if len(value.value) > 1 else value.value[0]}
        case Range():
            return {"min": list(value.low), "max": list(value.high)}
        case Alias():
            return {"equals": value.path}


def _steps(log: tuple[Step, ...]) -> list[dict[str, str]]:
    return [
        {"pass": step.name, "what": step.what, "why": step.why, "where": step.where}
        for step in log
        if step.name != GIVEN
    ]


def _target(r: TargetResult, budget: float) -> dict[str, Any]:
    general, special = (name for name in ("general", "final"))
    speeds = list(r.speeds.values())
    return {
        "target": r.target,
        "language": r.title,
        "file": r.file,
        "driver": r.proof.driver,
        "executed": r.proof.executed,
        "not_executed_because": r.unavailable or None,
        "prices": r.reduced.prices,
        "approximations": [
            {
                "kind": c.kind,
                "what": c.what,
                "why": c.why,
                "saving": c.saving or None,
                "predicted_error": c.error,
                "refused_before": list(c.refused),
            }
            for c in r.reduced.changes
        ],
        "predicted": _measured(r.reduced.error, budget),
        "exact_proof": _proof(r.exact_proof, 0.0),
        "proof": _proof(r.proof, budget),
        "operations": {key: {**counts, "all": sum(counts.values())} for key, counts in r.operations.items()},
        "lines": r.lines,
        "spirv_instructions": r.spirv or None,
        "speed": None
        if len(speeds) != 2
        else {
            "unit": "ns per evaluation, net of inputs and loop",
            general: vars(speeds[0]),
            special: vars(speeds[1]),
            "ratio": speeds[1].ns / speeds[0].ns if min(s.low for s in speeds) > 0.0 else None,
        },
    }


def _measured(m: Measured, budget: float) -> dict[str, Any]:
    return {
        "largest": m.largest,
        "p999": m.p999,
        "half_steps_8bit": m.largest / HALF_STEP,
        "share_of_budget": m.largest / budget if budget else None,
    }


def _proof(p: Proof, budget: float) -> dict[str, Any]:
    return {
        "points": p.points,
        "error": _measured(p.error, budget),
        "general_itself": _measured(p.general, budget),
        "different_bits": p.different,
        "judged_by_intervals": p.judged,
        "outside_intervals": p.outside,
        "holds": p.holds(budget),
    }


def _environment(outcome: Outcome) -> dict[str, Any] | None:
    e = outcome.environment
    if e is None:
        return None
    return {
        "lights": [
            {"direction": light.direction, "colour": light.colour} for light in outcome.constant_lights
        ],
        "mean_radiance": e.mean_radiance,
        "largest_error": e.largest,
        "rms_error": e.rms,
        "relative_rms": e.rms / e.mean_radiance if e.mean_radiance else None,
        "points": e.points,
        "texels": e.texels,
    }


def as_json(data: dict[str, Any]) -> str:
    """The report as JSON."""
    return json.dumps(data, indent=1, sort_keys=False) + "\n"
