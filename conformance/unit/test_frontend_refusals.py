"""Bad sources get one sentence with their place.

Plan. data/bad_sources.toml holds the cases. In a case the mark `<!>` stands before the place that the error
must name; it is taken out before the source is read. Each case says the whole sentence, "..." for any part.
  source   a whole file (after a header line of imports, unless header = false)
  body     the statements of one function of x: X, n: u32, k: i32, d: D, v: V and p: P that returns f32
  files    further sources, path -> text
Every refusal is a SourceError (a UserError), one sentence, with the line and a caret under the place.
Reserved names are tried in every position where a source can give a name.
"""

import re
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from codegen.errors import SourceError, UserError
from codegen.library import Library
from conformance.unit.support.sources import FIRST_LINE, HEADER, write_library

MARK = "<!>"
FILE = "shaderlib/numeric/probe.py"
HEAD = "def probe(x: X, n: u32, k: i32, d: D, v: V, p: P) -> f32:\n"


@dataclass(frozen=True)
class Case:
    """One bad source: its marked text, what the error must say, and further files."""

    name: str
    sentence: str
    source: str = ""
    body: str = ""
    header: bool = True
    files: dict[str, str] = field(default_factory=dict)

    @property
    def marked(self) -> str:
        """The text of the file, with its mark."""
        if self.source:
            return self.source
        return HEAD + "".join(f"    {line}\n" for line in self.body.strip("\n").splitlines())

    @property
    def place(self) -> tuple[int, int]:
        """Line and column of the mark, from 1."""
        before = self.marked[: self.marked.index(MARK)]
        start = FIRST_LINE if self.header else 1
        return start + before.count("\n"), len(before) - (before.rfind("\n") + 1) + 1

    @property
    def text(self) -> str:
        return self.marked.replace(MARK, "")

    def says(self, sentence: str) -> bool:
        """Whether this is the sentence."""
        return re.fullmatch(re.escape(self.sentence).replace(re.escape("..."), ".*"), sentence) is not None


def cases() -> list[Case]:
    data = tomllib.loads((Path(__file__).parent / "data" / "bad_sources.toml").read_text(encoding="utf-8"))
    return [Case(name=name, **entry) for name, entry in data.items()]


def refusal(folder: Path, text: str, files: dict[str, str], *, header: bool = True) -> SourceError:
    """The error that reading all functions and structs of a library raises."""
    write_library(folder, files)
    write_library(folder, {"numeric/probe.py": text}, header=header)
    with pytest.raises(SourceError) as caught:
        read_everything(folder)
    return caught.value


def read_everything(folder: Path) -> None:
    library = Library(folder)
    assert library.functions
    assert library.structs is not None


@pytest.mark.parametrize("case", cases(), ids=lambda case: case.name)
def test_bad_source_is_refused_with_its_place_and_a_caret(case: Case, tmp_path: Path) -> None:
    error = refusal(tmp_path, case.text, case.files, header=case.header)
    line, column = case.place
    assert case.says(error.sentence), error.sentence
    assert (error.place.path, error.place.line, error.place.column) == (FILE, line, column)
    first, *shown = str(error).split("\n")
    assert isinstance(error, UserError)
    assert first == f"{FILE}:{line}:{column}: {error.sentence}"
    source_line = (HEADER * case.header + case.text).splitlines()[line - 1]
    assert shown == [f"    {source_line}", f"    {' ' * (column - 1)}^"]


def test_every_case_marks_one_place() -> None:
    unmarked = [case.name for case in cases() if case.marked.count(MARK) != 1]
    assert not unmarked


RESERVED = (
    *("half", "kernel", "sample", "mix", "var", "input", "output", "near", "lit", "equal", "float3", "vec2f"),
    *("saturate", "M_PI", "discard", "texture"),
)
"""Keywords, built-ins and macros of one target or another."""

POSITIONS = {
    "parameter": "def probe({}: X) -> f32:\n    return 1.0\n",
    "local": "def probe(x: X) -> f32:\n    {} = x\n    return x\n",
    "loop": "def probe(x: X) -> f32:\n    for {} in range(3):\n        y = x\n    return x\n",
    "function": "def {}(x: X) -> f32:\n    return x\n",
    "struct": "@struct\nclass {}:\n    angle: X\ndef probe(x: X) -> f32:\n    return x\n",
    "field": "@struct\nclass Angles:\n    {}: X\ndef probe(x: X) -> f32:\n    return x\n",
}


@pytest.mark.parametrize("position", POSITIONS)
@pytest.mark.parametrize("word", RESERVED)
def test_reserved_name_is_refused(word: str, position: str, tmp_path: Path) -> None:
    error = refusal(tmp_path, POSITIONS[position].format(word), {})
    kind = "local" if position == "loop" else position
    told = rf'{kind} name "{word}" is a (keyword|built-in|macro) of .+; choose another'
    assert re.fullmatch(told, error.sentence), error.sentence


@pytest.mark.parametrize("word", ["_private", "two__underscores"])
@pytest.mark.parametrize("position", POSITIONS)
def test_name_with_underscores_that_targets_reserve_is_refused(
    word: str, position: str, tmp_path: Path
) -> None:
    assert f'"{word}" must be ASCII' in refusal(tmp_path, POSITIONS[position].format(word), {}).sentence


def test_name_defined_in_two_files_is_refused(tmp_path: Path) -> None:
    text = "def probe(x: X) -> f32:\n    return x\n"
    error = refusal(tmp_path, text, {"direction/probe.py": text})
    assert error.sentence == '"probe" is already defined in shaderlib/direction/probe.py'
    assert str(error).endswith("    def probe(x: X) -> f32:\n    ^")


def test_text_that_is_no_text_is_refused(tmp_path: Path) -> None:
    write_library(tmp_path, {"numeric/probe.py": ""})
    (tmp_path / "numeric/probe.py").write_bytes(b"X = 1.0\n# \xff\n")
    with pytest.raises(SourceError, match=r"shaderlib/numeric/probe\.py:2:3: a shader source is ASCII"):
        read_everything(tmp_path)


def test_null_byte_is_refused(tmp_path: Path) -> None:
    assert "not valid Python" in refusal(tmp_path, "X\0 = 1.0\n", {}).sentence


@pytest.mark.parametrize("terms", [300, 900, 4000])
def test_expression_without_end_is_refused(terms: int, tmp_path: Path) -> None:
    text = f"def probe(x: X) -> f32:\n    return {' + '.join(['x'] * terms)}\n"
    assert "nested too deeply" in refusal(tmp_path, text, {}).sentence


def test_missing_folder_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UserError, match="no shader sources"):
        Library(tmp_path / "nowhere")


def test_unknown_function_names_the_nearest(tmp_path: Path) -> None:
    write_library(tmp_path, {"numeric/probe.py": "def sin_angle(x: X) -> f32:\n    return x\n"})
    with pytest.raises(UserError) as caught:
        Library(tmp_path).function("sin_angel")
    assert str(caught.value) == 'unknown function "sin_angel"; did you mean "sin_angle"?'
