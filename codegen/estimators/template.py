"""The estimators as source text; $names are filled in for each lobe by codegen.estimators.sources.

$lobe the lobe's name, $shown the same in a sentence, $arguments its parameters after a comma, $peak the pair
of numbers of its densest sample; $lit the test, $height, $cosine and $times the factor that a surface adds,
$below what is said of directions below it.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Estimator:
    """An estimator: the text of its function's body and the entries of its docstring."""

    name: str
    summary: str
    entries: dict[str, str]
    body: str
    imports: tuple[tuple[str, str], ...]


ENV = "the map, as env_radiance reads it"
V = "direction to the viewer, in the map's axes"
SAMPLES = "number of samples, at most 4096; 0 gives black"
SHIFT = "displacement of the points in the unit square, for instance from a hash of the pixel"
UNSEEN = "samples with a density below 1e-30 contribute 0 and count$below"
COLBERT = "Colbert and Krivanek 2007, GPU-Based Importance Sampling, GPU Gems 3 chapter 20"
SAMPLED = (
    ("shaderlib.sampling.cranley_patterson", "cranley_patterson"),
    ("shaderlib.sampling.hammersley", "hammersley"),
    ("shaderlib.direction.to_local", "to_local"),
    ("shaderlib.direction.to_world", "to_world"),
    ("shaderlib.environment.domains", "MOST_SAMPLES"),
    ("shaderlib.environment.domains", "SMALLEST_DENSITY"),
    ("shaderlib.lang", "f32"),
    ("shaderlib.lang", "max"),
    ("shaderlib.lang", "min"),
    ("shaderlib.lang", "u32"),
    ("shaderlib.lang", "vec3"),
    ("shaderlib.lobes.${lobe}_pdf", "${lobe}_pdf"),
    ("shaderlib.lobes.${lobe}_sample", "${lobe}_sample"),
    ("shaderlib.lobes.${lobe}_value", "${lobe}_value"),
)

MONTE_CARLO = Estimator(
    "monte_carlo",
    "Light that $shown reflects from an environment map, by importance sampling.",
    {
        "samples": SAMPLES,
        "shift": SHIFT,
        "returns": "mean of radiance value$times / pdf over the samples, linear RGB",
        "degenerate": UNSEEN,
        "form": "Hammersley points, rotated by shift, drawn with the lobe's density; each looks up the "
        "largest level. Right on average but for the map's resampling; noisy where a light is small",
        "source": COLBERT,
    },
    """
viewer = to_local(frame, v)
count = max(min(samples, u32(MOST_SAMPLES)), 1)
total = vec3(0.0)
for i in range(min(samples, MOST_SAMPLES)):
    u = cranley_patterson(hammersley(i, count), shift)
    l = ${lobe}_sample(u, viewer$arguments)
    pdf = ${lobe}_pdf(l, viewer$arguments)
    if pdf > SMALLEST_DENSITY$lit:
        weight = ${lobe}_value(l, viewer$arguments)$height / pdf
        total += weight * env_level(env, to_world(frame, l), 0)
return total / f32(count)
""",
    (*SAMPLED, ("shaderlib.environment.env_level", "env_level")),
)

FILTERED = Estimator(
    "filtered",
    "Light that $shown reflects from an environment map, by filtered importance sampling.",
    {
        "samples": SAMPLES,
        "shift": SHIFT,
        "returns": "mean of radiance value$times / pdf over the samples, linear RGB",
        "degenerate": UNSEEN,
        "form": "Hammersley points, rotated by shift, drawn with the lobe's density; each looks up the level "
        "whose texels are as large as what the sample stands for. Little noise from few samples, and a bias "
        "that shrinks with their number: less error where they lie further apart than texels",
        "source": COLBERT,
    },
    """
viewer = to_local(frame, v)
count = max(min(samples, u32(MOST_SAMPLES)), 1)
total = vec3(0.0)
for i in range(min(samples, MOST_SAMPLES)):
    u = cranley_patterson(hammersley(i, count), shift)
    l = ${lobe}_sample(u, viewer$arguments)
    pdf = ${lobe}_pdf(l, viewer$arguments)
    if pdf > SMALLEST_DENSITY$lit:
        weight = ${lobe}_value(l, viewer$arguments)$height / pdf
        w = to_world(frame, l)
        lod = env_lod(env, w, pdf, f32(count))
        total += weight * env_radiance(env, w, lod)
return total / f32(count)
""",
    (
        *SAMPLED,
        ("shaderlib.environment.env_lod", "env_lod"),
        ("shaderlib.environment.env_radiance", "env_radiance"),
    ),
)

