"""What a generated function can see: locals by type, helpers, structs."""

from __future__ import annotations

from dataclasses import dataclass, field

from codegen.ir.types import Struct, Type


@dataclass(frozen=True)
class Local:
    """A visible name. `least` and `most` enclose an i32, so that no sum of them leaves 32 bits.

    parameter  whether it is one of the function: only those may end a loop early
    """

    name: str
    type: Type
    writable: bool = False
    least: int = 0
    most: int = 0
    parameter: bool = False


@dataclass(frozen=True)
class Helper:
    """A function that the entry may call."""

    name: str
    parameters: tuple[Type, ...]
    returns: Type


@dataclass
class Scope:
    """Visible names, innermost block last."""

    structs: tuple[Struct, ...] = ()
    helpers: tuple[Helper, ...] = ()
    blocks: list[dict[str, Local]] = field(default_factory=lambda: [{}])

    def add(self, local: Local) -> None:
        """Make a name visible in the innermost block."""
        self.blocks[-1][local.name] = local

    def visible(self) -> dict[str, Local]:
        """Every visible name."""
        return {name: local for block in self.blocks for name, local in block.items()}

    def of(self, type_: Type) -> list[Local]:
        """Visible names of a type."""
        return [local for local in self.visible().values() if local.type == type_]

    def free(self, names: tuple[str, ...]) -> list[str]:
        """Names that can be given here; names of blocks that have ended are free again."""
        taken = self.visible()
        return [n for n in names if n not in taken]
