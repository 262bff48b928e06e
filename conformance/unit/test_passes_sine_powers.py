"""Sines to constant whole exponents become products and roots, which err as stated from the power in float64.

Directions lie all around the hair and closer and closer to it, to 1e-7 rad; one is the hair itself.
"""

import numpy as np
import pytest

from codegen.evaluate import evaluate
from codegen.library import load_library
from codegen.passes.analysis.operations import operations
from codegen.passes.rules.powers import NAME
from codegen.passes.rules.sine_powers import FUNCTION, error
from codegen.passes.specialise import specialise
from conformance.reference.direction import sin_angle

LIBRARY = load_library()
MOST = 1024
SAID = {
    1: "a root",
    2: "no multiplication",
    3: "1 multiplication and a root",
    8: "2 multiplications",
    24: "4 multiplications",
    101: "8 multiplications and a root",
    MOST: "9 multiplications",
}
"""Exponents, and what the log says of them: s^12 = s^8 s^4, s^50 = s^32 s^16 s^2 times the root of s."""


def directions(lanes: int = 4000) -> tuple[np.ndarray[tuple[int, ...], np.dtype[np.float32]], ...]:
    rng = np.random.default_rng(20_126)
    n = rng.normal(size=(lanes, 3))
    n /= np.linalg.norm(n, axis=1)[:, None]
    away = np.cross(n, rng.normal(size=(lanes, 3)))
    away /= np.linalg.norm(away, axis=1)[:, None]
    angle = np.concatenate([np.geomspace(1e-7, np.pi / 2, lanes // 2), np.linspace(0.0, np.pi, lanes // 2)])
    w = np.cos(angle)[:, None] * n + np.sin(angle)[:, None] * away
    return n.astype(np.float32), w.astype(np.float32)


@pytest.mark.parametrize("exponent", SAID)
def test_product_errs_as_stated(exponent: int) -> None:
    made = specialise(LIBRARY, FUNCTION, constants={"p": float(exponent)}, new_name="f", powers=MOST)
    (step,) = [s for s in made.log if s.name == NAME]
    assert step.what == f"{FUNCTION}(n, w, {exponent}) -> {SAID[exponent]}"
    assert step.why == f"absolute error at most {error(exponent):.2g} (either-way rounding)"
    assert operations(made.function)["special"] == exponent % 2
    n, w = directions()
    got = evaluate(LIBRARY.with_functions([made.function]), "f", {"n": n, "w": w}, "float32")
    assert isinstance(got, np.ndarray) and np.isfinite(got).all()
    exact = sin_angle(n.astype(np.float64), w.astype(np.float64)) ** exponent
    assert np.abs(got - exact).max() <= error(exponent)


@pytest.mark.parametrize("exponent", [0.5, 2.5, MOST + 1.0])
def test_other_exponents_stay(exponent: float) -> None:
    made = specialise(LIBRARY, FUNCTION, constants={"p": exponent}, new_name="f", powers=MOST)
    assert not [s for s in made.log if s.name == NAME]


def test_nothing_changes_unasked() -> None:
    made = specialise(LIBRARY, FUNCTION, constants={"p": 2.0}, new_name="f")
    assert not [s for s in made.log if s.name == NAME]
