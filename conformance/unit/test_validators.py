"""Validators accept a sound library in every dialect and report the line of an unsound one."""

from importlib import import_module

import pytest

from targets import BuildFailed, TargetUnavailable

DIALECTS = [
    *(("glsl", dialect) for dialect in ("330", "430", "450", "es300", "es310", "vulkan450")),
    ("wgsl", "wgsl"),
    ("opencl", "1.2"),
    ("opencl", "3.0"),
]

C_FAMILY = """\
{qualifier}float twice(float x)
{{
    return x + x;
}}

{qualifier}float four_times(float x)
{{
    return twice({argument});
}}
"""
WGSL = """\
fn twice(x: f32) -> f32 {{
    return x + x;
}}

// The defect, if any, is in the same line as in the other languages.

fn four_times(x: f32) -> f32 {{
    return twice({argument});
}}
"""
DEFECT_LINE = 8


def library(target: str, argument: str) -> str:
    """A library of two functions; the argument of a call is left to the test."""
    if target == "wgsl":
        return WGSL.format(argument=argument)
    return C_FAMILY.format(qualifier="static " if target == "opencl" else "", argument=argument)


def validate_or_skip(target: str, dialect: str, text: str) -> None:
    """Validate; skip where the validator is missing."""
    try:
        import_module(f"targets.{target}.validate").validate(text, dialect)
    except TargetUnavailable as reason:
        pytest.skip(f"{target} {dialect}: {reason}")


@pytest.mark.parametrize(("target", "dialect"), DIALECTS)
def test_sound_library_is_accepted(target: str, dialect: str) -> None:
    validate_or_skip(target, dialect, library(target, "twice(x)"))


@pytest.mark.parametrize(("target", "dialect"), DIALECTS)
def test_unsound_library_is_refused_with_its_line(target: str, dialect: str) -> None:
    with pytest.raises(BuildFailed) as failure:
        validate_or_skip(target, dialect, library(target, "undeclared_name"))
    assert "undeclared_name" in failure.value.log
    assert f":{DEFECT_LINE}" in failure.value.log


@pytest.mark.parametrize("target", ["glsl", "wgsl", "opencl"])
def test_unknown_dialect_is_refused(target: str) -> None:
    with pytest.raises(ValueError, match="is called 'none'"):
        import_module(f"targets.{target}.validate").validate("", "none")


@pytest.mark.parametrize("target", ["glsl", "wgsl", "opencl"])
def test_availability_is_none_or_a_reason(target: str) -> None:
    reason = import_module(f"targets.{target}.validate").validator_available()
    assert reason is None or reason.strip()


def test_missing_glslang_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    module = import_module("targets.glsl.validate")
    assert "glslang-tools" in module.validator_available()
    with pytest.raises(TargetUnavailable, match="glslang-tools"):
        module.validate("", "430")
