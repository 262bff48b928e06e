"""The verifier accepts what the front end and the passes make, and refuses what neither may make.

Plan. Every function of the library passes after lowering and after every pass. Functions malformed by hand,
one defect each, are refused with a message that names the function and the defect.
"""

import pytest

from codegen.errors import Place
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32, I32, U32, VEC2, VEC3, Field, Struct, Type
from codegen.ir.unit import Unit
from codegen.ir.verify import MalformedIRError, verify, verify_selection
from codegen.library import load_library
from codegen.passes import run_passes
from codegen.passes.printing.rename import add_prefix
from conformance.unit.support.trees import no_function

NOWHERE = Place("test", 1)
PAIR = Struct("Pair", (Field("first", F32), Field("second", VEC3)))
X, N, V, C = ir.Var(F32, "x"), ir.Var(U32, "n"), ir.Var(VEC3, "v"), ir.Var(BOOL, "c")
PARAMETERS = (("x", F32), ("n", U32), ("v", VEC3), ("c", BOOL), ("pair", PAIR))
ONE = ir.Const(F32, 1.0)


def function(*body: ir.Stmt, returns: Type = F32) -> ir.Function:
    parameters = tuple(ir.Parameter(name, type_, None) for name, type_ in PARAMETERS)
    return ir.Function("probe", "", "base", None, parameters, returns, body, ir.Doc("", {}), NOWHERE)


def half_of(name: str) -> tuple[tuple[Type, ...], Type] | None:
    return ((F32,), F32) if name == "half_of" else None


def test_every_library_function_is_well_formed() -> None:
    verify_selection(load_library().select().functions)


def test_every_pass_keeps_functions_well_formed() -> None:
    """run_passes is the whole list; each pass that it is made of is also tried alone."""
    selection = load_library().select()
    verify_selection(run_passes(selection, "vair_").functions)
    verify_selection(add_prefix(Unit(selection.functions, selection.structs), "other_").functions)


def test_prefix_reaches_every_name_and_no_other() -> None:
    selection = load_library().select()
    unit = run_passes(selection, "other_")
    defined = [f.name for f in unit.functions] + [s.type.name for s in unit.structs]
    called = {callee for f in unit.functions for callee in ir.callees(f)}
    assert all(name.startswith("other_") for name in defined)
    assert called <= set(defined)
    before = [[p.name for p in f.parameters] for f in selection.functions]
    assert [[p.name for p in f.parameters] for f in unit.functions] == before


GOOD: dict[str, tuple[ir.Stmt, ...]] = {
    "return": (ir.Return(X),),
    "branches": (ir.If(C, (ir.Return(X),), (ir.Return(ONE),)),),
    "mutable": (ir.Let("y", X, True), ir.Assign("y", ONE), ir.Return(ir.Var(F32, "y"))),
    "loop": (
        ir.Let("y", X, True),
        ir.For("i", 0, 3, (ir.Assign("y", ir.Convert(F32, ir.Var(I32, "i"))),)),
        ir.Return(ir.Var(F32, "y")),
    ),
    "splat": (ir.Return(ir.Swizzle(F32, ir.Construct(VEC3, (X,)), "x")),),
    "joined": (ir.Return(ir.Swizzle(F32, ir.Construct(VEC3, (ir.Swizzle(VEC2, V, "xy"), X)), "z")),),
    "field": (ir.Return(ir.Member(F32, ir.Construct(PAIR, (X, V)), "first")),),
    "call": (ir.Return(ir.Call(F32, "half_of", (X,))),),
}


@pytest.mark.parametrize("name", GOOD)
def test_well_formed_function_is_accepted(name: str) -> None:
    verify(function(*GOOD[name]), half_of)


