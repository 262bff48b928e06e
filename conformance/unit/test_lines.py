"""Emitted lines know the source lines that they say, and compilers' messages lead back to them.

Plan.
  comment     every emitted function names the file and line of its definition
  map         every line of code is in it, and where it declares a local, the source line names that too
  directives  the text with them compiles in every dialect; in WGSL they are refused
  way back    one statement of a function is broken; glslang, naga and PoCL complain; what they print leads to
              the source line of that statement: by the map alone, by a map and the host's first line, and by
              directives. Logs of other compilers, as these print them, are read too
  refusals    one sentence, status 2
"""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path

import pytest

from codegen.cli import run
from codegen.emit.dialect import Dialect
from codegen.emit.frame import file_text
from codegen.emit.module import include
from codegen.library import default_root, load_library
from codegen.lines.directives import directives_of, with_directives
from codegen.lines.linemap import LineMap, Origin, as_json, map_of, read_map
from codegen.lines.where import Message, annotated, messages, origin_of
from conformance.unit.support.dialects import DIALECTS, ONE_PER_TARGET, dialect_id, validate
from targets import BuildFailed

Capture = pytest.CaptureFixture[str]
ROOT = default_root().parent
FUNCTION = "sin_angle_half"
BROKEN = ("dot(total, total)", "dot(total, totals)")
"""A name of FUNCTION's last statement, and one that nobody declared."""
SOME = ("fakefur_shade", "env_guarded_lambert", "pcg3d")
"""Functions with structs, loops, branches and maps."""
HOST = "// a host\n// with lines\n// of its own\n"


def source_line(origin: Origin) -> str:
    return (ROOT / origin.file).read_text(encoding="utf-8").splitlines()[origin.line - 1]


def emitted(d: Dialect, names: Sequence[str] | None, directives: bool = False) -> tuple[str, LineMap]:
    head, defined = include(load_library(), d, names)
    if not directives:
        text = file_text(d, head, defined)
        return text, map_of(d, text, defined)
    chosen = directives_of(d, defined)
    text = with_directives(chosen, head, defined)
    return text, map_of(d, text, defined, None if chosen.by_name else chosen.numbers)


def broken_line() -> str:
    """The place of the broken statement, as a person would find it."""
    place = load_library().function(FUNCTION).place
    lines = (ROOT / place.path).read_text(encoding="utf-8").splitlines()
    number = next(k for k, line in enumerate(lines, 1) if k > place.line and BROKEN[0] in line)
    return f"{place.path}:{number} (vair_{FUNCTION})"


def complaint(text: str, d: Dialect) -> str:
    with pytest.raises(BuildFailed) as caught:
        validate(text, d)
    return caught.value.log


def test_every_comment_names_its_source() -> None:
    library = load_library()
    text, _ = emitted(ONE_PER_TARGET[0], None)
    found = re.findall(r"^//   from +(\S+):(\d+)$", text, re.MULTILINE)
    places = [library.function(f.name).place for f in library.select().functions]
    assert found == [(place.path, str(place.line)) for place in places]


@pytest.mark.parametrize("d", ONE_PER_TARGET, ids=dialect_id)
def test_lines_say_what_their_source_lines_say(d: Dialect) -> None:
    text, found = emitted(d, None)
    code = 0
    for number, line in enumerate(text.splitlines(), 1):
        if line and not line.startswith(("//", "#")):
            code += 1
            origin = found.origins.get(number)
            if origin is None:
                continue
            local = re.match(r" +(?:float|int|uint|vec\d|float\d|let|var) (\w+)(?::[^=]+)? = ", line)
            if local and not local[1].endswith("_"):
                assert re.search(rf"\b{local[1]}\b", source_line(origin)), (line, str(origin))
    lost = code - len(found.origins)
    lookups = sum(len(x.splitlines()) for x in [d.lookup_library] if x)
    assert 0 <= lost <= lookups, f"{lost} lines of code come from nowhere"


def test_a_map_survives_its_file(tmp_path: Path) -> None:
    _, found = emitted(ONE_PER_TARGET[0], [FUNCTION], directives=True)
    path = tmp_path / "map.json"
    path.write_text(as_json(found), encoding="utf-8")
    assert read_map(path) == found
    data = json.loads(path.read_text(encoding="utf-8"))
    assert data["columns"] == ["line", "function", "file", "source_line"]
    assert all(len(row) == 4 for row in data["map"])


@pytest.mark.parametrize("d", [d for d in DIALECTS if d.line_map], ids=dialect_id)
def test_text_with_directives_compiles(d: Dialect) -> None:
    text, _ = emitted(d, SOME, directives=True)
    plain, _ = emitted(d, SOME)
    code = [line for line in text.splitlines() if line and not line.startswith(("//", "#line"))]
    assert code == [line for line in plain.splitlines() if line and not line.startswith("//")]
    validate(text, d)


@pytest.mark.parametrize("d", ONE_PER_TARGET, ids=dialect_id)
def test_a_message_leads_back_by_the_map(d: Dialect) -> None:
    text, found = emitted(d, [FUNCTION])
    log = complaint(text.replace(*BROKEN), d)
    told = list(annotated(found, log))
    assert f"    from {broken_line()}" in told, log
    assert [line for line in told if not line.startswith("    from ")] == log.splitlines()


