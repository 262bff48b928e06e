"""Vendored folders to test with: two sets of files, and what a folder holds."""

import os
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from codegen.cli import run
from codegen.library import load_library
from codegen.vendor.lock import NAME
from codegen.vendor.options import Options
from codegen.vendor.plan import Plan, plan_functions

SMALL = Options(("glsl/430", "wgsl/wgsl", "opencl/1.2"), functions=("sin_angle",))
OTHER = replace(SMALL, functions=("strand_specular",), per_function=True)


@cache
def small_plan() -> Plan:
    """One file per target."""
    return plan_functions(load_library(), SMALL)


@cache
def other_plan() -> Plan:
    """Another set: other files under other names, in folders."""
    return plan_functions(load_library(), OTHER)


def content(folder: Path) -> dict[str, str]:
    """Every file below a folder by name, links by where they lead."""
    return {
        path.relative_to(folder).as_posix(): f"-> {os.readlink(path)}"
        if path.is_symlink()
        else path.read_text()
        for path in sorted(folder.rglob("*"))
        if path.is_symlink() or not path.is_dir()
    }


def expected(plan: Plan) -> dict[str, str]:
    """What a folder holds once the plan is in it."""
    return {**plan.files, NAME: plan.lock_text}


def vair(capsys: pytest.CaptureFixture[str], *arguments: object) -> tuple[int, str, str]:
    """Run the command line: status, output, errors."""
    status = run([str(a) for a in arguments])
    told = capsys.readouterr()
    return status, told.out, told.err
