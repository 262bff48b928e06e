"""`vair demo web` without a browser: what it serves, what it writes, what it refuses.

Plan.
  server    the files by name, and nothing else, on 127.0.0.1; a port that is taken is one sentence
  command   -o writes, --no-serve only writes; Ctrl-C ends it and leaves nothing behind; bad use is one
            sentence, and so is a scene that the page would show wrongly
"""

from __future__ import annotations

import http.client
import json
import re
import signal
import subprocess
import sys
import threading
import urllib.request
from collections.abc import Iterator
from dataclasses import replace
from http.server import ThreadingHTTPServer
from pathlib import Path

import numpy as np
import pytest

from codegen.cli import run
from codegen.errors import UserError
from codegen.fur.shading import fur_shading
from conformance.picture.fur.studio import FurStudio
from conformance.web.build import check_scene
from conformance.web.choices import choices
from conformance.web.serve import HOST, POLL, address, open_server

# ---------------------------------------------------------------- server


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[http.client.HTTPConnection]:
    """A connection to a server of index.html and part/a.json, beside which other files lie."""
    top = tmp_path_factory.mktemp("served")
    folder = top / "page"
    (folder / "part").mkdir(parents=True)
    (folder / "index.html").write_text("page", encoding="utf-8")
    (folder / "part" / "a.json").write_text("{}", encoding="utf-8")
    (folder / "other.txt").write_text("other", encoding="utf-8")
    (top / "secret.txt").write_text("secret", encoding="utf-8")
    with open_server(folder, ["index.html", "part/a.json", "gone.js"]) as server:
        thread = threading.Thread(target=server.serve_forever, args=(POLL,), daemon=True)
        thread.start()
        connection = http.client.HTTPConnection(HOST, server.server_port, timeout=10.0)
        yield connection
        connection.close()
        server.shutdown()
        thread.join()


def answer(connection: http.client.HTTPConnection, path: str, method: str = "GET") -> tuple[int, str, bytes]:
    connection.request(method, path)
    response = connection.getresponse()
    return response.status, response.headers["Content-Type"], response.read()


def test_the_server_gives_its_files(served: http.client.HTTPConnection) -> None:
    assert served.host == HOST == "127.0.0.1"
    assert answer(served, "/") == (200, "text/html; charset=utf-8", b"page")
    assert answer(served, "/index.html?x=1")[2] == b"page"
    assert answer(served, "/part/a.json") == (200, "application/json", b"{}")
    assert answer(served, "/part/a.json", "HEAD") == (200, "application/json", b"")


@pytest.mark.parametrize(
    "path",
    [
        "/other.txt",
        "/part",
        "/part/",
        "/../secret.txt",
        "/%2e%2e/secret.txt",
        "//secret.txt",
        "/gone.js",
        "x",
    ],
)
def test_the_server_gives_nothing_else(served: http.client.HTTPConnection, path: str) -> None:
    assert answer(served, path)[0] == 404


def test_a_port_that_is_taken_is_one_sentence(tmp_path: Path) -> None:
    with (
        open_server(tmp_path, []) as server,
        pytest.raises(UserError, match=r"^cannot serve on 127\.0\.0\.1:\d+: "),
    ):
        open_server(tmp_path, [], server.server_port)


# ---------------------------------------------------------------- command


@pytest.fixture
def small_page(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """A page of one file, and a server that is interrupted at once; returns what was opened."""
    opened: list[str] = []

    def interrupted(self: ThreadingHTTPServer) -> None:
        opened.append(address(self))
        raise KeyboardInterrupt

    monkeypatch.setattr("conformance.web.build.page_files", lambda *_: {"part/index.html": b"page"})
    monkeypatch.setattr(ThreadingHTTPServer, "serve_forever", interrupted)
    monkeypatch.setattr("webbrowser.open", lambda url: opened.append(f"browser {url}"))
    return opened


def test_it_serves_until_interrupted(
    small_page: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    assert run(["demo", "web"]) == 0
    url = capsys.readouterr().out.split()[0]
    assert re.fullmatch(r"http://127\.0\.0\.1:\d+/", url)
    assert small_page == [f"browser {url}", url]
    assert list(tmp_path.iterdir()) == []


def test_it_opens_no_browser_and_keeps_the_folder_if_told(small_page: list[str], tmp_path: Path) -> None:
    assert run(["demo", "web", "--no-browser", "-o", str(tmp_path / "kept")]) == 0
    assert len(small_page) == 1
    assert (tmp_path / "kept" / "part" / "index.html").read_bytes() == b"page"
    assert run(["demo", "web", "--no-serve", "-o", str(tmp_path / "written")]) == 0
    assert len(small_page) == 1
    assert (tmp_path / "written" / "part" / "index.html").is_file()


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["web", "--no-serve"], "--no-serve needs -o FOLDER, where the page is to be written"),
        (["web", "--scene", "missing.toml"], "missing.toml"),
        (["web", "--port", "99999"], "99999 is not in the range 0<=x<=65535"),
    ],
    ids=["no-folder", "no-scene", "port"],
)
def test_bad_use_is_one_sentence(
    arguments: list[str], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["demo", *arguments]) == 2
    said = capsys.readouterr().err
    assert sentence in said
    assert said.count("\n") == 1


@pytest.mark.parametrize("what", ["shading", "layers", "exponent", "shadows"])
def test_a_scene_that_the_page_would_show_wrongly_is_refused(studio: FurStudio, what: str) -> None:
    wrong, sentence = {
        "shading": (
            replace(studio, shading=fur_shading(studio.library, "shell_shade")),
            "is shaded by shell_shade",
        ),
        "layers": (
            replace(studio, fur=replace(studio.fur, layers=1)),
            "layers is 1; the page has a control for 2 to 64",
        ),
        "exponent": (
            replace(studio, material={**studio.material, "optics.exponent": np.array([8.0])}),
            r"optics\.exponent is 8; the page has a control for 16 to 100",
        ),
        "shadows": (replace(studio, picture=replace(studio.picture, shadows=True)), "shadows must be false"),
    }[what]
    with pytest.raises(UserError, match=sentence):
        check_scene(wrong, Path("scene.toml"), choices())


@pytest.mark.nightly
def test_a_process_ends_by_ctrl_c(ball: Path) -> None:
    command = [sys.executable, "-m", "codegen.cli", "demo", "web", "--no-browser", "--scene", str(ball)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        url = process.stdout.readline().split()[0]
        with urllib.request.urlopen(f"{url}web.json", timeout=10.0) as found:
            assert json.load(found)["format"] == 1
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=30.0) == 0