@pytest.mark.parametrize("d", ONE_PER_TARGET, ids=dialect_id)
def test_a_message_leads_back_from_a_host(d: Dialect) -> None:
    text, found = emitted(d, [FUNCTION])
    log = complaint(HOST + text.replace(*BROKEN), d)
    told = list(annotated(found, log, first=1 + HOST.count("\n")))
    assert f"    from {broken_line()}" in told, log


@pytest.mark.parametrize("d", [d for d in DIALECTS if d.line_map], ids=dialect_id)
def test_a_message_leads_back_by_directives(d: Dialect) -> None:
    """Whatever stands before the file does not matter then."""
    text, found = emitted(d, [FUNCTION], directives=True)
    log = complaint(HOST + text.replace(*BROKEN), d)
    assert f"    from {broken_line()}" in list(annotated(found, log)), log


@pytest.mark.parametrize("d", [d for d in ONE_PER_TARGET if d.line_map], ids=dialect_id)
def test_lines_behind_the_file_are_counted_as_without_it(d: Dialect) -> None:
    """A mistake of the host behind the file is reported where the host has it."""
    text, _ = emitted(d, [FUNCTION], directives=True)
    log = complaint(text + "\nmistake!\n", d)
    number = text.count("\n") + 2
    assert number in [m.line for m in messages(log) if isinstance(m, Message)], log


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("ERROR: 0:57: 'x' : undeclared identifier", (0, 57)),
        ("ERROR: 4:57: 'x' : undeclared identifier", (4, 57)),
        ("0:57(12): error: `x' undeclared", (0, 57)),
        ("0(57) : error C1503: undefined variable", (0, 57)),
        ("   ┌─ wgsl:57:12", (0, 57)),
        (":57:12 error: unresolved value 'x'", (0, 57)),
        ("error: include:57:12: unknown type name 'x'", (0, 57)),
        ("<source>:57:12: error: use of undeclared identifier 'x'", (0, 57)),
        ("vair.cl:57:12: warning: unused", (0, 57)),
        ("57 errors", None),
    ],
)
def test_logs_of_many_compilers_are_read(text: str, place: tuple[int, int] | None) -> None:
    (found,) = messages(text)
    assert (None if isinstance(found, str) else (found.file, found.line)) == place


def test_where_answers(tmp_path: Path, capsys: Capture) -> None:
    path, log = tmp_path / "map.json", tmp_path / "log.txt"
    emit = [
        "emit",
        "--target",
        "wgsl",
        "--function",
        FUNCTION,
        "--map",
        str(path),
        "-o",
        str(tmp_path / "a.wgsl"),
    ]
    assert run(emit) == 0
    lines = (tmp_path / "a.wgsl").read_text(encoding="utf-8").splitlines()
    number = next(k for k, line in enumerate(lines, 1) if BROKEN[0] in line)
    assert run(["where", str(path), str(number)]) == 0
    assert capsys.readouterr().out == f"{broken_line()}\n"
    assert run(["where", str(path), str(number + 9), "--first", "10"]) == 0
    assert capsys.readouterr().out == f"{broken_line()}\n"
    assert run(["where", str(path), "1"]) == 0
    assert "line 1 defines nothing" in capsys.readouterr().out
    log.write_text(f"error: no definition\n   ┌─ wgsl:{number}:3\n", encoding="utf-8")
    assert run(["where", str(path), "--log", str(log)]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == f"    from {broken_line()}"


def test_places_outside_of_the_file_have_no_origin() -> None:
    _, found = emitted(ONE_PER_TARGET[0], [FUNCTION], directives=True)
    assert origin_of(found, Message("", 9, 1)) is None
    assert origin_of(found, Message("", 0, 10**6)) is None


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (
            ["emit", "--target", "wgsl", "--line-directives"],
            "WGSL has no line directives; --map FILE.json says",
        ),
        (["where", "none.json", "3"], "none.json: there is no such file"),
        (["where", "other.json", "3"], "other.json: is no line map; --map of vair emit"),
        (["where", "map.json"], "needs a line of the emitted file, or a compiler's messages by --log"),
        (["where", "map.json", "999"], "line 999 is not in the emitted file, which takes lines 1 to 9"),
        (["where", "new.json", "3"], "new.json: has format 2"),
        (["where", "bad.json", "3"], "bad.json: is damaged: a row is line, function, file, source_line"),
    ],
)
def test_refusals(
    arguments: list[str], told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Capture
) -> None:
    monkeypatch.chdir(tmp_path)
    good = as_json(LineMap("glsl", "430", 9, {2: Origin("f", "a.py", 1)}, {}))
    Path("map.json").write_text(good, encoding="utf-8")
    Path("new.json").write_text(good.replace('"format": 1', '"format": 2'), encoding="utf-8")
    Path("bad.json").write_text(good.replace('[2, "f"', '[0, "f"'), encoding="utf-8")
    Path("other.json").write_text("[]", encoding="utf-8")
    assert run(arguments) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert told in err
