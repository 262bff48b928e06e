"""Random choices, names and literals of generated programs."""

from __future__ import annotations

import ast
import random
from collections.abc import Sequence
from typing import Any, TypeVar

from codegen.names import reserved
from codegen.ops import BUILTINS

T = TypeVar("T")

WORDS = """
    a b c e g h k m q r s u y z
    alpha amount axis bent blue cosine depth even fade gain grey half_way height hue input_value
    kept level lift mask mean next_one odd offset outer part pick point ratio red rest root round_off
    scale seed share side slope spread step_size tail tint tip turn value weight width wrap
    result_0 load vair main float_value x_0 harness words index
"""
"""Names of parameters and locals; some stand close to names of the harness and of the targets."""

NAMES = tuple(w for w in dict.fromkeys(WORDS.split()) if w not in reserved() and w not in BUILTINS)

FLOATS = (0.0, 0.5, 1.0, 2.0, 3.0, 0.25, 1.5, 0.1, 0.7, 2.75, 1e-3, 7.0, 0.3333333333333333)
WORDS_U32 = (0, 1, 2, 3, 5, 7, 31, 32, 255, 65535, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x9E3779B9)


class Choice(random.Random):
    """A seeded source of decisions."""

    def chance(self, probability: float) -> bool:
        """True that often."""
        return self.random() < probability

    def later(self, options: Sequence[T]) -> T:
        """One of the options, later ones more often: what was just assigned should be used."""
        return options[max(self.randrange(len(options)), self.randrange(len(options)))]

    def one(self, **weights: float) -> str:
        """One of the names, by weight."""
        return self.choices(list(weights), list(weights.values()))[0]


def call(name: str, *arguments: ast.expr) -> ast.expr:
    """The call of a plain name."""
    return ast.Call(ast.Name(name, ast.Load()), list(arguments), [])


def number(value: float | int | bool) -> ast.expr:
    """A literal; a negative one is a sign before a literal, as Python reads it."""
    if not isinstance(value, bool) and value < 0:
        return ast.UnaryOp(ast.USub(), ast.Constant(-value))
    return ast.Constant(value)


def name(text: str) -> ast.expr:
    """A plain name."""
    return ast.Name(text, ast.Load())


_OPERATORS: dict[str, Any] = {
    "+": ast.Add, "-": ast.Sub, "*": ast.Mult, "/": ast.Div, "//": ast.FloorDiv, "%": ast.Mod,
    "<<": ast.LShift, ">>": ast.RShift, "&": ast.BitAnd, "|": ast.BitOr, "^": ast.BitXor,
    "<": ast.Lt, "<=": ast.LtE, ">": ast.Gt, ">=": ast.GtE, "==": ast.Eq, "!=": ast.NotEq,
}  # fmt: skip


def binary(left: ast.expr, op: str, right: ast.expr) -> ast.expr:
    """An operation of two operands; ast.unparse puts parentheses only where Python needs them."""
    kind = _OPERATORS[op]()
    if isinstance(kind, ast.cmpop):
        return ast.Compare(left, [kind], [right])
    return ast.BinOp(left, kind, right)
