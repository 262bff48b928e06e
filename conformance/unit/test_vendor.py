"""Vendored folders: what is written, what is refused, what is found, and what survives an interruption.

Plan.
  options     targets and dialects by name, refusals with the nearest name
  lock        read back as written, the same to the byte; one that is damaged or leads elsewhere is refused
  writing     updates, keeps what a person edited or put there, removes what is no more, touches nothing else
  links       no link below the folder is followed, no name leads out of it
What interruptions leave is in test_vendor_interrupted.py, what verify finds in test_vendor_verify.py.
"""

import os
import shutil
from pathlib import Path

import pytest

from codegen.errors import UserError
from codegen.library import default_root
from codegen.lines.linemap import read_map
from codegen.vendor.install import install
from codegen.vendor.lock import NAME, lock_text, read_lock
from codegen.vendor.options import SCENE_ALONE, choose_dialects
from codegen.vendor.plan import Plan
from codegen.vendor.state import states
from conformance.unit.support.vendored import content, expected, other_plan, small_plan, vair


@pytest.fixture(scope="module")
def small() -> Plan:
    return small_plan()


@pytest.fixture(scope="module")
def other() -> Plan:
    return other_plan()


@pytest.mark.parametrize(
    ("targets", "dialects", "chosen"),
    [
        ((), (), ("glsl/430", "wgsl/wgsl", "opencl/1.2")),
        (("opencl",), (), ("opencl/1.2",)),
        ((), ("es300", "wgsl"), ("glsl/es300", "wgsl/wgsl")),
        (("wgsl", "glsl"), ("es300",), ("glsl/es300", "wgsl/wgsl")),
        (("opencl",), ("all",), ("opencl/1.2", "opencl/3.0")),
    ],
)
def test_dialects_follow_targets_and_names(
    targets: tuple[str, ...], dialects: tuple[str, ...], chosen: tuple[str, ...]
) -> None:
    assert choose_dialects(targets, dialects) == chosen


