"""Replay identities: function/target/family/count/seed/lane, enough to draw the same input again."""

from __future__ import annotations

import re
from dataclasses import dataclass

from codegen.errors import UserError

MOST_LANES = 10_000_000
"""Of one draw; an identity that names more is damaged."""
_NUMBER = re.compile(r"[0-9]{1,18}")


@dataclass(frozen=True)
class Identity:
    """One lane of one draw of one function on one target."""

    function: str
    target: str
    family: str
    count: int
    seed: int
    lane: int

    def __str__(self) -> str:
        return f"{self.function}/{self.target}/{self.family}/{self.count}/{self.seed}/{self.lane}"

    @staticmethod
    def parse(text: str) -> Identity:
        """The identity that a failure printed; raises UserError for anything else."""
        parts = text.split("/")
        try:
            function, target, family = parts[:3]
            count, seed, lane = map(_number, parts[3:])
            identity = Identity(function, target, family, count, seed, lane)
        except ValueError:
            raise UserError(
                f'"{text}" is no replay identity; a failure prints function/target/family/count/seed/lane'
            ) from None
        if not 0 <= identity.lane < identity.count:
            raise UserError(f'replay identity "{text}" names lane {identity.lane} of {identity.count}')
        if identity.count > MOST_LANES:
            raise UserError(f'replay identity "{text}" names a draw of {identity.count} lanes')
        return identity


def _number(text: str) -> int:
    if not _NUMBER.fullmatch(text):
        raise ValueError("digits alone")
    return int(text)
