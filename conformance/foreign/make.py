"""Test vectors of a function: inputs as a check draws them, references, and intervals under every table."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from codegen.execute import flatten
from codegen.intervals import TABLES
from codegen.kit.rows import columns
from codegen.kit.vectors import Interval, Vectors
from codegen.library import Library
from conformance.check.draws import draws
from conformance.check.features import applies
from conformance.check.prepared import Prepared, prepare
from conformance.check.sample import Sample

LANES = 64
"""Random points of a function."""
FAMILY = 8
"""Most points of one family of hard cases."""


def prepared_vectors(library: Library, name: str, lanes: int, family: int) -> Prepared:
    """The inputs of a kit's function: fewer of what `vair check` draws."""
    return prepare(library, name, draws(library.function(name), lanes, family))


def vectors(ready: Prepared, tables: Sequence[str] = TABLES) -> Vectors:
    """All that is known of a function on its inputs."""
    library, name, sample = ready.library, ready.name, ready.sample
    counts = np.bincount(sample.family, minlength=len(sample.families))
    intervals = {}
    for table in tables:
        allowed = ready.permitted(table)
        intervals[table] = Interval(
            tuple(columns(allowed.low)), tuple(columns(allowed.high)), allowed.guaranteed
        )
    return Vectors(
        function=ready.function,
        source=library.select([name]).source_hash,
        inputs=words_of(sample),
        families=tuple((f, int(count)) for f, count in zip(sample.families, counts, strict=True)),
        expected=tuple(columns(ready.truth.expected)),
        ambiguous=ready.truth.doubtful,
        intervals=intervals,
        bounds=tuple((b, applies(b, sample.inputs, sample.lanes)) for b in library.bounds.get(name, ())),
    )


def words_of(sample: Sample) -> np.ndarray[tuple[int, ...], np.dtype[np.uint32]]:
    """The inputs as words, (rows, lanes)."""
    return flatten(list(sample.inputs.values()), sample.lanes)
