"""Specialisation: a function for one scene, with only the parameters that still vary.

    specialise(library, "fakefur_shade", constants={"optics.rho_surface": 0.0}, new_name="fur")

The passes work together on values (codegen.passes.ssa.values): while calls are inlined, every new value is
simplified by all rules, and what that decides simplifies what follows, so one walk reaches the fixed point.
The log says what was done, why it is sound, and where in the sources.
"""

from __future__ import annotations

import copy
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from codegen.errors import Place, UserError
from codegen.ir import nodes as ir
from codegen.ir.types import Struct, Type
from codegen.library import Library
from codegen.names import where_reserved
from codegen.passes.analysis.ranges import Ranges
from codegen.passes.inline import CallRule, Inliner
from codegen.passes.placement.dead import pruned, used_parameters
from codegen.passes.placement.schedule import statements
from codegen.passes.rules.axes import zero_components
from codegen.passes.rules.fold import constants as fold_constants
from codegen.passes.rules.guards import guards
from codegen.passes.rules.identities import identities
from codegen.passes.rules.powers import whole, whole_exponents
from codegen.passes.rules.scalars import components
from codegen.passes.rules.sine_powers import EXPONENTS, whole_sine_exponents
from codegen.passes.rules.sums import cancellation
from codegen.passes.ssa.flow import roots
from codegen.passes.ssa.values import Rule, Step, Value, Values, constant_components, leaves
from codegen.passes.subject import Fact, Subject, is_taken_apart

EXACT_KINDS = ("exact", "finite", "real")
"""Kinds of identities that are applied unless others are asked for; see codegen.passes.rules.identities."""


@dataclass(frozen=True)
class Specialised:
    """A function made for known parameters.

    function    without calls, unless some were kept
    source      name of the function that it was made from
    parameters  path in the source's signature -> name of the parameter, for what still varies
    dropped     paths that are no parameters any more, structs taken apart
    constants   path -> value, as given
    aliases     path -> path, as given
    log         what was done, in order
    whole       whether a power has a constant whole exponent and was left as it is
    """

    function: ir.Function
    source: str
    parameters: Mapping[str, str]
    dropped: tuple[str, ...]
    constants: Mapping[str, Any]
    aliases: Mapping[str, str]
    log: tuple[Step, ...]
    whole: bool

    def impose(self, inputs: Mapping[str, Any]) -> dict[str, Any]:
        """Inputs of the general function with the constants and aliases put in."""
        made: dict[str, Any] = copy.deepcopy(dict(inputs))
        for path, value in self.constants.items():
            _put(made, path, value)
        for path, target in self.aliases.items():
            _put(made, path, _get(made, target))
        return made

    def arguments(self, inputs: Mapping[str, Any]) -> dict[str, Any]:
        """What the specialised function takes of inputs of the general one."""
        return {name: _get(inputs, path) for path, name in self.parameters.items()}


def _get(inputs: Mapping[str, Any], path: str) -> Any:
    value: Any = inputs
    for name in path.split("."):
        value = value[name]
    return value


def _put(inputs: dict[str, Any], path: str, value: Any) -> None:
    *outer, last = path.split(".")
    place = inputs
    for name in outer:
        place = place.setdefault(name, {})
    place[last] = value


def specialise(
    library: Library,
    name: str,
    constants: Mapping[str, Any] | None = None,
    aliases: Mapping[str, str] | None = None,
    ranges: Mapping[str, tuple[float, float]] | None = None,
    facts: Iterable[Fact | tuple[str, float, float]] = (),
    *,
    new_name: str | None = None,
    variants: Mapping[str, str] | None = None,
    keep: Collection[str] = (),
    kinds: Collection[str] = EXACT_KINDS,
    powers: int = 0,
    unroll: int = 8,
) -> Specialised:
    """A function of the library, made for what is known of its parameters.

    constants  path -> number, sequence, or fields of a struct
    aliases    path -> path of another parameter that it equals
    ranges     path -> least and largest value, inside the domain
    facts      (expression over parameters, least, largest): ("dot(n, v)", 0.05, 1.0)
    new_name   name of the result; the old one with "_specialised" by default
    variants   function -> the variant that is called in its place, wherever it is called
    keep       functions whose calls stay calls
    kinds      kinds of identities to apply: exact, finite, real, unit
    powers     largest constant whole exponent that becomes multiplications; 0: none, since that is not exact
    unroll     loops of at most so many iterations are unrolled
    raises     UserError for unknown names and paths, and for values outside their domains
    """
    variants = dict(variants or {})
    subject = Subject(
        library.function(variants.get(name, name)),
        dict(constants or {}),
        dict(aliases or {}),
        dict(ranges or {}),
    )
    function = subject.function
    values = Values(function=function.name, line=function.place.line)
    values.simplify_by((components, fold_constants))
    arguments = subject.arguments(values)
    proofs = Ranges(values)
    for given in facts:
        fact = given if isinstance(given, Fact) else Fact(*given)
        _learn(proofs, subject, values, fact)
    proofs.check_facts()
    values.simplify_by(exact_rules(proofs, frozenset(kinds)))
    left_whole: set[str] = set()
    asked = (whole_exponents(powers), whole_sine_exponents(powers)) if powers else ()
    inliner = Inliner(
        library, values, keep, unroll, (*asked, _noting(left_whole)), checked(library, variants)
    )
    flow = pruned(inliner.flow(function, arguments))
    left = used_parameters(values, [*roots(flow.items), *leaves(flow.result)])
    names = parameter_names(left, function)
    body, origins = statements(values, flow, function.returns, names, function.place.line)
    dropped = [path for path in values.parameters if path not in left]
    for path in dropped:
        given_away = _within(path, subject.constants) or _within(path, subject.aliases)
        if not given_away:
            values.note("dead", f"parameter {path} is gone", "nothing that is left uses it")
    made = replace(
        function,
        name=new_name or f"{name}_specialised",
        kind="base",
        base=None,
        parameters=tuple(
            ir.Parameter(names[path], values.parameters[path].type, values.parameters[path].domain)
            for path in left
        ),
        body=body,
        doc=_doc(library, function, names, subject),
        place=Place(function.place.path, function.place.line),
        origins={
            number: library.function(source).source_of(line) for number, (source, line) in origins.items()
        },
    )
    return Specialised(
        made,
        name,
        names,
        tuple(dropped),
        subject.constants,
        subject.aliases,
        tuple(values.log),
        bool(left_whole),
    )


