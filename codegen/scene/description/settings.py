"""What a scene says of a parameter: a constant, a range, or that it equals another one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from codegen.errors import nearest
from codegen.ir.domains import Finite, Interval, Length, Unit, number
from codegen.ir.types import BOOL, F32, Struct, Vector
from codegen.scene.description.lights import Lights
from codegen.scene.description.model import COLOUR, HALF, LIGHT, Model, Slot
from codegen.scene.description.tables import Table, is_number, show

UNIT_SLACK = 1e-3
"""How far a constant direction may be from length 1 as it is written; it is normalised then."""


@dataclass(frozen=True)
class Constant:
    """One value, one number per component, rounded to float32."""

    value: tuple[float, ...]


@dataclass(frozen=True)
class Range:
    """A parameter that varies, with ends per component."""

    low: tuple[float, ...]
    high: tuple[float, ...]


@dataclass(frozen=True)
class Alias:
    """The value of another parameter."""

    path: str


Setting = Constant | Range | Alias


def read_settings(table: Table, model: Model, lights: Lights) -> dict[str, Setting]:
    """The settings of [parameters] by path; aliases lead to a parameter that is no alias itself."""
    known = model.settable
    found: dict[str, Setting] = {}
    for key in table.content:
        if key in (LIGHT, COLOUR, HALF) and key in model.slots:
            raise table.error(f'"{key}"', "comes from the lights of the scene: see [lights]")
        if key not in known:
            raise table.error(f'"{key}"', f"{model.function.name} has no such parameter{nearest(key, known)}")
        found[key] = _setting(table, key, known[key], known)
        if isinstance(found[key], Alias) and key in lights.per_light:
            raise table.error(f'"{key}"', "is in per_light: each light has its own, so it equals no other")
    return {path: _resolved(table, path, found, known) for path in found}


def _setting(table: Table, key: str, slot: Slot, known: dict[str, Slot]) -> Setting:
    value: Any = table.value(key)
    if isinstance(value, str):
        return _alias(table, key, value, slot, known)
    if isinstance(value, dict):
        return _range(table, key, value, slot)
    return Constant(_checked(table, f'"{key}"', numbers(table, f'"{key}"', value, slot), slot))


def _alias(table: Table, key: str, target: str, slot: Slot, known: dict[str, Slot]) -> Alias:
    same = [path for path, s in known.items() if s.type == slot.type and path != key]
    if target not in known:
        raise table.error(f'"{key}"', f'"{target}" is no parameter to be equal to{nearest(target, same)}')
    if known[target].type != slot.type or target == key:
        why = "itself" if target == key else f"a {known[target].type.name}"
        raise table.error(f'"{key}"', f'"{target}" is {why}; it must be another {slot.type.name}')
    return Alias(target)


def _range(table: Table, key: str, value: dict[str, Any], slot: Slot) -> Range:
    shown = f'"{key}"'
    for name in value:
        if name not in ("min", "max"):
            raise table.error(shown, f'unknown key "{name}" of a range{nearest(name, ("min", "max"))}')
    if isinstance(slot.domain, Unit):
        raise table.error(shown, "is a direction: give a constant, or say in [view] what is known of it")
    ends = []
    for name in ("min", "max"):
        if name not in value:
            raise table.error(shown, f"a range needs {name}")
        wide = numbers(table, f"{shown} {name}", value[name], slot, repeat=True)
        ends.append(_checked(table, f"{shown} {name}", wide, slot))
    for low, high in zip(*ends, strict=True):
        if low > high:
            raise table.error(shown, f"min = {low:g} is above max = {high:g}")
    return Constant(ends[0]) if ends[0] == ends[1] else Range(*ends)  # type: ignore[return-value]


def numbers(table: Table, shown: str, value: Any, slot: Slot, *, repeat: bool = False) -> tuple[float, ...]:
    """The components that a TOML value gives a slot, rounded to its type.

    repeat  whether one number may stand for all components
    """
    size = slot.type.size if isinstance(slot.type, Vector) else 1
    element = slot.type.element if isinstance(slot.type, Vector) else slot.type
    assert not isinstance(element, Struct)
    if element == BOOL and isinstance(value, bool):
        return (float(value),)
    given = value if isinstance(value, list) else [value] * (size if repeat else 1)
    shape = "a number" if size == 1 else f"{size} numbers"
    if not all(map(is_number, given)) or len(given) != size or (size == 1 and isinstance(value, list)):
        more = "" if repeat or (size > 1 and isinstance(value, list)) else ", a range or another parameter"
        raise table.error(shown, f"must be {shape}{more}, not {show(value)}")
    if element == F32:
        with np.errstate(over="ignore"):
            rounded = np.asarray(given, np.float64).astype(np.float32)
        if not np.isfinite(rounded).all():
            raise table.error(shown, f"{show(value)} is beyond float32")
        return tuple(float(x) for x in rounded)
    if any(x != math.floor(x) for x in given):
        raise table.error(shown, f"must be whole, not {show(value)}")
    return tuple(float(x) for x in given)


def _checked(table: Table, shown: str, value: tuple[float, ...], slot: Slot) -> tuple[float, ...]:
    """The value if the slot's domain holds it; directions are normalised."""
    domain = slot.domain
    outside = False
    match domain:
        case Interval():
            low, high = (float(np.float32(x)) for x in (domain.low, domain.high))
            outside = any(not low <= x <= high for x in value)
        case Unit() | Length():
            length = math.sqrt(sum(x * x for x in value))
            if isinstance(domain, Unit):
                if abs(length - 1.0) > UNIT_SLACK:
                    raise table.error(shown, f"has length {length:g}; it must be a unit vector")
                return tuple(float(np.float32(x / length)) for x in value)
            outside = length != 0.0 and not domain.low <= length <= domain.high * (1 + 1e-6)
        case Finite() | None:
            pass
    if outside:
        text = ", ".join(number(x) for x in value)
        written = f"[{text}]" if len(value) > 1 else text
        assert domain is not None
        raise table.error(shown, f"{written} is outside its domain: {domain.describe()}")
    return value


def _resolved(table: Table, path: str, found: dict[str, Setting], known: dict[str, Slot]) -> Setting:
    """The setting with chains of aliases followed to their end."""
    setting, seen = found[path], [path]
    while isinstance(setting, Alias):
        target = setting.path
        if target in seen:
            raise table.error(f'"{path}"', f"leads back to itself: {' = '.join([*seen, target])}")
        seen.append(target)
        following = found.get(target)
        if following is None or isinstance(following, Range):
            _check_alias(table, path, known[path], known[target], following)
            return Alias(target)
        if isinstance(following, Constant):
            return Constant(_checked(table, f'"{path}"', following.value, known[path]))
        setting = following
    return setting


def _check_alias(table: Table, path: str, slot: Slot, target: Slot, known: Setting | None) -> None:
    """Refuse an alias whose target takes values that the parameter does not."""
    if not isinstance(slot.domain, Interval) or not isinstance(target.domain, Interval):
        if (slot.domain is None) != (target.domain is None) or type(slot.domain) is not type(target.domain):
            raise table.error(f'"{path}"', f'"{target.path}" has another domain')
        return
    low, high = (
        (min(known.low), max(known.high))
        if isinstance(known, Range)
        else (
            target.domain.low,
            target.domain.high,
        )
    )
    if low < slot.domain.low or high > slot.domain.high:
        raise table.error(
            f'"{path}"',
            f'"{target.path}" reaches {number(low)} to {number(high)}, '
            f"but this parameter is {slot.domain.describe()}: give that one a range",
        )
