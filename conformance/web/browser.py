"""Chromium without a window, through selenium: for tests of the page and pictures of it."""

from __future__ import annotations

import os
import shutil
import tempfile
import threading
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from conformance.web.serve import POLL, address, open_server

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
DRIVER = "chromedriver"
INSTALL = "apt-get install --no-install-recommends chromium chromium-driver"
WEBGPU = ("--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader")
"""WebGPU on SwiftShader, which comes with Chromium: the same device on every machine."""
FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--no-first-run",
    "--disable-extensions",
    "--disable-background-networking",
    "--disable-component-update",
    "--hide-scrollbars",
    "--use-gl=angle",
    "--use-angle=gl-egl",
    "--ignore-gpu-blocklist",
)
"""WebGL2 on Mesa: with it on SwiftShader, Chromium 156 loses its graphics process to WebGPU."""


def missing() -> str:
    """Why no browser can be driven here; empty where one can."""
    if not any(map(shutil.which, BROWSERS)):
        return f"no chromium is here: {INSTALL}"
    if not shutil.which(DRIVER):
        return f"no {DRIVER} is here: {INSTALL}"
    return ""


@contextmanager
def open_browser(flags: tuple[str, ...] = WEBGPU) -> Iterator[Any]:
    """A selenium driver of Chromium with a profile of its own; ask `missing` first whether there is one."""
    # selenium is told where everything is, so that it looks for nothing elsewhere.
    os.environ["SE_OFFLINE"] = "true"
    os.environ["SE_AVOID_STATS"] = "true"
    from selenium import webdriver

    options = webdriver.ChromeOptions()
    options.binary_location = next(filter(None, map(shutil.which, BROWSERS)))
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    for flag in (*FLAGS, *flags):
        options.add_argument(flag)
    with tempfile.TemporaryDirectory(prefix="vair-browser-", ignore_cleanup_errors=True) as profile:
        options.add_argument(f"--user-data-dir={profile}")
        service = webdriver.ChromeService(executable_path=shutil.which(DRIVER))
        driver = webdriver.Chrome(options=options, service=service)
        try:
            yield driver
        finally:
            driver.quit()


@contextmanager
def served(folder: Path, names: Iterable[str]) -> Iterator[str]:
    """The address at which the files of a folder are served."""
    with open_server(folder, names) as server:
        thread = threading.Thread(target=server.serve_forever, args=(POLL,), daemon=True)
        thread.start()
        try:
            yield address(server)
        finally:
            server.shutdown()
            thread.join()


def lacking(driver: Any, url: str) -> str:
    """Why this browser cannot draw with both backends; empty where it can."""
    driver.get(url)
    webgl2, webgpu = driver.execute_async_script(
        "const webgl2 = Boolean(new OffscreenCanvas(1, 1).getContext('webgl2'));"
        "const adapter = navigator.gpu ? navigator.gpu.requestAdapter() : Promise.resolve(null);"
        "adapter.then((found) => arguments[0]([webgl2, Boolean(found)]))"
    )
    if not webgl2:
        return "Chromium has no WebGL2 here: apt-get install --no-install-recommends libegl1 libgl1"
    return "" if webgpu else "Chromium has no WebGPU here"


def view(driver: Any, width: int, height: int, *, dark: bool = False) -> None:
    """Sets the size of the page's view in CSS pixels, however small, and its colours."""
    metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [scheme]})


def drawn(driver: Any, beyond: int = 0, timeout: float = 60.0) -> int:
    """Waits until the page has drawn more than `beyond` frames and rests; returns how many it has drawn."""
    from selenium.webdriver.support.ui import WebDriverWait

    def count(found: Any) -> int:
        script = (
            "const rests = window.page && !page.pacing.busy && page.pacing.wanted === null;"
            "return rests ? page.count : 0"
        )
        number: int = found.execute_script(script)
        return number if number > beyond else 0

    frames: int = WebDriverWait(driver, timeout, poll_frequency=0.05).until(count)
    return frames
