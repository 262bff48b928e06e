"""Procedural hairs for shell textures."""

from typing import Annotated

from shaderlib.domains import UnitInterval
from shaderlib.lang import Finite, Interval, clamp, f32, floor, i32, max, min, u32, uvec3, vec2
from shaderlib.sampling.pcg3d import pcg3d

# Texture coordinates are cut to multiples of 2^-20: scaling by a power of two and flooring are exact, and
# from there on everything is a whole number, so no target can decide differently.
COORDINATE_STEPS = 1048576.0

# Positions inside a cell are counted in 2^-15 of it; squared distances then fit into 32 bits.
CELL_STEPS: u32 = 32768


def shell_strand_mask(
    uv: Annotated[vec2, Interval(-1024.0, 1024.0)],
    height: UnitInterval,
    density: Annotated[f32, Interval(1.0, 4096.0)],
    thickness: UnitInterval,
    seed: Annotated[u32, Finite()],
) -> f32:
    """Coverage of a shell texel by one conical hair per cell of a square grid, bit-exact on every target.

    uv         texture coordinates, in [-1024, 1024]; cut to multiples of 2^-20
    height     height of the shell, 0 at the skin and 1 at the top; cut to multiples of 2^-16
    density    cells, and hairs, per unit of uv along each axis; cut to a whole number, at least 1
    thickness  diameter of a full-length hair at the skin, as a share of the cell; cut to multiples of 2^-14
    seed       any number; another one gives another coat
    returns    1 inside a hair, 0 outside. Odd rows are shifted by half a cell. The hair of a cell ends at a
               random height tip in [1/2, 1), its radius is thickness (tip - height) / 2 cells, and its
               random centre keeps it inside its cell
    form       whole numbers modulo 2^32. y = floor(uv.y 2^20) floor(density), x = floor(uv.x 2^20)
               floor(density) + 2^19 ((y >> 20) & 1); the cell is (x >> 20, y >> 20), so the pattern repeats
               every 4096 cells, and the place in it ((x >> 5) & 32767, (y >> 5) & 32767). (a, b, c) =
               pcg3d(cell, seed) >> 17, tip = 32768 + c, radius(h) = floor(thickness 2^14) max(tip - h, 0)
               >> 16, and the centre is radius(0) + (a (32768 - 2 radius(0)) >> 15), with b likewise.
               Inside: squared distance < radius(floor(height 2^16))^2
    source     shell textures: Lengyel et al. 2001; this pattern was made for this library
    """
    cells = u32(max(density, 1.0))
    along = u32(i32(floor(uv.y * COORDINATE_STEPS))) * cells
    half_cell = ((along >> 20) & 1) << 19
    across = u32(i32(floor(uv.x * COORDINATE_STEPS))) * cells + half_cell
    random = pcg3d(uvec3(across >> 20, along >> 20, seed))
    tip = CELL_STEPS + (random.z >> 17)
    reached = min(u32(clamp(height, 0.0, 1.0) * 65536.0), tip)
    widest = u32(clamp(thickness, 0.0, 1.0) * 16384.0)
    base = (widest * tip) >> 16
    radius = (widest * (tip - reached)) >> 16
    room = CELL_STEPS - 2 * base
    from_left = ((across >> 5) & 32767) - (base + (((random.x >> 17) * room) >> 15))
    from_top = ((along >> 5) & 32767) - (base + (((random.y >> 17) * room) >> 15))
    return 1.0 if from_left * from_left + from_top * from_top < radius * radius else 0.0
