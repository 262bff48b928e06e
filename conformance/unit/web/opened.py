"""The page in a browser, as the tests use it."""

from __future__ import annotations

import base64
import io
import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

from conformance.web.browser import drawn

Pixels = npt.NDArray[np.int64]

SIZE = 64
PLAIN = {"pixels": str(SIZE), "side": "1"}
"""As many pixels and samples as the scene of the furry ball has."""
PATIENCE = 30.0
"""Seconds after which something that should have happened counts as not happened."""


@dataclass
class Opened:
    """A browser, the folder of a page and the address at which it is served."""

    driver: Any
    url: str
    folder: Path
    scripts: list[str] = field(default_factory=list)

    def load(self, *scripts: str, **choice: str) -> None:
        """Loads the page afresh with choices in its address; scripts run before it."""
        for script in scripts:
            command = "Page.addScriptToEvaluateOnNewDocument"
            self.scripts.append(self.driver.execute_cdp_cmd(command, {"source": script})["identifier"])
        self.driver.get("about:blank")
        address = "&".join(f"{key}={value}" for key, value in (PLAIN | choice).items())
        self.driver.get(f"{self.url}#{address}")

    def steady(self) -> int:
        """The page drawing with WebGL2 as at first, loaded afresh if need be; returns the frames drawn."""
        usual = (
            "return Boolean(window.page?.ready) && page.backend === 'webgl2'"
            " && document.getElementById('message').hidden"
        )
        if not self.run(usual):
            self.load(backend="webgl2")
            return self.settle()
        self.driver.execute_async_script(
            "page.turning.set({ yaw: 0, pitch: 0, distance: 1 }); page.controls.reset();"
            "page.useShading(page.plan.shadings[0]).then(arguments[0])"
        )
        return self.settle()

    def forget_scripts(self) -> None:
        """Scripts that ran before the page run no more."""
        for identifier in self.scripts:
            command = "Page.removeScriptToEvaluateOnNewDocument"
            self.driver.execute_cdp_cmd(command, {"identifier": identifier})
        self.scripts.clear()

    def settle(self, beyond: int = 0) -> int:
        """Waits until the page has drawn more than that many frames and rests; returns their number."""
        return drawn(self.driver, beyond, PATIENCE)

    def run(self, script: str) -> Any:
        return self.driver.execute_script(script)

    def element(self, selector: str) -> Any:
        return self.driver.find_element("css selector", selector)

    def text(self, selector: str) -> str:
        """The text of an element, whether it is to be seen or not."""
        found: str = self.run(f"return document.querySelector({json.dumps(selector)}).textContent")
        return found

    def waited(self, selector: str, part: str = "") -> str:
        """The text of an element, as soon as it has one with that part."""
        from selenium.webdriver.support.ui import WebDriverWait

        def ready(_: Any) -> str:
            text = self.text(selector)
            return text if part in text else ""

        wait = WebDriverWait(self.driver, PATIENCE, poll_frequency=0.05)
        found: str = wait.until(ready)
        return found

    def pixels(self) -> Pixels:
        """The canvas (SIZE, SIZE, 3), drawn anew and read in the same task."""
        data = self.run("page.drawn(page.frame, page.size(1)); return page.renderer.canvas.toDataURL()")
        with Image.open(io.BytesIO(base64.b64decode(data.partition(",")[2]))) as image:
            return np.asarray(image.convert("RGB")).astype(np.int64)

    def console(self) -> list[str]:
        """What the browser's console has said since it was last asked."""
        return [entry["message"] for entry in self.driver.get_log("browser")]
