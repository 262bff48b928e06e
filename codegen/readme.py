"""The generated parts of README.md, between <!-- generated: NAME --> and <!-- end -->."""

from __future__ import annotations

import re

from codegen.backends import TARGETS, dialect
from codegen.emit.module import DEFAULT_PREFIX, emit_selection
from codegen.errors import UserError
from codegen.library import Library

EXAMPLE = "strand_specular_half"
_PART = re.compile(r"(<!-- generated: ([\w-]+) -->\n).*?(<!-- end -->)", re.DOTALL)
_FENCES = {"glsl": "glsl", "wgsl": "wgsl", "opencl": "c"}


def with_generated_parts(text: str, library: Library) -> str:
    """The README with its generated parts renewed; raises UserError for a part nobody generates."""
    parts = {"example": _example, "functions": _functions}

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
    sections = dict.fromkeys(f.module for f in library.public.values())
    for section in sections:
        own = [f for f in library.public.values() if f.module == section]
        base = ", ".join(f"`{f.name}`" for f in own if f.kind == "base")
        others = sum(f.kind != "base" for f in own)
        rows.append(f"| {section} | {base} | {others} |")
    return "\n".join(rows)
