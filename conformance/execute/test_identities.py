"""Identities that the strand functions must keep on every target, whatever the reference says.

Plan. On random directions and on triples near the axis and the highlight cone:
  printed forms  banks_printed = -strand_cosine; kajiya_printed(t, l, v) = strand_cosine(t, l, -v)
  exchange       strand_cosine, strand_specular, strand_azimuth_cosine do not change if l and v are exchanged
  orientation    nor if t is reversed
  rotation       nor if t, l and v make a quarter turn together, which permutes and negates components
  parity         mirror(mirror(l)) = l; sin_angle(a, b) = sin_angle(b, a) = sin_angle(a, -b)
Both sides err by no more than their declared absolute bounds, so they differ by no more than their sum: the
tolerance is data of shaderlib/*/bounds.toml.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from codegen.execute import execute
from codegen.library import load_library
from conformance import cases
from conformance.check.features import applies
from conformance.check.show import lane_inputs
from targets import TimedRuntime

Array = npt.NDArray[Any]
LIBRARY = load_library()
FAMILIES = ("uniform", "axis_triples", "cone_triples", "cone_axis_triples")
COUNT, SEED = 5_000, 77


def triples(family: str) -> dict[str, Array]:
    """Directions t, l, v and an exponent, as strand_specular takes them."""
    return cases.draw(LIBRARY.function("strand_specular"), family, COUNT, SEED)


def run(runtime: TimedRuntime, name: str, *arguments: Array) -> Array:
    parameters = LIBRARY.function(name).parameters
    inputs = {p.name: a for p, a in zip(parameters, arguments, strict=True)}
    value = execute(LIBRARY, name, inputs, runtime)
    assert isinstance(value, np.ndarray)
    return value


def slack(name: str, inputs: dict[str, Array]) -> Array:
    """The smallest declared absolute bound of the function per lane; infinite where it declares none."""
    count = len(next(iter(inputs.values())))
    least = np.full(count, np.inf)
    for bound in LIBRARY.bounds[name]:
        if bound.measure == "absolute" and not bound.field:
            least = np.where(applies(bound, inputs, count), np.minimum(least, bound.bound), least)
    return least


def assert_agree(left: Array, right: Array, allowed: Array, inputs: dict[str, Array]) -> None:
    assert np.isfinite(allowed).any(), "no declared absolute bound applies to these inputs"
    excess = np.abs(left.astype(np.float64) - right.astype(np.float64)) - allowed
    lane = int(np.argmax(excess))
    told = f"{left[lane]!r} and {right[lane]!r} for {lane_inputs(inputs, lane)}; allowed {allowed[lane]:.3g}"
    assert excess[lane] <= 0.0, told


@pytest.mark.parametrize("family", FAMILIES)
def test_banks_printed_is_the_negative(runtime: TimedRuntime, family: str) -> None:
    x = triples(family)
    t, l, v = x["t"], x["l"], x["v"]
    allowed = slack("strand_cosine", x) + slack("strand_cosine_banks_printed", x)
    printed = run(runtime, "strand_cosine_banks_printed", t, l, v)
    assert_agree(printed, -run(runtime, "strand_cosine", t, l, v), allowed, x)


@pytest.mark.parametrize("family", FAMILIES)
def test_kajiya_printed_has_the_viewer_inward(runtime: TimedRuntime, family: str) -> None:
    x = triples(family)
    t, l, v = x["t"], x["l"], x["v"]
    allowed = slack("strand_cosine", {**x, "v": -v}) + slack("strand_cosine_kajiya_printed", x)
    printed = run(runtime, "strand_cosine_kajiya_printed", t, l, v)
    assert_agree(printed, run(runtime, "strand_cosine", t, l, -v), allowed, x)


def quarter_turn(a: Array) -> Array:
    """A rotation about z that is exact in float32."""
    return np.stack([-a[:, 1], a[:, 0], a[:, 2]], axis=-1)


@pytest.mark.parametrize("family", FAMILIES)
@pytest.mark.parametrize("name", ["strand_cosine", "strand_specular", "strand_azimuth_cosine"])
@pytest.mark.parametrize("change", ["exchange", "orientation", "rotation"])
def test_unchanged(runtime: TimedRuntime, name: str, change: str, family: str) -> None:
    x = triples(family)
    t, l, v = x["t"], x["l"], x["v"]
    rest = (x["exponent"],) if name == "strand_specular" else ()
    other = {
        "exchange": (t, v, l),
        "orientation": (-t, l, v),
        "rotation": (quarter_turn(t), quarter_turn(l), quarter_turn(v)),
    }[change]
    changed = dict(zip(("t", "l", "v"), other, strict=True)) | {"exponent": x["exponent"]}
    allowed = slack(name, x) + slack(name, changed)
    assert_agree(run(runtime, name, t, l, v, *rest), run(runtime, name, *other, *rest), allowed, x)


def test_sine_of_lines(runtime: TimedRuntime) -> None:
    a, b = triples("uniform")["l"], triples("uniform")["v"]
    first = run(runtime, "sin_angle", a, b)
    # (a - b) x (a + b) is the same up to sign under all three; a compiler that fuses one of the two products
    # of a component rounds it otherwise after the exchange.
    for c, d in ((b, a), (a, -b), (-a, b)):
        inputs = {"a": c, "b": d}
        allowed = slack("sin_angle", {"a": a, "b": b}) + slack("sin_angle", inputs)
        assert_agree(run(runtime, "sin_angle", c, d), first, allowed, inputs)


def test_mirror_twice_is_the_identity(runtime: TimedRuntime) -> None:
    x = triples("uniform")
    l, n = x["l"], x["t"]
    inputs = {"l": l, "n": n}
    twice = run(runtime, "mirror", run(runtime, "mirror", l, n), n)
    allowed = np.repeat(2.0 * slack("mirror", inputs)[:, None], 3, axis=1)
    assert_agree(twice.ravel(), l.ravel(), allowed.ravel(), {"l": np.repeat(l, 3, axis=0)})
