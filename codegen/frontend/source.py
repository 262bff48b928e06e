"""One source file, parsed and indexed: imports, constants, domain aliases, structs, functions."""

from __future__ import annotations

import ast
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from codegen.errors import Place, SourceError, UserError

ROOT_PACKAGE = "shaderlib"
LANG = f"{ROOT_PACKAGE}.lang"


@dataclass
class SourceFile:
    """A parsed file. `imports` maps a local name to (module, name there); `nodes` what the file defines."""

    module: str
    shown_path: str
    text: str
    imports: dict[str, tuple[str, str]] = field(default_factory=dict)
    import_nodes: dict[str, ast.ImportFrom] = field(default_factory=dict)
    values: dict[str, ast.expr] = field(default_factory=dict)
    annotations: dict[str, ast.expr] = field(default_factory=dict)
    structs: dict[str, ast.ClassDef] = field(default_factory=dict)
    functions: dict[str, ast.FunctionDef] = field(default_factory=dict)

    @property
    def section(self) -> str:
        """The library section (first folder) the file belongs to; empty for files beside the folders."""
        parts = self.module.split(".")
        return parts[1] if len(parts) > 2 else ""

    @cached_property
    def _lines(self) -> list[str]:
        return self.text.splitlines()

    def place(self, node: ast.AST) -> Place:
        """Where a node stands."""
        line = getattr(node, "lineno", 1)
        column = getattr(node, "col_offset", 0)
        text = self._lines[line - 1] if 0 < line <= len(self._lines) else ""
        return Place(self.shown_path, line, column + 1, text)

    def error(self, node: ast.AST, sentence: str) -> SourceError:
        """The error for a node of this file."""
        return SourceError(self.place(node), sentence)


WORDS = {
    "Expr": "an expression without effect",
    "FunctionDef": "a nested function",
    "AsyncFunctionDef": "an async function",
    "ClassDef": "a nested class",
    "Constant": "a text or another constant that is no number",
    "JoinedStr": "a text",
    "Call": "a call of anything but a plain name",
    "ListComp": "a comprehension",
    "SetComp": "a comprehension",
    "DictComp": "a comprehension",
    "GeneratorExp": "a comprehension",
    "UnaryOp": "a plus sign before an operand",
    "Subscript": "an index; components are written v.x",
    "AugAssign": "an assignment to a component",
    "NamedExpr": "an assignment inside an expression",
    "Starred": "an unpacked argument",
    "Import": "a plain import (write from shaderlib... import name)",
    "ImportFrom": "a relative import",
    "Assign": "an assignment to several names",
    "AnnAssign": "a declaration without a value",
}


def describe(node: ast.AST) -> str:
    """What a piece of Python is, in words; its class name in lower case where that says it."""
    name = type(node).__name__
    return WORDS.get(name, f'"{name.lower()}"')


def read_source(path: Path, shown_path: str) -> str:
    """The text of a source; raises UserError where it cannot be read, SourceError where it is not ASCII."""
    try:
        data = path.read_bytes()
    except OSError as e:
        raise UserError(f"cannot read {shown_path}: {e.strerror}") from None
    lines = data.splitlines()
    for number, line in enumerate(lines, 1):
        if not line.isascii():
            column = next(k for k, byte in enumerate(line, 1) if byte > 127)
            place = Place(shown_path, number, column, line.decode("utf-8", "replace"))
            raise SourceError(place, "a shader source is ASCII: its comments are emitted into shaders")
    return data.decode("ascii").replace("\r\n", "\n")


def parse_file(path: Path, module: str, shown_path: str) -> SourceFile:
    """Parse and index one file; raises SourceError for what no shader source may contain at top level."""
    text = read_source(path, shown_path)
    file = SourceFile(module, shown_path, text)
    try:
        tree = ast.parse(text, filename=shown_path)
    except SyntaxError as e:
        place = Place(shown_path, e.lineno or 1, e.offset or 1, (e.text or "").rstrip("\n"))
        raise SourceError(place, f"not valid Python: {e.msg}") from None
    except (ValueError, RecursionError, MemoryError):
        raise SourceError(Place(shown_path, 1), "not valid Python, or nested too deeply") from None
    for position, node in enumerate(tree.body):
        _index(file, node, is_first=position == 0)
    return file


def _index(file: SourceFile, node: ast.stmt, *, is_first: bool) -> None:
    match node:
        case ast.Expr(value=ast.Constant(value=str())) if is_first:
            return
        case ast.ImportFrom(module=str() as module, names=names, level=0):
            _imports(file, node, module, names)
        case ast.Assign(targets=[ast.Name(id=name)], value=value):
            _define(file, node, name)
            file.values[name] = value
        case ast.AnnAssign(target=ast.Name(id=name), annotation=annotation, value=ast.expr() as value):
            _define(file, node, name)
            file.values[name] = value
            file.annotations[name] = annotation
        case ast.ClassDef(name=name):
            _define(file, node, name)
            file.structs[name] = node
        case ast.FunctionDef(name=name):
            _define(file, node, name)
            file.functions[name] = node
        case _:
            raise file.error(
                node, f"a shader source holds imports, constants, structs and functions, not {describe(node)}"
            )


def _define(file: SourceFile, node: ast.AST, name: str) -> None:
    if name in file.values or name in file.structs or name in file.functions or name in file.imports:
        raise file.error(node, f'"{name}" is defined twice in this file')


def _imports(file: SourceFile, node: ast.ImportFrom, module: str, names: Iterable[ast.alias]) -> None:
    if module in ("typing", "__future__"):
        return
    if module != ROOT_PACKAGE and not module.startswith(f"{ROOT_PACKAGE}."):
        raise file.error(node, f'a shader source imports from {ROOT_PACKAGE} and typing only, not "{module}"')
    for alias in names:
        if alias.name == "*":
            raise file.error(node, "import the names one by one, not with *")
        local = alias.asname or alias.name
        _define(file, node, local)
        file.imports[local] = (module, alias.name)
        file.import_nodes[local] = node
