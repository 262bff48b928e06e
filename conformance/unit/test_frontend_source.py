"""A source file knows its section and its places, and says in words what it does not take.

Plan. Modules by their depth; nodes with a place, without one, and beyond the text; a piece of Python for
every word of the table, beside pieces that go by their own name; bytes around the end of ASCII.
"""

import ast
from pathlib import Path

import pytest

from codegen.errors import Place, SourceError
from codegen.frontend.source import WORDS, SourceFile, describe, parse_file, read_source

SHOWN = "shaderlib/numeric/probe.py"
FILE = SourceFile("shaderlib.numeric.probe", SHOWN, "A = 1\nB = 2\n")


@pytest.mark.parametrize(
    ("module", "section"),
    [
        ("shaderlib.constants", ""),
        ("shaderlib.numeric.probe", "numeric"),
        ("shaderlib.numeric.inner.probe", "numeric"),
    ],
)
def test_the_section_is_the_first_folder(module: str, section: str) -> None:
    assert SourceFile(module, SHOWN, "").section == section


def test_a_node_stands_at_its_line_and_column() -> None:
    first, second = ast.parse(FILE.text).body
    assert isinstance(second, ast.Assign)
    assert FILE.place(first) == Place(SHOWN, 1, 1, "A = 1")
    assert FILE.place(second.value) == Place(SHOWN, 2, 5, "B = 2")


def test_a_node_without_a_place_stands_at_the_beginning() -> None:
    assert FILE.place(ast.parse(FILE.text)) == Place(SHOWN, 1, 1, "A = 1")


@pytest.mark.parametrize("line", [-1, 0, 3, 9])
def test_beyond_the_text_there_is_none_to_show(line: int) -> None:
    node = ast.Pass(lineno=line, col_offset=4)
    assert FILE.place(node) == Place(SHOWN, line, 5, "")


PIECES = {
    "Expr": ("f()", "an expression without effect"),
    "FunctionDef": ("def f():\n    pass", "a nested function"),
    "AsyncFunctionDef": ("async def f():\n    pass", "an async function"),
    "ClassDef": ("class C:\n    pass", "a nested class"),
    "Constant": ("'text'", "a text or another constant that is no number"),
    "JoinedStr": ("f'{x}'", "a text"),
    "Call": ("a.b()", "a call of anything but a plain name"),
    "ListComp": ("[x for x in y]", "a comprehension"),
    "SetComp": ("{x for x in y}", "a comprehension"),
    "DictComp": ("{x: x for x in y}", "a comprehension"),
    "GeneratorExp": ("(x for x in y)", "a comprehension"),
    "UnaryOp": ("+x", "a plus sign before an operand"),
    "Subscript": ("x[0]", "an index; components are written v.x"),
    "AugAssign": ("v.x += 1.0", "an assignment to a component"),
    "NamedExpr": ("(x := 1.0)", "an assignment inside an expression"),
    "Starred": ("*x", "an unpacked argument"),
    "Import": ("import os", "a plain import (write from shaderlib... import name)"),
    "ImportFrom": ("from . import x", "a relative import"),
    "Assign": ("a, b = 1, 2", "an assignment to several names"),
    "AnnAssign": ("x: int", "a declaration without a value"),
    "While": ("while True:\n    pass", '"while"'),
    "Lambda": ("lambda: 1", '"lambda"'),
}


@pytest.mark.parametrize("kind", PIECES)
def test_a_piece_of_python_is_said_in_words(kind: str) -> None:
    text, words = PIECES[kind]
    statement = ast.parse(f"[{text}]" if kind == "Starred" else text).body[0]
    found = [node for node in ast.walk(statement) if type(node).__name__ == kind]
    assert describe(found[0]) == words


def test_every_word_has_its_piece() -> None:
    assert set(WORDS) <= set(PIECES)


@pytest.mark.parametrize(
    ("line", "column", "shown"),
    [
        (b"# \x7f\xc3\xa9", 4, "# \x7f\u00e9"),
        (b"#\x80", 2, "#\ufffd"),
        (b"\xff", 1, "\ufffd"),
    ],
    ids=["a letter", "the first byte beyond", "the last byte"],
)
def test_what_is_not_ascii_is_shown_where_it_stands(
    line: bytes, column: int, shown: str, tmp_path: Path
) -> None:
    path = tmp_path / "probe.py"
    path.write_bytes(b"A = 1\n" + line + b"\nB = 2\n")
    with pytest.raises(SourceError) as caught:
        read_source(path, SHOWN)
    assert caught.value.place == Place(SHOWN, 2, column, shown)


def test_what_python_cannot_place_stands_at_the_beginning(tmp_path: Path) -> None:
    path = tmp_path / "probe.py"
    path.write_bytes(b"A = 1\nB = \0\n")
    with pytest.raises(SourceError, match="not valid Python") as caught:
        parse_file(path, "shaderlib.numeric.probe", SHOWN)
    assert (caught.value.place.line, caught.value.place.column) == (1, 1)


def test_imports_that_only_python_needs_are_left_out(tmp_path: Path) -> None:
    path = tmp_path / "probe.py"
    path.write_text("from __future__ import annotations\nfrom typing import Annotated\nA = 1\n")
    assert not parse_file(path, "shaderlib.numeric.probe", SHOWN).imports


def test_lines_end_as_they_do_everywhere(tmp_path: Path) -> None:
    path = tmp_path / "probe.py"
    path.write_bytes(b"A = 1\r\n# \x7f\r\n")
    assert read_source(path, SHOWN) == "A = 1\n# \x7f\n"
