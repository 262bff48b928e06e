"""Every dialect, and its validator with a skip where it is missing."""

from importlib import import_module

import pytest

from codegen.backends import TARGETS, dialects_of
from codegen.emit.dialect import Dialect
from targets import TargetUnavailable

DIALECTS: list[Dialect] = [d for target in TARGETS for d in dialects_of(target).values()]
ONE_PER_TARGET: list[Dialect] = [next(d for d in DIALECTS if d.target == target) for target in TARGETS]


def dialect_id(dialect: Dialect) -> str:
    """The name of a dialect in the id of a test."""
    return dialect.name if dialect.name == dialect.target else f"{dialect.target}-{dialect.name}"


def validate(text: str, dialect: Dialect) -> None:
    """Let the target's own compiler read a library; skip where there is none."""
    try:
        import_module(f"targets.{dialect.target}.validate").validate(text, dialect.name)
    except TargetUnavailable as reason:
        pytest.skip(f"{dialect_id(dialect)}: {reason}")
