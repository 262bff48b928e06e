"""Names across files: where a function, struct, constant or alias is defined; lowered on first use."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from codegen import names
from codegen.errors import Place, SourceError, UserError, nearest, unknown
from codegen.frontend import annotations as stated
from codegen.frontend import constants, docstring
from codegen.frontend.source import LANG, ROOT_PACKAGE, SourceFile, parse_file, read_source
from codegen.frontend.statements import lower_body
from codegen.ir.domains import MARKERS, Domain
from codegen.ir.nodes import Doc, Function, Parameter, StructDef, callees
from codegen.ir.types import TEXTURE, VALUE_TYPES, Field, Struct, Type
from codegen.ops import BUILTINS

LANG_NAMES = frozenset(
    {*BUILTINS, *VALUE_TYPES, *MARKERS, TEXTURE.name, "variant", "printed", "helper", "struct"} - {"bool"}
)
_DEFINITION = re.compile(r"^(def|class) (\w+)", re.MULTILINE)


class Resolver:
    """All sources below one folder; functions and structs become IR when first asked for."""

    def __init__(self, root: Path, extra: Iterable[Path] = ()) -> None:
        """`root` is the folder of the package shaderlib; raises UserError where there is none.

        Each folder of `extra` counts as one more section, named like the folder: shaderlib.<folder>.<file>.
        """
        self._paths: dict[str, tuple[Path, str]] = {}
        self._files: dict[str, SourceFile] = {}
        self._defined: dict[str, str] = {}
        self._function_names: dict[str, None] = {}  # a set in order
        self._families: dict[str, list[str]] = {}
        self._functions: dict[str, Function] = {}
        self._structs: dict[str, StructDef] = {}
        self._lowering: list[str] = []
        self._defining: list[tuple[str, str]] = []
        self._add(root, root, f"{ROOT_PACKAGE}/")
        for folder in extra:
            self._add(folder, folder.parent, "")

    def _add(self, folder: Path, base: Path, shown: str) -> None:
        """Take in the sources below a folder, as modules named by their way from `base`."""
        if not folder.is_dir():
            raise UserError(f'no shader sources: "{folder}" is not a folder')
        for path in sorted(folder.rglob("*.py")):
            relative = path.relative_to(base)
            if path.name in ("lang.py", "__init__.py"):
                continue
            module = ".".join((ROOT_PACKAGE, *relative.with_suffix("").parts))
            self._paths[module] = path, f"{shown}{relative.as_posix()}"
            self._scan(module)

    def _scan(self, module: str) -> None:
        """Note what a file defines without parsing it: one function of many needs few of the files."""
        path, shown = self._paths[module]
        for found in _DEFINITION.finditer(read_source(path, shown)):
            name = found.group(2)
            if name in self._defined and self._defined[name] != module:
                other = self._paths[self._defined[name]][1]
                line = found.string.count("\n", 0, found.start()) + 1
                place = Place(shown, line, text=found.string.splitlines()[line - 1])
                raise SourceError(place, f'"{name}" is already defined in {other}')
            self._defined[name] = module
            if found.group(1) == "def":
                self._function_names[name] = None

    def file(self, module: str) -> SourceFile:
        """The parsed file of a module."""
        if module not in self._files:
            path, shown = self._paths[module]
            file = parse_file(path, module, shown)
            for local, (source, name) in file.imports.items():
                self._check_import(file, file.import_nodes[local], source, name)
            self._files[module] = file
        return self._files[module]

    def parse_all(self) -> None:
        """Parse every file, so that a source that nothing uses yet is checked too."""
        for module in self._paths:
            self.file(module)

    def _check_import(self, file: SourceFile, node: ast.AST, module: str, name: str) -> None:
        if module == LANG:
            if name not in LANG_NAMES:
                raise file.error(node, f'{LANG} defines no "{name}"{nearest(name, LANG_NAMES)}')
        elif module not in self._paths:
            raise file.error(node, f'no source "{module}" to import{nearest(module, self._paths)}')

    @contextmanager
    def defining(self, file: SourceFile, name: str, node: ast.AST) -> Iterator[None]:
        """While the definition of a name is read: refuse a definition that leads back to itself."""
        key = file.module, name
        if key in self._defining:
            raise file.error(node, f'"{name}" is defined by itself')
        self._defining.append(key)
        try:
            yield
        finally:
            self._defining.pop()

    def needed_files(self, modules: Iterable[str]) -> dict[str, SourceFile]:
        """The files of these modules and, all the way, what they import: constants and domains count too."""
        needed: dict[str, SourceFile] = {}
        waiting = list(modules)
        while waiting:
            module = waiting.pop()
            if module not in needed:
                needed[module] = self.file(module)
                waiting += [m for m, _ in needed[module].imports.values() if m != LANG]
        return needed

    def where(self, name: str) -> SourceFile | None:
        """The file that defines a function or struct; None for an unknown name."""
        module = self._defined.get(name)
        return None if module is None else self.file(module)

    def module_of(self, name: str) -> str:
        """The module that defines a function or struct; empty for an unknown name."""
        return self._defined.get(name, "")

    def path_of(self, name: str) -> Path | None:
        """The file that defines a function or struct; None for an unknown name."""
        module = self.module_of(name)
        return self._paths[module][0] if module else None

    @property
    def names(self) -> list[str]:
        """Every function and struct of the sources."""
        return list(self._defined)

    def find(self, file: SourceFile, name: str) -> tuple[SourceFile, str] | None:
        """The file that defines `name` as seen in `file`, and its name there; None for built-in names."""
        if name in file.imports:
            module, original = file.imports[name]
            if module == LANG:
                return None
            found = self.file(module)
            if original in found.imports:
                with self.defining(file, name, file.import_nodes[name]):
                    return self.find(found, original)
            defined = [*found.values, *found.structs, *found.functions]
            if original not in defined:
                sentence = f'{found.shown_path} defines no "{original}"{nearest(original, defined)}'
                raise file.error(file.import_nodes[name], sentence)
            return found, original
        if name in file.values or name in file.structs or name in file.functions:
            return file, name
        return None

    def constant(self, file: SourceFile, name: str) -> constants.Number | None:
        """The value of a named constant as seen in `file`; None where the name is not a constant."""
        where, original = self.find(file, name) or (file, name)
        if original not in where.values:
            return None
        value = where.values[original]
        with self.defining(where, original, value):
            return constants.fold(value, lambda n: self.constant(where, n))

    def constant_type(self, file: SourceFile, name: str) -> Type | None:
        """The type that a constant's annotation states; None without one."""
        where, original = self.find(file, name) or (file, name)
        node = where.annotations.get(original)
        return stated.read(self, where, node, node)[0] if node is not None else None

    def struct(self, file: SourceFile, name: str) -> StructDef:
        """The struct that `file` defines under `name`."""
        if name not in self._structs:
            node = file.structs[name]
            names.check(name, "struct", file.place(node))
            if [ast.unparse(d) for d in node.decorator_list] != ["struct"]:
                sentence = (
                    "a class in a shader source is a struct: decorate it with @struct, and nothing else"
                )
                raise file.error(node, sentence)
            if further := [*node.bases, *node.keywords]:
                raise file.error(further[0], "a struct is made of no other class")
            doc = self._doc(file, node)
            fields: list[Field] = []
            for item in node.body:
                match item:
                    case ast.Expr(value=ast.Constant(value=str())):
                        pass
                    case ast.AnnAssign(target=ast.Name(id=field), annotation=annotation, value=None):
                        names.check(field, "field", file.place(item))
                        if any(f.name == field for f in fields):
                            raise file.error(item, f'field "{field}" is given twice')
                        with self.defining(file, name, item):
                            type_, domain = stated.read(self, file, annotation, item)
                        if type_ == TEXTURE:
                            raise file.error(item, "a texture is a parameter; no struct holds one")
                        fields.append(
                            Field(field, type_, self._needs_domain(file, item, field, type_, domain))
                        )
                    case _:
                        raise file.error(item, "a struct holds annotated fields and a docstring only")
            if not fields:
                raise file.error(node, "a struct needs a field")
            self._structs[name] = StructDef(Struct(name, tuple(fields)), file.section, doc, file.place(node))
        return self._structs[name]

    def function(self, name: str) -> Function:
        """The IR of a function; raises UserError for an unknown name, SourceError for a bad source."""
        if name in self._functions:
            return self._functions[name]
        file = self.where(name)
        if file is None or name not in file.functions:
            raise unknown("function", name, self.function_names())
        node = file.functions[name]
        if name in self._lowering:
            cycle = " -> ".join([*self._lowering[self._lowering.index(name) :], name])
            raise file.error(node, f"recursion is not possible in shaders: {cycle}")
        self._lowering.append(name)
        try:
            lowered = self._lower(file, node)
            for callee in callees(lowered):
                self.function(callee)
        finally:
            self._lowering.pop()
        self._functions[name] = lowered
        return lowered

    def function_names(self) -> list[str]:
        """Every function of the sources."""
        return list(self._function_names)

    def defines(self, name: str) -> bool:
        """Whether a source defines a function of that name."""
        return name in self._function_names

    def family(self, name: str) -> list[str]:
        """The functions of the file that defines a name, and of the files named after it."""
        module = self.module_of(name)
        if module not in self._families:
            self._families[module] = [
                other
                for other in self._function_names
                if (found := self.module_of(other)) == module or found.startswith(f"{module}_")
            ]
        return self._families[module]

    def struct_names(self) -> list[str]:
        """Every struct of the sources."""
        return [name for name in self._defined if name not in self._function_names]

    def signature(self, file: SourceFile, node: ast.FunctionDef) -> tuple[tuple[Parameter, ...], Type]:
        """Parameters and result type of a function, from its annotations alone."""
        a = node.args
        extra = [*a.posonlyargs, *a.kwonlyargs, *filter(None, (a.vararg, a.kwarg)), *a.defaults]
        if extra:
            raise file.error(extra[0], "a shader function has plain parameters without defaults")
        parameters: list[Parameter] = []
        for argument in a.args:
            names.check(argument.arg, "parameter", file.place(argument))
            if any(p.name == argument.arg for p in parameters):
                raise file.error(argument, f'parameter "{argument.arg}" is given twice')
            type_, domain = stated.read(self, file, argument.annotation, argument)
            domain = self._needs_domain(file, argument, argument.arg, type_, domain)
            parameters.append(Parameter(argument.arg, type_, domain))
        returns = stated.read(self, file, node.returns, node)[0]
        if returns == TEXTURE:
            raise file.error(node, "a texture is a parameter; no function returns one")
        return tuple(parameters), returns

    def kind(self, file: SourceFile, node: ast.FunctionDef) -> tuple[str, str | None]:
        """What the decorators say: the function's kind and, for variants and printed forms, its base."""
        if len(node.decorator_list) > 1:
            raise file.error(node.decorator_list[1], "a function has one decorator at most")
        for decorator in node.decorator_list:
            match decorator:
                case ast.Name(id="helper"):
                    return "helper", None
                case ast.Call(
                    func=ast.Name(id=("variant" | "printed") as kind),
                    args=[ast.Constant(value=str() as base)],
                ):
                    if base == node.name:
                        raise file.error(decorator, f'"{base}" cannot be its own base')
                    if base not in self._function_names:
                        near = nearest(base, (n for n in self.function_names() if n != node.name))
                        raise file.error(decorator, f'unknown base "{base}"{near}')
                    return kind, base
                case _:
                    raise file.error(
                        decorator, 'decorators are @helper, @variant("base") and @printed("base")'
                    )
        return "base", None

    def _needs_domain(
        self, file: SourceFile, node: ast.AST, name: str, type_: Type, domain: Domain | None
    ) -> Domain | None:
        if (
            domain is None
            and not isinstance(type_, Struct)
            and type_.name not in ("bool", "u32", "i32", "uvec2", "uvec3")
        ):
            raise file.error(node, f'state the domain of "{name}": Annotated[{type_.name}, Interval(...)]')
        return domain

    @staticmethod
    def _doc(file: SourceFile, node: ast.FunctionDef | ast.ClassDef) -> Doc:
        text = ast.get_docstring(node) or ""
        if "\\" in text:
            raise file.error(
                node.body[0], "a backslash in a docstring would continue the emitted comment line"
            )
        return docstring.parse(text)

    def _lower(self, file: SourceFile, node: ast.FunctionDef) -> Function:
        names.check(node.name, "function", file.place(node))
        parameters, returns = self.signature(file, node)
        kind, base = self.kind(file, node)
        doc = self._doc(file, node)
        try:
            body = lower_body(self, file, node, parameters, returns)
        except RecursionError:
            raise file.error(node, f'an expression of "{node.name}" is nested too deeply') from None
        return Function(node.name, file.section, kind, base, parameters, returns, body, doc, file.place(node))
