"""One browser for all tests of the page, and the page of a furry ball."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from codegen.files import write_folder
from codegen.library import load_library
from conformance.picture.fur.studio import FurStudio, set_up_fur
from conformance.unit.web.furry_ball import write_furry_ball
from conformance.unit.web.opened import Opened
from conformance.web.browser import lacking, missing, open_browser, served, view
from conformance.web.build import page_files
from conformance.web.choices import choices


@pytest.fixture(scope="session")
def ball(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The scene file of a furry ball."""
    return write_furry_ball(tmp_path_factory.mktemp("ball"))


@pytest.fixture(scope="session")
def studio(ball: Path) -> FurStudio:
    """The furry ball, ready to be drawn by Python."""
    return set_up_fur(load_library(), ball)


@pytest.fixture(scope="session")
def files(ball: Path) -> dict[str, bytes]:
    """The files of the page of the furry ball, with two variants."""
    offered = choices().only("fakefur_shade", "fakefur_shade_printed")
    return page_files(load_library(), ball, offered)


@pytest.fixture(scope="session")
def session(files: dict[str, bytes], tmp_path_factory: pytest.TempPathFactory) -> Iterator[Opened]:
    """The browser; skips where there is none."""
    reason = missing()
    if reason:
        pytest.skip(reason)
    folder = tmp_path_factory.mktemp("web") / "page"
    write_folder(folder, files)
    with served(folder, files) as url, open_browser() as driver:
        reason = lacking(driver, f"{url}page.css")
        if reason:
            pytest.skip(reason)
        yield Opened(driver, url, folder)


@pytest.fixture
def loud_page(session: Opened) -> Iterator[Opened]:
    """The page in a view of 1280 by 900, for tests at which the browser itself has something to say."""
    view(session.driver, 1280, 900)
    session.console()
    yield session
    session.forget_scripts()
    session.console()


@pytest.fixture
def page(loud_page: Opened) -> Iterator[Opened]:
    """The page; fails the test if the browser's console says anything."""
    yield loud_page
    assert loud_page.console() == []
