"""Lookup in a table over two angles."""

from shaderlib.domains import UnitSquare
from shaderlib.factored.domains import AngleTable
from shaderlib.lang import helper, lookup, texture_size, vec2, vec4


@helper
def angle_table_lookup(table: AngleTable, uv: UnitSquare) -> vec4:
    """Bilinear lookup in a table whose ends are the centres of its outermost texels.

    table    values of any size
    uv       coordinates of both angles, 0 and 1 at the ends of the axes
    returns  the value between the four nearest texels
    form     half a texel is left out at either end, so that the ends need no texels beyond them
    source   elementary
    """
    margin = vec2(0.5) / texture_size(table)
    return lookup(table, margin + uv * (vec2(1.0) - 2.0 * margin))
