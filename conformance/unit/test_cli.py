"""The command line does what it says, and says what is wrong in one sentence.

Plan.
  good input   list, list --json, show, emit, --help, --version; a file written by -o equals standard output
  bad input    status 2, nothing on standard output, one line on standard error with the nearest valid name
  output       written to the side and moved into place: an unwritable place leaves nothing behind, a link and
               a device stay what they are, the mode of a file is kept
  process      the same through a real process: no traceback, a reader that leaves early is no error
"""

import json
import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest
from click import Command, Context

from codegen.backends import TARGETS, dialect
from codegen.cli import COMMANDS, documentation, run, vair
from codegen.emit.module import emit
from codegen.library import load_library
from codegen.version import VERSION
from targets import doctor
from targets.drivers import present

ROOT = Path(__file__).parents[2]
Capture = pytest.CaptureFixture[str]


def answer(capsys: Capture, *arguments: str) -> str:
    """Standard output of a command that has to succeed quietly."""
    status = run(list(arguments))
    out, err = capsys.readouterr()
    assert (status, err) == (0, "")
    return out


BAD_USAGE: dict[str, tuple[list[str], str]] = {
    "command": (["emti"], 'unknown command "emti"; did you mean "emit"?'),
    "function of show": (["show", "sin_angel"], 'unknown function "sin_angel"; did you mean "sin_angle"?'),
    "function of emit": (
        ["emit", "--target", "glsl", "--function", "sin_angel"],
        'unknown function "sin_angel"; did you mean "sin_angle"?',
    ),
    "function of check": (["check", "--function", "sin_angel"], 'did you mean "sin_angle"?'),
    "no function": (["show"], "FUNCTION"),
    "no target": (["emit"], "--target"),
    "target of emit": (["emit", "--target", "glls"], 'unknown target "glls"; did you mean "glsl"?'),
    "target of show": (
        ["show", "sin_angle", "--target", "hlsl"],
        'unknown target "hlsl"; did you mean "glsl"?',
    ),
    "target of check": (["check", "--target", "opengl"], 'unknown target "opengl"'),
    "target that is nothing": (["emit", "--target", "cuda"], "valid names: glsl, opencl, wgsl"),
    "dialect": (
        ["emit", "--target", "glsl", "--dialect", "431"],
        'unknown glsl dialect "431"; did you mean "430"?',
    ),
    "dialect of another target": (
        ["emit", "--target", "opencl", "--dialect", "es300"],
        'unknown opencl dialect "es300"; did you mean "3.0"?',
    ),
    "dialect of show": (
        ["show", "sin_angle", "--target", "wgsl", "--dialect", "430"],
        'unknown wgsl dialect "430"',
    ),
    "dialect without target": (["show", "sin_angle", "--dialect", "430"], "--dialect needs --target"),
    "option": (["emit", "--target", "glsl", "--functoin", "sin_angle"], "--function"),
    "option without value": (["emit", "--target"], "--target"),
    "argument too many": (["list", "strand"], "strand"),
    "prefix": (
        ["emit", "--target", "glsl", "--prefix", "1_"],
        'prefix "1_" must be a plain ASCII identifier',
    ),
    "reserved prefix": (["emit", "--target", "glsl", "--prefix", "gl_"], 'prefix "gl_" starts like a name'),
    "empty prefix": (["emit", "--target", "glsl", "--prefix", ""], 'prefix "" must be'),
    "error limit": (
        ["emit", "--target", "glsl", "--function", "sin_angle", "--max-error", "nan"],
        "--max-error nan: the largest error is a number from 0 on",
    ),
    "endless error limit": (
        ["emit", "--target", "glsl", "--function", "sin_angle", "--max-error", "inf"],
        "--max-error inf: the largest error is a number from 0 on",
    ),
    "replay": (["check", "--replay", "nonsense"], "nonsense"),
    "replay of nothing": (["check", "--replay", ""], "replay"),
}


@pytest.mark.parametrize("name", BAD_USAGE)
def test_bad_usage_gets_one_sentence_and_status_2(name: str, capsys: Capture) -> None:
    arguments, sentence = BAD_USAGE[name]
    status = run(arguments)
    out, err = capsys.readouterr()
    assert (status, out) == (2, "")
    assert err.startswith("vair: ")
    assert err.count("\n") == 1
    assert sentence in err


