"""Expressions: Python's tree becomes the typed tree; literals take the type their place asks for."""

from __future__ import annotations

import ast
from collections.abc import Collection, Mapping
from typing import NoReturn

from codegen.errors import nearest
from codegen.frontend import constants
from codegen.frontend.scope import Names
from codegen.frontend.settle import NoValueError, settle
from codegen.frontend.source import LANG, SourceFile, describe
from codegen.ir import nodes as ir
from codegen.ir.types import (
    BOOL,
    F32,
    I32,
    U32,
    VALUE_TYPES,
    Scalar,
    Struct,
    Texture,
    Type,
    Vector,
    vector_of,
)
from codegen.ops import BUILTINS, OPERATORS

_SYMBOLS: dict[type[ast.AST], str] = {
    ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/", ast.FloorDiv: "//", ast.Mod: "%",
    ast.LShift: "<<", ast.RShift: ">>", ast.BitAnd: "&", ast.BitOr: "|", ast.BitXor: "^",
    ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!=",
    ast.And: "and", ast.Or: "or", ast.Not: "not", ast.USub: "negate", ast.Invert: "~",
}  # fmt: skip
_HINTS: dict[type[ast.AST], str] = {
    ast.Pow: "there is no operator **; multiply, or call safe_pow",
    ast.MatMult: "there are no matrices; use dot and cross",
    ast.Is: "compare with ==",
    ast.In: "compare with == and or",
    ast.IsNot: "compare with !=",
    ast.NotIn: "compare with != and and",
}
_CASTS: dict[str, Scalar] = {"f32": F32, "i32": I32, "u32": U32}


def _element(type_: Type) -> Scalar | None:
    """The type of a number that stands beside an operand of this type."""
    element = type_.element if isinstance(type_, Vector) else type_
    return element if isinstance(element, Scalar) else None


