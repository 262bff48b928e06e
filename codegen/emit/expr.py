"""Expressions as text. Invariant: the text parses back to the same tree."""

from __future__ import annotations

from dataclasses import replace

from codegen.emit.dialect import Dialect
from codegen.emit.literal import literal
from codegen.emit.precedence import CONDITION, LEFT, RIGHT, level
from codegen.ir import nodes as ir
from codegen.ir.content import is_constant
from codegen.ir.types import F32, TEXTURE, Array, Struct, Type, Vector
from codegen.ops import BUILTINS

_SPELLING = {"//": "/", "and": "&&", "or": "||", "not": "!", "negate": "-"}
_PRIMARY = frozenset({"primary"})
_TESTS = frozenset({"comparison", "and", "or"})
_CONDITIONAL_PARTS = CONDITION | {"primary"}


class ExprPrinter:
    """Prints expressions of one dialect; one method per kind of node."""

    def __init__(self, dialect: Dialect) -> None:
        self.dialect = dialect

    def show(self, e: ir.Expr) -> str:
        """The text of an expression."""
        if self.dialect.typed_suffix and isinstance(e, ir.Binary | ir.Builtin) and is_constant(e):
            single = replace(self.dialect, float_suffix=self.dialect.typed_suffix, typed_suffix="")
            return ExprPrinter(single).show(e)
        match e:
            case ir.Const():
                return literal(e, self.dialect)
            case ir.Var():
                return e.name
            case ir.Unary():
                return f"{_SPELLING.get(e.op, e.op)}{self.bare(e.operand, _PRIMARY)}"
            case ir.Binary():
                return self.binary(e)
            case ir.Builtin():
                return self.builtin(e)
            case ir.Call():
                return f"{e.function}({self.arguments(e.args)})"
            case ir.Construct():
                return self.construct(e)
            case ir.Convert():
                return self.convert(e)
            case ir.Member():
                return f"{self.bare(e.value, _PRIMARY)}.{e.name}"
            case ir.Index():
                return f"{self.bare(e.value, _PRIMARY)}[{self.show(e.index)}]"
            case ir.Swizzle():
                return f"{self.bare(e.value, _PRIMARY)}.{e.components}"
            case ir.Select():
                return self.conditional(e)

    def builtin(self, e: ir.Builtin) -> str:
        """A built-in under its name in this dialect."""
        op = BUILTINS[e.op]
        if self.dialect.target in op.text and isinstance(e.args[0], ir.Var):
            return op.text[self.dialect.target].format(e.args[0].name)
        trailing = tuple(ir.Const(F32, x) for x in op.trailing)
        looks_up = bool(self.dialect.lookup) and any(a.type == TEXTURE for a in e.args)
        name = self.dialect.lookup if looks_up else op.spelling(self.dialect.target)
        return f"{name}({self.arguments((*e.args, *trailing))})"

    def texture(self, name: str) -> list[tuple[str, str]]:
        """What stands for a texture of this name: names with their types."""
        return [(name + suffix, type_) for suffix, type_ in self.dialect.texture]

    def bare(self, e: ir.Expr, allowed: frozenset[str]) -> str:
        """An operand, in parentheses unless its level is allowed to stand bare."""
        text = self.show(e)
        return text if self.level(e) in allowed else f"({text})"

    def level(self, e: ir.Expr) -> str:
        """The level in this dialect: casts are unary in C, select() is a call in WGSL."""
        if isinstance(e, ir.Select) and self.dialect.conditional == "select":
            return "primary"
        if isinstance(e, ir.Convert) and self.dialect.conversions == "cast":
            return "primary" if isinstance(e.type, Vector) else "unary"
        if isinstance(e, ir.Construct):
            cast = self.dialect.vectors if isinstance(e.type, Vector) else self.dialect.structs
            return "primary" if cast == "call" else "unary"
        return level(e)

    def arguments(self, args: tuple[ir.Expr, ...]) -> str:
        """Arguments of a call, between its parentheses; a texture may be several."""
        texts = [
            ", ".join(part for part, _ in self.texture(a.name))
            if isinstance(a, ir.Var) and a.type == TEXTURE
            else self.show(a)
            for a in args
        ]
        for k, a in enumerate(args):
            # WGSL would read f(a < b, c > (d)) as a call of the template a<b, c>.
            opens = "<" in texts[k] and self.level(a) in _TESTS
            if opens and any(">" in text for text in texts[k + 1 :]):
                texts[k] = f"({texts[k]})"
        return ", ".join(texts)

    def binary(self, e: ir.Binary) -> str:
        """An operation with the parentheses that keep its tree."""
        at = level(e)
        left, right = self.bare(e.left, LEFT[at]), self.bare(e.right, RIGHT[at] | self._right_casts(e.right))
        return f"{left} {_SPELLING.get(e.op, e.op)} {right}"

    def _right_casts(self, e: ir.Expr) -> frozenset[str]:
        """A cast may stand bare on the right (a * (float)b); a sign may not (a - -b)."""
        is_sign = isinstance(e, ir.Unary | ir.Const)
        return frozenset() if is_sign else frozenset({"unary"})

    def construct(self, e: ir.Construct) -> str:
        """A vector, struct or array of its parts."""
        name = self.type_name(e.type)
        if isinstance(e.type, Struct) and self.dialect.structs == "compound":
            return f"({name}){{{self.arguments(e.args)}}}"
        if isinstance(e.type, Vector) and self.dialect.vectors == "cast":
            return f"({name})({self.arguments(e.args)})"
        return f"{name}({self.arguments(e.args)})"

    def type_name(self, type_: Type) -> str:
        """The spelling of a type where a value of it is made."""
        if isinstance(type_, Array):
            element = self.dialect.types[type_.element.name]
            if self.dialect.declaration == "name: type":
                return f"array<{element}, {type_.size}>"
            return f"{element}[{type_.size}]"
        return self.dialect.types.get(type_.name, type_.name)

    def convert(self, e: ir.Convert) -> str:
        """A conversion between types of numbers."""
        name = self.dialect.types[e.type.name]
        if self.dialect.conversions == "cast":
            if isinstance(e.type, Vector):
                return f"convert_{name}({self.show(e.operand)})"
            return f"({name}){self.bare(e.operand, _PRIMARY)}"
        return f"{name}({self.show(e.operand)})"

    def conditional(self, e: ir.Select) -> str:
        """A choice between two values; WGSL evaluates both, which no value here can tell."""
        if self.dialect.conditional == "select":
            return f"select({self.arguments((e.if_false, e.if_true, e.condition))})"
        condition = self.bare(e.condition, _CONDITIONAL_PARTS)
        parts = [self.bare(part, _CONDITIONAL_PARTS) for part in (e.if_true, e.if_false)]
        return f"{condition} ? {parts[0]} : {parts[1]}"
