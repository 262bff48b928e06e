"""IR as source text of the subset: what the front end would read. For reports of reduced programs."""

from __future__ import annotations

import ast

from codegen.ir import nodes as ir
from codegen.ir.domains import Finite, Interval
from codegen.ir.types import BOOL, F32, I32, U32, Struct, Type
from codegen.ops import BUILTINS
from conformance.fuzz.choices import binary, call, name, number

STEP = "    "


def functions_text(functions: tuple[ir.Function, ...], structs: tuple[ir.StructDef, ...] = ()) -> str:
    """Structs and functions, one after the other; the last function is the entry."""
    parts = [struct_text(s.type) for s in structs]
    for k, f in enumerate(functions):
        parts.append(("" if k == len(functions) - 1 else "@helper\n") + function_text(f))
    return "\n\n".join(parts) + "\n"


def struct_text(struct: Struct) -> str:
    """A struct's definition."""
    fields = "\n".join(f"{STEP}{f.name}: {_stated(f.type, f.domain)}" for f in struct.fields)
    return f"@struct\nclass {struct.name}:\n{fields}"


def function_text(f: ir.Function) -> str:
    """A function's definition."""
    parameters = ", ".join(f"{p.name}: {_stated(p.type, p.domain)}" for p in f.parameters)
    return "\n".join([f"def {f.name}({parameters}) -> {f.returns.name}:", *_block(f.body, STEP)])


def _stated(type_: Type, domain: object) -> str:
    if isinstance(type_, Struct) or type_ == BOOL:
        return type_.name
    if isinstance(domain, Interval):
        return f"Annotated[{type_.name}, Interval({domain.low!r}, {domain.high!r})]"
    return f"Annotated[{type_.name}, {Finite.__name__}()]"


def _block(body: tuple[ir.Stmt, ...], indent: str) -> list[str]:
    lines: list[str] = []
    for s in body:
        match s:
            case ir.Let() | ir.Assign():
                lines.append(f"{indent}{s.name} = {expression_text(s.value)}")
            case ir.Return():
                lines.append(f"{indent}return {expression_text(s.value)}")
            case ir.If():
                lines += [f"{indent}if {expression_text(s.condition)}:", *_block(s.then, indent + STEP)]
                if s.orelse:
                    lines += [f"{indent}else:", *_block(s.orelse, indent + STEP)]
            case ir.For():
                bounds = f"{s.start}, {s.stop}" if s.start else str(s.stop)
                if s.limit is not None:
                    bounds = f"min({expression_text(s.limit)}, {s.stop})"
                lines += [f"{indent}for {s.name} in range({bounds}):", *_block(s.body, indent + STEP)]
    return lines or [f"{indent}pass"]


def expression_text(e: ir.Expr) -> str:
    """An expression with the parentheses that Python needs."""
    return ast.unparse(expression(e))


def expression(e: ir.Expr) -> ast.expr:
    """Python's tree of an expression."""
    parts = [expression(c) for c in ir.children(e)]
    match e:
        case ir.Const():
            if e.type in (U32, I32):
                return call(e.type.name, number(int(e.value)))
            return number(float(e.value) if e.type == F32 else e.value)
        case ir.Var():
            return name(e.name)
        case ir.Unary():
            operators: dict[str, ast.unaryop] = {"negate": ast.USub(), "~": ast.Invert(), "not": ast.Not()}
            return ast.UnaryOp(operators[e.op], parts[0])
        case ir.Binary(op="and"):
            return ast.BoolOp(ast.And(), parts)
        case ir.Binary(op="or"):
            return ast.BoolOp(ast.Or(), parts)
        case ir.Binary():
            return binary(parts[0], e.op, parts[1])
        case ir.Builtin():
            return call(BUILTINS[e.op].name, *parts)
        case ir.Call():
            return call(e.function, *parts)
        case ir.Construct() | ir.Convert():
            return call(e.type.name, *parts)
        case ir.Member():
            return ast.Attribute(parts[0], e.name, ast.Load())
        case ir.Swizzle():
            return ast.Attribute(parts[0], e.components, ast.Load())
        case ir.Index():
            return ast.Subscript(parts[0], parts[1], ast.Load())
        case ir.Select():
            return ast.IfExp(*parts)