def test_nothing_asked_shows_the_help(capsys: Capture) -> None:
    assert run([]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert all(command in err for command in COMMANDS)


@pytest.mark.parametrize("command", [None, *COMMANDS])
def test_help(command: str | None, capsys: Capture) -> None:
    out = answer(capsys, *filter(None, [command]), "--help")
    assert out.startswith("Usage: vair")
    assert "--help" in out


@pytest.mark.parametrize("name", COMMANDS)
def test_help_reads_what_the_command_says_of_itself(name: str) -> None:
    command = vair.get_command(Context(vair), name)
    assert command is not None
    shown = Command(name, help=documentation(name)).get_short_help_str()
    assert shown == command.get_short_help_str()


def test_help_imports_no_command() -> None:
    """Nor the generator: help is read more often than anything else."""
    code = (
        "import sys; from codegen.cli import run; run(['--help']); "
        "late = 'codegen.commands', 'codegen.ir', 'conformance'; "
        "assert not [m for m in sys.modules if m.startswith(late)]"
    )
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True, capture_output=True)


def test_version(capsys: Capture) -> None:
    assert VERSION in answer(capsys, "--version")


def test_list_names_every_public_function_with_its_signature(capsys: Capture) -> None:
    out = answer(capsys, "list")
    public = load_library().documented
    listed = [line.strip().split("(")[0] for line in out.splitlines() if " -> " in line]
    assert listed == list(public)
    assert "  sin_angle(a: vec3, b: vec3) -> f32" in out.splitlines()


def test_list_as_json_is_complete(capsys: Capture) -> None:
    data = json.loads(answer(capsys, "list", "--json"))
    library = load_library()
    assert data["version"] == VERSION
    assert [f["name"] for f in data["functions"]] == list(library.documented)
    assert [s["name"] for s in data["structs"]] == list(library.structs)
    (entry,) = [f for f in data["functions"] if f["name"] == "sin_angle"]
    assert [p["domain"] for p in entry["parameters"]] == ["unit vector", "unit vector"]
    assert "sin_angle_cosine" in entry["variants"]
    assert entry["error"]


def test_show_gives_documentation_and_every_target(capsys: Capture) -> None:
    out = answer(capsys, "show", "sin_angle")
    assert out.startswith("sin_angle(a: vec3, b: vec3) -> f32\n")
    assert all(emit(load_library(), dialect(target), ["sin_angle"]) in out for target in TARGETS)


def test_show_one_dialect(capsys: Capture) -> None:
    out = answer(capsys, "show", "sin_angle", "--target", "glsl", "--dialect", "es300")
    assert "GLSL ES 3.00" in out
    assert "-- WGSL" not in out


@pytest.mark.parametrize("target", TARGETS)
def test_emitted_file_equals_standard_output(target: str, tmp_path: Path, capsys: Capture) -> None:
    out = answer(capsys, "emit", "--target", target)
    assert out == emit(load_library(), dialect(target))
    file = tmp_path / "library.txt"
    assert answer(capsys, "emit", "--target", target, "-o", str(file)) == ""
    assert file.read_bytes() == out.encode()
    assert os.listdir(tmp_path) == ["library.txt"]


def test_emit_takes_functions_prefix_and_dialect(capsys: Capture) -> None:
    arguments = ["--dialect", "es310", "--prefix", "fur_", "--function", "sin_angle", "--function", "mirror"]
    out = answer(capsys, "emit", "--target", "glsl", *arguments)
    assert out == emit(load_library(), dialect("glsl", "es310"), ["sin_angle", "mirror"], "fur_")


EMIT = ["emit", "--target", "wgsl", "--function", "sin_angle", "-o"]


def refused(capsys: Capture, path: Path) -> str:
    status = run([*EMIT, str(path)])
    out, err = capsys.readouterr()
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert err.startswith(f'vair: cannot write "{path}": ')
    return err


def test_output_that_is_a_folder_is_refused(tmp_path: Path, capsys: Capture) -> None:
    assert "it is a folder" in refused(capsys, tmp_path)
    assert os.listdir(tmp_path) == []


def test_output_in_a_missing_folder_is_refused(tmp_path: Path, capsys: Capture) -> None:
    assert f'the folder "{tmp_path / "none"}" does not exist' in refused(capsys, tmp_path / "none" / "a.wgsl")
    assert os.listdir(tmp_path) == []


def test_output_below_a_file_is_refused(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "file").write_text("kept")
    refused(capsys, tmp_path / "file" / "a.wgsl")
    assert (tmp_path / "file").read_text() == "kept"


def test_output_with_an_impossible_name_is_refused(tmp_path: Path, capsys: Capture) -> None:
    refused(capsys, tmp_path / ("x" * 300))
    assert os.listdir(tmp_path) == []


