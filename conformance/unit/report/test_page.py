"""The report's page in a browser, without network: it draws, filters and says nothing to the console.

Plan. Chromium loads the page of a made-up report by an address that asks for a filter, and prints it.
  console   no message of any kind
  table     only the rows of the driver asked for whose names have all words of the filter
  cards     the others are hidden; a plot of the first is drawn, with its marks, bars and front
  figures   the list below a plot names the worst input and the command that replays it
Where chromium is missing the test is skipped and says so.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from html.parser import HTMLParser
from pathlib import Path

import pytest

from codegen.library import load_library
from conformance.report.model import build
from conformance.report.page import page
from conformance.unit.support.light import small_section
from conformance.unit.support.results import MESA, POCL, WORDS, small_result

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
WAIT_MILLISECONDS = 8000
"""Of the page's own clock, which runs as fast as the page can."""
FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-extensions",
    "--window-size=1280,2000",
    f"--virtual-time-budget={WAIT_MILLISECONDS}",
    "--enable-logging=stderr",
    "--dump-dom",
)


class Document(HTMLParser):
    """Counts of what the test asks for."""

    def __init__(self) -> None:
        super().__init__()
        self.rows: list[str] = []
        self.hidden: dict[str, bool] = {}
        self.plots = self.marks = self.bars = 0
        self._body = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        names = (given.get("class") or "").split()
        if tag == "tr" and "data-driver" in given:
            self.rows.append(given["data-driver"] or "")
        if tag == "article":
            self.hidden[given["id"] or ""] = "hidden" in given
        self.plots += "main-svg" in names
        self.marks += tag == "path" and "point" in names
        self.bars += "yerror" in names


@pytest.fixture(scope="module")
def opened(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, str]:
    """The document and the console's messages."""
    if BROWSER is None:
        pytest.skip("no chromium is here: apt-get install --no-install-recommends chromium")
    library = load_library()
    results = [small_result(library, d) for d in (MESA, POCL)]
    report = build(library, results, command="vair report -o DIR", light=small_section())
    folder: Path = tmp_path_factory.mktemp("page")
    (folder / "report.html").write_text(page(library, report), encoding="utf-8")
    address = f"{(folder / 'report.html').as_uri()}#driver=1&mode=latency&unit=ulp&filter=sin_angle"
    done = subprocess.run(
        [BROWSER, *FLAGS, f"--user-data-dir={folder / 'profile'}", address],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    return done.stdout, "\n".join(line for line in done.stderr.splitlines() if "CONSOLE" in line)


def test_the_console_is_silent(opened: tuple[str, str]) -> None:
    assert opened[1] == ""


def test_table_and_cards_are_filtered(opened: tuple[str, str]) -> None:
    found = Document()
    found.feed(opened[0])
    variants = [f for f in load_library().public.values() if f.name == "sin_angle" or f.base == "sin_angle"]
    assert found.rows == ["1"] * len(variants)
    assert found.hidden == {"sin_angle": False, "strand_cosine": True}


def test_plots_are_drawn(opened: tuple[str, str]) -> None:
    found = Document()
    found.feed(opened[0])
    assert found.plots >= 4, "the overview, a card, and two of the estimators of light"
    assert found.marks > 0 and found.bars > 0


def test_figures_stand_in_words_too(opened: tuple[str, str]) -> None:
    listed = "".join(re.findall(r"<dl>.*?</dl>", opened[0], flags=re.DOTALL))
    assert WORDS in listed
    assert "vair check --replay worst/opencl-pocl/sin_angle_half.json" in listed
    assert "vair report -o DIR --function sin_angle_half --target opencl" in listed
