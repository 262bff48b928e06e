"""Times of compiling includes: glslang accepts every shell, and the page says what was recorded.

Plan.
  shells    each compiles with an include, as it was measured
  times     the include's share is the difference; one more shader costs what several do beyond one
  page      the table is that of results.json, and has every shell
"""

import pytest

from codegen.backends import dialect
from codegen.emit.module import emit
from codegen.library import load_library
from conformance.bench.compile import record, times
from conformance.bench.compile.shells import SHELLS, Shell
from conformance.bench.compile.times import SEVERAL, Taken, Times, longest, measured, whole_library
from targets.glsl.validate import MISSING_VALIDATOR
from targets.packages import find_tool

FUNCTION = "sin_angle"


DEFAULT = {shell.name for shell in SHELLS[:2]}


@pytest.mark.parametrize(
    "shell",
    [pytest.param(s, id=s.name, marks=() if s.name in DEFAULT else pytest.mark.nightly) for s in SHELLS],
)
def test_every_shell_compiles_with_an_include(shell: Shell) -> None:
    glslang = find_tool("glslangValidator", "glslang")
    if glslang is None:
        pytest.skip(MISSING_VALIDATOR)
    (found,) = measured(load_library(), glslang, shell, [FUNCTION], 1)
    assert found.function == FUNCTION
    assert min(found.whole.median, found.empty.median) > 0.0
    assert (found.several is None) == bool(shell.options)
    assert whole_library(load_library(), glslang, shell, 1).least > 0.0


def test_a_shader_that_is_none_is_no_measurement(monkeypatch: pytest.MonkeyPatch) -> None:
    glslang = find_tool("glslangValidator", "glslang")
    if glslang is None:
        pytest.skip(MISSING_VALIDATOR)
    monkeypatch.setattr(times, "emit", lambda *arguments: "mistake!\n")
    with pytest.raises(RuntimeError, match=r"(?s)#version 300 es, frag: .*syntax error"):
        measured(load_library(), glslang, SHELLS[0], [FUNCTION], 1)


def test_what_one_more_shader_takes() -> None:
    several = Taken(80.0 + 4.0 * (SEVERAL - 1), 0.0)
    found = Times(FUNCTION, Taken(80.0, 70.0), Taken(65.0, 60.0), several)
    assert (found.above, found.more) == (15.0, 4.0)
    assert Times(FUNCTION, found.whole, found.empty, None).more is None


def test_the_longest_include_comes_first() -> None:
    library = load_library()
    names = ["sin_angle", "fakefur_shade", "mirror"]
    first, *others = longest(library, names)
    assert first == "fakefur_shade"
    lengths = [len(emit(library, dialect("glsl", "es300"), [name])) for name in (first, *others)]
    assert lengths == sorted(lengths, reverse=True)


def test_the_page_says_what_was_recorded() -> None:
    data = record.read()
    assert list(data["shells"]) == [shell.name for shell in SHELLS]
    text = record.README.read_text(encoding="utf-8")
    assert record.table(data) == text.partition(record.BEGIN)[2].partition(record.END)[0].strip()