def test_output_in_a_protected_folder_is_refused(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Root may write anywhere, so the refusal of the system is played."""

    def denied(**arguments: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("tempfile.mkstemp", denied)
    assert "Permission denied" in refused(capsys, tmp_path / "a.wgsl")
    assert os.listdir(tmp_path) == []


def test_failed_move_leaves_the_old_file_and_no_other(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "a.wgsl"
    file.write_text("old")

    def no_space(*arguments: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.replace", no_space)
    assert "No space left on device" in refused(capsys, file)
    assert file.read_text() == "old"
    assert os.listdir(tmp_path) == ["a.wgsl"]


def test_bad_input_leaves_the_old_file(tmp_path: Path, capsys: Capture) -> None:
    file = tmp_path / "a.wgsl"
    file.write_text("old")
    assert run(["emit", "--target", "wgsl", "--function", "sin_angel", "-o", str(file)]) == 2
    capsys.readouterr()
    assert file.read_text() == "old"
    assert os.listdir(tmp_path) == ["a.wgsl"]


def test_output_keeps_the_mode_and_follows_a_link(tmp_path: Path, capsys: Capture) -> None:
    file, link = tmp_path / "a.wgsl", tmp_path / "link.wgsl"
    file.write_text("old")
    file.chmod(0o640)
    link.symlink_to(file)
    answer(capsys, *EMIT, str(link))
    assert link.is_symlink()
    assert "fn vair_sin_angle" in file.read_text()
    assert stat.S_IMODE(file.stat().st_mode) == 0o640


def test_output_to_a_device_leaves_the_device(capsys: Capture) -> None:
    """Writing to the side and moving into place would replace it."""
    answer(capsys, *EMIT, os.devnull)
    assert stat.S_ISCHR(os.stat(os.devnull).st_mode)


def test_broken_source_is_one_sentence_with_its_place(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "shaderlib"
    folder.mkdir()
    (folder / "probe.py").write_text("import numpy\n")
    monkeypatch.setattr("codegen.library.default_root", lambda: folder)
    load_library.cache_clear()
    try:
        assert run(["list"]) == 2
    finally:
        load_library.cache_clear()
    out, err = capsys.readouterr()
    assert out == ""
    assert err.splitlines()[0].startswith("vair: shaderlib/probe.py:1:1: a shader source holds")
    assert err.splitlines()[1:] == ["    import numpy", "    ^"]


def process(*arguments: str, **options: object) -> subprocess.CompletedProcess[str]:
    """The command in a process of its own."""
    return subprocess.run(  # type: ignore[call-overload,no-any-return]  # options are passed through
        [sys.executable, "-m", "codegen.cli", *arguments],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
        **options,
    )


def test_process_emits_what_the_library_emits() -> None:
    done = process("emit", "--target", "opencl", "--function", "sin_angle")
    expected = emit(load_library(), dialect("opencl"), ["sin_angle"])
    assert (done.returncode, done.stdout, done.stderr) == (0, expected, "")


@pytest.mark.parametrize("name", ["command", "function of emit", "option", "dialect"])
def test_process_refuses_without_a_traceback(name: str) -> None:
    arguments, sentence = BAD_USAGE[name]
    done = process(*arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("vair: ") and done.stderr.count("\n") == 1
    assert sentence in done.stderr


@pytest.mark.parametrize(
    "arguments", [["emit", "--target", "glsl"], ["list", "--json"], ["show", "sin_angle"]]
)
def test_reader_that_leaves_early_is_no_error(arguments: list[str]) -> None:
    read, write = os.pipe()
    os.close(read)
    command = [sys.executable, "-m", "codegen.cli", *arguments]
    done = subprocess.run(command, cwd=ROOT, stdout=write, stderr=subprocess.PIPE, text=True, check=False)
    os.close(write)
    assert (done.returncode, done.stderr) == (0, "")


def test_full_disk_is_one_sentence() -> None:
    """Standard output may fail like any file."""
    with open("/dev/full", "w") as full:
        command = [sys.executable, "-m", "codegen.cli", "emit", "--target", "glsl"]
        done = subprocess.run(command, cwd=ROOT, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("vair: ") and done.stderr.count("\n") == 1
    assert "No space left on device" in done.stderr


def test_doctor_lists_drivers_validators_and_packages(
    capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two named drivers stand for the others, each of which takes a process and a second."""
    monkeypatch.setattr(doctor, "present", lambda: present(["softpipe-fragment", "rusticl"]))
    out = answer(capsys, "doctor")
    assert "softpipe-fragment" in out and "rusticl" in out
    assert all(heading in out.splitlines() for heading in ("drivers", "validators", "packages"))
    assert "drivers are ready" in out.splitlines()[-1]
