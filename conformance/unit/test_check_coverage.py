"""Bounds cover the domains that functions state, except what is on record.

Plan.
  record  no function leaves out more than uncovered.json says, and the page shows the record
  lobes   every lobe is bounded on its whole domain but for the pole and the heights that are named here
  count   a bound of half a domain leaves out the other half
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from codegen.library import Library, load_library
from conformance.check.coverage import DATA, PAGE, page, uncovered
from conformance.unit.support.sources import library_of

LIBRARY = load_library()
RECORD = json.loads(DATA.read_text(encoding="utf-8"))
DRAWN = 0.02
"""Points are drawn anew where a family or a domain changes: shares move by so much."""
LOBES_WITH_GAPS = {"strand_pdf", "poulin_fournier_value", "poulin_fournier_value_eight"}
"""Towards the axis, for exponents below 2, the density of the strand lobe has a pole that float32 does not
tell; Poulin and Fournier's highlights are not measured at heights between 0 and 1e-12."""
RARE = 1e-3
"""Share of the random points of a lobe that its bounds may leave out: gaps are at the rim of its domain."""
PARTS = [list(LIBRARY.public)[k::6] for k in range(6)]


@pytest.mark.parametrize("names", PARTS, ids=lambda names: names[0])
def test_nothing_is_left_out_beyond_the_record(names: list[str]) -> None:
    for name in names:
        recorded = RECORD.get(name, {"random": 0.0, "all": 0.0})
        at_random, everywhere = uncovered(LIBRARY, name)
        slack = DRAWN if name in RECORD else 0.0
        told = (
            f"{name}: {everywhere:.1%} outside every bound; python -m conformance.check.coverage records it"
        )
        assert at_random <= recorded["random"] + slack, told
        assert everywhere <= recorded["all"] + slack, told


def test_lobes_are_bounded_everywhere() -> None:
    left_out = {
        name for name in RECORD if name in LIBRARY.public and LIBRARY.function(name).module == "lobes"
    }
    assert left_out <= LOBES_WITH_GAPS
    assert all(RECORD[name]["random"] < RARE for name in left_out)


def test_page_shows_the_record() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(RECORD)
    assert set(RECORD) <= set(LIBRARY.public)


def test_half_a_domain_is_half_uncovered(tmp_path: Path) -> None:
    text = "def probe(x: Annotated[f32, Interval(0.0, 1.0)]) -> f32:\n    return x\n"
    library_of(tmp_path, text)
    (tmp_path / "numeric" / "bounds.toml").write_text(
        '[[probe]]\nmeasure = "absolute"\nbound = 1e-6\nwhere = { x = [0.0, 0.5] }\n'
        'domain = "half"\norigin = "none"\n',
        encoding="utf-8",
    )
    at_random, everywhere = uncovered(Library(tmp_path), "probe")
    assert abs(at_random - 0.5) < 0.05
    assert 0.0 < everywhere < 1.0
