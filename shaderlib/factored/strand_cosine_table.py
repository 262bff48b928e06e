"""Strand cosine from a table."""

from shaderlib.domains import Cosine
from shaderlib.factored.angle_table_lookup import angle_table_lookup
from shaderlib.factored.domains import AngleTable
from shaderlib.factored.strand_table_uv import strand_table_uv
from shaderlib.lang import f32


def strand_cosine_table(table: AngleTable, cos_l: Cosine, cos_v: Cosine) -> f32:
    """Cosine between the viewer and the best mirror direction of a strand, read from a table.

    table       the strand cosine over strand_table_uv in its first channel, as `vair table strand_cosine`
                writes it; any size
    cos_l       t.l, cosine between the tangent and the direction to the light
    cos_v       t.v, cosine between the tangent and the direction to the viewer
    returns     sin_l sin_v - cos_l cos_v up to the error of the table
    degenerate  light or viewer along the strand: the first or last texels, where the table is exact
    form        the lecture's texture, on axes that follow the angles. strand_cosine computes the same without
                a texture and is as good at every exponent; a table of another function of both angles, a
                measured lobe for instance, is read the same way
    source      Banks 1994; Heidrich and Seidel 1998; Isidoro and Brennan 2002
    """
    return angle_table_lookup(table, strand_table_uv(cos_l, cos_v)).x
