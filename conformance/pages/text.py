"""Texts as HTML: emitted code with its syntax coloured, and Markdown."""

from __future__ import annotations

import functools
import posixpath
import re
from collections.abc import Callable, Sequence
from html import escape
from typing import Any

from markdown_it import MarkdownIt
from markdown_it.token import Token
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import get_lexer_by_name

LEXERS = {"opencl": "c", "sh": "bash"}
_PREFIXED = re.compile(r"\b(vair_)(\w+)")


def coloured(text: str, language: str) -> str:
    """Code as a pre element; unknown languages stay plain."""
    lexer = get_lexer_by_name(LEXERS.get(language, language or "text"))
    html: str = highlight(text, lexer, HtmlFormatter(cssclass="code"))
    return html


@functools.cache
def code_style() -> str:
    """The style of coloured code, for light and dark pages."""
    light = HtmlFormatter(style="default", cssclass="code").get_style_defs(".code")
    dark = HtmlFormatter(style="github-dark", cssclass="code").get_style_defs(".code")
    kept = "\n".join(line for line in light.splitlines() if line.startswith(".code ."))
    dark = "\n".join(line for line in dark.splitlines() if line.startswith(".code ."))
    return f"{kept}\n@media (prefers-color-scheme: dark) {{\n{dark}\n}}\n"


def linked(html: str, address: Callable[[str], str | None]) -> str:
    """Emitted names inside coloured code as links, where they have an address."""

    def link(match: re.Match[str]) -> str:
        target = address(match[2])
        return match[0] if target is None else f'<a href="{target}">{match[1]}{match[2]}</a>'

    return _PREFIXED.sub(link, html)


def rendered(markdown: str, address: Callable[[str], str | None]) -> str:
    """Markdown as HTML; headings get identifiers, links to other files the addresses of their pages.

    address  file that a link names -> its address here; None where it has no page: the link is left out
    """
    parser = MarkdownIt("commonmark", {"html": False}).enable("table")
    parser.add_render_rule("fence", _fence)
    tokens = parser.parse(markdown)
    for k, token in enumerate(tokens):
        if token.type == "heading_open":
            token.attrSet("id", anchor(tokens[k + 1].content))
        if token.type == "inline":
            token.children = _with_addresses(token.children or [], address)
    html: str = parser.renderer.render(tokens, parser.options, {})
    return html.replace("<table>", '<div class="scroll"><table class="plain">').replace(
        "</table>", "</table></div>"
    )


def anchor(heading: str) -> str:
    """The identifier of a heading, as code hosts make it."""
    return re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")


def title_of(markdown: str) -> str:
    """The first heading."""
    found = re.search(r"^# (.+)$", markdown, re.MULTILINE)
    return found[1] if found else ""


def _fence(_: Any, tokens: Sequence[Token], index: int, *__: Any) -> str:
    """A code block in colours; above it the file that it goes into, if it names one."""
    words = tokens[index].info.split()
    html = coloured(tokens[index].content, words[0] if words else "text")
    file = next((w.removeprefix("file=") for w in words if w.startswith("file=")), "")
    told = (
        f"at the end of <code>{escape(file[1:])}</code>"
        if file[:1] == "+"
        else f"<code>{escape(file)}</code>"
    )
    return f'<p class="small">{told}</p>{html}' if file else html


def _with_addresses(children: list[Token], address: Callable[[str], str | None]) -> list[Token]:
    kept: list[Token] = []
    is_dropped = False
    for child in children:
        if child.type == "link_open":
            file, _, place = str(child.attrGet("href") or "").partition("#")
            target = address(posixpath.normpath(file)) if file else ""
            is_dropped = target is None
            if target is not None:
                child.attrSet("href", target + (f"#{place}" if place else ""))
        if not (is_dropped and child.type in ("link_open", "link_close")):
            kept.append(child)
    return kept
