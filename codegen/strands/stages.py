"""The text of the stages that draw ribbons, per target and dialect, and their uniform block."""

from __future__ import annotations

from codegen.backends import dialect as find_dialect
from codegen.backends import stage_sources
from codegen.fur.layout import Block, FrameMember, block_of
from codegen.fur.shading import FurShading
from codegen.fur.stages import fill
from codegen.ir.types import F32, U32, VEC3, VEC4
from codegen.library import Library

FRAME: tuple[FrameMember, ...] = (
    ("view_projection", "mat4", 1),
    ("eye", VEC3, 1),
    ("width", F32, 1),
    ("tip_share", F32, 1),
    ("s_min", F32, 1),
    ("light_count", U32, 1),
    ("light_direction", VEC4, 0),
    ("light_colour", VEC4, 0),
)
"""As in targets/glsl/strands/frame.glsl and targets/wgsl/strands/strands.wgsl."""
STATE = {"blend": None, "depth_test": "less-equal", "depth_write": True, "cull": "none"}
ENTRIES = ("strand_vertex", "strand_fragment")


def strand_texts(library: Library, shading: FurShading, target: str, dialect: str) -> dict[str, str]:
    """The stages of one dialect by file name: strand.vert and strand.frag, or strands.wgsl.

    errors  UserError for a target or a dialect in which strands cannot be drawn
    """
    sources = stage_sources(target, "strands")
    return fill(library, shading, find_dialect(target, dialect), sources, "hair as ribbons")


def strand_block(shading: FurShading) -> Block:
    """The uniform block of the stages."""
    return block_of(FRAME, ((slot.name, slot.type) for slot in shading.material), shading.lights)
