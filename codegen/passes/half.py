"""Half precision: f32 becomes f16, and constants that are no halves become what the data states.

before   def opacity(x: f32) -> f32:  return 1.0 - exp(-min(x, 80.0))
after    def opacity(x: f16) -> f16:  return 1.0h - exp(-min(x, 9.7h))

Parameters that the data lists stay f32. An operation on f32 alone stays f32; where f32 meets f16, it is
converted to f16. A call with f32 arguments alone calls the function's f32 text, under a name of its own.
Results and fields of structs are f16. Literals follow the values they stand beside.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace

from codegen.errors import UserError
from codegen.ir import nodes as ir
from codegen.ir.types import F16, F32, Struct, Type, element_of, half_of
from codegen.library import Library
from codegen.ops import BUILTINS

SMALLEST_NORMAL = 2.0**-14
"""Below it a half is denormal, and a device may flush it to zero."""
SINGLE_SUFFIX = "_single"


@dataclass(frozen=True)
class HalfRules:
    """What the pass has to be told.

    constants  (float32 value, function or "" for all) -> the half to use instead
    single     function -> its parameters that stay f32
    """

    constants: Mapping[tuple[float, str], float] = field(default_factory=dict)
    single: Mapping[str, frozenset[str]] = field(default_factory=dict)


@dataclass(frozen=True)
class Version:
    """One text of a library function: its half form, or the f32 text that half forms call."""

    source: ir.Function
    function: ir.Function
    is_half: bool


def half_versions(library: Library, names: Iterable[str], rules: HalfRules) -> tuple[Version, ...]:
    """The half forms of these functions and of all they need, dependencies first.

    raises  UserError for a constant that no half can hold and no rule replaces
    """
    halver = _Halver(library, rules)
    for name in names:
        halver.half(name)
    return tuple(halver.versions.values())


def half_structs(structs: Iterable[ir.StructDef]) -> tuple[ir.StructDef, ...]:
    """The structs with fields in f16."""
    made = []
    for s in structs:
        type_ = half_of(s.type)
        assert isinstance(type_, Struct)
        made.append(replace(s, type=type_))
    return tuple(made)


def to_half(value: float) -> float:
    """The nearest half, ties to even; raises OverflowError beyond 65519."""
    rounded: float = struct.unpack("<e", struct.pack("<e", value))[0]
    return rounded


class _Halver:
    def __init__(self, library: Library, rules: HalfRules) -> None:
        self.library = library
        self.rules = rules
        self.versions: dict[tuple[str, bool], Version] = {}

    def half(self, name: str) -> ir.Function:
        """The half form of a function, made once."""
        if (name, True) not in self.versions:
            source = self.library.function(name)
            made = _Body(self, source).function()
            self.versions[name, True] = Version(source, made, True)
        return self.versions[name, True].function

    def single(self, name: str) -> ir.Function:
        """The f32 text of a function under its own name, with all it calls."""
        if (name, False) not in self.versions:
            source = self.library.function(name)

            def rename(e: ir.Expr) -> ir.Expr:
                return replace(e, function=self.single(e.function).name) if isinstance(e, ir.Call) else e

            body = ir.map_body(source.body, rename)
            made = replace(source, name=name + SINGLE_SUFFIX, body=body)
            self.versions[name, False] = Version(source, made, False)
        return self.versions[name, False].function

    def has_single(self, name: str) -> bool:
        """Whether the function's f32 text touches no struct: structs are halves."""
        f = self.library.function(name)
        types = [f.returns, *(p.type for p in f.parameters), *(e.type for e in ir.expressions(f.body))]
        return not any(isinstance(t, Struct) for t in types) and all(map(self.has_single, ir.callees(f)))


def _is_float(type_: Type) -> bool:
    return element_of(type_) in (F16, F32)


