"""Results that were computed elsewhere, judged as those of our own drivers are."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from codegen.backends import TARGETS
from codegen.errors import UserError, unknown
from codegen.execute import unflatten
from codegen.intervals import TABLES
from codegen.kit.results import Results
from codegen.kit.vectors import identity
from codegen.library import Library
from conformance.check.backend import Backend
from conformance.check.engine import check_function
from conformance.check.result import FunctionResult
from conformance.foreign.make import prepared_vectors, words_of


def judge(
    library: Library, results: Results, names: Sequence[str] = (), table: str = ""
) -> Iterator[FunctionResult]:
    """The verdicts on each function of the kit that the results come from.

    names   judge these only; a function of the kit without results fails
    table   the accuracy table; that of the file or of its target if empty
    raises  UserError for unknown names, and for results of other inputs or texts than this library's
    """
    if results.target not in TARGETS:
        raise UserError(f"{results.path}: {unknown('target', results.target, TARGETS)}")
    chosen = table or results.table
    if chosen and chosen not in TABLES:
        raise unknown("accuracy table", chosen, TABLES)
    for name in names:
        if name not in results.wanted:
            raise UserError(f"{results.path}: its kit does not hold {library.function(name).name}")
    for name in names or results.wanted:
        yield _judge(library, results, name, chosen)


def _judge(library: Library, results: Results, name: str, table: str) -> FunctionResult:
    computed = results.functions.get(name)
    if computed is None or computed.words is None:
        sentence = f"failed: {computed.failed}" if computed else f"has no results in {results.path.name}"
        return FunctionResult(
            name, results.target, results.driver, results.target, stage="execute", broken=f"{name} {sentence}"
        )
    ready = prepared_vectors(library, name, results.lanes, results.family)
    source = library.select([name]).source_hash
    if computed.vectors != identity(ready.function, source, words_of(ready.sample)):
        raise UserError(
            f"{results.path}: the results of {name} belong to vectors {computed.vectors} of another library; "
            "write a kit with this one and run it again"
        )
    words = computed.words
    if words.shape[1] != ready.sample.lanes:
        raise UserError(
            f"{results.path}: {name} has {words.shape[1]} results, but its vectors have "
            f"{ready.sample.lanes} lanes"
        )

    def run(_: Library, name: str, inputs: Mapping[str, Any]) -> Any:
        return unflatten(library.function(name).returns, words)

    on = Backend(results.target, results.driver, run, table=table)
    return check_function(library, name, on, prepared=ready)