def _noting(left_whole: set[str]) -> CallRule:
    """A rule that applies nowhere and notes the powers with constant whole exponents that it meets."""

    def rule(values: Values, function: ir.Function, arguments: dict[str, Value]) -> None:
        exponent = EXPONENTS.get(function.name)
        if exponent is not None and whole(arguments[exponent]) is not None:
            left_whole.add(function.name)

    return rule


def exact_rules(proofs: Ranges, kinds: frozenset[str]) -> tuple[Rule, ...]:
    """All rules in the order in which they are tried."""
    last: tuple[Rule, ...] = (cancellation(),) if "real" in kinds else ()
    return (components, fold_constants, identities(proofs, kinds), zero_components, guards(proofs), *last)


def _learn(proofs: Ranges, subject: Subject, values: Values, fact: Fact) -> None:
    e, low, high = subject.fact(values, fact)
    where = f'{subject.function.name}: fact "{fact.expression}"'
    known = constant_components(e)
    if known is not None:
        if not all(low - 1e-6 <= float(x) <= high + 1e-6 for x in known):
            raise UserError(f"{where} contradicts the constants, which make it {values.show(e)}")
        return
    earlier = proofs.facts.get(id(e))
    if earlier is not None:
        low, high = max(low, earlier[0]), min(high, earlier[1])
        if low > high:
            raise UserError(f"{where} contradicts another fact")
    proofs.add_fact(e, low, high)
    values.note("facts", f"{values.show(e)} in [{low:g}, {high:g}]", "given")


def checked(library: Library, variants: Mapping[str, str]) -> Mapping[str, str]:
    """The same map, after looking whether each variant can stand in; raises UserError where it cannot."""
    for name, chosen in variants.items():
        one, other = library.function(name), library.function(chosen)
        types = [[p.type for p in f.parameters] for f in (one, other)]
        if types[0] != types[1] or one.returns != other.returns:
            raise UserError(f'"{chosen}" takes other parameters than "{name}" and cannot stand in for it')
    return variants


def parameter_names(paths: Collection[str], function: ir.Function) -> dict[str, str]:
    """A name for each path: its last part where that is unambiguous, else the whole path."""
    last = [path.rpartition(".")[2] for path in paths]
    whole = {p.name for p in function.parameters}
    names: dict[str, str] = {}
    for path in paths:
        short = path.rpartition(".")[2]
        clash = last.count(short) > 1 or (short in whole and short != path)
        names[path] = path.replace(".", "_") if clash else short
        taken = where_reserved(names[path])
        if taken is not None:
            raise UserError(
                f'{function.name}: parameter {path} would be called "{names[path]}", which is {taken}'
            )
    return names


def _within(path: str, given: Collection[str]) -> bool:
    return any(path == outer or path.startswith(f"{outer}.") for outer in given)


def _doc(library: Library, function: ir.Function, names: Mapping[str, str], subject: Subject) -> ir.Doc:
    """The documentation of the source, for the parameters that are left."""
    entries: dict[str, str] = {}
    texts: dict[str, str] = {}

    def visit(path: str, type_: Type, text: str) -> None:
        texts[path] = text
        if is_taken_apart(type_):
            assert isinstance(type_, Struct)
            fields = library.struct(type_.name).doc.entries
            for f in type_.fields:
                visit(f"{path}.{f.name}", f.type, fields.get(f.name, ""))

    for p in function.parameters:
        visit(p.name, p.type, function.doc.entries.get(p.name, ""))
    for path, name in names.items():
        entries[name] = texts[path]
    for key in ("returns", "source"):
        if key in function.doc.entries:
            entries[key] = function.doc.entries[key]
    return ir.Doc(function.doc.summary, entries)
