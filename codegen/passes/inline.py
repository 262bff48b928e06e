"""Inlining: a function with all it calls becomes one flow of values, with a single exit.

before   def f(x): return g(x) + g(1.0)         def g(y): if y < 0.0: return 0.0
                                                          return sqrt(y)
after    x < 0 ? 0 : sqrt(x) + 1

Calls are followed with the values of their arguments, so that what a caller knows simplifies what it calls.
Structs are kept as their fields: a field that nothing uses, or that is constant, is gone. A return inside a
branch becomes a choice between two values; a decided branch leaves one side.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field, replace

from codegen.errors import UserError
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, Array, Struct, Type
from codegen.library import Library
from codegen.passes.placement import branches
from codegen.passes.ssa.flow import Branch, Carried, Flow, Item, Loop, Merge
from codegen.passes.ssa.values import CALL, FIELD, LOCAL, PARAMETER, Value, Values, leaves

MOST_UNROLLED = 128
"""Iterations of a loop with a return inside: such a loop is always unrolled, each inside the one before."""

Scope = dict[str, Value]
CallRule = Callable[[Values, ir.Function, dict[str, Value]], "ir.Expr | None"]


@dataclass
class Inliner:
    """Follows the statements of functions over values.

    keep     functions whose calls stay calls
    unroll   loops of at most so many iterations are unrolled
    calls    rules that replace a whole call, see codegen.passes.rules.powers
    variants function -> the variant that is followed in its place
    """

    library: Library
    values: Values
    keep: Collection[str]
    unroll: int
    calls: tuple[CallRule, ...] = ()
    variants: Mapping[str, str] = field(default_factory=dict)
    items: list[Item] = field(default_factory=list)
    bound: int = 0

    def flow(self, function: ir.Function, arguments: Scope) -> Flow:
        """The flow of a function for these arguments."""
        result = self.replaced(function, arguments)
        if result is None:
            result = self.function(function, arguments)
        return Flow(self.items, result)

    def replaced(self, function: ir.Function, arguments: Scope) -> Value | None:
        """What a rule makes of a whole call; None where none applies."""
        for rule in self.calls:
            found = rule(self.values, function, arguments)
            if found is not None:
                return found
        return None

    def function(self, function: ir.Function, arguments: Scope) -> Value:
        """The value of a call."""
        v = self.values
        caller = v.function, v.line
        v.function, v.line = function.name, function.place.line
        result = self.block(function.body, dict(arguments))
        v.function, v.line = caller
        assert result is not None
        return result

    def block(self, body: tuple[ir.Stmt, ...], scope: Scope) -> Value | None:
        """Follow statements; the value they return, or None where they end without returning."""
        for position, s in enumerate(body):
            self.values.line = s.line or self.values.line
            rest = body[position + 1 :]
            match s:
                case ir.Let() | ir.Assign():
                    scope[s.name] = self.named(self.whole(s.value, scope), s.name)
                case ir.Return():
                    return self.whole(s.value, scope)
                case ir.If():
                    if _returns(s):
                        return self.branch(s, scope, rest)
                    self.branch(s, scope, ())
                case ir.For():
                    loop, limit = self.limited(s, scope)
                    if _returns(s):
                        return self.block((*self.turns(loop, limit, scope), *rest), scope)
                    self.loop(loop, limit, scope)
        return None

    def named(self, value: Value, name: str, rank: int = LOCAL) -> Value:
        """The value, remembering that the source calls it so; fields of a struct by their own names."""
        if isinstance(value, dict):
            for key, part in value.items():
                self.named(part, key, FIELD)
        else:
            self.values.hint(value, name, rank)
        return value

    def branch(self, s: ir.If, scope: Scope, rest: tuple[ir.Stmt, ...]) -> Value | None:
        """A branch and, where it may return, all that follows it."""
        condition = self.scalar(s.condition, scope)
        if isinstance(condition, ir.Const):
            chosen = s.then if condition.value else s.orelse
            shown = self.values.show(condition)
            self.values.note(branches.NAME, f"if {shown}: one side is left", f"the condition is {shown}")
            return self.block((*chosen, *rest), scope)
        sides: list[tuple[Scope, list[Item], Value | None]] = []
        outer, line = self.items, self.values.line
        for part in (s.then, s.orelse):
            inner, self.items, self.values.line = dict(scope), [], line
            result = self.block((*part, *rest), inner)
            sides.append((inner, self.items, result))
        self.items, self.values.line = outer, line
        (then, then_items, then_result), (orelse, else_items, else_result) = sides
        branch = Branch(condition, then_items, else_items, [])
        if then_result is not None:  # then what follows is part of both sides, and both return
            assert else_result is not None
            merged = self.merged(branch, "result", then_result, else_result)
            self.finish(branch)
            return merged
        for name in scope:
            scope[name] = self.merged(branch, name, then[name], orelse[name])
        self.finish(branch)
        return None

    def merged(self, branch: Branch, name: str, a: Value, b: Value) -> Value:
        """One value for both ways: a choice where both are cheap, else a leaf that the branch binds."""
        if a is b:
            return a
        if isinstance(a, dict):
            assert isinstance(b, dict)
            return {key: self.merged(branch, key, a[key], b[key]) for key in a}
        assert not isinstance(b, dict)
        if branches.select_is_cheaper(branch, a, b):
            chosen = self.values.build(ir.Select(a.type, branch.condition, a, b))
            self.values.hint(chosen, name, FIELD)
            return chosen
        leaf = self.leaf(a.type, name)
        branch.merges.append(Merge(leaf, name, a, b))
        return leaf

    def finish(self, branch: Branch) -> None:
        """Keep a branch that binds something; loops of a branch that binds nothing compute nothing."""
        if branch.merges:
            self.items.append(branch)

    def leaf(self, type_: Type, name: str) -> ir.Var:
        """A new variable that a branch or loop binds; its name holds a character no source name has."""
        self.bound += 1
        made = self.values.intern(ir.Var(type_, f"{name}@{self.bound}"))
        assert isinstance(made, ir.Var)
        return made

    def limited(self, s: ir.For, scope: Scope) -> tuple[ir.For, ir.Expr | None]:
        """The loop with what ends it early; a constant is its bound, too."""
        limit = None if s.limit is None else self.scalar(s.limit, scope)
        if isinstance(limit, ir.Const):
            return replace(s, stop=max(min(s.stop, int(limit.value)), s.start)), limit
        return s, limit

    def turns(self, s: ir.For, limit: ir.Expr | None, scope: Scope) -> tuple[ir.Stmt, ...]:
        """All turns of a loop that may return: one inside the other where only a run tells how many."""
        bodies = _iterations(s)
        if isinstance(limit, ir.Const | None):
            return tuple(statement for body in bodies for statement in body)
        self.bound += 1
        name = f"{s.name}@{self.bound}"
        scope[name] = limit
        inner: tuple[ir.Stmt, ...] = ()
        for i, body in zip(reversed(range(s.start, s.stop)), reversed(bodies), strict=True):
            goes_on = ir.Binary(BOOL, "<", ir.Const(s.index_type, i), ir.Var(s.index_type, name))
            inner = (ir.If(goes_on, (*body, *inner), ()),)
        return inner

    def loop(self, s: ir.For, limit: ir.Expr | None, scope: Scope) -> None:
        """A counted loop without a return: unrolled where it is short, else kept."""
        count = max(s.stop - s.start, 0)
        if isinstance(limit, ir.Const | None) and count <= self.unroll:
            self.values.note("unroll", f"{count} iterations over {s.name}", "the bounds are constant")
            self.block(self.turns(s, limit, scope), scope)
            return
        assigned = {a.name for a in ir.statements(s.body) if isinstance(a, ir.Assign)}
        carried = [name for name in scope if name in assigned]
        while True:
            kept, changed = self.iteration(s, limit, scope, carried)
            still = [name for name in carried if name in changed]
            if still == carried:
                break
            carried = still
        self.items.append(kept)

    def iteration(
        self, s: ir.For, limit: ir.Expr | None, scope: Scope, carried: list[str]
    ) -> tuple[Loop, set[str]]:
        """One body over leaves for what it changes; also which of those it does change."""
        outer, line = self.items, self.values.line
        self.items = []
        index = self.leaf(s.index_type, s.name)
        self.values.indices[index.name] = s.start, s.stop - 1
        inner: Scope = {**scope, s.name: index}
        inside = {name: self.leaves_like(scope[name], name) for name in carried}
        inner.update(inside)
        self.block(s.body, inner)
        loop = Loop(index, s.name, s.start, s.stop, limit, self.items, [])
        self.items, self.values.line = outer, line
        changed = {
            name
            for name in carried
            if any(x is not y for x, y in zip(leaves(inside[name]), leaves(inner[name]), strict=True))
        }
        if changed == set(carried):
            for name in carried:
                scope[name] = self.carry(loop, name, inside[name], scope[name], inner[name])
        return loop, changed

    def leaves_like(self, value: Value, name: str) -> Value:
        """New variables in the shape of a value."""
        if isinstance(value, dict):
            return {key: self.leaves_like(part, key) for key, part in value.items()}
        return self.leaf(value.type, name)

    def carry(self, loop: Loop, name: str, inside: Value, initial: Value, following: Value) -> Value:
        """Note what an iteration hands on; the value behind the loop."""
        if isinstance(inside, dict):
            assert isinstance(initial, dict)
            assert isinstance(following, dict)
            return {k: self.carry(loop, k, inside[k], initial[k], following[k]) for k in inside}
        assert isinstance(inside, ir.Var)
        assert not isinstance(initial, dict)
        assert not isinstance(following, dict)
        outside = self.leaf(inside.type, name)
        loop.carried.append(Carried(inside, outside, name, initial, following))
        return outside

    def scalar(self, e: ir.Expr, scope: Scope) -> ir.Expr:
        value = self.expr(e, scope)
        assert not isinstance(value, dict)
        return value

    def whole(self, e: ir.Expr, scope: Scope) -> Value:
        """The value of a statement's expression."""
        return self.expr(e, scope)

    def expr(self, e: ir.Expr, scope: Scope) -> Value:
        """The value of an expression."""
        match e:
            case ir.Var():
                return scope[e.name]
            case ir.Member():
                of = self.expr(e.value, scope)
                assert isinstance(of, dict)
                return of[e.name]
            case ir.Construct() if isinstance(e.type, Struct) and not isinstance(e.type, Array):
                fields = zip(e.type.fields, e.args, strict=True)
                return {f.name: self.named(self.expr(a, scope), f.name, FIELD) for f, a in fields}
            case ir.Call():
                return self.call(e, scope)
            case _:
                parts = tuple(self.scalar(c, scope) for c in ir.children(e))
                return self.values.build(ir.rebuild(e, parts))

    def call(self, e: ir.Call, scope: Scope) -> Value:
        """A call: replaced by a rule, kept by request, or followed."""
        function = self.library.function(self.variants.get(e.function, e.function))
        if function.name != e.function:
            self.values.note("variants", f"{e.function} -> {function.name}", "asked for")
        given = [self.expr(a, scope) for a in e.args]
        if function.name in self.keep:
            arguments = tuple(
                joined(self.values, p.type, a) for p, a in zip(function.parameters, given, strict=True)
            )
            return split(self.values, self.values.build(replace(e, function=function.name, args=arguments)))
        bound = {
            p.name: self.named(a, p.name, PARAMETER) for p, a in zip(function.parameters, given, strict=True)
        }
        replaced = self.replaced(function, bound)
        if replaced is not None:
            return replaced
        return self.named(self.function(function, bound), function.name, CALL)


def joined(values: Values, type_: Type, value: Value) -> ir.Expr:
    """A value as one expression: structs are constructed."""
    if not isinstance(value, dict):
        return value
    assert isinstance(type_, Struct)
    parts = tuple(joined(values, f.type, value[f.name]) for f in type_.fields)
    return values.build(ir.Construct(type_, parts))


def split(values: Values, e: ir.Expr) -> Value:
    """An expression as a value: structs are taken apart."""
    if not isinstance(e.type, Struct):
        return e
    return {f.name: split(values, values.build(ir.Member(f.type, e, f.name))) for f in e.type.fields}


def _returns(s: ir.Stmt) -> bool:
    return any(isinstance(x, ir.Return) for x in ir.statements((s,)))


def _iterations(s: ir.For) -> list[tuple[ir.Stmt, ...]]:
    """The body of each turn."""
    if s.stop - s.start > MOST_UNROLLED:
        raise UserError(
            f"a loop that may return runs {s.stop - s.start} times; at most {MOST_UNROLLED} are unrolled"
        )
    return [(ir.Let(s.name, ir.Const(s.index_type, i)), *s.body) for i in range(s.start, s.stop)]
