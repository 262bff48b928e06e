"""A docstring is a summary and entries, wherever its lines break.

Plan. Text against the summary and entries that it has; every case also with the margin that it has in a
source, with tabs for its margin, and with spaces behind its lines.
"""

import ast
import textwrap

import pytest

from codegen.frontend.docstring import parse
from codegen.ir.nodes import Doc

CASES: dict[str, tuple[str, str, dict[str, str]]] = {
    "a summary": ("What it is.", "What it is.", {}),
    "a summary over lines": ("What it\nis.", "What it is.", {}),
    "a summary in paragraphs": ("What it is.\n\nAnd why.", "What it is. And why.", {}),
    "an indented summary": ("What it is:\n\n    an example.", "What it is: an example.", {}),
    "an entry": ("What.\n\nx  the first", "What.", {"x": "the first"}),
    "an entry alone": ("x  the first", "", {"x": "the first"}),
    "an entry over lines": ("What.\n\nx  the first,\n   and on", "What.", {"x": "the first, and on"}),
    "an entry in paragraphs": ("What.\n\nx  the first,\n\n   and on", "What.", {"x": "the first, and on"}),
    "entries in order": ("What.\n\nz  last\na  first", "What.", {"z": "last", "a": "first"}),
    "a summary behind entries": (
        "What.\n\nx  first\nAnd why.\n  Yes.",
        "What. And why. Yes.",
        {"x": "first"},
    ),
    "one space makes no entry": ("What.\n\nreturns nothing", "What. returns nothing", {}),
    "a digit starts no entry": ("What.\n\n2  is a number", "What. 2  is a number", {}),
    "a name with digits": ("What.\n\nr_0  a ratio", "What.", {"r_0": "a ratio"}),
    "an underscore first": ("What.\n\n_r  a ratio", "What.", {"_r": "a ratio"}),
    "spaces inside an entry": ("What.\n\nx  one  two", "What.", {"x": "one  two"}),
}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("margin", ["", "    ", "\t", "\t\t"], ids=["none", "spaces", "a tab", "two tabs"])
@pytest.mark.parametrize("behind", ["", "  "], ids=["bare", "spaces behind"])
def test_a_docstring_is_a_summary_and_entries(case: str, margin: str, behind: str) -> None:
    text, summary, entries = CASES[case]
    lines = textwrap.indent(text, margin).removeprefix(margin).split("\n")
    written = f"{behind}\n".join([*lines, margin])
    docstring = ast.get_docstring(ast.parse(f"'''{written}'''"))
    assert docstring is not None
    doc = parse(docstring)
    assert doc == Doc(summary, entries)
    assert list(doc.entries) == list(entries)


def test_no_docstring_says_nothing() -> None:
    assert parse("") == Doc("", {})