MALFORMED: dict[str, tuple[tuple[ir.Stmt, ...], str]] = {
    "wrong mark": ((ir.Return(ir.Binary(F32, "+", X, V)),), "Binary is marked f32"),
    "wrong mark of a condition": ((ir.Return(ir.Binary(F32, "<", X, X)),), "marked f32 but gives bool"),
    "wrong built-in": ((ir.Return(ir.Builtin(F32, "sqrt", (N,))),), "Builtin is marked f32 but gives None"),
    "wrong arity": ((ir.Return(ir.Builtin(F32, "max", (X,))),), "Builtin is marked f32 but gives None"),
    "unknown name": ((ir.Return(ir.Var(F32, "y")),), "Var is marked f32 but gives None"),
    "name of another type": ((ir.Return(ir.Var(F32, "n")),), "Var is marked f32 but gives u32"),
    "whole float": ((ir.Return(ir.Const(F32, 1)),), "Const is marked f32"),
    "truth as a number": ((ir.Return(ir.Const(F32, True)),), "Const is marked f32"),
    "unknown function": ((ir.Return(ir.Call(F32, "nothing", (X,))),), "Call is marked f32 but gives None"),
    "argument": ((ir.Return(ir.Call(F32, "half_of", (N,))),), "Call is marked f32 but gives None"),
    "result": ((ir.Return(N),), "returns u32"),
    "no statements": ((), "a path without return"),
    "no return": ((ir.Let("y", X),), "a path without return"),
    "no return in a branch": ((ir.If(C, (ir.Return(X),)),), "a path without return"),
    "return in a loop only": ((ir.For("i", 0, 3, (ir.Return(X),)),), "a path without return"),
    "immutable": ((ir.Let("y", X), ir.Assign("y", ONE), ir.Return(X)), '"y" is not a mutable local'),
    "parameter": ((ir.Assign("x", ONE), ir.Return(X)), '"x" is not a mutable local'),
    "loop variable": (
        (ir.For("i", 0, 3, (ir.Assign("i", ir.Const(I32, 1)),)), ir.Return(X)),
        '"i" is not a mutable local',
    ),
    "another type": (
        (ir.Let("y", X, True), ir.Assign("y", N), ir.Return(X)),
        '"y" is not a mutable local of type u32',
    ),
    "unassigned": ((ir.Assign("y", X), ir.Return(X)), '"y" is not a mutable local'),
    "twice": ((ir.Let("y", X), ir.Let("y", X), ir.Return(X)), '"y" is defined twice'),
    "over a parameter": ((ir.Let("x", X), ir.Return(X)), '"x" is defined twice'),
    "over a loop": ((ir.For("x", 0, 3, ()), ir.Return(X)), '"x" is defined twice'),
    "out of a block": ((ir.If(C, (ir.Let("y", X),)), ir.Return(ir.Var(F32, "y"))), "Var is marked f32"),
    "out of a loop": (
        (ir.For("i", 0, 3, ()), ir.Return(ir.Convert(F32, ir.Var(I32, "i")))),
        "Var is marked i32",
    ),
    "condition": ((ir.If(X, (ir.Return(X),), (ir.Return(X),)),), "a condition that is no truth value"),
    "sides": ((ir.Return(ir.Select(F32, C, X, N)),), "Select is marked f32 but gives None"),
    "structs": (
        (ir.Return(ir.Member(F32, ir.Select(PAIR, C, ir.Var(PAIR, "pair"), ir.Var(PAIR, "pair")), "first")),),
        "Select is marked Pair but gives None",
    ),
    "component": ((ir.Return(ir.Swizzle(F32, ir.Swizzle(VEC2, V, "xy"), "z")),), "Swizzle is marked f32"),
    "component of a number": ((ir.Return(ir.Swizzle(F32, X, "x")),), "Swizzle is marked f32"),
    "field": ((ir.Return(ir.Member(F32, ir.Var(PAIR, "pair"), "third")),), "Member is marked f32"),
    "parts": ((ir.Return(ir.Swizzle(F32, ir.Construct(VEC3, (X, X)), "x")),), "Construct is marked vec3"),
    "parts of integers": (
        (ir.Return(ir.Swizzle(F32, ir.Construct(VEC3, (N,)), "x")),),
        "Construct is marked",
    ),
    "fields": ((ir.Return(ir.Member(F32, ir.Construct(PAIR, (X, X)), "first")),), "Construct is marked Pair"),
    "conversion": ((ir.Return(ir.Convert(F32, C)),), "Convert is marked f32"),
    "conversion of a vector": ((ir.Return(ir.Convert(F32, V)),), "Convert is marked f32"),
    "unreachable": ((ir.Return(X), ir.Return(X)), "never reached"),
    "unknown operator": ((ir.Return(ir.Binary(F32, "**", X, X)),), "Binary is marked f32 but gives None"),
    "unknown built-in": ((ir.Return(ir.Builtin(F32, "mix", (X,))),), "Builtin is marked f32 but gives None"),
}


@pytest.mark.parametrize("name", MALFORMED)
def test_malformed_function_is_refused(name: str) -> None:
    body, defect = MALFORMED[name]
    with pytest.raises(MalformedIRError) as caught:
        verify(function(*body), half_of)
    assert str(caught.value).startswith("probe: ")
    assert defect in str(caught.value)


def test_two_parameters_of_one_name_are_refused() -> None:
    parameters = (ir.Parameter("x", F32, None), ir.Parameter("x", U32, None))
    f = ir.Function("probe", "", "base", None, parameters, F32, (ir.Return(X),), ir.Doc("", {}), NOWHERE)
    with pytest.raises(MalformedIRError, match='two parameters named "x"'):
        verify(f, no_function)


def test_call_before_definition_is_refused() -> None:
    caller = function(ir.Return(ir.Call(F32, "half_of", (X,))))
    with pytest.raises(MalformedIRError, match="Call is marked f32"):
        verify_selection((caller,))
