"""Names across files: what a resolver finds, in which order, once, and what it says of what is not there.

Plan. Small folders of sources against what they define: sections and extra folders, files that are none,
families, needed files through diamonds and circles of imports, constants and their types, what is kept, names
that nobody defines, circles of calls entered from outside, errors that repeat themselves.
"""

from pathlib import Path

import pytest

from codegen.errors import SourceError, UserError
from codegen.frontend.resolve import Resolver
from codegen.ir.types import F32, U32
from conformance.unit.support.sources import write_library

FUNCTION = "def {}(x: X) -> f32:\n    return x\n"
PAIR = "@struct\nclass Pair:\n    first: X\n"


def resolver_of(folder: Path, files: dict[str, str], *extra: Path) -> Resolver:
    """A resolver of sources that define a function each, unless their text is given."""
    stated = {name: text or FUNCTION.format(Path(name).stem) for name, text in files.items()}
    return Resolver(write_library(folder, stated), extra)


def test_files_are_taken_in_order_of_their_names(tmp_path: Path) -> None:
    names = [f"probe_{k:02}" for k in range(24)]
    resolver = resolver_of(tmp_path, {f"numeric/{name}.py": "" for name in [*names[1::2], *names[::2]]})
    assert resolver.function_names() == resolver.names == names
    assert [resolver.module_of(name) for name in names[:2]] == [
        "shaderlib.numeric.probe_00",
        "shaderlib.numeric.probe_01",
    ]


def test_files_of_the_language_and_of_packages_are_no_sources(tmp_path: Path) -> None:
    none = "import os\ndef stray(x):\n    return os.name\n"
    resolver = resolver_of(
        tmp_path, {"lang.py": none, "__init__.py": none, "numeric/__init__.py": none, "a/b.py": ""}
    )
    resolver.parse_all()
    assert resolver.names == ["b"]


def test_an_extra_folder_is_one_more_section(tmp_path: Path) -> None:
    text = "from shaderlib.numeric.twice import twice\ndef inner(x: X) -> f32:\n    return twice(x)\n"
    extra = write_library(tmp_path / "forms", {"inner.py": text})
    resolver = resolver_of(tmp_path / "root", {"numeric/twice.py": ""}, extra)
    assert resolver.module_of("inner") == "shaderlib.forms.inner"
    assert resolver.path_of("inner") == extra / "inner.py"
    function = resolver.function("inner")
    assert (function.module, function.place.path) == ("forms", "forms/inner.py")
    assert resolver.function("twice").place.path == "shaderlib/numeric/twice.py"


def test_a_second_definition_is_refused_at_its_line(tmp_path: Path) -> None:
    write_library(tmp_path, {"b/second.py": f"\n\n{FUNCTION.format('probe')}"}, header=False)
    with pytest.raises(SourceError) as caught:
        resolver_of(tmp_path, {"a/first.py": FUNCTION.format("probe")})
    place = caught.value.place
    assert (place.path, place.line, place.text) == ("shaderlib/b/second.py", 3, "def probe(x: X) -> f32:")


def test_what_was_read_is_kept(tmp_path: Path) -> None:
    resolver = resolver_of(tmp_path, {"numeric/probe.py": PAIR + FUNCTION.format("probe")})
    file = resolver.where("probe")
    assert file is not None
    assert resolver.file("shaderlib.numeric.probe") is file
    assert resolver.where("Pair") is file
    assert resolver.function("probe") is resolver.function("probe")
    assert resolver.struct(file, "Pair") is resolver.struct(file, "Pair")
    assert resolver.family("probe") is resolver.family("probe")


def test_a_family_is_a_file_and_those_named_after_it(tmp_path: Path) -> None:
    resolver = resolver_of(
        tmp_path,
        {
            "numeric/probe.py": FUNCTION.format("probe") + FUNCTION.format("beside"),
            "numeric/probe_quick.py": FUNCTION.format("other_name"),
            "numeric/probes.py": "",
            "numeric/another.py": "",
            "direction/probe_far.py": "",
        },
    )
    assert resolver.family("probe") == resolver.family("beside") == ["probe", "beside", "other_name"]
    assert resolver.family("other_name") == ["other_name"]
    assert resolver.family("another") == ["another"]