GUARDED = Estimator(
    "guarded",
    "Light that $shown reflects from an environment map, filtered only where that helps.",
    {
        "samples": SAMPLES,
        "shift": SHIFT,
        "returns": "env_filtered_$lobe, or env_monte_carlo_$lobe where the lobe's peak would be looked up "
        "below level 1/2",
        "degenerate": UNSEEN,
        "form": "there, samples lie closer than half a texel's blur, and filtering adds more error than it "
        "takes",
        "source": COLBERT + "; the guard: this library",
    },
    """
viewer = to_local(frame, v)
count = max(min(samples, u32(MOST_SAMPLES)), 1)
densest = $peak
peak = ${lobe}_sample(densest, viewer$arguments)
peak_pdf = ${lobe}_pdf(peak, viewer$arguments)
peak_lod = env_lod(env, to_world(frame, peak), peak_pdf, f32(count))
total = vec3(0.0)
for i in range(min(samples, MOST_SAMPLES)):
    u = cranley_patterson(hammersley(i, count), shift)
    l = ${lobe}_sample(u, viewer$arguments)
    pdf = ${lobe}_pdf(l, viewer$arguments)
    if pdf > SMALLEST_DENSITY$lit:
        weight = ${lobe}_value(l, viewer$arguments)$height / pdf
        w = to_world(frame, l)
        lod = env_lod(env, w, pdf, f32(count)) if peak_lod >= SHARP_LOD else 0.0
        total += weight * env_radiance(env, w, lod)
return total / f32(count)
""",
    (
        *SAMPLED,
        ("shaderlib.lang", "vec2"),
        ("shaderlib.environment.domains", "SHARP_LOD"),
        ("shaderlib.environment.env_lod", "env_lod"),
        ("shaderlib.environment.env_radiance", "env_radiance"),
    ),
)

GRID = Estimator(
    "grid",
    "Light that $shown reflects from an environment map, from a fixed grid of directions.",
    {
        "samples": "directions at most, up to 4096: floor(sqrt(samples / 2)) rows of latitude, at least one, "
        "as many columns as fit; 0 gives black",
        "shift": "its first number turns the grid about the y axis, 1 being a column; the second is ignored",
        "returns": "sum of radiance value$times solid angle over the grid, linear RGB",
        "degenerate": "a lobe between the directions is missed$below",
        "form": "each direction stands for its cell of latitude and longitude: its exact solid angle, and "
        "the level of the map with texels of that size",
        "source": "the lecture's first strategy; solid angles: latlong_solid_angle",
    },
    """
viewer = to_local(frame, v)
count = f32(min(samples, u32(MOST_SAMPLES)))
rows = max(floor(sqrt(0.5 * count + 0.25)), 1.0)
columns = max(floor((count + 0.5) / rows), 1.0)
total = vec3(0.0)
for i in range(min(samples, MOST_SAMPLES)):
    number = f32(i)
    row = floor((number + 0.5) / columns)
    if row < rows:
        turn = (number - row * columns + 0.5 + shift.x) / columns
        uv = vec2(turn - floor(turn), (row + 0.5) / rows)
        w = latlong_direction(uv)
        solid_angle = latlong_solid_angle(uv.y, columns, rows)
        l = to_local(frame, w)
        value = ${lobe}_value(l, viewer$arguments)
        weight = value$cosine * solid_angle
        if weight > 0.0:
            lod = env_lod(env, w, 1.0 / solid_angle, 1.0)
            total += weight * env_radiance(env, w, lod)
return total
""",
    (
        ("shaderlib.direction.to_local", "to_local"),
        ("shaderlib.environment.domains", "MOST_SAMPLES"),
        ("shaderlib.environment.env_lod", "env_lod"),
        ("shaderlib.environment.env_radiance", "env_radiance"),
        *(("shaderlib.lang", name) for name in ("f32", "floor", "max", "min", "sqrt", "u32", "vec2", "vec3")),
        ("shaderlib.lobes.${lobe}_value", "${lobe}_value"),
        ("shaderlib.maps.latlong_direction", "latlong_direction"),
        ("shaderlib.maps.latlong_solid_angle", "latlong_solid_angle"),
    ),
)

ESTIMATORS = (GRID, MONTE_CARLO, FILTERED, GUARDED)
