"""Who may import whom.

Plan. Every Python file of the project is parsed, never imported, and its imports are held against the
directions of the design:
  shaderlib               itself and the typing module; it is source text for the front end
  codegen                 neither targets nor conformance nor a GPU package; only the command line loads
                          them, by name and lazily
  targets                 never another target; outside dialect files nothing of the project but targets
  conformance.reference   numpy, scipy, mpmath and the standard library
  everything else         not conformance
A GPU package is imported where a device is opened, so that importing a module never needs a driver. No module
imports itself through others, not even late, inside a function.
"""

import ast
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PROJECT = {"shaderlib", "codegen", "targets", "conformance", "examples"}
GPU_PACKAGES = {"moderngl", "wgpu", "pyopencl"}
TARGETS = {"glsl", "wgsl", "opencl"}
LOADERS = {"import_module", "__import__", "find_spec"}
# The composition root: the only files of codegen that may name what lies above codegen.
COMPOSITION_ROOT = ("codegen/cli.py", "codegen/backends.py", "codegen/commands/")
MODULE_NAME = re.compile(r"(targets|conformance)(\.[a-z_]\w*)+(:\w+)?")


@dataclass(frozen=True)
class Import:
    """One imported module: its dotted name, its line, and whether it is imported on import of the file."""

    name: str
    line: int
    at_import: bool

    @property
    def package(self) -> str:
        return self.name.partition(".")[0]


def files_under(folder: str) -> list[str]:
    return sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / folder).rglob("*.py"))


def absolute(path: str, node: ast.ImportFrom) -> str:
    """The dotted name that a possibly relative import means in the file at path."""
    if node.level == 0:
        return node.module or ""
    package = list(Path(path).parent.parts)
    return ".".join(package[: len(package) - node.level + 1] + ([node.module] if node.module else []))


def is_type_checking(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and ast.unparse(node.test) in {"TYPE_CHECKING", "typing.TYPE_CHECKING"}


def walk(node: ast.AST, at_import: bool = True) -> Iterator[tuple[ast.AST, bool]]:
    """Every node below, with whether it runs when the file is imported."""
    for child in ast.iter_child_nodes(node):
        deferred = isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda)) or is_type_checking(
            child
        )
        yield child, at_import
        yield from walk(child, at_import and not deferred)


@cache
def imports(path: str) -> list[Import]:
    found = []
    for node, at_import in walk(ast.parse((ROOT / path).read_text(encoding="utf-8"), path)):
        if isinstance(node, ast.Import):
            found += [Import(alias.name, node.lineno, at_import) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            module = absolute(path, node)
            # "from targets import glsl" names targets.glsl as much as "import targets.glsl" does.
            found += [Import(f"{module}.{alias.name}", node.lineno, at_import) for alias in node.names]
    return found


def refuse(path: str, bad: list[Import], rule: str) -> None:
    lines = "\n".join(f"  {path}:{item.line} imports {item.name}" for item in bad)
    assert not bad, f"{rule}\n{lines}"


@pytest.mark.parametrize("path", files_under("shaderlib"))
def test_shaderlib_imports_only_shaderlib(path: str) -> None:
    allowed = {"shaderlib", "typing", "__future__"}
    if path == "shaderlib/lang.py":
        allowed |= {"collections", "dataclasses"}
    refuse(path, [item for item in imports(path) if item.package not in allowed], "shaderlib is only parsed")


@pytest.mark.parametrize("path", files_under("codegen"))
def test_codegen_imports_nothing_above_it(path: str) -> None:
    above = {"shaderlib", "targets", "conformance", "examples"} | GPU_PACKAGES
    refuse(path, [item for item in imports(path) if item.package in above], "codegen knows no target")


@pytest.mark.parametrize(
    "path", [path for path in files_under("codegen") if not path.startswith(COMPOSITION_ROOT)]
)
def test_only_the_command_line_loads_targets_by_name(path: str) -> None:
    tree = ast.parse((ROOT / path).read_text(encoding="utf-8"), path)
    bad = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and ast.unparse(node.func).rpartition(".")[2] in LOADERS:
            bad.append(f"  {path}:{node.lineno} {ast.unparse(node)}")
        elif (
            isinstance(node, ast.Constant)
            and isinstance(node.value, str)
            and MODULE_NAME.fullmatch(node.value)
        ):
            bad.append(f"  {path}:{node.lineno} names the module {node.value}")
    assert not bad, "only codegen/cli.py and codegen/commands load by name\n" + "\n".join(bad)


@pytest.mark.parametrize("path", files_under("targets"))
def test_targets_see_text_and_arrays_only(path: str) -> None:
    above = {"shaderlib", "conformance", "examples"}
    if not Path(path).name.startswith("dialect"):
        above |= {"codegen"}
    refuse(path, [item for item in imports(path) if item.package in above], "a runtime sees text and arrays")


@pytest.mark.parametrize("path", files_under("targets"))
def test_no_target_imports_another(path: str) -> None:
    folder = Path(path).parts[1]
    others = TARGETS - {folder} if folder in TARGETS else set()
    bad = [item for item in imports(path) if item.package == "targets" and item.name.split(".")[1] in others]
    refuse(path, bad, "no target imports another")


@pytest.mark.parametrize("path", files_under("conformance/reference"))
def test_references_share_nothing_with_the_project(path: str) -> None:
    allowed = {"numpy", "scipy", "mpmath"} | sys.stdlib_module_names
    bad = [
        item
        for item in imports(path)
        if item.package not in allowed and not item.name.startswith("conformance.reference")
    ]
    refuse(path, bad, "a reference is written from the paper, with numpy, scipy and mpmath only")


@pytest.mark.parametrize(
    "path", [path for folder in sorted(PROJECT - {"conformance"}) for path in files_under(folder)]
)
def test_nothing_imports_conformance(path: str) -> None:
    refuse(
        path, [item for item in imports(path) if item.package == "conformance"], "nothing imports conformance"
    )


@pytest.mark.parametrize("path", [path for folder in sorted(PROJECT) for path in files_under(folder)])
def test_gpu_packages_are_imported_where_a_device_is_opened(path: str) -> None:
    bad = [item for item in imports(path) if item.package in GPU_PACKAGES and item.at_import]
    refuse(path, bad, "importing a module must not need a driver; import the GPU package inside the function")


def file_of(name: str) -> str | None:
    """The file of a dotted name that is a module, a package or something inside one."""
    stem = name.replace(".", "/")
    candidates = (f"{stem}.py", f"{stem}/__init__.py")
    return next((path for path in candidates if (ROOT / path).is_file()), None)


def test_no_circle_of_imports() -> None:
    graph: dict[str, set[str]] = {}
    for path in (path for folder in sorted(PROJECT) for path in files_under(folder)):
        names = {item.name for item in imports(path) if item.package in PROJECT}
        found = {file_of(name) or file_of(name.rpartition(".")[0]) for name in names}
        graph[path] = {file for file in found if file is not None} - {path}
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(f"a circle of imports: {' <- '.join(error.args[1])}")


def test_the_folders_are_there() -> None:
    """Guards the tests above against passing because they looked at nothing."""
    assert not [folder for folder in sorted(PROJECT) if not files_under(folder)]
    assert files_under("conformance/reference")
