"""Bounds cover the domains that functions state, except what is on record.

Plan.
  record   no function leaves out more than uncovered.json says, nor has the range of its results for its only
           bound in a larger part, and the page shows the record
  reasons  what leaves something out has a reason; so has every lobe's rim
  range    a bound that says where results lie holds everywhere, and is not counted as one that tells more
  count    a bound of half a domain leaves out the other half
"""

from __future__ import annotations

import json
from fnmatch import fnmatchcase
from pathlib import Path

import pytest

from codegen.library import Library, load_library
from conformance.check.coverage import DATA, PAGE, REASONS, Shares, is_range, page, shares, uncovered
from conformance.unit.support.sources import library_of

LIBRARY = load_library()
RECORD = json.loads(DATA.read_text(encoding="utf-8"))
DRAWN = 0.02
"""Points are drawn anew where a family or a domain changes: shares move by so much."""
RARE = 1e-3
"""Share of the random points that bounds may leave out: gaps are at the rim of a domain."""
PARTS = [list(LIBRARY.public)[k::6] for k in range(6)]
NOTHING = {"left out": [0.0, 0.0], "range only": [0.0, 0.0]}


@pytest.mark.parametrize("names", PARTS, ids=lambda names: names[0])
def test_nothing_is_left_out_beyond_the_record(names: list[str]) -> None:
    for name in names:
        for kind, found in zip(NOTHING, shares(LIBRARY, name), strict=True):
            at_random, everywhere = RECORD.get(name, NOTHING)[kind]
            told = f"{name}, {kind}: {found.all:.1%}; python -m conformance.check.coverage records it"
            assert found.random <= at_random + (DRAWN if at_random else 0.0), told
            assert found.all <= everywhere + (DRAWN if everywhere else 0.0), told


def test_what_is_left_out_has_a_reason_and_is_rare() -> None:
    left_out = {name: row["left out"] for name, row in RECORD.items() if any(row["left out"])}
    assert all(any(fnmatchcase(name, glob) for glob in REASONS) for name in left_out)
    assert all(at_random < RARE for at_random, _ in left_out.values())


def test_lobes_are_told_more_than_their_range() -> None:
    for name in LIBRARY.public:
        if LIBRARY.function(name).module == "lobes" and name in RECORD:
            assert RECORD[name]["range only"] == RECORD[name]["left out"], name


def test_page_shows_the_record() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(RECORD)
    assert set(RECORD) <= set(LIBRARY.public)


def test_range_of_results_is_no_telling_bound(tmp_path: Path) -> None:
    text = "def probe(x: Annotated[f32, Interval(0.0, 1.0)]) -> f32:\n    return x\n"
    library_of(tmp_path, text)
    (tmp_path / "numeric" / "bounds.toml").write_text(
        '[[probe]]\nmeasure = "absolute"\nbound = 1.0\ndomain = "all"\norigin = "range of the results"\n',
        encoding="utf-8",
    )
    library = Library(tmp_path)
    assert is_range(library.bounds["probe"][0])
    assert shares(library, "probe") == (Shares(0.0, 0.0), Shares(1.0, 1.0))


def test_half_a_domain_is_half_uncovered(tmp_path: Path) -> None:
    text = "def probe(x: Annotated[f32, Interval(0.0, 1.0)]) -> f32:\n    return x\n"
    library_of(tmp_path, text)
    (tmp_path / "numeric" / "bounds.toml").write_text(
        '[[probe]]\nmeasure = "absolute"\nbound = 1e-6\nwhere = { x = [0.0, 0.5] }\n'
        'domain = "half"\norigin = "none"\n',
        encoding="utf-8",
    )
    found = uncovered(Library(tmp_path), "probe")
    assert abs(found.random - 0.5) < 0.05
    assert 0.0 < found.all < 1.0
