"""Emitted files are sound, complete, documented and the same everywhere.

Plan.
  determinism  the same bytes again, in a process with another hash seed, and in the committed includes
  form         guards where the dialect has them, no other directive, header lines, ASCII, 100 columns
  names        every global name carries the prefix, none is reserved anywhere (by an independent parser)
  comments     every function documents each parameter, its result and its source
  compilers    the whole library, which the committed includes equal, in every dialect; each public function
               alone in WGSL
  bounds       bounds.toml of a wrong shape gets one sentence
"""

import hashlib
import os
import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

from codegen.backends import TARGETS, dialect
from codegen.emit.definition import read_definitions
from codegen.emit.dialect import Dialect
from codegen.emit.module import DEFAULT_PREFIX, emit
from codegen.emit.parameter import described
from codegen.errors import UserError
from codegen.generate import include_name
from codegen.ir.domains import Domain, Finite, Interval, Length, Unit
from codegen.library import Library, load_library
from codegen.names import where_reserved
from codegen.version import VERSION
from conformance.unit.support.dialects import DIALECTS, ONE_PER_TARGET, dialect_id, validate
from conformance.unit.support.neutral import find, parse, text_of
from conformance.unit.support.sources import library_of, write_library

ROOT = Path(__file__).parents[2]
WIDTH = 100
GUARD = {"glsl": True, "opencl": True, "wgsl": False}
all_dialects = pytest.mark.parametrize("dialect", DIALECTS, ids=dialect_id)
one_per_target = pytest.mark.parametrize("dialect", ONE_PER_TARGET, ids=dialect_id)


@cache
def whole(dialect_index: int) -> str:
    """The emitted library in one dialect."""
    return emit(load_library(), DIALECTS[dialect_index])


def text_in(dialect: Dialect) -> str:
    return whole(DIALECTS.index(dialect))


@one_per_target
def test_emission_repeats_itself(dialect: Dialect) -> None:
    assert emit(Library(load_library().root), dialect) == text_in(dialect)


def test_another_process_emits_the_same_bytes() -> None:
    """Text is hashed differently there, so that sets have another order."""
    program = (
        "import hashlib; from codegen.backends import TARGETS, dialect; from codegen.emit.module import emit;"
        "from codegen.library import load_library; library = load_library();"
        "print([hashlib.sha256(emit(library, dialect(t)).encode()).hexdigest() for t in TARGETS])"
    )
    here = [hashlib.sha256(text_in(dialect(target)).encode()).hexdigest() for target in TARGETS]
    seed = "1" if os.environ.get("PYTHONHASHSEED") == "0" else "0"
    environment = {**os.environ, "PYTHONHASHSEED": seed}
    run = [sys.executable, "-c", program]
    done = subprocess.run(run, cwd=ROOT, env=environment, capture_output=True, text=True, check=True)
    assert done.stdout == f"{here}\n"


@all_dialects
def test_header_names_the_product_its_options_and_its_licence(dialect: Dialect) -> None:
    head = text_in(dialect).split("\n", 8)[:8]
    joined = "\n".join(head)
    assert head[0] == f"// Vair {VERSION}: hair, fur and strand shading functions, {dialect.title}"
    assert f"vair emit --target {dialect.target} --dialect {dialect.name}" in joined
    assert re.search(r"^// Source hash [0-9a-f]{16}$", joined, re.MULTILINE)
    assert "// SPDX-License-Identifier: MIT" in head


@all_dialects
def test_only_directives_are_one_guard_per_definition(dialect: Dialect) -> None:
    """Each names what it guards; no two are equal."""
    text = text_in(dialect)
    directives = [line for line in text.splitlines() if line.lstrip().startswith("#")]
    if not GUARD[dialect.target]:
        assert directives == []
        return
    guards = [line.split()[1] for line in directives[::3]]
    expected = [word for g in guards for word in (f"#ifndef {g}", f"#define {g}", "#endif")]
    assert directives == expected
    assert len(set(guards)) == len(guards)
    names = [d.name for d in read_definitions(text)]
    assert [g.rpartition("_")[0] for g in guards if "LOOKUP" not in g] == [
        n.upper() for n in names if "lookup" not in n
    ]


@all_dialects
def test_text_is_plain_and_narrow(dialect: Dialect) -> None:
    text = text_in(dialect)
    wide = [line for line in text.splitlines() if len(line) > WIDTH]
    ragged = [line for line in text.splitlines() if line != line.rstrip()]
    assert text.isascii()
    assert text.endswith("\n") and not text.endswith("\n\n")
    assert not wide
    assert not ragged
    assert not [line for line in text.splitlines() if line.endswith("\\")]


GLOBALS = {"glsl": "glsl", "wgsl": "wgsl", "opencl": "c"}


