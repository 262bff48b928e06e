"""Reads damaged sources: each gives well-formed IR or one sentence, never another exception."""

from __future__ import annotations

import tempfile
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

from codegen.backends import TARGETS, dialect
from codegen.emit.module import emit
from codegen.errors import UserError
from codegen.ir.verify import verify_selection
from codegen.library import Library
from conformance.fuzz.case import HEADER, make_case
from conformance.fuzz.choices import Choice
from conformance.fuzz.mutate import mutant

MUTANTS = 20
"""Damaged versions of each program."""


@dataclass
class Refusals:
    """Counts, and the sources that were answered with something else than a sentence."""

    accepted: int = 0
    refused: int = 0
    sentences: Counter[str] = field(default_factory=Counter)
    crashes: list[tuple[int, int, str, str]] = field(default_factory=list)

    def lines(self) -> list[str]:
        """A summary."""
        total = self.accepted + self.refused + len(self.crashes)
        return [
            f"{total} damaged sources: {self.refused} refused in {len(self.sentences)} kinds of sentences, "
            f"{self.accepted} still valid, {len(self.crashes)} crashes"
        ]


def damaged(seed: int, number: int, version: int) -> str:
    """The damaged version of a program, the same each time."""
    choice = Choice((seed * 1_000_003 + number) * 1_009 + version + 1)
    return mutant(choice, HEADER + "\n\n" + make_case(seed, number).text)


def read_damaged(seed: int, number: int, versions: int, found: Refusals) -> None:
    """Read damaged versions of one program."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "numeric" / "probe.py"
        path.parent.mkdir()
        for version in range(versions):
            text = damaged(seed, number, version)
            path.write_text(text, encoding="utf-8")
            try:
                library = Library(Path(folder))
                verify_selection(library.select().functions)
                if library.public:
                    for target in TARGETS:
                        emit(library, dialect(target))
            except UserError as e:
                found.refused += 1
                sentence = getattr(e, "sentence", str(e))
                found.sentences[" ".join(w for w in sentence.split() if w.isalpha())] += 1
                if not sentence or "\n" in sentence:
                    found.crashes.append((number, version, "the sentence is no sentence", sentence))
            except Exception as e:
                found.crashes.append((number, version, f"{type(e).__name__}: {e}", text))
            else:
                found.accepted += 1
