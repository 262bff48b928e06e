"""The lobes that environment maps light. Read this file as a table."""

from __future__ import annotations

from dataclasses import dataclass

SURFACE_FRAME = "tangent, bitangent and normal of the surface, in the map's axes"
STRAND_FRAME = "the strand's tangent and any two directions across it, in the map's axes"
SATIN_FRAME = "the cylinders' direction, the one across them and the normal, in the map's axes"


@dataclass(frozen=True)
class Argument:
    """A parameter of a lobe: its name, the alias of its domain, the module that defines that, what it is."""

    name: str
    domain: str
    module: str
    meaning: str


@dataclass(frozen=True)
class Lobe:
    """A lobe of shaderlib/lobes, known by its three functions.

    name       what their names start with
    shown      the same in a sentence
    arguments  its parameters
    peak       pair of numbers whose sample is the densest
    imports    what that needs, by module
    surface    False for a lobe over the whole sphere, which has no cosine
    frame      what its frame is
    """

    name: str
    shown: str
    arguments: tuple[Argument, ...] = ()
    peak: str = "vec2(0.0)"
    imports: tuple[tuple[str, str], ...] = ()
    surface: bool = True
    frame: str = SURFACE_FRAME


def _exponent(name: str = "exponent", meaning: str = "p, sharpness of the lobe") -> Argument:
    return Argument(name, "Exponent", "shaderlib.domains", meaning)


def _widths(tangent: str, bitangent: str) -> tuple[Argument, ...]:
    module = "shaderlib.lobes.domains"
    return (
        Argument("alpha_x", "Roughness", module, tangent),
        Argument("alpha_y", "Roughness", module, bitangent),
    )


LOBES = (
    Lobe("lambert", "a Lambert lobe"),
    Lobe("phong", "a Phong lobe", (_exponent(),)),
    Lobe("blinn_phong", "a Blinn-Phong lobe", (_exponent(),)),
    Lobe(
        "ward",
        "a Ward lobe",
        _widths("root mean square slope along the tangent", "root mean square slope along the bitangent"),
    ),
    Lobe(
        "ashikhmin_shirley",
        "an Ashikhmin-Shirley lobe",
        (
            _exponent("exponent_x", "sharpness along the tangent"),
            _exponent("exponent_y", "sharpness along the bitangent"),
        ),
    ),
    Lobe("ggx", "a GGX lobe", _widths("width along the tangent", "width along the bitangent")),
    Lobe("strand", "a strand", (_exponent(),), surface=False, frame=STRAND_FRAME),
    Lobe(
        "poulin_fournier",
        "satin",
        (
            Argument("spread", "Spread", "shaderlib.lobes.domains", "half angle of each arc, in radians"),
            Argument("specular", "UnitInterval", "shaderlib.domains", "share that facets reflect"),
            _exponent(meaning="p, sharpness of the facets"),
        ),
        peak="vec2(min(1.0 - specular, ONE_BELOW), 0.0)",
        imports=(("shaderlib.constants", "ONE_BELOW"), ("shaderlib.lang", "min")),
        frame=SATIN_FRAME,
    ),
)
