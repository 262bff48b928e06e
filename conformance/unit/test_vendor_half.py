"""Vendored half forms: chosen as `vair emit --precision half` chooses, kept by the lock, compared in value.

Plan.
  lock      the precision is kept and read back; another word for it is refused
  choice    the forms of `vair emit`; all that are of use if none is named; refusals with what to use instead
  text      whole files and any of one function each compile in every dialect, with what enables halves
  beside    half and single precision of the same functions stand in one shader
  verify    clean, an edit executed on halves inside the stated range, a form that is no more, a driver
            without halves
"""

import random
from dataclasses import replace
from pathlib import Path

import pytest

from codegen.backends import open_runtime
from codegen.emit.dialect import Dialect, with_half
from codegen.emit.module import HALF_PREFIX, emit
from codegen.errors import UserError
from codegen.half import half_forms
from codegen.library import load_library
from codegen.vendor.install import install
from codegen.vendor.lock import NAME, read_lock
from codegen.vendor.options import Options, key
from codegen.vendor.plan import folder_name, plan_functions
from conformance.unit.support.dialects import DIALECTS, dialect_id, validate
from conformance.unit.support.vendored import content, vair

FUNCTIONS = ("strand_specular", "fur_hair_area", "octahedral_encode")
HALF = Options(("glsl/430",), FUNCTIONS, prefix=HALF_PREFIX, precision="half")
all_dialects = pytest.mark.parametrize("d", DIALECTS, ids=dialect_id)
SEED = 7


def test_the_lock_keeps_the_precision(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "v"
    chosen = ("--function", FUNCTIONS[0], "--target", "glsl", "--precision", "half")
    assert vair(capsys, "vendor", folder, *chosen)[0] == 0
    lock = read_lock(folder / NAME)
    assert lock.options == Options(("glsl/430",), FUNCTIONS[:1], prefix=HALF_PREFIX, precision="half")
    assert "f16" in lock.functions[FUNCTIONS[0]].signature
    assert "exponent in [1, 32]" in lock.functions[FUNCTIONS[0]].errors[0]
    assert "none of them changed" in vair(capsys, "vendor", folder)[1]
    assert vair(capsys, "verify", folder)[:2] == (0, f"{folder}: as Vair {lock.version} writes it\n")
    text = (folder / NAME).read_text()
    (folder / NAME).write_text(text.replace('precision = "half"', 'precision = "double"'))
    status, _, err = vair(capsys, "verify", folder)
    assert status == 2 and 'unknown precision "double"; valid names: half, single' in err


def test_a_lock_of_single_precision_says_nothing_of_it() -> None:
    plan = plan_functions(load_library(), Options(("glsl/430",), FUNCTIONS[:1]))
    assert "precision" not in plan.lock_text.partition("[functions")[0]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("--function", "sin_angle_cosine"), "is of no use in half precision"),
        (("--scene", "x.toml"), "a scene is proven in single precision; leave out --precision half"),
    ],
)
def test_what_has_no_half_form_is_refused(
    arguments: tuple[str, ...], sentence: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    status, _, err = vair(capsys, "vendor", tmp_path / "v", "--precision", "half", *arguments)
    assert (status, err.count("\n")) == (2, 1) and sentence in err
    assert not (tmp_path / "v").exists()


def test_without_names_all_forms_of_use_are_taken() -> None:
    plan = plan_functions(load_library(), replace(HALF, functions=()))
    usable = {name for name, form in half_forms(load_library()).items() if not form.refused}
    assert set(plan.lock.functions) == usable


@all_dialects
def test_files_are_those_of_emit_and_compile(d: Dialect) -> None:
    plan = plan_functions(load_library(), replace(HALF, dialects=(key(d),)))
    ((name, text),) = plan.files.items()
    assert name.startswith("vair-half")
    assert text == emit(load_library(), with_half(d), FUNCTIONS)
    validate(text, d)


@pytest.mark.nightly
@all_dialects
def test_files_of_one_function_each_compile_in_any_order(d: Dialect) -> None:
    options = replace(HALF, dialects=(key(d),), per_function=True)
    plan = plan_functions(load_library(), options)
    files = [text for name, text in plan.files.items() if name.startswith(f"{folder_name(d)}/")]
    assert len(files) >= len(FUNCTIONS)
    random.Random(SEED).shuffle(files)
    enable = f"{d.half_enable}\n" if not d.guard else ""
    assert all((d.half_enable in text) for text in files)
    validate(enable + "\n".join(files), d)


@all_dialects
def test_both_precisions_stand_in_one_shader(d: Dialect) -> None:
    library = load_library()
    options = replace(HALF, dialects=(key(d),))
    (half,) = plan_functions(library, options).files.values()
    (single,) = plan_functions(library, Options((key(d),), FUNCTIONS)).files.values()
    validate(f"{half}\n{single}", d)


def test_an_edit_is_executed_on_halves(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    try:
        open_runtime("glsl")
    except UserError as reason:
        pytest.skip(str(reason))
    folder = tmp_path / "v"
    install(folder, plan_functions(load_library(), HALF))
    file = folder / "vair-half-430.glsl"
    text = file.read_text()
    changed = text.replace("exponent);\n}", "exponent) + 0.25;\n}")
    assert changed != text
    file.write_text(changed)
    status, out, _ = vair(capsys, "verify", folder)
    assert status == 1
    assert "strand_specular [glsl/430]: values differ by up to 0.25" in out
    assert sorted(content(folder)) == [file.name, NAME]


def test_a_driver_without_halves_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    try:
        runtime = open_runtime("wgsl")
    except UserError as reason:
        pytest.skip(str(reason))
    folder = tmp_path / "v"
    install(folder, plan_functions(load_library(), replace(HALF, dialects=("wgsl/wgsl",))))
    file = folder / "vair-half.wgsl"
    file.write_text(file.read_text().replace("exponent);\n}", "exponent) + 0.25;\n}"))
    status, out, _ = vair(capsys, "verify", folder)
    executed = getattr(runtime, "half_arithmetic", False)
    assert status == 1
    assert (
        "values differ by up to 0.25" if executed else "no half arithmetic; it refuses enable f16;"
    ) in out


def test_a_form_that_is_no_more_is_reported_as_removed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "v"
    plan = plan_functions(load_library(), HALF)
    gone = {**plan.lock.functions, "sin_angle_cosine": plan.lock.functions[FUNCTIONS[0]]}
    options = replace(HALF, functions=(*FUNCTIONS, "sin_angle_cosine"))
    install(folder, replace(plan, lock=replace(plan.lock, options=options, functions=gone)))
    status, out, _ = vair(capsys, "verify", folder, "--no-drivers")
    assert status == 1 and "sin_angle_cosine: removed" in out
