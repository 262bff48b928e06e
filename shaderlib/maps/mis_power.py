"""Power heuristic."""

from shaderlib.constants import SMALLEST_NORMAL
from shaderlib.lang import f32, max
from shaderlib.maps.domains import Density, SampleCount


def mis_power(samples_a: SampleCount, pdf_a: Density, samples_b: SampleCount, pdf_b: Density) -> f32:
    """Weight of a sample of technique a when techniques a and b are combined, by the power heuristic.

    samples_a   samples drawn by technique a
    pdf_a       density of technique a at the sample, per steradian
    samples_b   samples drawn by technique b
    pdf_b       density of technique b at the same direction
    returns     a^2 / (a^2 + b^2) with a = samples_a pdf_a and b = samples_b pdf_b, in [0, 1]
    degenerate  both densities 0: 0
    form        both are divided by the larger first: squares overflow from 1.8e19 on
    source      Veach and Guibas 1995, Optimally Combining Sampling Techniques for Monte Carlo Rendering
    """
    a = samples_a * pdf_a
    b = samples_b * pdf_b
    larger = max(max(a, b), SMALLEST_NORMAL)
    share_a = a / larger
    share_b = b / larger
    square_a = share_a * share_a
    return square_a / max(square_a + share_b * share_b, SMALLEST_NORMAL)
