"""Expressions as nested tuples that say the same for every language, from IR and from parsed text.

("number", kind, value)   kind f, u or i; a float as its 32 bits; the sign is ("-", operand)
("name", text)            a variable or a truth value
(operator, operands...)   operators as C spells them; "?:" with condition, value if true, value if false
("call", name, args...)   functions, constructors and conversions, by their spelling in the language
(".", operand, name)      fields and components
("[]", operand, index)    elements of arrays
"""

import re
import struct
import warnings
from collections.abc import Callable
from functools import cache
from importlib import import_module
from typing import Any

from tree_sitter import Language, Node, Parser

from codegen.emit.dialect import Dialect
from codegen.ir import nodes as ir
from codegen.ir.types import F32, U32
from codegen.ops import BUILTINS

Neutral = tuple[Any, ...]

GRAMMARS = {"glsl": "tree_sitter_glsl", "wgsl": "tree_sitter_wgsl_bevy", "opencl": "tree_sitter_c"}
C_SPELLING = {"//": "/", "and": "&&", "or": "||", "not": "!", "negate": "-"}


def bits_of(value: float) -> int:
    """The bits of the float32 nearest to a number."""
    bits: int = struct.unpack("<I", struct.pack("<f", value))[0]
    return bits


def of_ir(e: ir.Expr, dialect: Dialect) -> Neutral:
    """What the text of an expression has to parse to."""

    def spelled(name: str) -> str:
        return dialect.types.get(name, name)

    def of(part: ir.Expr) -> Neutral:
        return of_ir(part, dialect)

    match e:
        case ir.Const(type=type_, value=bool() as value):
            return ("name", str(value).lower())
        case ir.Const(type=type_, value=value):
            kind = "f" if type_ == F32 else "u" if type_ == U32 else "i"
            negative = str(value).startswith("-")
            size = abs(value)
            number = ("number", kind, bits_of(size) if kind == "f" else size)
            return ("-", number) if negative else number
        case ir.Var():
            return ("name", e.name)
        case ir.Unary() | ir.Binary():
            return (C_SPELLING.get(e.op, e.op), *map(of, ir.children(e)))
        case ir.Builtin():
            return ("call", BUILTINS[e.op].spelling(dialect.target), *map(of, e.args))
        case ir.Call():
            return ("call", e.function, *map(of, e.args))
        case ir.Construct() | ir.Convert():
            return ("call", spelled(e.type.name), *map(of, ir.children(e)))
        case ir.Member():
            return (".", of(e.value), e.name)
        case ir.Swizzle():
            return (".", of(e.value), e.components)
        case ir.Index():
            return ("[]", of(e.value), of(e.index))
        case ir.Select():
            return ("?:", of(e.condition), of(e.if_true), of(e.if_false))


@cache
def parser(target: str) -> Parser:
    """The independent parser of a target's language."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # one grammar is handed over as an int
        return Parser(Language(import_module(GRAMMARS[target]).language()))


def parse(target: str, text: str) -> Node:
    """The tree of a whole text; raises ValueError where it does not parse."""
    root = parser(target).parse(text.encode()).root_node
    if root.has_error:
        raise ValueError(f"does not parse as {target}: {text}")
    return root


GLSL_SCALAR = re.compile(r"\b(float|int|uint)\(")
"""A conversion that tree-sitter-glsl, grown from C's grammar, takes for a type: (int(x) + y)."""


def returned(target: str, text: str) -> Neutral:
    """The expression that the only return statement of a text returns."""
    if target == "glsl":
        text = GLSL_SCALAR.sub(r"to_\1(", text)
    statements = find(parse(target, text), "return_statement")
    if len(statements) != 1:
        raise ValueError(f"{len(statements)} return statements: {text}")
    (expression,) = meaningful(statements[0], skip=("return", ";"))
    return READERS[target](expression)


def find(node: Node, kind: str) -> list[Node]:
    """All nodes of a kind, in order."""
    here = [node] if node.type == kind else []
    return here + [found for child in node.children for found in find(child, kind)]