def test_all_dialects_are_all() -> None:
    assert len(choose_dialects((), ("all",))) == 9


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("--target", "glls"), 'unknown target "glls"; did you mean "glsl"?'),
        (("--dialect", "es3000"), 'unknown dialect "es3000"; did you mean "es300"?'),
        (
            ("--target", "wgsl", "--dialect", "es300"),
            'dialect "es300" is one of glsl, which --target leaves out',
        ),
        (("--function", "sin_angl"), 'unknown function "sin_angl"; did you mean "sin_angle"?'),
        (("--prefix", "gl_"), 'prefix "gl_" starts like a name that a target reserves'),
        (("--scene", "none.toml"), "none.toml: there is no such file"),
        (("--scene", "x.toml", "--function", "sin_angle"), SCENE_ALONE),
    ],
)
def test_bad_options_get_one_sentence(
    arguments: tuple[str, ...], sentence: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    status, out, err = vair(capsys, "vendor", tmp_path / "v", *arguments)
    assert (status, out, err) == (2, "", f"vair: {sentence}\n")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("options", [(), ("--per-function",)], ids=["together", "apart"])
def test_maps_lead_from_every_file_to_the_library(
    options: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, maps = tmp_path / "v", tmp_path / "maps"
    chosen = ("--function", "strand_specular", "--dialect", "es300", "--dialect", "wgsl", *options)
    assert vair(capsys, "vendor", folder, *chosen)[0] == 0
    assert vair(capsys, "vendor", folder, "--map", maps)[0] == 0
    files = [name for name in content(folder) if name != NAME]
    assert sorted(content(maps)) == sorted(f"{name}.json" for name in files)
    for name in files:
        found = read_map(maps / f"{name}.json")
        lines = (folder / name).read_text().splitlines()
        assert found.lines == len(lines)
        assert {n for n, line in enumerate(lines, 1) if line and line[0] not in "/#"} == set(found.origins)
        for number, origin in found.origins.items():
            if lines[number - 1].startswith(("float ", "fn ")):
                source = (default_root().parent / origin.file).read_text().splitlines()[origin.line - 1]
                assert f"def {origin.function.removeprefix('vair_')}(" in source
    assert vair(capsys, "verify", folder, "--no-drivers")[0] == 0


def test_maps_among_the_files_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "v"
    for maps in (folder, folder / "maps"):
        status, _, err = vair(capsys, "vendor", folder, "--function", "sin_angle", "--map", maps)
        assert (status, err.count("\n")) == (2, 1)
        assert "would be files that vair verify does not expect" in err
    assert not folder.exists()


def test_lock_is_read_as_it_was_written(small: Plan, other: Plan, tmp_path: Path) -> None:
    for plan in (small, other):
        (tmp_path / NAME).write_text(plan.lock_text)
        assert read_lock(tmp_path / NAME) == plan.lock
        assert lock_text(plan.lock) == plan.lock_text
    assert small.lock_text.isascii()


DAMAGE = {
    "no TOML": ("format = 1", "format 1", "is not valid TOML"),
    "another format": ("format = 1", "format = 2", "format 2 is not known here"),
    "a truth value": ("format = 1", "format = true", '"format" must be a whole number'),
    "nothing": ('version = "', 'versoin = "', '"version" is missing'),
    "number": ('prefix = "vair_"', "prefix = 3", '"prefix" must be a text'),
    "prefix": ('prefix = "vair_"', 'prefix = "gl_"', 'prefix "gl_" starts like a name'),
    "dialect": ('"glsl/430"', '"glsl/43"', 'unknown glsl dialect "43"; did you mean "430"?'),
    "target": ('"glsl/430"', '"hlsl/430"', 'unknown target "hlsl"; did you mean "glsl"?'),
    "above": ('"vair-430.glsl"', '"../vair-430.glsl"', "'../vair-430.glsl' is no file of this folder"),
    "absolute": ('"vair-430.glsl"', '"/vair-430.glsl"', "is no file of this folder"),
    "itself": ('"vair-430.glsl"', '"vair.lock"', "is no file of this folder"),
    "hidden": ('"vair-430.glsl"', '".git/config"', "is no file of this folder"),
    "deep": ('"vair-430.glsl"', '"a/b/c.glsl"', "is no file of this folder"),
    "backslash": ('"vair-430.glsl"', '"a\\\\b.glsl"', "is no file of this folder"),
    "hash": ('= "sha256:', '= "sha256;', "has no hash"),
    "of no dialect": ('"vair-430.glsl"', '"vair-450.glsl"', "is of no dialect that is listed"),
    "nested": ("format = 1", f"format = {'[' * 5000}", "is nested too deeply"),
    "long number": ("format = 1", f"format = {'9' * 5000}", "is not valid TOML"),
}


@pytest.mark.parametrize("name", DAMAGE)
def test_damaged_lock_gets_one_sentence(
    name: str, small: Plan, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    old, new, sentence = DAMAGE[name]
    install(tmp_path / "v", small)
    text = small.lock_text.replace(old, new, 1)
    assert text != small.lock_text
    (tmp_path / "v" / NAME).write_text(text)
    before = content(tmp_path)
    for command in ("verify", "vendor"):
        if (name, command) == ("of no dialect", "vendor"):  # a file like any other there
            continue
        status, out, err = vair(capsys, command, tmp_path / "v")
        assert (status, out) == (2, "")
        assert sentence in err and NAME in err and err.count("\n") == 1
    assert content(tmp_path) == before


def test_files_are_those_of_the_plan_and_nothing_is_left_beside(
    small: Plan, other: Plan, tmp_path: Path
) -> None:
    folder = tmp_path / "v"
    assert install(folder, small) == list(small.files)
    assert content(tmp_path) == {f"v/{n}": t for n, t in expected(small).items()}
    assert install(folder, small) == []
    assert install(folder, other) == list(other.files)
    assert content(tmp_path) == {f"v/{n}": t for n, t in expected(other).items()}


def test_what_else_lies_in_the_folder_stays(small: Plan, other: Plan, tmp_path: Path) -> None:
    folder = tmp_path / "v"
    install(folder, small)
    (folder / "README").write_text("mine")
    (folder / "own").mkdir()
    (folder / "own" / "x.glsl").write_text("mine too")
    kept = {"README": "mine", "own/x.glsl": "mine too"}
    install(folder, other)
    assert content(folder) == {**expected(other), **kept}
    install(folder, small)
    assert content(folder) == {**expected(small), **kept}
    assert not (folder / "wgsl").exists()


def test_the_working_directory_stays_the_same_folder(
    small: Plan, other: Plan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    install(tmp_path / "v", small)
    monkeypatch.chdir(tmp_path / "v")
    install(Path("."), other)
    assert content(Path(os.getcwd())) == expected(other)


def test_edited_and_foreign_files_are_kept_unless_forced(
    small: Plan, other: Plan, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "v"
    install(folder, small)
    with (folder / "vair-430.glsl").open("a") as file:
        file.write("// mine\n")
    before = content(folder)
    for options in ((), ("--function", "strand_specular", "--per-function")):
        status, out, err = vair(capsys, "vendor", folder, *options)
        assert (status, out) == (2, "")
        assert err == f'vair: "{folder}": vair-430.glsl: edited since Vair wrote it; --force replaces it\n'
    assert content(folder) == before
    assert vair(capsys, "vendor", folder, "--force")[0] == 0
    assert content(folder) == expected(small)
    shutil.rmtree(folder)
    folder.mkdir()
    (folder / "vair.wgsl").write_text("mine")
    with pytest.raises(UserError, match=r"vair\.wgsl: there, and Vair did not write it; --force replaces it"):
        install(folder, small)
    assert content(folder) == {"vair.wgsl": "mine"}
    install(folder, small, force=True)
    assert content(folder) == expected(small)


def test_missing_files_come_back_and_line_ends_are_no_edit(small: Plan, tmp_path: Path) -> None:
    folder = tmp_path / "v"
    install(folder, small)
    (folder / "vair.wgsl").unlink()
    glsl = folder / "vair-430.glsl"
    glsl.write_bytes(glsl.read_bytes().replace(b"\n", b"\r\n"))
    assert [(s.file, s.state) for s in states(folder, small.lock, small.files)] == [("vair.wgsl", "missing")]
    install(folder, small)
    assert content(folder) == expected(small)


def test_no_link_is_followed(small: Plan, other: Plan, tmp_path: Path) -> None:
    outside = tmp_path / "outside"
    outside.mkdir()
    (outside / "precious").write_text("keep")
    folder = tmp_path / "v"
    install(folder, small)
    (folder / "vair.wgsl").unlink()
    (folder / "vair.wgsl").symlink_to(outside / "precious")
    (folder / "glsl-430").symlink_to(outside)
    assert ("vair.wgsl", "edited") in [(s.file, s.state) for s in states(folder, small.lock, small.files)]
    for plan in (small, other):
        with pytest.raises(UserError, match="--force replaces it"):
            install(folder, plan)
    install(folder, small, force=True)
    assert not (folder / "vair.wgsl").is_symlink()
    with pytest.raises(UserError, match="glsl-430 is a link that leads elsewhere"):
        install(folder, other, force=True)
    assert content(outside) == {"precious": "keep"}


def test_a_folder_that_is_a_link_is_written_where_it_leads(small: Plan, other: Plan, tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "v").symlink_to(tmp_path / "real")
    for plan in (small, other):
        install(tmp_path / "v", plan)
        assert (tmp_path / "v").is_symlink()
        assert content(tmp_path / "real") == expected(plan)


def test_a_folder_that_cannot_be_written_gets_one_sentence(
    small: Plan, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(UserError, match="it is a file"):
        install(tmp_path / "file", small)
    with pytest.raises(UserError, match="cannot make"):
        install(tmp_path / "no" / "v", small)
    status, _, err = vair(capsys, "verify", tmp_path / "no")
    assert (status, err) == (2, f'vair: "{tmp_path / "no"}": there is no such folder\n')
    status, _, err = vair(capsys, "verify", tmp_path)
    assert (status, err) == (2, f"vair: {tmp_path / NAME}: there is no such file\n")
