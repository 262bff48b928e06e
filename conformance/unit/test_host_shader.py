"""Emitted text in somebody else's shader: nothing but prefixed definitions, in any company and order.

Plan.
  text        every line of code belongs to a struct or a function; no #version, #extension, pragma, precision
  size        the code of a whole model, with all that it calls, stays within what a person reads at a time
  names       no name that any file holds, whatever kind, is reserved on any target
  subsets     files of one function each, any of them in any order, compile in every dialect; so do files of
              several functions under one prefix where there is a preprocessor
  versions    two versions with two prefixes compile and compute side by side; with one prefix what differs is
              refused by the compiler, what is the same is not
Drawn subsets print their seed; one more number in the id of a test is another draw.
"""

import random
import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from codegen.backends import complete_program, dialect, open_runtime
from codegen.emit.collisions import inner_names
from codegen.emit.definition import read_definitions
from codegen.emit.dialect import Dialect
from codegen.emit.module import DEFAULT_PREFIX, emit
from codegen.errors import UserError
from codegen.execute import on_device, unflatten
from codegen.generate import include_name
from codegen.ir.unit import Unit
from codegen.kernels import kernel_body
from codegen.library import load_library
from codegen.names import where_reserved
from codegen.passes import run_passes
from codegen.vendor.options import Options, key
from codegen.vendor.plan import folder_name, plan_functions
from conformance.unit.support.dialects import DIALECTS, ONE_PER_TARGET, dialect_id, validate
from targets import BuildFailed

ROOT = Path(__file__).parents[2]
all_dialects = pytest.mark.parametrize("d", DIALECTS, ids=dialect_id)
one_per_target = pytest.mark.parametrize("d", ONE_PER_TARGET, ids=dialect_id)
GUARDED = [d for d in ONE_PER_TARGET if d.guard]
MOST_LINES = 150
"""Lines of code of fakefur_shade and all that it calls, without comments and include guards: a limit that the
library sets itself, since hosts take these lines in."""
SUBSET = 5
"""Functions of a drawn subset."""
DRAWS = [
    0,
    *(pytest.param(k, marks=pytest.mark.nightly) for k in range(1, 24)),
]


def text_in(d: Dialect) -> str:
    """The library in one dialect: what is committed, which another test holds to what is emitted."""
    return (ROOT / "targets" / d.target / "include" / include_name(d)).read_text(encoding="utf-8")


def single_files(d: Dialect, names: list[str]) -> Mapping[str, str]:
    """Some functions as files of one function each."""
    options = Options((key(d),), tuple(names), per_function=True)
    return plan_functions(load_library(), options).files


@all_dialects
def test_all_code_belongs_to_definitions(d: Dialect) -> None:
    text = text_in(d)
    lines = [line for line in text.splitlines() if line and not line.startswith("//")]
    code = [line for definition in read_definitions(text) for line in definition.code if line]
    assert [line for line in lines if not line.startswith("#")] == code
    starts = {re.sub(r"\W.*", "", definition.code[0]) for definition in read_definitions(text)}
    types = {t.partition("<")[0] for t in d.types.values()}
    own = {DEFAULT_PREFIX + name for name in load_library().structs}
    assert starts <= {"struct", "typedef", "static", "fn", "highp", *types, *own}
    assert not re.search(r"#\s*(version|extension|pragma|include|undef)|^precision\b", text, re.MULTILINE)


@all_dialects
def test_a_whole_model_is_short(d: Dialect) -> None:
    definitions = read_definitions(emit(load_library(), d, ["fakefur_shade"]))
    assert definitions[-1].name == f"{DEFAULT_PREFIX}fakefur_shade" and len(definitions) > 10
    assert sum(len(definition.code) for definition in definitions) <= MOST_LINES


@all_dialects
def test_no_name_is_reserved_anywhere(d: Dialect) -> None:
    """As they are printed: after the passes, with prefixes, guards included."""
    selection = load_library().select()
    unit = run_passes(Unit(selection.functions, selection.structs), DEFAULT_PREFIX)
    names = {name: what for name, what in inner_names(unit, d)}
    names |= {f.name: "a function" for f in unit.functions} | {s.name: "a struct" for s in unit.structs}
    names |= {definition.guard: "a guard" for definition in read_definitions(text_in(d))}
    assert len(names) > len(unit.functions)
    assert {name: where_reserved(name) for name in names if where_reserved(name)} == {}


