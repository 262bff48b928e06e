"""What a vendored folder is made of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from codegen.backends import TARGETS, dialect, dialects_of
from codegen.emit.dialect import Dialect, with_half
from codegen.emit.module import DEFAULT_PREFIX
from codegen.errors import UserError, unknown
from codegen.names import check_prefix

ALL = "all"
PRECISIONS = ("single", "half")
SCENE_SINGLE = "a scene is proven in single precision; leave out --precision half"
SCENE_ALONE = "a scene has one function of its own; leave out --function and --per-function"


@dataclass(frozen=True)
class Options:
    """What was asked for.

    dialects      "glsl/430": target and dialect, in order
    functions     by name; none stands for all
    scene         a scene file, relative to the folder; empty for none
    prefix        before every name
    per_function  one file per function and dialect instead of one per dialect
    precision     "half": the half forms of the functions that have one
    """

    dialects: tuple[str, ...]
    functions: tuple[str, ...] = ()
    scene: str = ""
    prefix: str = DEFAULT_PREFIX
    per_function: bool = False
    precision: str = "single"

    def __post_init__(self) -> None:
        check_prefix(self.prefix)
        if self.scene and (self.functions or self.per_function):
            raise UserError(SCENE_ALONE)
        if self.precision not in PRECISIONS:
            raise unknown("precision", self.precision, PRECISIONS)
        if self.scene and self.half:
            raise UserError(SCENE_SINGLE)

    @property
    def half(self) -> bool:
        """Whether half forms are asked for."""
        return self.precision == "half"

    def found_dialects(self) -> list[Dialect]:
        """The dialects; raises UserError for one that there is not."""
        found = []
        for name in self.dialects:
            target, _, own = name.partition("/")
            found.append(with_half(dialect(target, own)) if self.half else dialect(target, own))
        return found


def key(d: Dialect) -> str:
    """A dialect as options name it."""
    return f"{d.target}/{d.name}"


def choose_dialects(targets: Sequence[str], names: Sequence[str]) -> tuple[str, ...]:
    """What --target and --dialect ask for, in the order of targets and dialects.

    A target without a dialect of its own has its default; without a target all have theirs, or those that a
    dialect is named of. "all" stands for every dialect.

    raises  UserError for names that are unknown or do not belong together
    """
    for name in targets:
        if name not in TARGETS:
            raise unknown("target", name, TARGETS)
    every = {d.name: d for target in TARGETS for d in dialects_of(target).values()}
    for name in names:
        if name not in every and name != ALL:
            raise unknown("dialect", name, [*every, ALL])
        if targets and name != ALL and every[name].target not in targets:
            raise UserError(f'dialect "{name}" is one of {every[name].target}, which --target leaves out')
    chosen = []
    for target in targets or TARGETS:
        own = [d for d in dialects_of(target).values() if d.name in names or ALL in names]
        if not own and (targets or not names):
            own = [dialect(target)]
        chosen += own
    return tuple(dict.fromkeys(sorted(map(key, chosen), key=_order)))


def _order(name: str) -> tuple[int, int]:
    target, _, own = name.partition("/")
    return TARGETS.index(target), list(dialects_of(target)).index(own)