def meaningful(node: Node, skip: tuple[str, ...] = ("(", ")", ",", "{", "}", "<", ">", ".")) -> list[Node]:
    return [child for child in node.children if child.type not in skip]


def text_of(node: Node) -> str:
    return (node.text or b"").decode()


def number(text: str) -> Neutral:
    """A literal by its look: a point, an exponent or a suffix f make a float, u an unsigned number."""
    if text.startswith("-"):
        return ("-", number(text[1:]))
    plain = text.rstrip("fu")
    if any(mark in plain for mark in ".e"):
        return ("number", "f", bits_of(float(plain)))
    return ("number", "u" if text.endswith("u") else "i", int(plain))


def c_like(node: Node) -> Neutral:
    """GLSL and C. Where C's grammar cannot tell (float3)(a, b) from a call, a known type name decides."""
    match node.type:
        case "identifier" | "true" | "false":
            return ("name", text_of(node))
        case "number_literal":
            return number(text_of(node))
        case "parenthesized_expression":
            (inner,) = meaningful(node)
            return c_like(inner)
        case "unary_expression":
            operator, operand = node.children
            return (operator.type, c_like(operand))
        case "binary_expression":
            left, operator, right = node.children
            return (operator.type, c_like(left), c_like(right))
        case "conditional_expression":
            return ("?:", *map(c_like, meaningful(node, skip=("?", ":"))))
        case "field_expression":
            value, field = meaningful(node)
            return (".", c_like(value), text_of(field))
        case "call_expression":
            called, arguments = node.children
            name = text_of(called).strip("()").removeprefix("to_")
            return ("call", name, *map(c_like, meaningful(arguments)))
        case "cast_expression":
            type_, value = meaningful(node)
            return ("call", text_of(type_), c_like(value))
        case "compound_literal_expression":
            type_, values = meaningful(node)
            return ("call", text_of(type_), *map(c_like, meaningful(values)))
        case _:
            raise ValueError(f"unexpected {node.type}: {text_of(node)}")


def wgsl(node: Node) -> Neutral:
    """WGSL. A sign may be part of a literal; select(if_false, if_true, condition) is the conditional."""
    match node.type:
        case "identifier":
            return ("name", text_of(node))
        case "const_literal":
            text = text_of(node)
            return ("name", text) if text in ("true", "false") else number(text)
        case "parenthesized_expression":
            (inner,) = meaningful(node)
            return wgsl(inner)
        case "unary_expression":
            operator, operand = node.children
            return (operator.type, wgsl(operand))
        case "binary_expression":
            left, operator, right = node.children
            return (operator.type, wgsl(left), wgsl(right))
        case "composite_value_decomposition_expression":
            return wgsl_postfix(node)
        case "type_constructor_or_function_call_expression":
            called, arguments = node.children
            name, args = text_of(called), [wgsl(a) for a in meaningful(arguments)]
            return ("?:", args[2], args[1], args[0]) if name == "select" else ("call", name, *args)
        case "bitcast_expression":
            type_, value = meaningful(node, skip=("bitcast", "<", ">"))
            return ("call", f"bitcast<{text_of(type_)}>", wgsl(value))
        case _:
            raise ValueError(f"unexpected {node.type}: {text_of(node)}")


def wgsl_postfix(node: Node) -> Neutral:
    """Fields and components. The grammar reads -a.x as (-a).x; the specification lets .x bind tighter."""
    names: list[str] = []
    while node.type == "composite_value_decomposition_expression":
        node, field = meaningful(node)
        names.append(text_of(field))
    sign = node.children[0].type if node.type == "unary_expression" else ""
    value = wgsl(node.children[1] if sign else node)
    for name in reversed(names):
        value = (".", value, name)
    return (sign, value) if sign else value


READERS: dict[str, Callable[[Node], Neutral]] = {"glsl": c_like, "opencl": c_like, "wgsl": wgsl}
