"""The hand-written stages of handwritten/ as texts: general, with the material typed in, or without light."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from codegen.fur.shading import member_name
from codegen.fur.stages import STAGES

FOLDER = Path(__file__).parent / "handwritten"
_DARK = (
    (r"\n    shade_\w+: [\w<>]+,", ""),
    (r"fn fake_fur\(.*?\n}\n\n", ""),
    (r"fake_fur\([^;]*?, point\.share\), (alpha|1\.0)\);", r"vec3<f32>(0.5, 0.4, 0.3), \1);"),
)
"""What takes the light out of the WGSL, with the uniforms that it needs."""
_WHOLE = {"glsl": r"\bat_share\.[xy]", "wgsl": r"\b(?:point\.|(?<![\w.]))share\.[xy]"}
"""What scales a painted coat; a coat that is not painted has 1 in its place."""


def by_hand(target: str, material: Mapping[str, Any] | None = None) -> dict[str, str]:
    """The stages by file name, as codegen.fur.stages.stage_texts names them.

    material  values by path to be typed in, for a coat that is not painted; None: uniforms
    """
    text = (FOLDER / f"fur.{target}").read_text(encoding="utf-8")
    if material is not None:
        vector = "vec3" if target == "glsl" else "vec3<f32>"
        for path, value in material.items():
            numbers = [f"{x:.9g}" for x in np.atleast_1d(np.asarray(value, np.float32)).tolist()]
            numbers = [x if set(x) & set(".e") else f"{x}.0" for x in numbers]
            typed = numbers[0] if len(numbers) == 1 else f"{vector}({', '.join(numbers)})"
            text = text.replace(f"fur.{member_name(path)}", typed)
        head, fragment = re.split(r"(?=\buvec3 pcg3d|\bfn pcg3d)", text)
        text = head + re.sub(_WHOLE[target], "1.0", fragment)
    return {"fur.wgsl": text} if target == "wgsl" else _stages(text)


def floor(target: str) -> dict[str, str]:
    """The same hairs in one colour: what a frame costs beside its lighting."""
    if target == "glsl":
        return {
            name: stage.replace("#version 330\n", "#version 330\n#define FLOOR\n")
            for name, stage in by_hand(target).items()
        }
    text = by_hand(target)["fur.wgsl"]
    for pattern, left in _DARK:
        text = re.sub(pattern, left, text, flags=re.DOTALL)
    return {"fur.wgsl": text}


def _stages(text: str) -> dict[str, str]:
    kinds = {"vert": "VERTEX", "frag": "FRAGMENT"}
    return {
        f"{stage}.{ending}": f"#version 330\n#define {stage.upper()}\n#define {kind}\n{text}"
        for stage in STAGES
        for ending, kind in kinds.items()
    }