def test_needed_files_are_all_that_imports_lead_to_once(tmp_path: Path) -> None:
    resolver = resolver_of(
        tmp_path,
        {
            "numeric/top.py": "from shaderlib.numeric.left import left\n"
            "from shaderlib.numeric.right import right\n" + FUNCTION.format("top"),
            "numeric/left.py": "from shaderlib.numeric.base import base\n" + FUNCTION.format("left"),
            "numeric/right.py": "from shaderlib.numeric.base import base\n" + FUNCTION.format("right"),
            "numeric/base.py": "from shaderlib.numeric.right import right\n" + FUNCTION.format("base"),
            "numeric/alone.py": "",
        },
    )
    needed = resolver.needed_files(["shaderlib.numeric.top"])
    assert set(needed) == {f"shaderlib.numeric.{name}" for name in ("top", "left", "right", "base")}
    assert all(resolver.file(module) is file for module, file in needed.items())
    assert set(resolver.needed_files(["shaderlib.numeric.alone"])) == {"shaderlib.numeric.alone"}
    assert not resolver.needed_files([])


def test_constants_have_values_and_the_types_that_are_stated(tmp_path: Path) -> None:
    text = "TURN = 6.25\nSTEPS: u32 = 8\nHALF_TURN = TURN / 2\n" + FUNCTION.format("probe")
    resolver = resolver_of(tmp_path, {"numeric/probe.py": text})
    file = resolver.file("shaderlib.numeric.probe")
    assert resolver.constant(file, "TURN") == 6.25
    assert resolver.constant(file, "HALF_TURN") == 3.125
    assert resolver.constant(file, "STEPS") == 8
    assert resolver.constant_type(file, "STEPS") == U32
    assert resolver.constant_type(file, "TURN") is None
    for name in ("sqrt", "probe", "nobody"):
        assert resolver.constant(file, name) is None
        assert resolver.constant_type(file, name) is None
    parameters, returns = resolver.signature(file, file.functions["probe"])
    assert ([p.name for p in parameters], returns) == (["x"], F32)


@pytest.mark.parametrize("name", ["nobody", "Pair"])
def test_a_name_of_no_function_is_told(name: str, tmp_path: Path) -> None:
    resolver = resolver_of(tmp_path, {"numeric/probe.py": PAIR + FUNCTION.format("probe")})
    with pytest.raises(UserError, match=f'unknown function "{name}"'):
        resolver.function(name)
    assert not resolver.defines(name)


def test_a_name_of_nobody_has_no_place(tmp_path: Path) -> None:
    resolver = resolver_of(tmp_path, {"numeric/probe.py": ""})
    assert resolver.where("nobody") is None
    assert resolver.path_of("nobody") is None
    assert resolver.module_of("nobody") == ""
    assert resolver.path_of("probe") == tmp_path / "numeric/probe.py"


def test_a_circle_of_calls_is_told_without_the_way_to_it_and_again(tmp_path: Path) -> None:
    body = "def {}(x: X) -> f32:\n    return {}(x)\n"
    text = body.format("outer", "first") + body.format("first", "second") + body.format("second", "first")
    resolver = resolver_of(tmp_path, {"numeric/probe.py": text})
    for _ in range(2):
        with pytest.raises(SourceError) as caught:
            resolver.function("outer")
        assert caught.value.sentence == "recursion is not possible in shaders: first -> second -> first"


def test_an_alias_that_leads_back_to_itself_is_told_again(tmp_path: Path) -> None:
    text = "A = B\nB = A\ndef probe(x: A) -> f32:\n    return x\n"
    resolver = resolver_of(tmp_path, {"numeric/probe.py": text})
    for _ in range(2):
        with pytest.raises(SourceError, match='"A" is defined by itself'):
            resolver.function("probe")
