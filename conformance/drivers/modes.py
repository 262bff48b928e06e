"""Modes: in which form, from which source and under which compiler settings a driver sees a function."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

from codegen.backends import dialect
from codegen.errors import UserError, unknown
from codegen.intervals import TABLES
from codegen.ir.nodes import Function
from codegen.kernels import KernelOptions
from conformance.check.draws import Draw, draws
from targets.drivers import Driver

TABLE = Path(__file__).with_name("modes.toml")
DEFAULT = "default"


@dataclass(frozen=True)
class Mode:
    """One entry of modes.toml; see there for the fields."""

    name: str
    summary: str
    uniform: int
    family: int
    targets: tuple[str, ...] = ()
    form: str = "plain"
    source: str = "words"
    precise: bool = False
    prelude: str = ""
    options: tuple[str, ...] = ()
    table: str = ""
    families: tuple[str, ...] | None = None

    def fits(self, driver: Driver) -> bool:
        """Whether a driver has this mode: its target, its harness and its dialect allow it."""
        own_form = driver.kernel.get("form", "plain")
        wrong_target = self.targets and driver.target not in self.targets
        wrong_form = own_form != "plain" and self.form != "plain"
        no_qualifier = self.precise and not dialect(driver.target, driver.kernel.get("dialect")).precise
        return not (wrong_target or wrong_form or no_qualifier)

    def kernel_options(self, driver: Driver) -> KernelOptions:
        """How a kernel is written in this mode for a driver."""
        own = KernelOptions(**driver.kernel)  # type: ignore[arg-type]  # the catalogue's own spelling
        changed: dict[str, Any] = {"source": self.source, "precise": self.precise, "prelude": self.prelude}
        if self.form != "plain":
            changed["form"] = self.form
        return replace(own, **changed)

    def settings(self) -> dict[str, object]:
        """What the target's open_runtime is told beside the driver's own settings."""
        settings: dict[str, object] = {}
        if self.options:
            settings["options"] = self.options
        if self.form == "uniform":
            settings["uniforms"] = True
        return settings

    def draws(self, function: Function, uniform: int | None = None, family: int | None = None) -> list[Draw]:
        """The inputs of a run, as many as the mode asks for unless other numbers are given."""
        wanted: Iterable[Draw] = draws(function, uniform or self.uniform, family or self.family)
        return [d for d in wanted if self.families is None or d.family in ("uniform", *self.families)]


@cache
def modes() -> dict[str, Mode]:
    """Every mode by name."""
    return parse(tomllib.loads(TABLE.read_text(encoding="utf-8")), TABLE.name)


def parse(table: dict[str, Any], shown: str) -> dict[str, Mode]:
    """The modes of a table; raises UserError for an entry with missing or unknown keys."""
    found = {}
    for name, entry in table.items():
        values: dict[str, Any] = {key: tuple(v) if isinstance(v, list) else v for key, v in entry.items()}
        try:
            found[name] = Mode(name=name, **values)
        except TypeError as e:
            raise UserError(f"{shown}: mode {name}: {str(e).partition(' ')[2]}") from None
        if found[name].table not in ("", *TABLES):
            raise unknown(f"accuracy table of mode {name}", found[name].table, TABLES)
    return found


def mode(name: str) -> Mode:
    """A mode by name; raises UserError with the nearest name."""
    if name not in modes():
        raise unknown("mode", name, modes())
    return modes()[name]


def modes_of(driver: Driver, names: Iterable[str]) -> list[Mode]:
    """The modes asked for that the driver has; "all" stands for every one."""
    wanted = list(names) or [DEFAULT]
    chosen = modes().values() if "all" in wanted else [mode(name) for name in wanted]
    return [m for m in chosen if m.fits(driver)]
