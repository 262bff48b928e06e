"""The documentation: every page is there, says what is known, and its links lead somewhere, without network.

Plan. Pages of a few functions of every kind are written once.
  content   a page names what its function's own data say: parameters, bounds, drivers, guarantee, times,
            texts on every target, variants, paper, erratum; a figure of it is one that was recorded
  links     every link of every page leads to a file and a heading that are there; nothing comes from a
            network; no page shows a name without a page as a link
  browser   Chromium opens pages at the width of a desktop and of a telephone: no message, nothing wider than
            the page. All pages of all functions: nightly
  refusals  one sentence, status 2
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from codegen.backends import TARGETS, dialect
from codegen.cli import run
from codegen.emit.definition import read_definitions
from codegen.emit.module import emit
from codegen.guarantees import guarantees, phrase
from codegen.library import load_library
from codegen.passes.analysis.operations import operations_by_cost
from conformance.pages import recorded
from conformance.pages.site import GUIDES
from conformance.pages.text import anchor, rendered
from conformance.web.browser import missing, open_browser, view

FUNCTIONS = (
    "sin_angle",
    "sin_angle_half",
    "strand_cosine",
    "strand_cosine_banks_printed",
    "fakefur_shade",
    "env_radiance",
    "pcg3d",
)
WIDTHS = (1280, 390)
"""A desktop and a telephone, in pixels."""
OVERFLOW = "return document.documentElement.scrollWidth - document.documentElement.clientWidth;"


class Page(HTMLParser):
    """Links, identifiers and text of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.links: list[str] = []
        self.sources: list[str] = []
        self.names: set[str] = set()
        self.words: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {key: value or "" for key, value in attrs}
        if tag in ("a", "link") and "href" in given:
            self.links.append(given["href"])
        if "src" in given:
            self.sources.append(given["src"])
        self.names.add(given.get("id", ""))

    def handle_data(self, data: str) -> None:
        self.words.append(data)

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.words).split())


def read(path: Path) -> Page:
    page = Page()
    page.feed(path.read_text(encoding="utf-8"))
    return page


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("pages") / "docs"
    names = [part for name in FUNCTIONS for part in ("--function", name)]
    assert run(["docs", "-o", str(folder), *names]) == 0
    return folder


def pages(folder: Path) -> list[Path]:
    return sorted(folder.rglob("*.html"))


def test_every_page_is_there(site: Path) -> None:
    found = {path.relative_to(site).as_posix() for path in pages(site)}
    functions = {f"functions/{name}.html" for name in FUNCTIONS}
    assert found == functions | {f"guides/{name}.html" for name in GUIDES} | {"index.html", "errata.html"}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_page_says_what_is_known(site: Path, name: str) -> None:
    library = load_library()
    f = library.function(name)
    page = read(site / "functions" / f"{name}.html")
    told = [
        f.doc.summary,
        f.doc.entries["source"],
        f"{f.place.path}:{f.place.line}",
        "GLSL 4.30",
        "OpenCL C 1.2",
    ]
    told += [p.name for p in f.parameters] + [f"vair emit --target wgsl --function {name}"]
    told += [b.describe() for b in library.bounds_of(name)] + [b.origin for b in library.bounds_of(name)]
    told += [v.name for v in library.variants(name)]
    told += [f"{d['driver']} {d['version']}" for d in recorded.on_drivers(library, f)]
    surveyed = guarantees(library).get(name)
    for table, guarantee in surveyed.tables.items() if surveyed else ():
        told.append(phrase(table, guarantee, library.bounds_of(name)).partition(" by the ")[0])
    told += [f"{count} {cost}" for cost, count in operations_by_cost(f, library).items()]
    assert [text for text in told if " ".join(text.split()) not in page.text] == []
    # Words of code are coloured one by one.
    letters = page.text.replace(" ", "")
    for target in TARGETS:
        code = read_definitions(emit(library, dialect(target), [name]))[-1].code
        assert [line for line in code if line.replace(" ", "") not in letters] == []


