"""Replay identities: function/target/family/count/seed/lane, enough to draw the same input again."""

from __future__ import annotations

from dataclasses import dataclass

from codegen.errors import UserError


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
            function, target, family, count, seed, lane = parts
            identity = Identity(function, target, family, int(count), int(seed), int(lane))
        except ValueError:
            raise UserError(
                f'"{text}" is no replay identity; a failure prints function/target/family/count/seed/lane'
            ) from None
        if not 0 <= identity.lane < identity.count:
            raise UserError(f'replay identity "{text}" names lane {identity.lane} of {identity.count}')
        return identity
