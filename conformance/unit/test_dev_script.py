"""The script ./dev: what it says when something is not there.

Plan. The script runs in a copy of its own folder (with a space in its name) and with a PATH that holds
only the programs named, so nothing is installed and nothing outside the copy is touched:
  syntax            bash accepts it
  usage             ./dev alone names every command; an unknown command is refused
  generated         ./dev check-generated looks at every file that the generator writes
  no apt            the missing drivers are listed by what they are for
  no Python         says which version is needed
  a foreign .venv   is never removed
  no package index  is told apart from a broken pin, and leaves an unfinished .venv that is rebuilt
  interrupted       gives the .venv that worked before back
  report            takes the example scenes that are specialised; a quick one takes none
  three.js          is fetched once for the tests (a stub of npm); without npm or network they run without
"""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from codegen.generate import generated_files

ROOT = Path(__file__).parents[2]
# What the script calls besides Python; all of it is on every system with bash.
BASICS = ["bash", "cat", "dirname", "env", "flock", "grep", "id", "mkdir", "mktemp", "mv", "rm", "tail"]
COMMANDS = ["setup", "demo", "test", "report", "lint", "gen", "check-generated", "lock"]


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A folder that holds what ./dev reads, and a bin/ with the basic programs."""
    folder = tmp_path / "a check out"
    (folder / ".ci").mkdir(parents=True)
    (folder / "bin").mkdir()
    for name in ["dev", "pyproject.toml", ".ci/requirements.txt"]:
        shutil.copy(ROOT / name, folder / name)
    for name in BASICS:
        program = shutil.which(name)
        if program is not None:
            (folder / "bin" / name).symlink_to(program)
    return folder


def dev(folder: Path, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Runs the copy of ./dev from another folder, seeing only the programs in bin/."""
    clean = {"PATH": str(folder / "bin"), "TMPDIR": str(folder.parent), "HOME": str(folder.parent)}
    return subprocess.run(
        ["bash", str(folder / "dev"), *arguments],
        cwd=folder.parent,
        env=clean | environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )


def provide_python(folder: Path) -> None:
    """The interpreter behind the running .venv, so that the script can make a .venv from it."""
    real = Path(sys.base_prefix) / "bin" / f"python{sys.version_info.major}.{sys.version_info.minor}"
    (folder / "bin" / "python3").symlink_to(real)


