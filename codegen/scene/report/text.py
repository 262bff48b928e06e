"""The file of one target: header, guard, comment and function, in the manner of `vair emit`."""

from __future__ import annotations

import re
from dataclasses import replace

from codegen.backends import dialect
from codegen.emit.definition import Definition
from codegen.emit.dialect import Dialect
from codegen.emit.frame import DIRECTIONS, FINITE, file_text, header
from codegen.emit.literal import shortest
from codegen.emit.module import DEFAULT_PREFIX, definitions, emit_selection
from codegen.ir import nodes as ir
from codegen.ir.domains import Domain, Interval, number
from codegen.library import Library
from codegen.scene.description.document import Scene
from codegen.scene.general import General
from codegen.scene.reduction.reduce import Reduced

_INTERVAL = re.compile(r",? in \[[^\]]*\]")
"""An interval as the comments of sources tell it."""


def file_name(scene: Scene, target: str) -> str:
    """The name of a target's file: fox_at_noon_shade.glsl."""
    return f"{scene.function}.{dialect(target, scene.dialects[target]).extension}"


def documented(scene: Scene, general: General, reduced: Reduced) -> ir.Function:
    """The final function with a comment that says what it is for and what it leaves out."""
    f = reduced.final.function
    source = scene.model.function
    entries = {p.name: _told(p, general) for p in f.parameters}
    entries["returns"] = (
        f"radiance towards the viewer of {_lights(scene)}, in the unit of the lights' colours"
    )
    if reduced.changes:
        largest = number(float(f"{reduced.error.largest:.2g}"))
        entries["error"] = (
            f"absolute <= {number(float(f'{scene.budget:.3g}'))} against {source.name} over the scene's "
            f"ranges; predicted {largest}"
        )
    else:
        entries["error"] = f"none beside {source.name}: exact passes only"
    brief = dict.fromkeys(c.brief or c.what for c in reduced.changes)
    entries["form"] = "; ".join([f"{source.name} for what the scene leaves open", *brief])
    if scene.facts:
        known = [f"{a}.{b} in [{number(low)}, {number(high)}]" for (a, b), (low, high) in scene.facts.items()]
        entries["degenerate"] = f"outside of {', '.join(known)} the value is not specified"
    entries["source"] = source.doc.entries.get("source", "")
    kept = {key: text for key, text in entries.items() if text}
    summary = f'{source.name} for the scene "{_plain(scene.name)}", what it fixes folded in.'
    domains = {name: general.slots[name].domain for name in (p.name for p in general.function.parameters)}
    narrowed = {p.name: p.domain or domains.get(p.name) for p in f.parameters}
    parameters = tuple(replace(p, domain=_readable(narrowed[p.name])) for p in f.parameters)
    return replace(f, parameters=parameters, doc=ir.Doc(summary, kept), kind="base", base=None)


def _told(p: ir.Parameter, general: General) -> str:
    """What the source says of a parameter; without its interval where the scene has a narrower one."""
    text = general.function.doc.entries.get(p.name, "")
    wide = general.slots[p.name].domain
    if isinstance(p.domain, Interval) and isinstance(wide, Interval) and p.domain != wide:
        return _INTERVAL.sub("", text)
    return text


def _readable(domain: Domain | None) -> Domain | None:
    """The domain with float32 ends written as briefly as they can be: 0.4 and not 0.400000006."""
    if not isinstance(domain, Interval):
        return domain
    return replace(domain, low=float(shortest(domain.low)), high=float(shortest(domain.high)))


def _lights(scene: Scene) -> str:
    lights = scene.lights
    parts = [
        f"{count} {kind} light{'s' if count > 1 else ''}"
        for count, kind in ((lights.directional, "directional"), (lights.point, "point"))
        if count
    ]
    if lights.environment is not None:
        parts.append(f'{lights.environment_lights} constant lights of "{_plain(lights.environment.name)}"')
    return " and ".join(parts)


def _plain(text: str) -> str:
    return text.encode("ascii", "replace").decode("ascii").replace('"', "'")


def emitted(
    library: Library, scene: Scene, general: General, reduced: Reduced, prefix: str = DEFAULT_PREFIX
) -> str:
    """The text of the target's file."""
    return file_text(*included(library, scene, general, reduced, prefix))


def included(
    library: Library, scene: Scene, general: General, reduced: Reduced, prefix: str = DEFAULT_PREFIX
) -> tuple[Dialect, list[str], list[Definition]]:
    """The dialect, the header and the definitions of the target's file."""
    chosen = dialect(reduced.target, scene.dialects[reduced.target])
    extended = library.with_functions([documented(scene, general, reduced)])
    selection = extended.select([scene.function])
    defined = definitions(extended, chosen, selection, prefix)
    named = "" if prefix == DEFAULT_PREFIX else f", prefix {prefix}"
    head = header(
        chosen,
        f"vair scene {scene.path.name}, target {chosen.target}, dialect {chosen.name}{named}",
        f"Budget {_plain(scene.budget_text)}; source hash {selection.source_hash}",
        f"{DIRECTIONS} Colours are linear RGB. {FINITE}",
    )
    return chosen, head, defined


def line_counts(
    library: Library, scene: Scene, general: General, target: str, written: str
) -> dict[str, int]:
    """Lines of code without comments: the general function with all it calls, and what is written."""
    chosen = dialect(target, scene.dialects[target])
    before = emit_selection(library, chosen, library.select([general.function.name]), DEFAULT_PREFIX)
    return {"general": _code_lines(before), "final": _code_lines(written.splitlines())}


def _code_lines(lines: list[str]) -> int:
    """Lines that are neither empty nor a comment nor for the preprocessor."""
    return sum(bool(line.strip()) and not line.lstrip().startswith(("//", "#")) for line in lines)


def spirv_texts(
    library: Library, scene: Scene, general: General, reduced: Reduced
) -> dict[str, tuple[str, str]]:
    """GLSL for Vulkan of both, and the prefix of what is to be counted there."""
    chosen = dialect("glsl", "vulkan450")
    final = library.with_functions([reduced.final.function])
    found: dict[str, tuple[str, str]] = {}
    for key, source, name in (("general", library, general.function.name), ("final", final, scene.function)):
        lines = emit_selection(source, chosen, source.select([name]), DEFAULT_PREFIX)
        found[key] = "\n".join(lines), DEFAULT_PREFIX
    return found
