"""Balance heuristic."""

from shaderlib.constants import SMALLEST_NORMAL
from shaderlib.lang import f32, max
from shaderlib.maps.domains import Density, SampleCount


def mis_balance(samples_a: SampleCount, pdf_a: Density, samples_b: SampleCount, pdf_b: Density) -> f32:
    """Weight of a sample of technique a when techniques a and b are combined, by the balance heuristic.

    samples_a   samples drawn by technique a
    pdf_a       density of technique a at the sample, per steradian
    samples_b   samples drawn by technique b
    pdf_b       density of technique b at the same direction
    returns     samples_a pdf_a / (samples_a pdf_a + samples_b pdf_b), in [0, 1]
    degenerate  both densities 0: 0
    form        the division is guarded at the smallest normal float, below which products may flush to zero
    source      Veach and Guibas 1995, Optimally Combining Sampling Techniques for Monte Carlo Rendering
    """
    a = samples_a * pdf_a
    b = samples_b * pdf_b
    return a / max(a + b, SMALLEST_NORMAL)