class ExpressionLowering:
    """Lowers the expressions of one function.

    `scope` maps the visible locals to their types; `ended` names locals of blocks that have ended.
    """

    def __init__(
        self, resolver: Names, file: SourceFile, scope: Mapping[str, Type], ended: Collection[str] = ()
    ) -> None:
        self.resolver = resolver
        self.file = file
        self.scope = scope
        self.ended = ended

    def fail(self, node: ast.AST, sentence: str) -> NoReturn:
        raise self.file.error(node, sentence)

    def lower(self, node: ast.expr, expected: Type | None = None) -> ir.Expr:
        """The typed expression. `expected` decides the type of integer literals and is otherwise a check."""
        folded = None if self._is_local(node) else constants.fold(node, self._constant)
        e = self._literal(node, folded, expected) if folded is not None else self._lower(node, expected)
        e = self._settled(node, e)
        if expected is not None and e.type != expected:
            self.fail(node, f"this is {e.type.name}, but {expected.name} is needed here")
        return e

    def _settled(self, node: ast.expr, e: ir.Expr) -> ir.Expr:
        try:
            return settle(e)
        except NoValueError as reason:
            self.fail(node, f"this constant expression {reason}")

    def _is_local(self, node: ast.expr) -> bool:
        return isinstance(node, ast.Name) and node.id in self.scope

    def _constant(self, name: str) -> constants.Number | None:
        return None if name in self.scope else self.resolver.constant(self.file, name)

    def _literal(self, node: ast.expr, value: constants.Number, expected: Type | None) -> ir.Expr:
        if isinstance(value, bool):
            return ir.Const(BOOL, value)
        stated_types = [self._stated_type(part) for part in ast.walk(node)]
        stated = next((t for t in stated_types if t is not None), None)
        if isinstance(value, float):
            rounded = constants.to_float32(value)
            if rounded is None:
                self.fail(node, f"{value!r} does not fit into a normal float32")
            if isinstance(node, ast.Name) and stated is not None and stated != F32:
                self.fail(node, f'"{node.id}" is stated to be {stated.name}, but {value!r} is f32')
            return ir.Const(F32, rounded)
        wanted = expected or stated or I32
        if wanted == F32:
            self.fail(node, f"write {value}.0: a whole number here would be an integer")
        low, high = (0, 2**32 - 1) if wanted == U32 else (-(2**31), 2**31 - 1)
        if wanted not in (I32, U32) or not low <= value <= high:
            self.fail(node, f"{value} is not a value of {wanted.name}")
        if value == low < 0:
            self.fail(node, f"{value} has no literal in C: its sign is an operator")
        return ir.Const(wanted, value)

    def _stated_type(self, node: ast.AST) -> Type | None:
        """The type that the annotation of a named constant states."""
        if not isinstance(node, ast.Name) or node.id in self.scope:
            return None
        return self.resolver.constant_type(self.file, node.id)

    def _lower(self, node: ast.expr, expected: Type | None) -> ir.Expr:
        match node:
            case ast.Name(id=name):
                return self._name(node, name)
            case ast.Attribute(value=value, attr=attribute):
                return self._attribute(node, value, attribute)
            case ast.Call(func=ast.Name(id=name)):
                return self._call(node, name)
            case ast.IfExp(test=test, body=body, orelse=orelse):
                a, b = self._pair(body, orelse, expected)
                if a.type != b.type:
                    self.fail(node, f"the two sides differ: {a.type.name} and {b.type.name}")
                if isinstance(a.type, Texture):
                    self.fail(node, "a texture is a parameter; no expression chooses one")
                if isinstance(a.type, Struct):
                    self.fail(node, "a conditional expression chooses numbers and vectors; write if and else")
                return ir.Select(a.type, self.lower(test, BOOL), a, b)
            case ast.UnaryOp(op=op, operand=operand) if type(op) in _SYMBOLS:
                e = self.lower(operand, expected if isinstance(op, ast.USub | ast.Invert) else None)
                return self._operation(node, _SYMBOLS[type(op)], (e,))
            case ast.BinOp(left=left, op=op, right=right):
                return self._binary(node, op, left, right)
            case ast.Compare(left=left, ops=[op], comparators=[right]):
                return self._binary(node, op, left, right)
            case ast.Compare():
                self.fail(node, "comparisons do not chain: write a < b and b < c")
            case ast.BoolOp(op=op, values=values):
                e = self.lower(values[0], BOOL)
                for value in values[1:]:
                    e = self._operation(node, _SYMBOLS[type(op)], (e, self.lower(value, BOOL)))
                    e = self._settled(node, e)
                return e
            case _:
                self.fail(node, f"{describe(node)} is outside the shader subset of Python")

    def _name(self, node: ast.expr, name: str) -> ir.Expr:
        if name not in self.scope:
            if name in self.ended:
                self.fail(
                    node, f'"{name}" was assigned in a block that has ended; assign it before the block'
                )
            if name in self.file.imports or self.resolver.find(self.file, name):
                self.fail(node, f'"{name}" is neither a local nor a constant number')
            known = [*self.scope, *self.file.imports, *self.file.values]
            self.fail(node, f'unknown name "{name}"{nearest(name, known)}')
        return ir.Var(self.scope[name], name)

    def _attribute(self, node: ast.expr, value: ast.expr, attribute: str) -> ir.Expr:
        e = self.lower(value)
        if isinstance(e.type, Struct):
            found = e.type.field(attribute)
            if found is None:
                valid = [f.name for f in e.type.fields]
                self.fail(node, f'{e.type.name} has no field "{attribute}"{nearest(attribute, valid)}')
            return ir.Member(found.type, e, attribute)
        if isinstance(e.type, Vector) and set(attribute) <= set("xyzw"[: e.type.size]):
            result = vector_of(e.type.element, len(attribute))
            if result is not None:
                return ir.Swizzle(result, e, attribute)
        self.fail(node, f'{e.type.name} has no component "{attribute}"')

    def _pair(self, left: ast.expr, right: ast.expr, expected: Type | None) -> tuple[ir.Expr, ir.Expr]:
        """Two operands; an integer literal takes the type of the other one."""
        if self._is_whole_number(left) and not self._is_whole_number(right):
            b = self.lower(right, expected)
            return self.lower(left, _element(b.type)), b
        a = self.lower(left, expected)
        return a, self.lower(right, _element(a.type) if self._is_whole_number(right) else expected)

    def _is_whole_number(self, node: ast.expr) -> bool:
        if self._is_local(node) or isinstance(node, ast.Name):
            return False
        value = constants.fold(node, self._constant)
        return isinstance(value, int) and not isinstance(value, bool)

    def _binary(self, node: ast.expr, op: ast.AST, left: ast.expr, right: ast.expr) -> ir.Expr:
        symbol = _SYMBOLS.get(type(op))
        if symbol is None:
            hint = _HINTS.get(type(op), f"{describe(op)} is outside the shader subset of Python")
            self.fail(node, hint)
        return self._operation(node, symbol, self._pair(left, right, None))

    def _operation(self, node: ast.expr, symbol: str, operands: tuple[ir.Expr, ...]) -> ir.Expr:
        types = tuple(e.type for e in operands)
        result = OPERATORS[symbol].result(types)
        if result is None:
            shown = " and ".join(t.name for t in types)
            hint = " (for whole numbers write //)" if symbol == "/" and U32 in types else ""
            if symbol == "/" and types == (I32, I32):
                hint = " (write the numbers with a point)"
            if symbol in ("+", "-") and F32 in types and any(isinstance(t, Vector) for t in types):
                hint = " (to add a number to a vector, make it a vector: vec3(x))"
            self.fail(node, f'"{symbol}" takes no {shown}{hint}')
        last = operands[-1]
        if symbol in ("/", "//", "%") and isinstance(last, ir.Const) and last.value == 0:
            self.fail(node, "this divides by zero")
        if symbol in ("<<", ">>") and isinstance(last, ir.Const) and not 0 <= last.value <= 31:
            self.fail(node, "a shift is by 0 to 31 bits")
        if len(operands) == 1:
            return ir.Unary(result, symbol, operands[0])
        return ir.Binary(result, symbol, operands[0], operands[1])

    def _call(self, node: ast.Call, name: str) -> ir.Expr:
        imported_from = self.file.imports.get(name, (None, name))
        found = self.resolver.find(self.file, name)
        if found is not None:
            where, original = found
            if original in where.structs:
                return self._struct(node, self.resolver.struct(where, original).type)
            if original in where.functions:
                return self._library_call(node, where, original)
        elif imported_from[0] == LANG:
            original = imported_from[1]
            if original in _CASTS:
                return self._cast(node, _CASTS[original])
            if original in VALUE_TYPES and isinstance(VALUE_TYPES[original], Vector):
                return self._vector(node, VALUE_TYPES[original])
            if original in BUILTINS:
                return self._builtin(node, original)
        importable = [*BUILTINS, *(set(VALUE_TYPES) - {"bool"}), *self.resolver.function_names()]
        if name in importable and name not in self.scope:
            source = LANG if name in BUILTINS or name in VALUE_TYPES else self.resolver.module_of(name)
            self.fail(node, f'"{name}" is not imported: from {source} import {name}')
        self.fail(node, f'unknown function "{name}"{nearest(name, importable)}')

    def _positional(self, node: ast.Call, name: str, count: int) -> list[ast.expr]:
        if node.keywords or any(isinstance(a, ast.Starred) for a in node.args):
            self.fail(node, f"{name} takes its arguments by position")
        if len(node.args) != count:
            plural = "" if count == 1 else "s"
            self.fail(node, f"{name} takes {count} argument{plural}, not {len(node.args)}")
        return node.args

    def _library_call(self, node: ast.Call, where: SourceFile, name: str) -> ir.Expr:
        parameters, returns = self.resolver.signature(where, where.functions[name])
        arguments = self._positional(node, name, len(parameters))
        args = tuple(self.lower(a, p.type) for a, p in zip(arguments, parameters, strict=True))
        return ir.Call(returns, name, args)

    def _builtin(self, node: ast.Call, name: str) -> ir.Expr:
        op = BUILTINS[name]
        arguments = self._positional(node, name, len(op.names))
        typed = next((self.lower(a).type for a in arguments if not self._is_whole_number(a)), None)
        args = tuple(self.lower(a, typed if self._is_whole_number(a) else None) for a in arguments)
        types = tuple(a.type for a in args)
        result = op.result(types)
        if result is None:
            self.fail(node, f"{name} takes no {', '.join(t.name for t in types)}")
        return ir.Builtin(result, name, args)

    def _cast(self, node: ast.Call, target: Scalar) -> ir.Expr:
        (argument,) = self._positional(node, target.name, 1)
        if self._is_whole_number(argument) and target != F32:
            return self.lower(argument, target)
        e = self.lower(argument)
        if e.type not in (F32, I32, U32):
            self.fail(node, f"{target.name}() converts numbers, not {e.type.name}")
        return e if e.type == target else ir.Convert(target, e)

    def _vector(self, node: ast.Call, type_: Type) -> ir.Expr:
        assert isinstance(type_, Vector)
        if node.keywords:
            self.fail(node, f"{type_.name} takes its components by position")
        whole = [self._is_whole_number(a) for a in node.args]
        args = tuple(
            self.lower(a, type_.element if w else None) for a, w in zip(node.args, whole, strict=True)
        )
        size = 0
        for argument, e in zip(node.args, args, strict=True):
            element = e.type.element if isinstance(e.type, Vector) else e.type
            if element != type_.element:
                self.fail(argument, f"{type_.name} is made of {type_.element.name}, not {e.type.name}")
            size += e.type.size if isinstance(e.type, Vector) else 1
        if size != type_.size and not (len(args) == 1 and size == 1):
            self.fail(node, f"{type_.name} needs {type_.size} components, not {size}")
        return ir.Construct(type_, args)

    def _struct(self, node: ast.Call, type_: Struct) -> ir.Expr:
        given: dict[str, ast.expr] = dict(zip((f.name for f in type_.fields), node.args, strict=False))
        if len(node.args) > len(type_.fields):
            self.fail(node, f"{type_.name} has {len(type_.fields)} fields, not {len(node.args)}")
        for keyword in node.keywords:
            name = keyword.arg or ""
            if type_.field(name) is None:
                valid = [f.name for f in type_.fields]
                self.fail(node, f'{type_.name} has no field "{name}"{nearest(name, valid)}')
            if name in given:
                self.fail(node, f'field "{name}" is given twice')
            given[name] = keyword.value
        missing = [f.name for f in type_.fields if f.name not in given]
        if missing:
            self.fail(node, f"{type_.name} lacks {', '.join(missing)}")
        return ir.Construct(type_, tuple(self.lower(given[f.name], f.type) for f in type_.fields))
