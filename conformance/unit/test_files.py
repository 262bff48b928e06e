"""Several files into a folder: all of them new or none, whoever stops a run or runs beside it.

Plan.
  every step  a fault before and after each step of the file system leaves one whole set
  kills       processes that write two sets in turn are killed at random moments: one whole set is there
  together    several processes write into one folder: one whole set is there whenever nobody writes
  others      files of other names stay, a link stays one, the working directory stays the same folder
  rests       what killed runs left beside the folder goes with the next run
"""

import contextlib
import os
import random
import shutil
import signal
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from codegen import files as writing
from codegen.errors import UserError
from codegen.files import write_folder
from codegen.kit.folder import NewFolder
from codegen.vendor.exclusive import exclusive
from conformance.unit.support.stopped import Stop, forked, stopping
from conformance.unit.support.vendored import content

SETS = [{f"{'part/' * (k % 2)}{k}.txt": f"{which} {k}".encode() for k in range(12)} for which in ("a", "b")]
"""The same names with other content."""
STEPS = ((os, "rename"), (os, "replace"), (shutil, "rmtree"), (writing, "exchange"), (Path, "write_bytes"))
MOST_STEPS = 40
KILLS = [20, pytest.param(200, marks=pytest.mark.nightly)]
LONGEST = 0.02
"""Seconds until a kill, at most: several runs take that long."""


def as_text(files: dict[str, bytes]) -> dict[str, str]:
    return {name: data.decode() for name, data in files.items()}


@pytest.mark.parametrize("after", [False, True])
def test_every_step_leaves_one_set(after: bool, tmp_path: Path) -> None:
    for at in range(1, MOST_STEPS):
        folder = tmp_path / str(at) / "out"
        folder.parent.mkdir()
        write_folder(folder, SETS[0])
        with pytest.MonkeyPatch.context() as patch, contextlib.suppress(Stop):
            steps = stopping(patch, STEPS, at, after=after)
            write_folder(folder, SETS[1])
        assert content(folder) in [as_text(files) for files in SETS]
        if steps() < at:
            break
    else:
        pytest.fail(f"more than {MOST_STEPS} steps")
    assert at > len(SETS[0])


@pytest.mark.parametrize("after", [False, True])
def test_a_folder_that_is_replaced_as_one_is_never_gone(after: bool, tmp_path: Path) -> None:
    def written(folder: Path, files: dict[str, bytes]) -> None:
        with NewFolder(folder) as new:
            new.add(files.items())
            new.place()

    whole = []
    for k, files in enumerate(SETS):
        written(tmp_path / f"whole-{k}", files)
        whole.append(content(tmp_path / f"whole-{k}"))
    for at in range(1, MOST_STEPS):
        folder = tmp_path / str(at) / "out"
        folder.parent.mkdir()
        written(folder, SETS[0])
        with pytest.MonkeyPatch.context() as patch, contextlib.suppress(Stop):
            steps = stopping(patch, STEPS, at, after=after)
            written(folder, SETS[1])
        assert content(folder) in whole
        if steps() < at:
            break
    else:
        pytest.fail(f"more than {MOST_STEPS} steps")
    assert at > len(SETS[0])


@pytest.mark.parametrize("count", KILLS)
def test_killed_processes_leave_one_set(count: int, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    write_folder(folder, SETS[0])

    def work() -> None:
        while True:
            for files in reversed(SETS):
                write_folder(folder, files)

    print(f"seed {count}")
    drawn = random.Random(count)
    for _ in range(count):
        with forked(work) as child:
            time.sleep(drawn.uniform(0.0, LONGEST))
            os.kill(child, signal.SIGKILL)
            status = os.waitpid(child, 0)[1]
        assert os.waitstatus_to_exitcode(status) == -signal.SIGKILL
        assert content(folder) in [as_text(files) for files in SETS]
    write_folder(folder, SETS[0])
    assert content(tmp_path) == {f"out/{name}": text for name, text in as_text(SETS[0]).items()}


def test_runs_at_the_same_time_do_not_mix(tmp_path: Path) -> None:
    """Into a folder with a file of somebody else, where files move in one by one."""
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "notes").write_text("mine")

    def work(first: int) -> Callable[[], None]:
        def runs() -> None:
            for k in range(10):
                write_folder(folder, SETS[(first + k) % 2])

        return runs

    wanted = [{"notes": "mine", **as_text(files)} for files in SETS]
    with contextlib.ExitStack() as stack:
        children = [stack.enter_context(forked(work(k))) for k in range(4)]
        for _ in range(20):
            with exclusive(folder):
                assert content(folder) in [{"notes": "mine"}, *wanted]
        assert [os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) for child in children] == [0] * 4
    assert content(folder) in wanted
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_what_killed_runs_left_goes_with_the_next(tmp_path: Path) -> None:
    (tmp_path / ".vair-out-x" / "new").mkdir(parents=True)
    (tmp_path / ".vair-other-x").mkdir()
    write_folder(tmp_path / "out", SETS[0])
    assert sorted(path.name for path in tmp_path.iterdir()) == [".vair-other-x", "out"]


def test_the_working_directory_stays_the_same_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "out"
    write_folder(folder, SETS[0])
    monkeypatch.chdir(folder)
    write_folder(Path(), SETS[1])
    assert content(Path()) == content(folder) == as_text(SETS[1])


def test_links_are_left_and_folders_are_refused(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    folder.mkdir()
    (tmp_path / "far").write_text("far")
    (folder / "link").symlink_to(tmp_path / "far")
    write_folder(folder, SETS[0])
    assert (folder / "link").is_symlink() and (tmp_path / "far").read_text() == "far"
    with pytest.raises(UserError, match=r'cannot write ".*/out/part": it is a folder'):
        write_folder(folder, {"0.txt": b"new", "part": b"new"})
    assert (folder / "0.txt").read_text() == "a 0"


def test_a_system_without_locks_and_exchange_writes_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(writing, "alone", lambda folder: contextlib.nullcontext())
    monkeypatch.setattr(writing, "swapped", lambda a, b: False)
    for files in SETS:
        write_folder(tmp_path / "out", files)
        assert content(tmp_path) == {f"out/{name}": text for name, text in as_text(files).items()}


def test_a_mode_stays(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    write_folder(folder, SETS[0])
    folder.chmod(0o750)
    write_folder(folder, SETS[1])
    assert folder.stat().st_mode & 0o777 == 0o750