def global_names(target: str, text: str) -> list[str]:
    """Names that a text defines at its top level, by the language's own grammar."""
    code = "\n".join(line for line in text.splitlines() if not line.startswith("#"))
    code = code.replace("static inline ", "").replace("highp ", "")
    names = []
    for node in parse(target, code).children:
        if node.type in ("comment", ";"):
            continue
        kinds = {"identifier", "type_identifier", "function_declarator"}
        declared = [child for child in node.children if child.type in kinds]
        for child in declared:
            inner = find(child, "identifier")[:1] if child.type == "function_declarator" else [child]
            names += [text_of(n) for n in inner]
        for spec in node.children:
            if spec.type == "struct_specifier":
                names += [text_of(n) for n in find(spec, "type_identifier")[:1]]
    return names


@one_per_target
def test_every_global_name_carries_the_prefix(dialect: Dialect) -> None:
    library = load_library()
    selection = library.select()
    expected = {f.name for f in selection.functions} | {s.name for s in selection.structs}
    for prefix in (DEFAULT_PREFIX, "my_fur_"):
        found = global_names(dialect.target, emit(library, dialect, prefix=prefix))
        assert expected <= {name.removeprefix(prefix) for name in found}
        # OpenCL's vector types stand as type names in front of functions; they are not defined here.
        own = [name for name in found if name not in dialect.types.values()]
        structs = {prefix + s.name for s in selection.structs}
        assert [name for name in own if not name.startswith(prefix) and name not in structs] == []
        assert not [name for name in own if where_reserved(name)]


def comments(text: str, prefix: str) -> dict[str, str]:
    """Function name -> the comment lines right above its definition."""
    found: dict[str, str] = {}
    block: list[str] = []
    for line in text.splitlines():
        if line.startswith("//"):
            block.append(line)
            continue
        name = re.match(rf"[\w ]*?\b({prefix}\w+)\(", line)
        if name and not line.startswith(" "):
            found[name.group(1)] = "\n".join(block)
        block = []
    return found


@one_per_target
def test_every_function_documents_its_parameters_result_and_source(dialect: Dialect) -> None:
    library = load_library()
    above = comments(text_in(dialect), DEFAULT_PREFIX)
    missing = []
    for f in library.select().functions:
        comment = above.get(DEFAULT_PREFIX + f.name, "")
        wanted = [p.name for p in f.parameters] + ["returns"] + (["source"] if f.public else [])
        missing += [f"{f.name}: {entry}" for entry in wanted if not re.search(rf"//   {entry}\s+\S", comment)]
    assert not missing


ROUNDED = 0.10000000149011612
"""0.1 in single precision."""
WHOLE = Interval(-3.4028234663852886e38, 3.4028234663852886e38)


@pytest.mark.parametrize(
    ("text", "domain", "shown"),
    [
        (
            "sharpness, in [0, 1e5]; best from 16 on",
            Interval(0.0, 1e5),
            "sharpness, in [0, 1e5]; best from 16 on",
        ),
        ("sharpness, in [0, 1e5]", Interval(8.0, 1e5), "sharpness, in [0, 1e5]; in [8, 100000]"),
        ("numbers in [0, 1)", Interval(0.0, 1.0 - 2.0**-24), "numbers in [0, 1)"),
        ("numbers in [0, 1)", Interval(0.0, 1.0), "numbers in [0, 1); in [0, 1]"),
        ("vector, of length 1e-6 to 1e6", Length(1e-6, 1e6), "vector, of length 1e-6 to 1e6"),
        ("share, 0 to 100", Interval(0.0, 10.0), "share, 0 to 100; in [0, 10]"),
        ("beyond [-1e39, 0)", Interval(0.0, 1.0), "beyond [-1e39, 0); in [0, 1]"),
        ("below, in [-1e39, 1]", Interval(-1.0, 1.0), "below, in [-1e39, 1]; in [-1, 1]"),
        ("all, in [-3.4028235e38, 3.4028235e38]", WHOLE, "all, in [-3.4028235e38, 3.4028235e38]"),
        ("share, in [0.1, 0.7]", Interval(ROUNDED, 0.7), "share, in [0.1, 0.7]"),
        ("share, 0.2 to 0.5, or 0.1 to 0.7", Interval(0.1, 0.7), "share, 0.2 to 0.5, or 0.1 to 0.7"),
        ("a share, 0, 1]", Interval(0.0, 1.0), "a share, 0, 1]; in [0, 1]"),
        ("0 to 1e5x", Interval(0.0, 1e5), "0 to 1e5x; in [0, 100000]"),
        ("a unit vector", Unit(), "a unit vector"),
        ("direction", Unit(), "direction; unit vector"),
        ("", Finite(), "finite"),
        ("anything", None, "anything"),
    ],
)
def test_domains_are_not_said_twice(text: str, domain: Domain | None, shown: str) -> None:
    assert described(text, domain) == shown


