"""Which pairs are run: relations with their own functions, rewritings with all functions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path

from codegen.ir.nodes import Function
from codegen.library import Library
from conformance.fuzz.case import Case, draw_inputs, make_case
from conformance.fuzz.source import write
from conformance.metamorphic import inputs, source
from conformance.metamorphic.pairs import Pair, draw, input_pair, source_pair
from conformance.metamorphic.relation import SourceRelation

SEED = 1
PROGRAM_SEED = 7
"""Of the random programs, which have the loops and branches that the library does without."""


def input_pairs(library: Library, lanes: int, each: int | None) -> Iterator[Pair]:
    """Every relation between inputs with `each` of its functions, or all."""
    for relation in inputs.RELATIONS:
        for name in relation.functions[:each]:
            function = library.function(name)
            yield input_pair(relation, function, draw(function, lanes, SEED))


def library_pairs(library: Library, lanes: int, each: int | None) -> Iterator[Pair]:
    """Rewritings of library functions: `each` functions for each relation, or all; relations start apart."""
    functions = list(library.public.values())
    for k, relation in enumerate(source.RELATIONS):
        first = k * len(functions) // len(source.RELATIONS)
        made = 0
        for function in (*functions[first:], *functions[:first]):
            if each is not None and made == each:
                break
            pair = library_pair(library, relation, function, lanes)
            if pair is not None:
                made += 1
                yield pair


def library_pair(library: Library, relation: SourceRelation, function: Function, lanes: int) -> Pair | None:
    """The rewriting of a library function; None where there is nothing to rewrite."""
    seed = SEED + source.RELATIONS.index(relation)
    return source_pair(relation, function, library, partial(draw, function, lanes, seed), lanes)


def program_pair(library: Library, relation: SourceRelation, case: Case, lanes: int) -> Pair | None:
    """The rewriting of a random program; None where there is nothing to rewrite."""
    function = library.function(case.entry)
    drawn = partial(draw_inputs, case, function.parameters, lanes)
    return source_pair(relation, function, library, drawn, lanes)


def random_programs(folder: Path, count: int) -> tuple[Library, list[Case]]:
    """Random programs as a library."""
    cases = [make_case(PROGRAM_SEED, k) for k in range(count)]
    return write(folder, cases), cases


def program_pairs(library: Library, cases: Sequence[Case], lanes: int, each: int | None) -> Iterator[Pair]:
    """Rewritings of random programs: `each` programs for each relation, or all."""
    for k, relation in enumerate(source.RELATIONS):
        first = k * len(cases) // len(source.RELATIONS)
        made = 0
        for case in (*cases[first:], *cases[:first]):
            if each is not None and made == each:
                break
            pair = program_pair(library, relation, case, lanes)
            if pair is not None:
                made += 1
                yield pair
