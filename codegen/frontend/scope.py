"""What lowering asks about names beyond its own function; resolve.Resolver answers."""

from __future__ import annotations

import ast
from contextlib import AbstractContextManager
from typing import Protocol

from codegen.frontend.constants import Number
from codegen.frontend.source import SourceFile
from codegen.ir.nodes import Parameter, StructDef
from codegen.ir.types import Type


class Names(Protocol):
    """Names across files: every method as documented at Resolver."""

    def find(self, file: SourceFile, name: str) -> tuple[SourceFile, str] | None: ...

    def where(self, name: str) -> SourceFile | None: ...

    def module_of(self, name: str) -> str: ...

    def function_names(self) -> list[str]: ...

    def constant(self, file: SourceFile, name: str) -> Number | None: ...

    def constant_type(self, file: SourceFile, name: str) -> Type | None: ...

    def struct(self, file: SourceFile, name: str) -> StructDef: ...

    def signature(self, file: SourceFile, node: ast.FunctionDef) -> tuple[tuple[Parameter, ...], Type]: ...

    def defining(self, file: SourceFile, name: str, node: ast.AST) -> AbstractContextManager[None]: ...