def test_a_bound_of_another_section_is_refused(tmp_path: Path) -> None:
    """Of one function only the file of its section is read."""
    for section, name in (("one", "f"), ("two", "g")):
        (tmp_path / section).mkdir()
        (tmp_path / section / f"{name}.py").write_text(f"def {name}(x: X) -> f32:\n    return x\n")
    bound = '[[f]]\nmeasure = "exact"\ndomain = "all"\norigin = "here"\n'
    (tmp_path / "one" / "bounds.toml").write_text(bound)
    assert [b.measure for b in Library(tmp_path).bounds_of("f")] == ["exact"]
    assert not Library(tmp_path).bounds_of("g")
    (tmp_path / "two" / "bounds.toml").write_text(bound)
    with pytest.raises(UserError, match=r'two/bounds\.toml: "f" is a function of another section'):
        Library(tmp_path).bounds  # noqa: B018  what reads every file


@one_per_target
def test_declared_errors_stand_in_the_comment(dialect: Dialect) -> None:
    library = load_library()
    above = comments(text_in(dialect), DEFAULT_PREFIX)
    for name, bounds in library.bounds.items():
        here = [b for b in bounds if not b.targets or dialect.target in b.targets]
        if name in library.public and here:
            assert re.search(r"//   error\s+\S", above[DEFAULT_PREFIX + name]), name


@all_dialects
def test_whole_library_compiles(dialect: Dialect) -> None:
    validate(text_in(dialect), dialect)


@all_dialects
def test_committed_include_is_up_to_date(dialect: Dialect) -> None:
    path = ROOT / "targets" / dialect.target / "include" / include_name(dialect)
    committed = path.read_text(encoding="utf-8")
    assert committed == text_in(dialect), "run ./dev gen"


def public_names() -> list[str]:
    return list(load_library().public)


def test_each_function_compiles_alone_in_wgsl() -> None:
    """WGSL is the strictest: a missing callee or struct, or a second definition, is an error."""
    library, wgsl = load_library(), dialect("wgsl")
    for name in public_names():
        validate(emit(library, wgsl, [name]), wgsl)


def test_each_function_brings_what_it_needs_and_nothing_else() -> None:
    """The selection is the same for every target; GLSL's grammar is quick to read."""
    library, glsl = load_library(), dialect("glsl")
    for name in public_names():
        text = emit(library, glsl, [name])
        selection = library.select([name])
        defined = {n for n in global_names("glsl", text) if n.startswith(DEFAULT_PREFIX)}
        needed = {DEFAULT_PREFIX + f.name for f in selection.functions}
        needed |= {DEFAULT_PREFIX + s.name for s in selection.structs}
        assert defined == needed


@pytest.mark.parametrize(
    "prefix", ["", "1st_", "two__", "_own", "gl_", "GL_", "cl_", "Cl_", "webgl_", "a-b", "fär_", "a b"]
)
def test_prefix_that_cannot_start_a_name_is_refused(prefix: str) -> None:
    with pytest.raises(UserError, match="prefix"):
        emit(load_library(), dialect("glsl"), ["sin_angle"], prefix)


def test_prefix_that_makes_a_reserved_name_is_refused(tmp_path: Path) -> None:
    library = library_of(
        tmp_path, "def flection(x: X) -> f32:\n    return x\ndef flect(x: X) -> f32:\n    return x\n"
    )
    with pytest.raises(UserError, match='prefix "re" makes "reflect", which is a'):
        emit(library, dialect("glsl"), prefix="re")


def test_prefix_that_makes_a_keyword_of_hlsl_in_any_case_is_refused(tmp_path: Path) -> None:
    library = library_of(tmp_path, "def nique(x: X) -> f32:\n    return x\n")
    with pytest.raises(UserError, match='makes "TECHnique", which is a keyword of HLSL in any case'):
        emit(library, dialect("glsl"), prefix="TECH")


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("def b(x: X, ab: X) -> f32:\n    return x + ab\n", "a parameter of b"),
        ("def b(x: X) -> f32:\n    ab = x * x\n    return ab\n", "a local of b"),
        ("@struct\nclass S:\n    ab: X\ndef b(s: S) -> f32:\n    return s.ab\n", "a field of S"),
        ("def b(b_sampler: X, ab: X) -> f32:\n    return b_sampler * ab\n", "a parameter of b"),
    ],
)
@one_per_target
def test_prefix_that_makes_the_name_of_a_variable_is_refused(
    text: str, what: str, dialect: Dialect, tmp_path: Path
) -> None:
    """A function that a local hides cannot be called."""
    with pytest.raises(UserError, match=f'prefix "a" makes "ab", which is {what}'):
        emit(library_of(tmp_path, text), dialect, prefix="a")


