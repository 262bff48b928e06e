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
from collections.abc import Callable, Iterable, Iterator
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


BLOCKS = ("body", "orelse", "finalbody", "handlers", "cases")


def statements(node: ast.AST, at_import: bool = True) -> Iterator[tuple[ast.AST, bool]]:
    """Every statement below, with whether it runs when the file is imported."""
    for child in (child for block in BLOCKS for child in getattr(node, block, ())):
        yield child, at_import
        deferred = isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef)) or is_type_checking(child)
        yield from statements(child, at_import and not deferred)


def parsed(path: str) -> ast.Module:
    return ast.parse((ROOT / path).read_text(encoding="utf-8"), path)


@cache
def imports(path: str) -> list[Import]:
    found = []
    for node, at_import in statements(parsed(path)):
        if isinstance(node, ast.Import):
            found += [Import(alias.name, node.lineno, at_import) for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            module = absolute(path, node)
            # "from targets import glsl" names targets.glsl as much as "import targets.glsl" does.
            found += [Import(f"{module}.{alias.name}", node.lineno, at_import) for alias in node.names]
    return found


@cache
def files_of(*folders: str) -> tuple[str, ...]:
    return tuple(path for folder in folders for path in files_under(folder))


def refuse(rule: str, paths: Iterable[str], is_bad: Callable[[str, Import], bool]) -> None:
    """Fail with every import of the files that is_bad(path, import) names."""
    bad = [(path, item) for path in paths for item in imports(path) if is_bad(path, item)]
    assert not bad, f"{rule}\n" + "\n".join(f"  {path}:{item.line} imports {item.name}" for path, item in bad)


def test_shaderlib_imports_only_shaderlib() -> None:
    def is_bad(path: str, item: Import) -> bool:
        allowed = {"shaderlib", "typing", "__future__"}
        if path == "shaderlib/lang.py":
            allowed |= {"collections", "dataclasses"}
        return item.package not in allowed

    refuse("shaderlib is only parsed", files_of("shaderlib"), is_bad)


def test_codegen_imports_nothing_above_it() -> None:
    above = {"shaderlib", "targets", "conformance", "examples"} | GPU_PACKAGES
    refuse("codegen knows no target", files_of("codegen"), lambda _, item: item.package in above)


def test_only_the_command_line_loads_targets_by_name() -> None:
    bad = []
    for path in files_of("codegen"):
        if path.startswith(COMPOSITION_ROOT):
            continue
        for node in ast.walk(parsed(path)):
            if isinstance(node, ast.Call) and ast.unparse(node.func).rpartition(".")[2] in LOADERS:
                bad.append(f"  {path}:{node.lineno} {ast.unparse(node)}")
            elif (
                isinstance(node, ast.Constant)
                and isinstance(node.value, str)
                and MODULE_NAME.fullmatch(node.value)
            ):
                bad.append(f"  {path}:{node.lineno} names the module {node.value}")
    assert not bad, "only codegen/cli.py and codegen/commands load by name\n" + "\n".join(bad)


def test_targets_see_text_and_arrays_only() -> None:
    def is_bad(path: str, item: Import) -> bool:
        above = {"shaderlib", "conformance", "examples"}
        if not Path(path).name.startswith("dialect"):
            above |= {"codegen"}
        return item.package in above

    refuse("a runtime sees text and arrays", files_of("targets"), is_bad)


def test_no_target_imports_another() -> None:
    def is_bad(path: str, item: Import) -> bool:
        folder = Path(path).parts[1]
        others = TARGETS - {folder} if folder in TARGETS else set()
        return item.package == "targets" and item.name.split(".")[1] in others

    refuse("no target imports another", files_of("targets"), is_bad)


def test_references_share_nothing_with_the_project() -> None:
    allowed = {"numpy", "scipy", "mpmath"} | sys.stdlib_module_names
    refuse(
        "a reference is written from the paper, with numpy, scipy and mpmath only",
        files_of("conformance/reference"),
        lambda _, item: item.package not in allowed and not item.name.startswith("conformance.reference"),
    )


def test_nothing_imports_conformance() -> None:
    refuse(
        "nothing imports conformance",
        files_of(*sorted(PROJECT - {"conformance"})),
        lambda _, item: item.package == "conformance",
    )


def test_gpu_packages_are_imported_where_a_device_is_opened() -> None:
    refuse(
        "importing a module must not need a driver; import the GPU package inside the function",
        files_of(*sorted(PROJECT)),
        lambda _, item: item.package in GPU_PACKAGES and item.at_import,
    )


def file_of(name: str) -> str | None:
    """The file of a dotted name that is a module, a package or something inside one."""
    stem = name.replace(".", "/")
    candidates = (f"{stem}.py", f"{stem}/__init__.py")
    return next((path for path in candidates if (ROOT / path).is_file()), None)


def test_no_circle_of_imports() -> None:
    graph: dict[str, set[str]] = {}
    for path in files_of(*sorted(PROJECT)):
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
