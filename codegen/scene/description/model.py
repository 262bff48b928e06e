"""A shading function as a scene sees it: its parameters taken apart, each with the part it plays."""

from __future__ import annotations

from dataclasses import dataclass

from codegen.errors import nearest
from codegen.ir.domains import Domain, Unit
from codegen.ir.nodes import Function
from codegen.ir.types import VEC3, Struct, Type
from codegen.library import Library
from codegen.scene.description.tables import Table

SUFFIX = "_shade"
LIGHT, COLOUR, HALF, VIEWER = "l", "light", "h", "v"
"""Parameters of shading functions that the lights of a scene provide: direction to the light, its colour, and
the half vector of light and viewer."""


@dataclass(frozen=True)
class Slot:
    """One parameter, or one field of a struct parameter.

    path    as a scene file names it: "optics.exponent", "t"
    name    as the result names it: the last part of the path, or all of it where that is taken
    """

    path: str
    name: str
    type: Type
    domain: Domain | None
    doc: str


@dataclass(frozen=True)
class Model:
    """A shading function and its slots in order."""

    function: Function
    slots: dict[str, Slot]

    @property
    def settable(self) -> dict[str, Slot]:
        """What [parameters] may speak of: everything that no light provides."""
        return {path: s for path, s in self.slots.items() if path not in (LIGHT, COLOUR, HALF)}

    @property
    def directions(self) -> dict[str, Slot]:
        """Unit vectors of the model, and the viewer where a half vector needs it."""
        found = {p: s for p, s in self.slots.items() if isinstance(s.domain, Unit) and s.type == VEC3}
        if HALF in found and VIEWER not in found:
            found[VIEWER] = Slot(VIEWER, VIEWER, VEC3, Unit(), "direction to the viewer; unit vector")
        return found

    @property
    def takes_colour(self) -> bool:
        """Whether the function multiplies by the colour of the light itself."""
        return COLOUR in self.slots


def find_model(library: Library, shade: Table) -> Model:
    """The model that [shade] names, with or without its ending "_shade"."""
    named = [n for n in library.resolver.function_names() if SUFFIX in n]
    models = {n.removesuffix(SUFFIX): n for n in named} | {n: n for n in named}
    name = shade.text("model")
    f = library.function(models[name]) if name in models else None
    if f is None or f.returns != VEC3 or not f.public:
        short = [n.removesuffix(SUFFIX) for n in named if n.endswith(SUFFIX)]
        raise shade.error("model", f'unknown model "{name}"{nearest(name, short)}')
    return Model(*_taken_apart(f, library))


def _taken_apart(f: Function, library: Library) -> tuple[Function, dict[str, Slot]]:
    found: list[tuple[str, Type, Domain | None, str]] = []

    def visit(path: str, type_: Type, domain: Domain | None, doc: str) -> None:
        if isinstance(type_, Struct):
            docs = library.struct(type_.name).doc.entries
            for field in type_.fields:
                visit(f"{path}.{field.name}", field.type, field.domain, docs.get(field.name, ""))
        else:
            found.append((path, type_, domain, doc))

    for p in f.parameters:
        visit(p.name, p.type, p.domain, f.doc.entries.get(p.name, ""))
    last = [path.rpartition(".")[2] for path, *_ in found]
    slots = {}
    for path, type_, domain, doc in found:
        short = path.rpartition(".")[2]
        name = short if last.count(short) == 1 else path.replace(".", "_")
        slots[path] = Slot(path, name, type_, domain, doc)
    return f, slots