class _Body:
    """One function on its way to halves: the scope maps names to their new types."""

    def __init__(self, halver: _Halver, source: ir.Function) -> None:
        self.halver = halver
        self.source = source
        self.kept = halver.rules.single.get(source.name, frozenset())

    def function(self) -> ir.Function:
        parameters = tuple(
            p if p.name in self.kept else replace(p, type=half_of(p.type)) for p in self.source.parameters
        )
        body = self.block(self.source.body, {p.name: p.type for p in parameters})
        returns = half_of(self.source.returns)
        return replace(self.source, parameters=parameters, returns=returns, body=body)

    def block(self, body: tuple[ir.Stmt, ...], outer: Mapping[str, Type]) -> tuple[ir.Stmt, ...]:
        scope, found = dict(outer), []
        for s in body:
            made: ir.Stmt
            match s:
                case ir.Let():
                    made = replace(s, value=self.own(s.value, scope))
                    scope[s.name] = made.value.type
                case ir.Assign():
                    made = replace(s, value=self.coerced(s.value, scope[s.name], scope))
                case ir.Return():
                    made = replace(s, value=self.coerced(s.value, half_of(self.source.returns), scope))
                case ir.If():
                    made = replace(
                        s,
                        condition=self.own(s.condition, scope),
                        then=self.block(s.then, scope),
                        orelse=self.block(s.orelse, scope),
                    )
                case ir.For():
                    limit = None if s.limit is None else self.own(s.limit, scope)
                    made = replace(s, limit=limit, body=self.block(s.body, {**scope, s.name: s.index_type}))
            found.append(made)
        return tuple(found)

    def element(self, parts: Iterable[ir.Expr], scope: Mapping[str, Type]) -> Type | None:
        """f32 where there are floats among the parts and all of them, literals aside, are f32; else f16;
        None for literals alone.
        """
        found = {self.natural(part, scope) for part in parts if _is_float(part.type)} - {None}
        return None if not found else F32 if found == {F32} else F16

    def natural(self, e: ir.Expr, scope: Mapping[str, Type]) -> Type | None:
        """The element that the floats of an expression have by themselves; literals have None."""
        match e:
            case ir.Var():
                return element_of(scope[e.name])
            case ir.Call():
                return F32 if self.calls_single(e, scope) else F16
            case ir.Member():
                return F16
            case ir.Builtin() if not BUILTINS[e.op].half:
                return F32
            case _:
                return self.element(ir.children(e), scope)

    def calls_single(self, e: ir.Call, scope: Mapping[str, Type]) -> bool:
        """Whether all arguments, literals aside, are f32, and the function's f32 text can be called."""
        return self.element(e.args, scope) == F32 and self.halver.has_single(e.function)

    def own(self, e: ir.Expr, scope: Mapping[str, Type]) -> ir.Expr:
        """The expression with the element that it has by itself."""
        return self.lower(e, scope, self.natural(e, scope))

    def coerced(self, e: ir.Expr, wanted: Type, scope: Mapping[str, Type]) -> ir.Expr:
        """The expression as a value of the wanted type; literals take it at once."""
        if self.natural(e, scope) is None:
            return self.lower(e, scope, element_of(wanted))
        made = self.own(e, scope)
        return made if made.type == wanted else ir.Convert(wanted, made)

    def lower(self, e: ir.Expr, scope: Mapping[str, Type], element: Type | None) -> ir.Expr:
        """The expression with this element: the one that it has by itself, or that literals take here.

        Whatever is not f32 makes halves of floats; structs hold halves in any case.
        """

        def becomes(type_: Type) -> Type:
            return type_ if element == F32 and not isinstance(type_, Struct) else half_of(type_)

        match e:
            case ir.Const():
                return e if becomes(e.type) == e.type else self.constant(e)
            case ir.Call():
                return self.call(e, scope)
            case ir.Construct() if isinstance(e.type, Struct):
                made = half_of(e.type)
                assert isinstance(made, Struct)
                pairs = zip(e.args, made.fields, strict=True)
                return ir.Construct(made, tuple(self.coerced(a, f.type, scope) for a, f in pairs))
            case _:
                parts = tuple(self.coerced(p, becomes(p.type), scope) for p in ir.children(e))
                return replace(ir.rebuild(e, parts), type=becomes(e.type))

    def call(self, e: ir.Call, scope: Mapping[str, Type]) -> ir.Expr:
        if self.calls_single(e, scope):
            callee = self.halver.single(e.function)
        else:
            callee = self.halver.half(e.function)
        pairs = zip(e.args, callee.parameters, strict=True)
        return ir.Call(callee.returns, callee.name, tuple(self.coerced(a, p.type, scope) for a, p in pairs))

    def constant(self, e: ir.Const) -> ir.Const:
        value = float(e.value)
        constants = self.halver.rules.constants
        stated = constants.get((abs(value), self.source.name), constants.get((abs(value), "")))
        if stated is not None:
            return ir.Const(F16, to_half(-stated if value < 0.0 else stated))
        try:
            rounded = to_half(value)
        except OverflowError:
            raise UserError(
                f"{self.source.name} has the constant {value:.9g}, which no half can hold (at most 65504)"
            ) from None
        if value != 0.0 and abs(rounded) < SMALLEST_NORMAL:
            raise UserError(
                f"{self.source.name} has the constant {value:.9g}, which halves lose (normal from 6.1e-5 on)"
            )
        return ir.Const(F16, rounded)
