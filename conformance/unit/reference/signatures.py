"""Stand-ins for the functions of the library: references and cases are tested without the generator.

Names, parameter order and types are the library's; the domains are the ones its text implies.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Interval:
    low: float
    high: float
    scale: str = "linear"


@dataclass(frozen=True)
class Unit:
    pass


@dataclass(frozen=True)
class Length:
    low: float
    high: float


@dataclass(frozen=True)
class Finite:
    pass


@dataclass(frozen=True)
class Parameter:
    name: str
    type: Any
    domain: Any


@dataclass(frozen=True)
class Struct:
    name: str
    fields: tuple[Parameter, ...]


@dataclass(frozen=True)
class Function:
    name: str
    parameters: tuple[Parameter, ...]


FRAME = Struct("Frame", tuple(Parameter(name, "vec3", Unit()) for name in ("tangent", "bitangent", "normal")))

SIGNATURES = """
safe_sqrt(x: signed)
safe_pow(x: base, y: power)
log_one_minus(q: below_one)
pow_one_minus(q: defect, p: power)
one_minus_exp_neg(x: depth)
exprel_neg(x: depth)
safe_smoothstep(edge0: signed, edge1: signed, x: signed)
safe_normalize(x: vector, fallback: unit)
bessel_i0e(x: bessel)
line_component(x: vector, t: unit)
line_rejection(x: vector, t: unit)
sin_angle(a: unit, b: unit)
sin_angle_half(a: unit, b: unit)
sin_angle_cross(a: unit, b: unit)
sin_angle_cosine(a: unit, b: unit)
half_vector(l: unit, v: unit)
mirror(l: unit, n: unit)
frame_from_normal(n: unit)
frame_from_tangent(n: unit, t: unit)
to_local(frame: frame, w: unit)
to_world(frame: frame, w: unit)
strand_angles(t: unit, l: unit, v: unit)
strand_diffuse(t: unit, l: unit)
strand_cosine(t: unit, l: unit, v: unit)
strand_cosine_banks_printed(t: unit, l: unit, v: unit)
strand_cosine_kajiya_printed(t: unit, l: unit, v: unit)
strand_specular(t: unit, l: unit, v: unit, exponent: power)
strand_specular_half(t: unit, h: unit, exponent: power)
strand_azimuth_cosine(t: unit, l: unit, v: unit)
inherited_shadow(n: unit, l: unit)
banks_shade(t: unit, n: unit, l: unit, v: unit, k_diffuse: colour, k_specular: colour, exponent: power)
kajiya_kay_shade(t: unit, l: unit, v: unit, k_diffuse: colour, k_specular: colour, exponent: power)
tangent_from_map(n: unit, t: unit, map_tangent: box)
tangent_shift(t: unit, n: unit, shift: shift)
scheuermann_shade(t: unit, n: unit, l: unit, v: unit, base: colour, primary: colour, \
primary_exponent: power, primary_shift: shift, secondary: colour, \
secondary_exponent: power, secondary_shift: shift, mask: share)
coat_extinction(rho: share)
coat_path_banks(depth: depth, t: unit, l: unit)
coat_path_slab(depth: depth, n: unit, l: unit)
coat_transmittance(extinction: long, path: long)
"""

KINDS: dict[str, tuple[Any, Any]] = {
    "signed": ("f32", Interval(-100.0, 100.0)),
    "base": ("f32", Interval(-1.0, 1.0)),
    "below_one": ("f32", Interval(0.0, 1.0 - 2.0**-24, "log")),
    "defect": ("f32", Interval(0.0, 2.0, "log")),
    "depth": ("f32", Interval(0.0, 1e9, "log")),
    "bessel": ("f32", Interval(-1e5, 1e5, "log")),
    "power": ("f32", Interval(0.0, 1e5, "log")),
    "share": ("f32", Interval(0.0, 1.0)),
    "shift": ("f32", Interval(-1.0, 1.0)),
    "long": ("f32", Interval(0.0, 1e18, "log")),
    "vector": ("vec3", Length(1e-30, 1e30)),
    "unit": ("vec3", Unit()),
    "colour": ("vec3", Interval(0.0, 1.0)),
    "box": ("vec3", Interval(-1.0, 1.0)),
    "frame": (FRAME, None),
}


def parsed(line: str) -> Function:
    """One line of SIGNATURES."""
    name, inside = re.fullmatch(r"(\w+)\((.*)\)", line).groups()  # type: ignore[union-attr]
    pairs = (part.split(": ") for part in inside.split(", "))
    return Function(name, tuple(Parameter(parameter, *KINDS[kind]) for parameter, kind in pairs))


FUNCTIONS: dict[str, Function] = {f.name: f for f in map(parsed, SIGNATURES.strip().splitlines())}
