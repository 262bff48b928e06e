"""All files of the documentation: an index, a page per function, the guides, the lecture's errata."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import jinja2

from codegen.library import Library
from codegen.version import VERSION
from conformance.pages import function
from conformance.pages.text import code_style, rendered, title_of
from conformance.templates import carried, templates

GUIDES = ("vendor", "generate", "conformance", "adding", "ci")
"""The guides, in the order of the index."""
ERRATA = Path(__file__).parents[1] / "printed"
NOTES = {
    "vendor": "no toolchain, compile errors, later upgrades",
    "generate": "functions by name, by error, or by a scene file",
    "conformance": "verdicts, replays, shards, and kits for other engines",
    "adding": "recipes that tests execute",
    "ci": "software drivers and a GPU runner, JUnit and JSON",
}


def site(library: Library, names: Sequence[str]) -> Iterator[tuple[str, bytes]]:
    """Path inside the folder and content of every file.

    names  functions that get a page; others are named without a link
    """
    style = carried("conformance.report", "page/report.css") + carried(__package__, "templates/pages.css")
    yield "style.css", (style + code_style()).encode()
    guides = [(name, title_of(guide(name)), NOTES[name]) for name in GUIDES]
    sections: dict[str, list[Any]] = {}
    for name in names:
        f = library.function(name)
        sections.setdefault(f.module, []).append(f)
    shared = {"version": VERSION, "source": library.select().source_hash, "guides": guides}
    yield "index.html", _page("index.html.j2", shared, root="", sections=sections, total=len(names))
    known = set(names)

    def address(name: str) -> str | None:
        return f"{name}.html" if name in known else None

    for name in names:
        shown = function.view(library, library.function(name), address)
        yield f"functions/{name}.html", _page("function.html.j2", shared, root="../", f=shown, known=known)
    for name in GUIDES:
        html = rendered(guide(name), lambda file: f"{file[:-3]}.html" if file[:-3] in GUIDES else None)
        title = title_of(guide(name))
        yield f"guides/{name}.html", _page("guide.html.j2", shared, root="../", title=title, html=html)
    markdown = (ERRATA / "README.md").read_text(encoding="utf-8")
    markdown = markdown[markdown.index("# ") :]
    html = rendered(markdown, lambda file: None)
    yield "errata.html", _page("guide.html.j2", shared, root="", title=title_of(markdown), html=html)
    for picture in sorted((ERRATA / "pictures").glob("*.png")):
        yield f"pictures/{picture.name}", picture.read_bytes()


def guide(name: str) -> str:
    """A guide's Markdown."""
    return carried("codegen", f"guides/{name}.md")


def _page(template: str, shared: dict[str, Any], **shown: Any) -> bytes:
    return _environment().get_template(template).render(**shared, **shown).encode()


@functools.cache
def _environment() -> jinja2.Environment:
    environment = templates("conformance.pages", "templates")
    environment.filters["figure"] = figure
    return environment


def figure(value: Any) -> str:
    """A number for people; infinite ones are words already."""
    if isinstance(value, str):
        return value
    return "0" if value == 0 else f"{value:.3g}"
