"""The generated parts of README.md, between <!-- generated: NAME --> and <!-- end -->."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from codegen.backends import TARGETS, dialect
from codegen.costs import entry, recorded, results_folder
from codegen.emit.module import DEFAULT_PREFIX, emit_selection
from codegen.errors import UserError
from codegen.library import Library, default_root

EXAMPLE = "strand_specular_half"
SPEED = ("sin_angle", "strand_specular", "strand_azimuth_cosine", "fakefur_shade", "fur_weights_slab")
"""Functions of the speed table, each with its variants and printed forms."""
PICTURE = "overview.png"
PICTURE_TEXT = "Every variant: time relative to the default form against error in 8-bit steps, per driver"
_PART = re.compile(r"(<!-- generated: ([\w-]+) -->\n).*?(<!-- end -->)", re.DOTALL)
_FENCES = {"glsl": "glsl", "wgsl": "wgsl", "opencl": "c"}


def with_generated_parts(text: str, library: Library) -> str:
    """The README with its generated parts renewed; raises UserError for a part nobody generates."""
    parts = {"example": _example, "functions": _functions, "speed": speed}

    def renew(match: re.Match[str]) -> str:
        name = match.group(2)
        if name not in parts:
            raise UserError(f'README.md: nothing generates the part "{name}"')
        return f"{match.group(1)}{parts[name](library)}\n{match.group(3)}"

    return _PART.sub(renew, text)


def _example(library: Library) -> str:
    blocks = []
    for target in TARGETS:
        d = dialect(target)
        lines = emit_selection(library, d, library.select([EXAMPLE]), DEFAULT_PREFIX)
        own = _last_function(lines, comment=target == TARGETS[0])
        blocks.append(f"{d.title}:\n```{_FENCES[target]}\n" + "\n".join(own) + "\n```")
    return "\n\n".join(blocks)


def _last_function(lines: list[str], *, comment: bool) -> list[str]:
    start = len(lines) - lines[::-1].index("") if "" in lines else 0
    block = lines[start:]
    return block if comment else [line for line in block if not line.startswith("//")]


def _functions(library: Library) -> str:
    rows = ["| section | functions | variants and printed forms |", "|---|---|---|"]
    sections = dict.fromkeys(f.module for f in library.documented.values())
    for section in sections:
        own = [f for f in library.documented.values() if f.module == section]
        base = ", ".join(f"`{f.name}`" for f in own if f.kind == "base")
        others = sum(f.kind != "base" for f in own)
        rows.append(f"| {section} | {base} | {others} |")
    return "\n".join(rows)


def speed(library: Library, folder: Path | None = None) -> str:
    """Recorded speed beside error, one pair of columns per driver; empty where nothing is recorded."""
    results = [r for target in TARGETS for r in recorded(folder) if r["device"]["target"] == target]
    if not results:
        return ""
    drivers = [r["device"]["short"] for r in results]
    head = " | ".join(f"{d}: time | error" for d in drivers)
    rows = [f"| function | measure | {head} |", f"|---|---|{'---:|---:|' * len(drivers)}"]
    for base in (name for name in SPEED if name in library.public):
        for f in results[0]["functions"]:
            if f["base"] == base and f["name"] in library.public:
                rows += _speed_row(results, f["name"], base)
    return "\n".join([*_picture(folder or results_folder()), *rows, "", _speed_method(results)])


def _picture(folder: Path) -> list[str]:
    """The recorded overview, where there is one."""
    file, root = folder / PICTURE, default_root().parent
    if not file.exists() or not file.is_relative_to(root):
        return []
    return [f"![{PICTURE_TEXT}]({file.relative_to(root).as_posix()})", ""]


def _speed_row(results: list[dict[str, Any]], name: str, base: str) -> list[str]:
    cells, measure = [], ""
    for result in results:
        data = entry(result, name)
        if data is None:
            cells += ["", ""]
            continue
        error = data["error"] or {"measure": "", "max": None}
        measure = measure or error["measure"]
        cells += [_time(data["speed"]["throughput"], own=name == base), _short(error["max"])]
    return [f"| `{name}` | {measure} | {' | '.join(cells)} |"] if any(cells) else []


def _time(timing: dict[str, Any], *, own: bool) -> str:
    if own:
        return f"{_short(timing['net_ns'])} ns"
    return "" if timing["ratio"] is None else f"x {timing['ratio']:.2f}"


def _short(value: float | None) -> str:
    if value is None:
        return ""
    return f"{value:.0f}" if 100.0 <= value < 1e4 else f"{value:.2g}"


def _speed_method(results: list[dict[str, Any]]) -> str:
    first = results[0]
    drivers = "; ".join(f"{r['device']['short']}: {r['device']['driver']}" for r in results)
    return (
        "Time of a base function: nanoseconds per evaluation above a kernel that adds up the inputs, eight "
        "independent chains, one thread; of the others: its multiple, the median of interleaved rounds. A "
        "ratio holds for its driver only. Error: largest over uniform and hard inputs; of a printed form, "
        f"against the printed formula. {first['machine']['cpu']}; {drivers}; {first['method']['clock']}. "
        "`./dev report` measures anew; [conformance/bench](conformance/bench) says how."
    )
