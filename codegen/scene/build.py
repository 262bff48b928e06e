"""A scene from its file to proven functions, one per target; nothing is written here."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from codegen.backends import dialect
from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.ir import nodes as ir
from codegen.ir.domains import Interval, Unit
from codegen.ir.types import F32, Array, Vector
from codegen.library import Library
from codegen.passes.analysis.operations import operations
from codegen.passes.probe import operations_left
from codegen.passes.specialise import Specialised
from codegen.scene import environment
from codegen.scene.beside import Beside
from codegen.scene.description.document import Scene
from codegen.scene.description.lights import UNROLLED
from codegen.scene.environment import ConstantLight, MapError
from codegen.scene.general import General, general_function
from codegen.scene.proof.errors import Floats, as_floats, exact_values, reference_values
from codegen.scene.proof.points import SEED, Points, draw
from codegen.scene.proof.proof import Proof, Results, prove
from codegen.scene.reduction.knowledge import Given, Knowledge
from codegen.scene.reduction.prices import Prices
from codegen.scene.reduction.reduce import Chosen, Reduced, Reducer
from codegen.scene.report import spirv, text
from codegen.scene.report.speed import Speed

SEARCH_POINTS = 12_000
PROOF_POINTS = 100_000
UNEXECUTED_POINTS = 20_000
"""Points of a proof by float32 evaluation alone, where no driver is there to execute it."""
ENVIRONMENT_POINTS = 24
LEAST_SHARE = 0.3
"""Share of the budget below which a search that fails its proof is not tried again."""

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Remaining:
    """A parameter that is left, and the operations that would be left if it were constant."""

    name: str
    operations: int


@dataclass
class TargetResult:
    """Everything about one target.

    before, after   speed of the general function and of the result, where a driver was timed
    exact_proof     the result of the exact passes alone against the general function
    """

    target: str
    title: str
    file: str
    text: str
    reduced: Reduced
    operations: dict[str, dict[str, int]]
    lines: dict[str, int]
    exact_proof: Proof
    proof: Proof
    spirv: dict[str, int | None] = field(default_factory=dict)
    speeds: dict[str, Speed] = field(default_factory=dict)
    unavailable: str = ""


@dataclass
class Outcome:
    """What `vair scene` found; `targets` in the order of the scene."""

    scene: Scene
    general: General
    known: Knowledge
    targets: list[TargetResult]
    remaining: list[Remaining]
    environment: MapError | None
    constant_lights: tuple[ConstantLight, ...]
    seconds: float
    hard_points: int


class Ahead(NamedTuple):
    """What does not depend on the search.

    points  of the proofs
    exact   the general function there in float64
    single  the same by the float32 evaluation, where no driver is open
    error   of the constant lights against their map
    """

    points: Points
    exact: Floats
    single: Floats | None
    error: MapError | None


@dataclass
class Builder:
    """Builds one scene.

    runtimes   target -> runtime, or the reason why there is none
    counting   instructions of both functions, by a compiler beside the proofs
    """

    library: Library
    scene: Scene
    runtimes: Mapping[str, Any]
    timed: bool = True
    say: Progress = lambda sentence: None
    results: Results = field(default_factory=dict)
    counting: spirv.Counting | None = None

    def build(self) -> Outcome:
        """Everything but the files; raises UserError where nothing may be written."""
        try:
            with Beside(forked=not self.executed) as beside:
                return self._built(beside)
        finally:
            if self.counting is not None:
                self.counting.close()

    def _built(self, beside: Beside) -> Outcome:
        begin = time.perf_counter()
        constant, pixels = self.constant_lights()
        general = general_function(self.scene, constant)
        library = self.library.with_functions([general.function])
        self.say("searching")
        drawn = functools.cache(partial(draw, self.scene, general, SEARCH_POINTS))
        points, wide, ahead = beside.in_turn(
            drawn,
            lambda: exact_values(library, general.function.name, drawn()),
            partial(self.ahead, library, general, constant, pixels),
        )
        reducer = Reducer.of(library, self.scene, general, points, None if self.executed else wide)
        self.check_budget(reducer.reference.rounding)
        if not reducer.exact().function.parameters:
            raise UserError(
                f"{self.scene.path}: nothing varies: the scene is one colour and needs no function"
            )
        first, *others = self.scene.dialects
        self.say(f"searching for {first}")
        prices, chosen = Prices.of(library, first), None
        if self.scene.budget > 0.0:
            chosen = reducer.chosen(prices, self.scene.budget)
        searches = [partial(self.apart, library, reducer, target, chosen) for target in others]
        under_way = searches if chosen is None else beside.each(searches)
        following = dict(zip(others, under_way, strict=True))
        reduced = reducer.reduced(prices, self.scene.budget, chosen)
        left = beside.one(partial(self.remaining, library, reduced))
        proven, exact, single, error = ahead()
        if single is not None:
            self.results["float32", general.function.body] = single
        results = [self.proven(library, general, reducer, reduced, proven, exact)]
        for target, searched in following.items():
            self.say(f"searching for {target}")
            other = searched()
            if not isinstance(other, Reduced):
                other = reducer.reduced(Prices.of(library, target), self.scene.budget, other)
            results.append(self.proven(library, general, reducer, other, proven, exact))
        self.say("probing what is left")
        final = results[0].reduced
        remaining = left() if final is reduced else self.remaining(library, final)
        for result in results:
            if result.target == "glsl" and self.counting is not None:
                result.spirv = self.counting.results()
        return Outcome(
            scene=self.scene,
            general=general,
            known=reducer.knowledge,
            targets=results,
            remaining=remaining,
            environment=error,
            constant_lights=tuple(constant),
            seconds=time.perf_counter() - begin,
            hard_points=int(proven.hard.sum()),
        )

    @property
    def executed(self) -> bool:
        """Whether a driver is open."""
        return any(not isinstance(runtime, str) for runtime in self.runtimes.values())

    def apart(
        self, library: Library, reducer: Reducer, target: str, first: Chosen | None
    ) -> Reduced | Chosen | None:
        """The result of the search for one more target; only its choices where these are those of the first
        one, since most that is left to do is then done there. None without those of the first one."""
        if first is None:
            return None
        prices = Prices.of(library, target)
        chosen = reducer.chosen(prices, self.scene.budget)
        return chosen if chosen.same_as(first) else reducer.reduced(prices, self.scene.budget, chosen)

    def ahead(
        self, library: Library, general: General, lights: list[ConstantLight], pixels: Floats | None
    ) -> Ahead:
        """What the proofs need of the general function, and the error of the map's lights."""
        points = draw(self.scene, general, PROOF_POINTS if self.executed else UNEXECUTED_POINTS, SEED + 1)
        single = None
        if self.executed:
            exact = exact_values(library, general.function.name, points)
        else:
            exact, single = reference_values(library, general.function.name, points)
        error = None if pixels is None else self.map_error(library, lights, pixels)
        return Ahead(points, exact, single, error)

    def constant_lights(self) -> tuple[list[ConstantLight], Floats | None]:
        """The lights of the scene's map, and the map."""
        lights = self.scene.lights
        if lights.environment is None:
            return [], None
        self.say("reading the map")
        pixels = environment.read_map(lights.environment, f"{self.scene.path}: [lights] environment")
        return environment.median_cut(pixels, lights.environment_lights), pixels

    def check_budget(self, rounding: float) -> None:
        """Refuse a budget below what float32 itself takes."""
        budget = self.scene.budget
        if 0.0 < budget < rounding:
            raise UserError(
                f"{self.scene.path}: [scene] budget: no variant meets {budget:.3g}; the best achievable is "
                f'{rounding:.2g}, the rounding of {self.scene.model.function.name} itself; or ask for "exact"'
            )

    def proven(
        self,
        library: Library,
        general: General,
        reducer: Reducer,
        reduced: Reduced,
        points: Points,
        exact: Floats,
    ) -> TargetResult:
        """The result of one target; where more points show more error, the search gets less room."""
        share = 1.0
        while True:
            result = self.target(library, general, reduced, points, exact)
            if self.holds(result):
                return result
            if not reduced.changes or share < LEAST_SHARE or not result.exact_proof.holds(0.0):
                raise UserError(self.refusal(result))
            share *= 0.7
            reduced = reducer.reduced(Prices.of(library, reduced.target), share * self.scene.budget)

    def target(
        self, library: Library, general: General, reduced: Reduced, points: Points, exact: Floats
    ) -> TargetResult:
        """Proof, text and figures of one target."""
        target = reduced.target
        runtime = self.runtimes.get(target)
        reason = runtime if isinstance(runtime, str) else ""
        runtime = None if isinstance(runtime, str) else runtime
        self.say(f"proving on {target}")
        name = general.function.name

        def proof(made: Specialised, budget: float) -> Proof:
            extended = library.with_functions([made.function])
            return prove(
                extended, name, made.function.name, points, exact, target, runtime, budget, self.results
            )

        exact_proof = proof(reduced.exact, 0.0)
        final_proof = proof(reduced.final, self.scene.budget) if reduced.changes else exact_proof
        written = text.emitted(library, self.scene, general, reduced)
        result = TargetResult(
            target=target,
            title=dialect(target, self.scene.dialects[target]).title,
            file=text.file_name(self.scene, target),
            text=written,
            reduced=reduced,
            operations={
                "general": operations(general.function, library),
                "exact": operations(reduced.exact.function),
                "final": operations(reduced.final.function),
            },
            lines=text.line_counts(library, self.scene, general, target, written),
            exact_proof=exact_proof,
            proof=final_proof,
            unavailable=reason,
        )
        if target == "glsl":
            if self.counting is not None:
                self.counting.close()
            self.counting = spirv.Counting(text.spirv_texts(library, self.scene, general, reduced))
        if runtime is not None and self.timed and final_proof.holds(self.scene.budget):
            from codegen.scene.report import stopwatch  # not without a driver

            self.say(f"timing on {target}")
            extended = library.with_functions([reduced.final.function])
            names = [name, reduced.final.function.name]
            ordinary = {key: np.asarray(v)[~points.hard] for key, v in points.inputs.items()}
            result.speeds = stopwatch.measure(extended, names, runtime, ordinary)
        return result

    def holds(self, result: TargetResult) -> bool:
        """Whether both proofs of a target hold."""
        budget = self.scene.budget if result.reduced.changes else 0.0
        return result.exact_proof.holds(0.0) and result.proof.holds(budget)

    def refusal(self, result: TargetResult) -> str:
        """Why nothing is written: which proof failed, and the term that did it."""
        proof, path = result.exact_proof, self.scene.path
        if not proof.holds(0.0):
            return (
                f"{path}: nothing is written: on {proof.driver} the exact passes give {proof.outside} of "
                f"{proof.judged} results outside what its specification permits, the first at "
                f"{proof.first_outside}"
            )
        proof, changes = result.proof, result.reduced.changes
        term = changes[-1].what if changes else "no term"
        return (
            f"{path}: nothing is written: on {proof.driver} the error is {proof.error.largest:.3g}, above "
            f"the budget {self.scene.budget:.3g}; the last approximation was {term}"
        )

    def map_error(self, library: Library, lights: list[ConstantLight], pixels: Floats) -> MapError:
        """The constant lights against the whole map, by the library's own model in float64."""
        one = general_function(_lit_by_one(self.scene))
        extended = library.with_functions([one.function])
        light = one.lights[0].names
        chosen = draw(_lit_by_one(self.scene), one, ENVIRONMENT_POINTS)

        def shade(directions: Floats, colours: Floats, points: npt.NDArray[np.intp]) -> Floats:
            inputs = {name: np.asarray(v)[points] for name, v in chosen.inputs.items()}
            inputs |= {light["l"]: directions.astype(np.float32), light["light"]: colours.astype(np.float32)}
            return as_floats(evaluate(extended, one.function.name, inputs, "float64"))

        return environment.measured_error(pixels, lights, shade, ENVIRONMENT_POINTS)

    def remaining(self, library: Library, reduced: Reduced) -> list[Remaining]:
        """What each parameter costs that is left: operations that go if it is constant, dearest first."""
        f = reduced.final.function
        simple = {p.name: value for p in f.parameters if (value := _simple_value(p)) is not None}
        asked = [{name: value} for name, value in simple.items()]
        left = operations_left(library.with_functions([f]), f.name, asked, UNROLLED)
        found = [Remaining(name, count) for name, count in zip(simple, left, strict=True)]
        return sorted(found, key=lambda r: r.operations)


def _simple_value(p: ir.Parameter) -> Given | None:
    """A constant as a host would choose it: an axis of the frame, white, the middle; none for arrays."""
    if isinstance(p.type, Array):
        return None
    if isinstance(p.domain, Unit):
        return (0.0, 0.0, 1.0)
    if isinstance(p.type, Vector):
        one = p.domain.high if isinstance(p.domain, Interval) else 1.0
        return (min(one, 1.0),) * p.type.size
    low, high = (p.domain.low, p.domain.high) if isinstance(p.domain, Interval) else (0.0, 1.0)
    middle = 0.5 * (low + high)
    return float(np.float32(middle)) if p.type == F32 else int(middle)


def _lit_by_one(scene: Scene) -> Scene:
    """The scene under a single directional light."""
    lights = replace(scene.lights, directional=1, point=0, environment=None, colour=(0.0, 1.0))
    return replace(scene, lights=lights)