SAMPLER = """def {}(map: {}, x: X) -> f32:
    return {}
"""
MAP, LOOKED_UP = 'Annotated[Texture, Edges("clamp", "clamp")]', "lookup_level(map, vec2(x), 0.0).x"


def test_prefix_that_makes_the_name_of_a_sampler_is_refused(tmp_path: Path) -> None:
    """WGSL hands over a map as two parameters; a number is one."""
    looked_up = library_of(tmp_path / "map", SAMPLER.format("ap_sampler", MAP, LOOKED_UP))
    with pytest.raises(UserError, match='prefix "m" makes "map_sampler", which is a parameter of ap_sampler'):
        emit(looked_up, dialect("wgsl"), prefix="m")
    assert "map_sampler(" in emit(
        library_of(tmp_path / "number", SAMPLER.format("ap_sampler", "X", "map * x")),
        dialect("wgsl"),
        prefix="m",
    )


def test_prefix_that_makes_two_names_of_variables_tells_that_of_a_function(tmp_path: Path) -> None:
    text = "@struct\nclass S:\n    ab: X\n    aS: X\ndef b(s: S) -> f32:\n    return s.ab + s.aS\n"
    with pytest.raises(UserError, match='prefix "a" makes "ab", which is a field of S'):
        emit(library_of(tmp_path, text), dialect("glsl"), prefix="a")


def hash_of(folder: Path, dialect: Dialect) -> str:
    found = re.search(r"Source hash (\w+)", emit(Library(folder), dialect, ["probe"]))
    assert found
    return found.group(1)


USER = "from shaderlib.constants import SCALE\ndef probe(x: X) -> f32:\n    return SCALE * x\n"
BOUND = '[[probe]]\nmeasure = "absolute"\nbound = {}\ndomain = "everywhere"\norigin = "this test"\n'


def test_hash_follows_everything_that_the_text_depends_on(tmp_path: Path) -> None:
    glsl = dialect("glsl")
    write_library(
        tmp_path, {"numeric/probe.py": USER, "constants.py": "SCALE = 2.0\n", "numeric/other.py": ""}
    )
    hashes = [hash_of(tmp_path, glsl)]
    write_library(tmp_path, {"constants.py": "SCALE = 3.0\n"})
    hashes.append(hash_of(tmp_path, glsl))
    for number in ("1e-6", "2e-6"):
        (tmp_path / "numeric/bounds.toml").write_text(BOUND.format(number), encoding="utf-8")
        hashes.append(hash_of(tmp_path, glsl))
    assert len(set(hashes)) == len(hashes)
    write_library(tmp_path, {"numeric/other.py": "UNRELATED = 1.0\n"})
    assert hash_of(tmp_path, glsl) == hashes[-1]


BAD_BOUNDS = {
    "not toml": ("[[probe]", "not valid TOML"),
    "no list": ("[probe]\nbound = 1.0\n", "bounds are tables, written [[probe]]"),
    "number": ("probe = 1.0\n", "bounds are tables, written [[probe]]"),
    "unknown function": (BOUND.format("1e-6").replace("[[probe]]", "[[prode]]"), 'did you mean "probe"?'),
    "unknown key": (BOUND.format("1e-6") + "fllor = 0.0\n", 'unknown key "fllor"; did you mean "floor"?'),
    "unknown measure": (BOUND.format("1e-6").replace("absolute", "absolut"), 'unknown measure "absolut"'),
    "no number": (BOUND.format("1e-6").replace("bound = 1e-6\n", ""), "a bound needs its number"),
    "no origin": (BOUND.format("1e-6").replace('origin = "this test"\n', ""), "a bound needs origin"),
    "text for a number": (BOUND.format('"small"'), "a value has the wrong type"),
    "one end": (BOUND.format("1e-6") + "where = { x = 1.0 }\n", "a value has the wrong type"),
    "foreign letters": (BOUND.format("1e-6").replace("everywhere", "überall"), "domain is ASCII"),
}


@pytest.mark.parametrize("name", BAD_BOUNDS)
def test_bad_bounds_get_one_sentence(name: str, tmp_path: Path) -> None:
    text, sentence = BAD_BOUNDS[name]
    library = library_of(tmp_path, "def probe(x: X) -> f32:\n    return x\n")
    (tmp_path / "numeric/bounds.toml").write_text(text, encoding="utf-8")
    with pytest.raises(UserError) as caught:
        emit(library, dialect("glsl"))
    assert str(caught.value).count("\n") == 0
    assert "shaderlib/numeric/bounds.toml" in str(caught.value)
    assert sentence in str(caught.value)
