"""The page about the lecture's misprints: it is what its command writes, complete, and right.

Plan:
  page       the committed text is what a fresh measurement gives
  pictures   the committed pictures are what is drawn now, and no other lie beside them
  coverage   every printed function of the library is measured, and is a printed function
  figures    figures known before are reproduced
  parts      fake fur composed for single misprints is the library's, with none and with all of them
"""

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from codegen.library import load_library
from conformance.printed import fur
from conformance.printed.catalogue import MISPRINTS
from conformance.printed.figures import COMPUTED, Figure, figures
from conformance.printed.misprint import Misprint, N
from conformance.printed.picture import picture
from conformance.printed.places import hemisphere
from conformance.printed.report import PICTURES, README, report

with Path(__file__).with_name("printed_checks.toml").open("rb") as file:
    CHECKS: dict[str, dict[str, Any]] = tomllib.load(file)

REMEDY = 'run "python -m conformance.printed"'


@pytest.mark.nightly  # the pictures and the known figures come from the same measurements
def test_page_is_what_is_measured() -> None:
    assert README.read_text(encoding="utf-8") == report(), REMEDY


@pytest.mark.parametrize("misprint", MISPRINTS, ids=lambda misprint: misprint.key)
def test_picture_is_what_is_drawn(misprint: Misprint) -> None:
    committed = np.asarray(Image.open(PICTURES / f"{misprint.key}.png").convert("RGB"), dtype=np.int16)
    fresh = picture(misprint).astype(np.int16)
    assert committed.shape == fresh.shape, REMEDY
    assert np.abs(committed - fresh).max() <= CHECKS["pixels"]["steps"], REMEDY


def test_no_picture_is_left_over() -> None:
    assert {path.name for path in PICTURES.iterdir()} == {f"{misprint.key}.png" for misprint in MISPRINTS}


def test_every_printed_function_is_measured() -> None:
    library = load_library()
    printed = {name for name, function in library.functions.items() if function.kind == "printed"}
    measured = {name for misprint in MISPRINTS for name in misprint.functions}
    assert printed
    assert measured == printed
    page = README.read_text(encoding="utf-8")
    assert not [name for name in printed if f"`{name}`" not in page]


@pytest.mark.parametrize("figure", figures(), ids=lambda figure: figure.name)
def test_known_figure(figure: Figure) -> None:
    assert len(figure.known) == len(figure.arguments)
    error = np.abs(np.subtract(figure.computed(), figure.known)).max()
    assert error <= figure.tolerance, f"{figure.computed()} for {figure.known}: {figure.origin}"


def test_every_figure_is_used() -> None:
    assert [figure.name for figure in figures()] == list(COMPUTED)


@pytest.mark.parametrize("name", ["fakefur_shade", "fakefur_shade_printed"])
def test_composed_fur_is_the_library_s(name: str) -> None:
    v, _, _ = hemisphere(6, 15)
    l = np.roll(v, 101, axis=0)
    misprints = dict.fromkeys(("half", "view", "sign", "angles"), name.endswith("_printed"))
    composed = fur.shade(fur.T, N, l, v, **misprints)
    assert np.abs(composed - fur.library_shade(name, fur.T, N, l, v)).max() <= CHECKS["parts"]["tolerance"]
