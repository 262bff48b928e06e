"""The tables, joined: operators by symbol, built-ins by name."""

from codegen.ops import arithmetic, bits, exponential, geometry, textures, trigonometry
from codegen.ops.op import Op, table

OPERATORS: dict[str, Op] = table(*arithmetic.OPERATORS, *bits.OPERATORS)
BUILTINS: dict[str, Op] = table(
    *arithmetic.BUILTINS,
    *exponential.BUILTINS,
    *trigonometry.BUILTINS,
    *geometry.BUILTINS,
    *bits.BUILTINS,
    *textures.BUILTINS,
)
