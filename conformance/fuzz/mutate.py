"""Damaged sources: small random changes to valid programs, each of which must be read or refused in words."""

from __future__ import annotations

import re

from conformance.fuzz.choices import Choice

TOKEN = re.compile(r"[A-Za-z_]\w*|\d+\.\d+|\d+|\*\*|//|<<|>>|[<>=!]=|->|\S|\n *")
FOREIGN = (
    "while x:", "lambda: 0", "[1.0, 2.0]", "x[0]", "{}", "yield", "None", "'text'", "f'{x}'", "...",
    "@", ":=", "**", "import os", "global x", "del x", "pass", "break", "try:", "class", "async",
    "await x", "*x", "is", "in", "0x", "1e999", "1e-60", "99999999999", "-1", "0", "1j", "float",
    "half", "__x", "vec3", "u32", "True", "not", "range(3)", "range(x)", "sqrt", "sqrt()", "vec3(1.0)",
    "mat4", "a.b.c", ".xyzw", ".rgb", "\t", "\\", "\x00", "é", "lambda", "return", "if", "else", "elif",
    "for", "def f():", "nonlocal y", "raise", "with a as b:", "print(x)", "1_000.0", "0.1.2",
    "x: f32 = 1.0", "Interval(2.0, 1.0)", "Annotated", "struct", "helper", "variant('a')",
)  # fmt: skip
"""Pieces from outside the subset, and pieces of it in the wrong place."""


def mutant(choice: Choice, text: str) -> str:
    """The text with one to three changes of its tokens or letters."""
    for _ in range(choice.choice((1, 1, 1, 2, 3))):
        text = _change(choice, text)
    return text


def _change(choice: Choice, text: str) -> str:
    spans = [m.span() for m in TOKEN.finditer(text)]
    if not spans:
        return choice.choice(FOREIGN)
    start, end = choice.choice(spans)
    other = text[slice(*choice.choice(spans))]
    kind = choice.one(foreign=4, delete=3, copy=4, twice=2, letter=2, line=2, insert=3, indent=1)
    match kind:
        case "foreign":
            return text[:start] + choice.choice(FOREIGN) + text[end:]
        case "delete":
            return text[:start] + text[end:]
        case "copy":
            return text[:start] + other + text[end:]
        case "twice":
            return text[:end] + " " + text[start:end] + text[end:]
        case "insert":
            return text[:end] + " " + choice.choice((*FOREIGN, other)) + " " + text[end:]
        case "letter":
            at = choice.randrange(len(text))
            return text[:at] + choice.choice("()[]{}.,:=+-*/<>&|^~%@!# \n\"'0a_") + text[at + 1 :]
        case "line":
            lines = text.split("\n")
            at, to = choice.randrange(len(lines)), choice.randrange(len(lines))
            lines[at], lines[to] = lines[to], lines[at]
            return "\n".join(lines)
        case _:
            lines = text.split("\n")
            at = choice.randrange(len(lines))
            lines[at] = choice.choice(("    ", "")) + lines[at].lstrip()
            return "\n".join(lines)
