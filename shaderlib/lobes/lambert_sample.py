"""Lambert lobe: sampler."""

from shaderlib.domains import Direction
from shaderlib.lang import vec3
from shaderlib.lobes.domains import UniformPair
from shaderlib.sampling.hemisphere_cosine import hemisphere_cosine


def lambert_sample(u: UniformPair, v: Direction) -> vec3:
    """Direction to the light, drawn with density lambert_pdf.

    u           pair of uniform numbers in [0, 1)
    v           direction to the viewer, in the local frame; without influence
    returns     unit vector with z > 0: hemisphere_cosine(u)
    degenerate  u.x = 0 or u.y = 0: the normal, the peak of the lobe. hemisphere_cosine puts these points on
                the horizon, where the density is 0; a Hammersley sequence starts at u = (0, 0)
    form        the weight value l.z / pdf is 1 for every sample
    source      Malley's method; Shirley and Chiu 1997
    """
    w = hemisphere_cosine(u)
    return w if w.z > 0.0 else vec3(0.0, 0.0, 1.0)