def needed(files: Mapping[str, str], d: Dialect, names: list[str]) -> list[str]:
    """The files of some functions; where there is no preprocessor, with those that their headers name."""
    chosen = [f"{folder_name(d)}/{name}.{d.extension}" for name in names]
    for name in list(chosen):
        header = files[name].split("\n\n", 1)[0]
        listed = re.search(r"^// Needs, in any order: (.*)", header, re.MULTILINE | re.DOTALL)
        assert listed is None or not d.guard
        others = re.findall(rf"\w+\.{d.extension}", listed[1]) if listed else []
        chosen += [f"{folder_name(d)}/{other}" for other in others]
    return list(dict.fromkeys(chosen))


@pytest.mark.parametrize("seed", DRAWS)
@all_dialects
def test_any_subset_in_any_order_compiles(d: Dialect, seed: int) -> None:
    drawn = random.Random(f"{seed} {dialect_id(d)}")
    names = drawn.sample(sorted(load_library().documented), SUBSET)
    files = single_files(d, names)
    included = needed(files, d, drawn.sample(names, SUBSET - 1))
    drawn.shuffle(included)
    print(f"seed {seed}: {' '.join(included)}")
    validate("\n".join(files[file] for file in included), d)


@pytest.mark.parametrize("seed", DRAWS)
@pytest.mark.parametrize("d", GUARDED, ids=dialect_id)
def test_files_of_several_functions_share_a_prefix(d: Dialect, seed: int) -> None:
    drawn = random.Random(seed)
    every = sorted(load_library().documented)
    subsets = [drawn.sample(every, SUBSET) for _ in range(2)]
    print(f"seed {seed}: {subsets}")
    validate("\n".join(emit(load_library(), d, subset) for subset in (*subsets, subsets[0])), d)


def test_the_whole_library_and_a_part_share_a_prefix() -> None:
    d = dialect("glsl", "es300")
    validate(emit(load_library(), d, ["fakefur_shade"]) + text_in(d), d)


OLD_LINE = re.compile(r"return 0\.5(f?) \* sqrt\(dot\(doubled, doubled\)\)")


def as_older_version(text: str) -> str:
    """sin_angle as a version might have had it that returned a quarter of the length."""
    changed, count = OLD_LINE.subn(r"return 0.25\1 * sqrt(dot(doubled, doubled))", text)
    assert count == 1
    return changed


@one_per_target
def test_two_versions_with_two_prefixes_stand_side_by_side(d: Dialect) -> None:
    library = load_library()
    try:
        runtime = open_runtime(d.target)
    except UserError as reason:
        pytest.skip(f"{d.target}: {reason}")
    new = emit(library, d, ["sin_angle"], "new_")
    old = as_older_version(emit(library, d, ["sin_angle"], "old_"))
    body = kernel_body(library, "sin_angle", d.target)
    second = body.replace("result", "second").replace("store_f32(0", "store_f32(1")
    both = body.replace(DEFAULT_PREFIX, "new_") + "\n" + second.replace(DEFAULT_PREFIX, "old_")
    function = library.function("sin_angle")
    axes = np.eye(3, dtype=np.float32)
    inputs = {"a": axes[[0, 0, 1]], "b": axes[[1, 0, 2]]}
    words, _ = on_device(function, inputs, 3)
    out = runtime.run(complete_program(d.target, old + new, both), words, 2)
    values = [np.asarray(unflatten(function.returns, out[k : k + 1])) for k in range(2)]
    assert values[0].tolist() == [1.0, 0.0, 1.0]
    assert values[1].tolist() == [0.5, 0.0, 0.5]


@pytest.mark.parametrize("d", GUARDED, ids=dialect_id)
def test_two_versions_with_one_prefix_are_refused(d: Dialect) -> None:
    """What both define alike does not matter; what they define differently is never chosen silently."""
    new = emit(load_library(), d, ["sin_angle"])
    older = as_older_version(new)
    changed = [
        n for n, o in zip(read_definitions(new), read_definitions(older), strict=True) if n.code != o.code
    ]
    assert len(changed) == 1
    # An emitted older text has the guard of its own code.
    guard = next(o.guard for o in read_definitions(older) if o.name == changed[0].name)
    with pytest.raises(BuildFailed, match="sin_angle"):
        validate(new + older.replace(changed[0].guard, guard), d)


def test_no_two_files_are_one_on_any_file_system() -> None:
    """Some tell no capitals from small letters."""
    library = load_library()
    names = [name.lower() for name in (*library.documented, *library.structs)]
    assert len(set(names)) == len(names)
    assert "wgsl/FurCoat.wgsl" in single_files(dialect("wgsl"), ["fakefur_shade"])
