"""Statements and whole functions as text."""

from __future__ import annotations

from codegen.emit import wrap
from codegen.emit.dialect import Dialect
from codegen.emit.expr import ExprPrinter
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F16, F32, TEXTURE, Array, Struct, Type, element_of, leaves

_STEP = "    "
Traced = tuple[str, int]
"""A line of text, and the source line of the statement that it is part of; 0 where none is known."""


class StmtPrinter:
    """Prints statements of one dialect."""

    def __init__(self, dialect: Dialect) -> None:
        self.dialect = dialect
        self.expr = ExprPrinter(dialect)

    def type_name(self, type_: Type) -> str:
        """The spelling of a type where something is declared: with the dialect's precision, if it has one."""
        if isinstance(type_, Array):
            return self.expr.type_name(type_)
        name = self.dialect.types.get(type_.name, type_.name)
        if type_ == BOOL or isinstance(type_, Struct):
            return name
        halved = element_of(type_) == F16
        return f"{self.dialect.half_precision if halved else self.dialect.precision} {name}".lstrip()

    def declare(self, name: str, type_: Type) -> str:
        """A parameter, field or array."""
        if self.dialect.declaration == "name: type":
            return f"{name}: {self.type_name(type_)}"
        if isinstance(type_, Array):
            constant = "const " if self.dialect.structs == "compound" else ""
            return f"{constant}{self.type_name(type_.element)} {name}[{type_.size}]"
        return f"{self.type_name(type_)} {name}"

    def parameter(self, p: ir.Parameter) -> list[str]:
        """A parameter of a function; a texture may be several."""
        if p.type != TEXTURE:
            return [self.declare(p.name, p.type)]
        if self.dialect.declaration == "name: type":
            return [f"{name}: {type_}" for name, type_ in self.expr.texture(p.name)]
        return [f"{type_} {name}" for name, type_ in self.expr.texture(p.name)]

    def let(self, s: ir.Let) -> str:
        """The declaration of a local, with its value."""
        value = self.expr.show(s.value)
        if isinstance(s.value.type, Array):
            return self.array(s, value)
        if self.dialect.declaration == "name: type":
            if not s.mutable:
                return f"let {s.name} = {value};"
            return f"var {s.name}: {self.type_name(s.value.type)} = {value};"
        qualifier = f"{self.dialect.local} " if self.dialect.local and holds_floats(s.value.type) else ""
        return f"{qualifier}{self.type_name(s.value.type)} {s.name} = {value};"

    def array(self, s: ir.Let, value: str) -> str:
        """A local array: C takes its elements in braces, WGSL numbers only variables freely."""
        if self.dialect.declaration == "name: type":
            return f"var {s.name} = {value};"
        if self.dialect.structs == "compound" and isinstance(s.value, ir.Construct):
            value = f"{{{self.expr.arguments(s.value.args)}}}"
        return f"{self.declare(s.name, s.value.type)} = {value};"

    def block(self, body: tuple[ir.Stmt, ...], indent: str) -> list[str]:
        """The lines of a block."""
        return [text for text, _ in self.traced(body, indent)]

    def traced(self, body: tuple[ir.Stmt, ...], indent: str) -> list[Traced]:
        """The same, each with the source line of its statement."""
        lines: list[Traced] = []
        for s in body:
            match s:
                case ir.Let():
                    lines += _of(s.line, wrap.code(self.let(s), indent))
                case ir.Assign():
                    lines += _of(s.line, wrap.code(f"{s.name} = {self.expr.show(s.value)};", indent))
                case ir.Return():
                    lines += _of(s.line, wrap.code(f"return {self.expr.show(s.value)};", indent))
                case ir.If():
                    lines += self.branch(s, indent)
                case ir.For():
                    lines += [
                        (f"{indent}{self.loop_head(s)}", s.line),
                        *self.traced(s.body, indent + _STEP),
                        (indent + "}", s.line),
                    ]
        return lines

    def branch(self, s: ir.If, indent: str, lead: str = "") -> list[Traced]:
        """The lines of an if; an if alone in the other side becomes "else if"."""
        head = wrap.code(f"{lead}if ({self.expr.show(s.condition)}) {{", indent)
        lines = [*_of(s.line, head), *self.traced(s.then, indent + _STEP)]
        if len(s.orelse) == 1 and isinstance(s.orelse[0], ir.If):
            return [*lines, *self.branch(s.orelse[0], indent, "} else ")]
        if s.orelse:
            lines += [(indent + "} else {", s.line), *self.traced(s.orelse, indent + _STEP)]
        return [*lines, (indent + "}", s.line)]

    def loop_head(self, s: ir.For) -> str:
        """The line that opens a loop."""
        start, stop = (self.expr.show(ir.Const(s.index_type, bound)) for bound in (s.start, s.stop))
        if not isinstance(s.limit, ir.Const | None):
            stop = self.expr.show(ir.Builtin(s.index_type, "min", (s.limit, ir.Const(s.index_type, s.stop))))
        word = "var" if self.dialect.declaration == "name: type" else self.dialect.types[s.index_type.name]
        return f"for ({word} {s.name} = {start}; {s.name} < {stop}; {s.name}++) {{"

    def function(self, f: ir.Function) -> list[str]:
        """A whole definition."""
        return [text for text, _ in self.traced_function(f)]

    def traced_function(self, f: ir.Function) -> list[Traced]:
        """The same, each line with its source line: that of the definition around the body."""
        parameters = ", ".join(part for p in f.parameters for part in self.parameter(p))
        if self.dialect.declaration == "name: type":
            head = f"fn {f.name}({parameters}) -> {self.type_name(f.returns)} {{"
        else:
            head = f"{self.dialect.qualifier}{self.type_name(f.returns)} {f.name}({parameters}) {{"
        line = f.place.line
        return [*_of(line, wrap.code(head, "")), *self.traced(f.body, _STEP), ("}", line)]

    def struct(self, s: Struct) -> list[str]:
        """A struct definition."""
        if self.dialect.declaration == "name: type":
            return [
                f"struct {s.name} {{",
                *(f"{_STEP}{self.declare(f.name, f.type)}," for f in s.fields),
                "}",
            ]
        fields = [f"{_STEP}{self.declare(f.name, f.type)};" for f in s.fields]
        if self.dialect.structs == "compound":
            return [f"typedef struct {s.name} {{", *fields, f"}} {s.name};"]
        return [f"struct {s.name} {{", *fields, "};"]


def _of(line: int, lines: list[str]) -> list[Traced]:
    return [(text, line) for text in lines]


def holds_floats(type_: Type) -> bool:
    """Whether any scalar of the type is a float."""
    return any(scalar in (F16, F32) for _, scalar in leaves(type_))