def test_recorded_figures_are_on_the_page(site: Path) -> None:
    library = load_library()
    f = library.function("sin_angle")
    page = read(site / "functions" / "sin_angle.html")
    drivers, times = recorded.on_drivers(library, f), recorded.times(library, f)
    assert drivers and times
    for d in drivers:
        assert f"{d['accuracy'][0]['maximum']:.3g}" in page.text
    for t in times:
        assert f"{t['ns']:.3g}" in page.text
    svg = (site / "functions" / "sin_angle.html").read_text(encoding="utf-8")
    assert svg.count("<svg") == len(recorded.group_points(library, "sin_angle")) > 0
    assert "var(--ink)" in svg and "#111111" not in svg


def test_struct_fields_stand_with_their_domains(site: Path) -> None:
    page = read(site / "functions" / "fakefur_shade.html")
    assert "optics.exponent" in page.text and "coat.density" in page.text


def test_an_erratum_is_told_on_both_pages(site: Path) -> None:
    for name in ("strand_cosine", "strand_cosine_banks_printed"):
        page = read(site / "functions" / f"{name}.html")
        assert "Strand cosine after Banks" in page.text
        assert "../errata.html#strand-cosine-after-banks" in page.links
    assert "Erratum" not in read(site / "functions" / "pcg3d.html").text


def broken_links(folder: Path) -> Iterator[str]:
    """Links and sources that lead nowhere, or out."""
    known = {path: read(path) for path in pages(folder)}
    for path, page in known.items():
        for link in (*page.links, *page.sources):
            if link == "data:,":
                continue
            file, _, place = link.partition("#")
            target = (path.parent / file).resolve() if file else path
            if not target.is_relative_to(folder.resolve()) or not target.is_file() or "//" in link:
                yield f"{path.name}: {link}"
            elif place and place not in known[target].names:
                yield f"{path.name}: {link}: no such place"


def test_every_link_leads_somewhere(site: Path) -> None:
    assert list(broken_links(site.resolve())) == []
    assert sum(len(read(path).links) for path in pages(site)) > 10 * len(FUNCTIONS)


def test_nothing_comes_from_a_network(site: Path) -> None:
    for path in [*pages(site), site / "style.css"]:
        text = path.read_text(encoding="utf-8").replace("http://www.w3.org/", "")
        assert "http://" not in text and "https://" not in text and "@import" not in text, path.name


def test_markdown_becomes_pages() -> None:
    text = "# A title, here\n\n[there](other.md#b) [gone](../x.py) `a_b`\n\n| a |\n|---|\n| 1 |\n"
    html = rendered(text, lambda file: "other.html" if file == "other.md" else None)
    assert '<h1 id="a-title-here">' in html and 'href="other.html#b"' in html
    assert "x.py" not in html and "gone" in html
    assert '<div class="scroll"><table' in html
    assert anchor("Fake fur, all four together") == "fake-fur-all-four-together"


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["docs"], "Missing option '-o'"),
        (["docs", "-o", "d", "--function", "sin_angel"], 'did you mean "sin_angle"?'),
        (["docs", "-o", "no/such/folder"], 'cannot make "no/such/folder"'),
    ],
)
def test_refusals(
    arguments: list[str],
    told: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(arguments) == 2
    assert told in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def visit(driver: Any, paths: list[Path]) -> list[str]:
    """What is wrong with pages in a browser, at every width."""
    wrong = []
    for width in WIDTHS:
        view(driver, width, 900)
        for path in paths:
            driver.get(path.as_uri())
            beyond = driver.execute_script(OVERFLOW)
            if beyond > 0:
                wrong.append(f"{path.name} is {beyond} px wider than {width} px")
            wrong += [f"{path.name}: {json.dumps(entry)}" for entry in driver.get_log("browser")]
    return wrong


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    reason = missing()
    if reason:
        pytest.skip(reason)
    with open_browser(()) as driver:
        yield driver


def test_pages_fit_a_desktop_and_a_telephone(site: Path, browser: Any) -> None:
    chosen = ["index.html", "functions/fakefur_shade.html", "functions/sin_angle.html", "guides/ci.html"]
    assert visit(browser, [site / name for name in [*chosen, "errata.html"]]) == []


@pytest.mark.nightly
def test_all_pages(tmp_path: Path, browser: Any) -> None:
    folder = tmp_path / "docs"
    assert run(["docs", "-o", str(folder)]) == 0
    assert len(list((folder / "functions").iterdir())) == len(load_library().documented)
    assert list(broken_links(folder.resolve())) == []
    assert visit(browser, pages(folder)) == []
