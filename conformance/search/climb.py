"""The hill-climb: islands of lanes, each lane replaced by its child where the child errs more."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any
from zlib import crc32

import numpy as np
import numpy.typing as npt

from codegen.bounds import Bound
from conformance import cases
from conformance.cases import domains
from conformance.cases.parameters import leaves
from conformance.cases.stream import Stream, single
from conformance.search.mutation import mutated
from conformance.search.objective import Objective
from conformance.search.population import Population, choose, join, pack, related, take, unpack, valid

ISLANDS = 32
ISLAND_LANES = 64
MIGRATION = 8
"""Generations between two moves of the better half of an island onto its worse half."""
PATIENCE = 40
"""Generations without a gain after which an island starts afresh."""


@dataclass(frozen=True)
class Find:
    """The worst input found for one bound: one lane of inputs, its error in the bound's measure."""

    function: str
    target: str
    driver: str
    bound: Bound
    error: float
    ratio: float
    inputs: dict[str, Any]


@dataclass(frozen=True)
class Search:
    """What one search did."""

    finds: list[Find]
    evaluations: int


def fresh_population(objective: Objective, seed: int, count: int) -> Population:
    """Random points, ends of domains and hard cases in equal parts, inside the domains."""
    function = objective.function
    found = leaves(function.parameters)
    families = [cases.UNIFORM, *cases.families_for(function.parameters)]
    share = -(-count // min(len(families), 8))
    order = Stream(seed, crc32(function.name.encode())).permutation(len(families))
    chosen = [families[k] for k in order[:8]]
    parts = [pack(found, cases.draw(function, family, share, seed)) for family in chosen]
    population = take(join(parts), Stream(seed).permutation(share * len(chosen))[:count])
    spare = pack(found, cases.draw(function, cases.UNIFORM, count, seed + 1))
    for leaf in found:
        inside = valid(leaf, population[leaf.path])
        population = choose(inside, population, spare)
    return population


def aimed(
    objective: Objective, population: Population, aim: npt.NDArray[np.intp], stream: Stream
) -> Population:
    """The population with every lane moved into the domain of the bound it aims at, as far as that domain
    speaks of single numbers; what it says of angles is left to chance and selection."""
    moved = {path: values.copy() for path, values in population.items()}
    free = {
        leaf.path for leaf in leaves(objective.function.parameters) if domains.kind(leaf.domain) == "Interval"
    }
    for k, bound in enumerate(objective.bounds):
        for text, (low, high) in bound.where.items():
            path, _, component = text.rpartition(".")
            values = moved.get(tuple(text.split(".")))
            if values is None and component in tuple("xyzw"):
                whole = moved.get(tuple(path.split(".")))
                values = whole[:, "xyzw".index(component)] if whole is not None and whole.ndim == 2 else None
            if not {tuple(text.split(".")), tuple(path.split("."))} & free:
                continue  # a component of a unit vector does not go alone
            if values is None or values.ndim != 1 or values.dtype != np.float32:
                continue
            inside = (aim != k) | ((values >= low) & (values <= high))
            first, last = domains.inward(low, high)
            drawn = domains.signed_logarithmic(stream, len(values), float(first), float(last))
            values[:] = np.where(inside, values, np.clip(single(drawn), first, last))
    return related(objective.function, moved)


def climb(objective: Objective, seconds: float, seed: int, generations: int | None = None) -> Search:
    """Search for that long, or that many generations; the same seed and generations give the same finds."""
    stream = Stream(seed, crc32(objective.function.name.encode()), crc32(objective.on.target.encode()))
    found = leaves(objective.function.parameters)
    count = ISLANDS * ISLAND_LANES
    island_of = np.arange(count) // ISLAND_LANES
    aim = island_of % len(objective.bounds)
    lanes = np.arange(count)
    population = aimed(objective, fresh_population(objective, seed, count), aim, stream)
    best = _Best(objective)
    scores = best.see(population, unpack(found, population))[aim, lanes]
    last_gain, top = np.zeros(ISLANDS, np.int64), np.full(ISLANDS, -np.inf)
    started, generation = time.perf_counter(), 0
    while generation != generations and (generations is not None or time.perf_counter() - started < seconds):
        generation += 1
        children = mutated(stream, objective.function, population, ISLAND_LANES)
        marks = best.see(children, unpack(found, children))[aim, lanes]
        better = marks >= scores
        population, scores = choose(better, children, population), np.where(better, marks, scores)
        peaks = scores.reshape(ISLANDS, ISLAND_LANES).max(axis=1)
        last_gain = np.where(peaks > top, generation, last_gain)
        top = np.maximum(top, peaks)
        stale = generation - last_gain > PATIENCE
        if stale.any():
            new = aimed(objective, fresh_population(objective, seed + 2 * generation, count), aim, stream)
            marks = best.see(new, unpack(found, new))[aim, lanes]
            mask = stale[island_of]
            population, scores = choose(mask, new, population), np.where(mask, marks, scores)
            last_gain, top = np.where(stale, generation, last_gain), np.where(stale, -np.inf, top)
        elif generation % MIGRATION == 0:
            order = np.lexsort((-scores, island_of)).reshape(ISLANDS, ISLAND_LANES)
            half = ISLAND_LANES // 2
            source = lanes.copy()
            source[order[:, half:].ravel()] = order[:, :half].ravel()
            population, scores = take(population, source), scores[source]
    return Search(best.finds(), best.evaluations)


class _Best:
    """The worst input seen so far under each bound."""

    def __init__(self, objective: Objective) -> None:
        self.objective = objective
        self.leaves = leaves(objective.function.parameters)
        self.error = np.full(len(objective.bounds), -1.0)
        self.lane: list[Population | None] = [None] * len(objective.bounds)
        self.evaluations = 0

    def see(self, population: Population, inputs: dict[str, Any]) -> Any:
        """Scores (bounds, n) of a population; its worst lanes are remembered."""
        count = len(next(iter(population.values())))
        errors = self.objective.errors(inputs, count)
        self.evaluations += count
        for k, row in enumerate(errors):
            lane = int(np.argmax(row))
            if row[lane] > self.error[k]:
                self.error[k] = row[lane]
                self.lane[k] = take(population, np.array([lane]))
        return self.objective.scores(errors)

    def finds(self) -> list[Find]:
        """One find per bound that applied to any input."""
        result = []
        ratios = self.objective.scores(self.error[:, None])[:, 0]
        for bound, error, ratio, lane in zip(
            self.objective.bounds, self.error, ratios, self.lane, strict=True
        ):
            if lane is not None:
                on, name = self.objective.on, self.objective.function.name
                inputs = unpack(self.leaves, lane)
                result.append(Find(name, on.target, on.driver, bound, float(error), float(ratio), inputs))
        return result
