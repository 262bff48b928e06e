"""What of the drivers, validators and packages that Vair can use is on this machine."""

import importlib.util
from collections.abc import Iterator
from dataclasses import dataclass
from importlib import metadata
from typing import Literal

from targets import TARGETS, Device, probe
from targets.drivers import catalogue, present, strings
from targets.packages import find_tool, run_tool

Kind = Literal["driver", "named driver", "validator", "package"]

DRIVER_HINTS = {
    "glsl": "apt-get install --no-install-recommends libegl1 libgl1",
    "wgsl": "apt-get install --no-install-recommends mesa-vulkan-drivers",
    "opencl": "apt-get install --no-install-recommends pocl-opencl-icd",
}
VALIDATOR_HINTS = {
    "glslangValidator": "apt-get install --no-install-recommends glslang-tools",
    "spirv-val": "apt-get install --no-install-recommends spirv-tools",
    "naga": "cargo install naga-cli --locked",
}
PACKAGES = ("moderngl", "wgpu", "pyopencl", "embreex", "trimesh")


@dataclass(frozen=True)
class Row:
    """One component.

    component  target of a driver, command of a validator, or name of a package
    kind       driver (what a target opens by itself), named driver, validator or package
    found      whether it is here and works
    version    its version, a driver's with its device; empty where it is missing
    hint       what installs it; for a driver that is missing also why it does not run
    """

    component: str
    kind: Kind
    found: bool
    version: str
    hint: str


def report() -> list[Row]:
    """Look at every component: drivers by opening them, validators by asking for their version."""
    return [*_drivers(), *_validators(), *_packages()]


def _drivers() -> Iterator[Row]:
    for target in TARGETS:
        answer = probe(target)
        if isinstance(answer, Device):
            version = f"{answer.api}; {answer.driver}; {answer.device}"
            yield Row(target, "driver", True, version, DRIVER_HINTS[target])
        else:
            yield Row(target, "driver", False, "", str(answer))


def drivers_by_name() -> list[Row]:
    """Every driver of the catalogue, opened in a process of its own; takes seconds."""
    rows = []
    for name, answer in present().items():
        known = catalogue()[name]
        if isinstance(answer, Device):
            version = "; ".join(strings(answer))
            rows.append(Row(name, "named driver", True, version, known.install))
        else:
            rows.append(Row(name, "named driver", False, "", str(answer)))
    return rows


def _validators() -> Iterator[Row]:
    for command, hint in VALIDATOR_HINTS.items():
        path = find_tool(command)
        version = _first_line_of(path) if path else ""
        yield Row(command, "validator", path is not None, version, hint)


def _first_line_of(path: str) -> str:
    _, text = run_tool(path, "--version")
    return text.strip().splitlines()[0] if text.strip() else "unknown version"


def _packages() -> Iterator[Row]:
    for package in PACKAGES:
        found = importlib.util.find_spec(package) is not None
        yield Row(package, "package", found, _package_version(package), f"pip install {package}")


def _package_version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return ""
