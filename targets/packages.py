"""Python packages and command line tools that a target may need and a machine may lack."""

import importlib
import re
import shutil
import subprocess
from typing import Any

from targets.protocol import TargetUnavailable

TOOL_SECONDS = 60.0
"""A validator that takes longer than this hangs."""


def require_package(name: str) -> Any:
    """Import a Python package; raises TargetUnavailable with the command that installs it."""
    try:
        return importlib.import_module(name)
    except (ImportError, OSError) as error:
        raise TargetUnavailable(
            f"the Python package {name} cannot be imported ({first_line(error)}): pip install {name}"
        ) from error


def first_line(error: BaseException) -> str:
    """The first line of an error's message, or the error's type where there is none."""
    lines = str(error).strip().splitlines()
    return lines[0].rstrip(".") if lines else type(error).__name__


def fits(wanted: str, name: str) -> bool:
    """Whether a device's name contains the wanted words; * and ? stand for anything in between."""
    words = map(re.escape, re.split(r"([*?])", wanted))
    pattern = "".join({r"\*": ".*", r"\?": "."}.get(word, word) for word in words)
    return re.search(pattern, name, re.IGNORECASE) is not None


def find_tool(*names: str) -> str | None:
    """Path of the first of these commands that is installed."""
    return next((path for path in map(shutil.which, names) if path), None)


def run_tool(*command: str, text: str = "", environment: dict[str, str] | None = None) -> tuple[int, str]:
    """Run a command line tool.

    text         what the tool reads from standard input
    environment  all variables of the tool; None: those of this process
    returns      exit status and everything printed
    """
    done = subprocess.run(
        command,
        input=text,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        timeout=TOOL_SECONDS,
        check=False,
    )
    return done.returncode, done.stdout