@pytest.mark.parametrize("name", ["dev", ".ci/run"])
def test_bash_accepts_the_script(name: str) -> None:
    done = subprocess.run(["bash", "-n", str(ROOT / name)], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_every_generated_file_is_checked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("codegen.generate.emit", lambda *_: "")  # only the names are needed, not the texts
    monkeypatch.setattr("codegen.generate.page", lambda *_: "")
    monkeypatch.setattr("codegen.generate.with_generated_parts", lambda *_: "")
    script = (ROOT / "dev").read_text(encoding="utf-8")
    checked = [ROOT / name for name in script.partition("\ngenerated=(")[2].partition(")")[0].split()]
    assert len(checked) > 5
    missed = [path for path, _ in generated_files() if not any(path.is_relative_to(c) for c in checked)]
    assert missed == []


def test_alone_it_says_what_it_can_do(checkout: Path) -> None:
    done = dev(checkout)
    assert (done.returncode, done.stderr) == (0, "")
    for command in COMMANDS:
        assert f"\n  {command} " in done.stdout


def test_an_unknown_command_is_refused(checkout: Path) -> None:
    done = dev(checkout, "tset")
    assert done.returncode == 2
    assert done.stderr == "dev: there is no command 'tset'; ./dev alone says what it can do.\n"


def test_without_python_it_names_the_version(checkout: Path) -> None:
    done = dev(checkout, "setup")
    assert done.returncode == 2
    assert "Python 3.11 or newer is needed and none was found" in done.stderr


def test_without_apt_it_names_the_missing_drivers(checkout: Path) -> None:
    provide_python(checkout)
    done = dev(checkout, "setup")
    assert done.returncode == 2
    assert "this system has no apt" in done.stderr
    assert "glslangValidator, which checks every GLSL dialect" in done.stderr
    assert "VAIR_SYSTEM=skip" in done.stderr
    assert not (checkout / ".venv").exists()


def test_a_foreign_venv_is_left_alone(checkout: Path) -> None:
    provide_python(checkout)
    (checkout / ".venv").mkdir()
    (checkout / ".venv" / "mine").touch()
    done = dev(checkout, "setup", VAIR_SYSTEM="skip")
    assert done.returncode == 2
    assert "a .venv here that ./dev did not make" in done.stderr
    assert (checkout / ".venv" / "mine").exists()


@pytest.mark.nightly  # makes a real .venv, which takes many seconds
def test_an_unreachable_index_is_said_and_an_unfinished_venv_rebuilt(checkout: Path) -> None:
    provide_python(checkout)
    (checkout / ".venv").mkdir()
    (checkout / ".venv" / "vair.setup").write_text("unfinished\n")
    (checkout / ".venv" / "half").touch()
    # Port 1 of this machine refuses every connection, as a cut network would.
    dead = {
        "PIP_PROXY": "http://127.0.0.1:1",
        "PIP_RETRIES": "0",
        "PIP_NO_CACHE_DIR": "1",
        "PIP_NO_INDEX": "0",
    }
    done = dev(checkout, "setup", VAIR_SYSTEM="skip", **dead)
    assert done.returncode == 2, done.stdout + done.stderr
    assert "pip got no answer from its package index" in done.stderr
    assert not (checkout / ".venv" / "half").exists()
    assert (checkout / ".venv" / "vair.setup").read_text() == "unfinished\n"


def test_an_interrupted_set_up_gives_the_old_venv_back(checkout: Path) -> None:
    provide_python(checkout)
    real = (checkout / "bin" / "python3").readlink()
    (checkout / "bin" / "python3").unlink()
    # An interpreter that stops, as a slow disk would, while it makes the .venv.
    stub = f"""#!/bin/sh
case "$*" in "-m venv .venv") touch started; exec sleep 60;; esac
exec {real} "$@"
"""
    (checkout / "bin" / "python3").write_text(stub)
    (checkout / "bin" / "python3").chmod(0o755)
    for name in ["sh", "sleep", "touch"]:
        (checkout / "bin" / name).symlink_to(str(shutil.which(name)))
    (checkout / ".venv").mkdir()
    (checkout / ".venv" / "vair.setup").write_text("a key of other pins\n")
    run = subprocess.Popen(
        ["bash", str(checkout / "dev"), "setup"],
        env={"PATH": str(checkout / "bin"), "TMPDIR": str(checkout.parent), "VAIR_SYSTEM": "skip"},
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
        start_new_session=True,
    )
    deadline = time.monotonic() + 30
    while not (checkout / "started").exists() and time.monotonic() < deadline:
        time.sleep(0.05)
    # Not SIGINT, which a background job would have been started to ignore; the script treats both alike.
    os.killpg(run.pid, signal.SIGTERM)
    _, said = run.communicate(timeout=30)
    assert run.returncode == 130
    assert said.endswith("\ndev: interrupted; the next run carries on cleanly.\n")
    assert (checkout / ".venv" / "vair.setup").read_text() == "a key of other pins\n"
    assert not (checkout / ".venv.old").exists()


@pytest.fixture
def set_up(checkout: Path) -> Path:
    """A copy whose .venv counts as current, with a Python that passes every check at once."""
    host = checkout / "examples" / "hosts" / "three"
    host.mkdir(parents=True)
    (host / "package-lock.json").write_text("{}")
    provide(checkout / ".venv" / "bin" / "python", 'case "$1" in -ISc) echo key ;; esac')
    (checkout / ".venv" / "vair.setup").write_text("key\n")
    (checkout / "bin" / "sh").symlink_to(str(shutil.which("sh")))
    return checkout


def provide(path: Path, body: str) -> None:
    """A program that runs this."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{body}\n")
    path.chmod(0o755)


def test_three_js_is_fetched_once(set_up: Path) -> None:
    calls, fetched = set_up / "calls", "examples/hosts/three/node_modules/.package-lock.json"
    provide(
        set_up / "bin" / "npm", f'echo "$@" >> "{calls}"\nmkdir -p "${{3}}/node_modules"; : > "{fetched}"'
    )
    first, second = (dev(set_up, "test", VAIR_SYSTEM="skip") for _ in range(2))
    assert (first.returncode, second.returncode) == (0, 0), first.stderr + second.stderr
    assert "three.js, into examples/hosts/three/node_modules:\n  npm ci" in first.stdout
    assert "three.js" not in second.stdout
    (call,) = calls.read_text().splitlines()
    assert call.startswith("ci --prefix examples/hosts/three ")


def test_tests_run_without_npm(set_up: Path) -> None:
    done = dev(set_up, "test", VAIR_SYSTEM="skip")
    assert (done.returncode, done.stderr) == (0, "")
    assert "three.js" not in done.stdout and "Tests:" in done.stdout


def test_tests_run_where_npm_cannot_fetch(set_up: Path) -> None:
    provide(set_up / "bin" / "npm", "echo npm error code ECONNREFUSED\nexit 1")
    done = dev(set_up, "test", VAIR_SYSTEM="skip")
    assert (done.returncode, done.stderr) == (0, "")
    assert "npm error code ECONNREFUSED\n  Its test is skipped; the next run tries again.\n" in done.stdout
    assert "Tests:" in done.stdout


@pytest.mark.parametrize(
    ("codes", "failed"),
    [
        ((0, 0, 0), ""),
        ((1, 0, 0), "tests (not nightly)"),
        ((0, 1, 0), "tests (nightly and not spreads)"),
        ((0, 0, 1), "tests (nightly and spreads)"),
        ((5, 0, 5), ""),
        ((0, 5, 5), ""),
        ((5, 5, 5), "tests (none was selected)"),
    ],
)
def test_the_night_has_three_parts(set_up: Path, codes: tuple[int, int, int], failed: str) -> None:
    """Some may hold none of the tests that were selected, not all; 5 is pytest's status for none."""
    calls = set_up / "calls"
    parts = ("not nightly", "nightly and not spreads", "nightly and spreads")
    ends = " ".join(f'*"-m {part} "*) exit {code} ;;' for part, code in zip(parts, codes, strict=True))
    provide(
        set_up / ".venv/bin/python",
        f'case "$1" in -ISc) echo key ;; esac\necho "$*" >> "{calls}"\ncase "$*" in {ends} esac',
    )
    done = dev(set_up, "test", "--nightly", "-k", "some", VAIR_SYSTEM="skip")
    assert done.returncode == (1 if failed else 0), done.stdout + done.stderr
    assert f"Failed: {failed}" in done.stdout + done.stderr if failed else "Failed" not in done.stdout
    asked = [line for line in calls.read_text().splitlines() if "worksteal" in line]
    assert asked == [
        f"-m pytest -n {count} --dist worksteal -m {part} -k some"
        for count, part in zip((2, 2, 0), parts, strict=True)
    ]


def test_report_shows_the_scenes_that_are_specialised(set_up: Path) -> None:
    """Those of the folder that examples/scenes/README.md names, and no scenes that are pictures."""
    scenes = "examples/scenes/specialised"
    shutil.copytree(ROOT / scenes, set_up / scenes)
    (set_up / "examples/scenes/a-picture.toml").touch()
    calls = set_up / "calls"
    provide(set_up / ".venv/bin/python", f'case "$1" in -ISc) echo key ;; *) echo "$@" >> "{calls}" ;; esac')
    for options in ([], ["--quick"]):
        assert dev(set_up, "report", *options, VAIR_SYSTEM="skip").returncode == 0
    whole, quick = calls.read_text().splitlines()
    names = sorted(path.name for path in (ROOT / scenes).glob("*.toml"))
    assert len(names) == 4
    assert re.findall(r"--scene (\S+)", whole) == [f"{scenes}/{name}" for name in names]
    assert quick == "-m codegen.cli report -o build/report --quick"


def test_it_is_quick_and_offline_once_set_up() -> None:
    """The key of the running .venv is current, so nothing is installed again."""
    if not os.access(ROOT / ".venv" / "vair.setup", os.R_OK):
        pytest.skip("the tests do not run from a .venv that ./dev made")
    done = subprocess.run(
        ["bash", str(ROOT / "dev"), "setup"],
        env=os.environ | {"VAIR_SYSTEM": "skip", "PIP_PROXY": "http://127.0.0.1:1"},
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "Ready: .venv/bin/vair\n", "")
