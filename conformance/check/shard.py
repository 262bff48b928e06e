"""Shards: a fixed share of all (function, target) pairs, for machines that check side by side."""

from __future__ import annotations

import re
from dataclasses import dataclass
from zlib import crc32

from codegen.errors import UserError


@dataclass(frozen=True)
class Shard:
    """Part `index` (from 1) of `of`. A pair's part depends on its own names alone, so adding a function
    moves no other."""

    index: int = 1
    of: int = 1

    @staticmethod
    def parse(text: str) -> Shard:
        """2/3 as a shard; raises UserError for anything else, and for a thousand parts or more."""
        match = re.fullmatch(r"([0-9]{1,3})/([0-9]{1,3})", text)
        if match is None or not 1 <= int(match[1]) <= int(match[2]):
            raise UserError(f'"{text}" is no shard; write 1/3, 2/3 or 3/3, of at most 999')
        return Shard(int(match[1]), int(match[2]))

    def holds(self, function: str, target: str) -> bool:
        """Whether this shard checks the function on the target."""
        return crc32(f"{function}/{target}".encode()) % self.of == self.index - 1

    def __str__(self) -> str:
        return f"{self.index}/{self.of}"
