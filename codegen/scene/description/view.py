"""What a scene knows of directions: ranges of the cosines between them."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Mapping

import numpy as np

from codegen.errors import nearest
from codegen.scene.description.model import HALF, LIGHT, Model
from codegen.scene.description.settings import Alias, Constant, Setting
from codegen.scene.description.tables import Table

Facts = dict[tuple[str, str], tuple[float, float]]
"""Least and largest cosine of pairs of directions, by the model's own names in alphabetical order."""

SLACK = 1e-6
"""Angle by which facts that just meet may miss each other, in radians."""


def read_facts(table: Table, model: Model, settings: Mapping[str, Setting]) -> Facts:
    """The facts of [view], which have keys like min_n_dot_v; raises UserError where they contradict."""
    directions = [d for d in model.directions if d != HALF] + ([LIGHT] if HALF in model.directions else [])
    directions = list(dict.fromkeys(directions))
    valid = [f"{end}_{a}_dot_{b}" for a, b in itertools.permutations(directions, 2) for end in ("min", "max")]
    preferred = [f"{end}_n_dot_{b}" for b in ("v", "l") for end in ("min", "max")]
    found: Facts = {}
    for key in table.content:
        if key not in valid:
            raise table.error(
                key, f"is no fact about directions{nearest(key, valid)}" + _examples(preferred, key, valid)
            )
        match = re.fullmatch(r"(min|max)_(\w+?)_dot_(\w+)", key)
        assert match is not None
        end, *pair = match.groups()
        a, b = sorted(_named(name, settings) for name in pair)
        value = table.number(key, -1.0, 1.0)
        low, high = found.get((a, b), (-1.0, 1.0))
        found[a, b] = (max(low, value), high) if end == "min" else (low, min(high, value))
    table.close()
    _check(table, found, settings)
    return found


def _examples(preferred: list[str], key: str, valid: list[str]) -> str:
    return "" if "mean" in nearest(key, valid) else f"; facts are written like {preferred[0]} = 0.05"


def _named(name: str, settings: Mapping[str, Setting]) -> str:
    """The direction that stands for an alias."""
    setting = settings.get(name)
    return setting.path if isinstance(setting, Alias) else name


def _check(table: Table, facts: Facts, settings: Mapping[str, Setting]) -> None:
    for (a, b), (low, high) in facts.items():
        if a == b and low > 1.0 - SLACK:
            continue
        if low > high or (a == b and high < 1.0):
            raise table.error(f"min_{a}_dot_{b}", f"{low:g} contradicts max_{a}_dot_{b} = {high:g}")
        values = [settings.get(name) for name in (a, b)]
        if all(isinstance(v, Constant) for v in values):
            first, second = (v.value for v in values if isinstance(v, Constant))
            cosine = float(np.dot(first, second))
            if not low - SLACK <= cosine <= high + SLACK:
                raise table.error(
                    f"min_{a}_dot_{b}",
                    f"contradicts the constants of {a} and {b}, whose cosine is {cosine:g}",
                )
    names = sorted({name for pair in facts for name in pair})
    for triple in itertools.combinations(names, 3):
        _check_triangle(table, facts, triple)


def _check_triangle(table: Table, facts: Facts, names: tuple[str, ...]) -> None:
    """Angles between three directions: none exceeds the sum of the others, and together at most a turn."""
    pairs = list(itertools.combinations(names, 2))
    angles = []
    for pair in pairs:
        low, high = facts.get(pair, (-1.0, 1.0))
        angles.append((math.acos(high), math.acos(low)))
    for k, pair in enumerate(pairs):
        least = angles[k][0]
        others = [angles[j][1] for j in range(3) if j != k]
        if least > sum(others) + SLACK:
            first, second = (pairs[j] for j in range(3) if j != k)
            raise table.error(
                f"max_{pair[0]}_dot_{pair[1]}",
                f"contradicts min_{first[0]}_dot_{first[1]} and min_{second[0]}_dot_{second[1]}: "
                f"no three directions are like that",
            )
    if sum(low for low, _ in angles) > 2.0 * math.pi + SLACK:
        first = pairs[0]
        raise table.error(
            f"max_{first[0]}_dot_{first[1]}",
            f"contradicts the other facts on {', '.join(names)}: no three directions are like that",
        )
