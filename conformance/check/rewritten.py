"""Libraries with one function rewritten: to see what its results hang on."""

from __future__ import annotations

import ast
from collections.abc import Callable

from codegen.frontend.source import SourceFile
from codegen.library import Library

Rewriting = Callable[[ast.Call | ast.BinOp], ast.expr]


class _Rewriter(ast.NodeTransformer):
    def __init__(self, rewriting: Rewriting) -> None:
        self.rewriting = rewriting

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        self.generic_visit(node)
        return self.rewriting(node)

    def visit_Call(self, node: ast.Call) -> ast.expr:
        self.generic_visit(node)
        return self.rewriting(node)


def is_call(node: ast.AST, name: str) -> bool:
    """Whether an expression calls a function of that name."""
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == name


def copy(library: Library, module: str) -> tuple[Library, SourceFile]:
    """The library once more, as far as a module needs it, and the module's source in it, to be changed."""
    copied = Library(library.root)
    for needed, file in library.resolver.needed_files([module]).items():
        own = copied.resolver.file(needed)
        own.functions.update(file.functions)
        own.values.update(file.values)
    return copied, copied.resolver.file(module)


def rewritten(library: Library, name: str, rewriting: Rewriting) -> Library:
    """The library with each call and each arithmetic operation of a function as `rewriting` gives it."""
    copied, file = copy(library, library.resolver.module_of(name))
    (definition,) = ast.parse(ast.unparse(file.functions[name])).body
    changed = ast.fix_missing_locations(_Rewriter(rewriting).visit(definition))
    assert isinstance(changed, ast.FunctionDef)
    file.functions[name] = changed
    return copied


def rounded(library: Library, name: str, factor: float) -> Library:
    """The library with every quotient and root that a function writes times a factor close to 1."""

    def times(node: ast.Call | ast.BinOp) -> ast.expr:
        if is_call(node, "sqrt") or (isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div)):
            return ast.BinOp(node, ast.Mult(), ast.Constant(factor))
        return node

    return rewritten(library, name, times)
