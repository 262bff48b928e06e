"""How vertices and uniforms lie in memory: std140 of OpenGL and the uniform space of WebGPU agree."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from codegen.ir.types import F32, U32, VEC3, VEC4, Type

LEAST_LIGHTS, MOST_LIGHTS = 8, 64
"""Lights that the arrays of the uniform block hold, at least and at most."""

_COMMON: list[Any] = [
    ("position", "<f4", 3),
    ("normal", "<f4", 3),
    ("comb", "<f4", 3),
    ("uv", "<f4", 2),
    ("length_share", "<f4"),
    ("density_share", "<f4"),
]
FUR_VERTEX = np.dtype(_COMMON)
FIN_VERTEX = np.dtype([*_COMMON, ("face_a", "<f4", 3), ("face_b", "<f4", 3), ("w", "<f4")])
"""Attributes by location. Fins: face_a and face_b are the normals of the two faces at the edge, w is 0 at the
skin and 1 at the tips."""
LIT: Any = ("lit", "<f4", 4)
"""The last attribute of both where lights cast shadows: the share of each of the first three lights that
arrives at the vertex, and the share of all others together."""

Bytes = npt.NDArray[np.uint8]


@dataclass(frozen=True)
class Member:
    """One member of the uniform block: `count` values of a type, from a byte `offset` on."""

    name: str
    type: str
    offset: int
    components: int
    count: int = 1
    stride: int = 0
    kind: str = "<f4"


@dataclass(frozen=True)
class Block:
    """The uniform block of the stages."""

    members: tuple[Member, ...]
    size: int

    def pack(self, values: Mapping[str, Any]) -> bytes:
        """The block's bytes; every member needs a value, arrays may be shorter than declared."""
        data = bytearray(self.size)
        for member in self.members:
            array = np.atleast_1d(np.asarray(values[member.name], member.kind))
            rows = array.reshape(-1, member.components)
            if len(rows) > member.count:
                raise ValueError(f"{member.name} holds {member.count} values, not {len(rows)}")
            for k, row in enumerate(rows):
                at = member.offset + k * member.stride
                data[at : at + row.nbytes] = row.tobytes()
        return bytes(data)


FrameMember = tuple[str, Type | str, int]
"""Name, type and how many; 0: as many as there are lights."""

_FRAME: tuple[FrameMember, ...] = (
    ("view_projection", "mat4", 1),
    ("eye", VEC3, 1),
    ("coat_length", F32, 1),
    ("force", VEC3, 1),
    ("s_min", F32, 1),
    ("hairs", F32, 1),
    ("thickness", F32, 1),
    ("opacity", F32, 1),
    ("authored_layers", F32, 1),
    ("layers", U32, 1),
    ("seed", U32, 1),
    ("light_count", U32, 1),
    ("fin_threshold", F32, 1),
    ("rho_surface", F32, 1),
    ("cos_dark", F32, 1),
    ("cos_lit", F32, 1),
    ("fin_opacity", F32, 1),
    ("light_direction", VEC4, 0),
    ("light_colour", VEC4, 0),
)
"""As in targets/glsl/fur/frame.glsl and targets/wgsl/fur/fur.wgsl."""


def uniform_block(material: Iterable[tuple[str, Type]], lights: int = LEAST_LIGHTS) -> Block:
    """The block: members that every fur has, with room for so many lights, then those of a material."""
    return block_of(_FRAME, material, lights)


def block_of(frame: Iterable[FrameMember], material: Iterable[tuple[str, Type]], lights: int) -> Block:
    """A block of members of a frame, with room for so many lights, then those of a material."""
    members = []
    end = 0
    for name, type_, said in (*frame, *((name, type_, 1) for name, type_ in material)):
        count = said or lights
        type_name = type_ if isinstance(type_, str) else type_.name
        components = 16 if type_name == "mat4" else getattr(type_, "size", 1)
        alignment = 16 if components > 2 or count > 1 else 4 * components
        offset = -(-end // alignment) * alignment
        kind = "<u4" if type_ == U32 else "<i4" if type_name == "i32" else "<f4"
        stride = 16 if count > 1 else 0
        members.append(Member(name, type_name, offset, components, count, stride, kind))
        end = offset + (count * stride or 4 * components)
    return Block(tuple(members), -(-end // 16) * 16)
