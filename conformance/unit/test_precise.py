"""Emission with `precise`: every operation contributes to a qualified variable, and nothing else changes.

Plan. The pass gives every computed return a local with a free name; the printer qualifies locals that hold
floats; the whole library so emitted is valid GLSL where a validator is here; a dialect without the qualifier
refuses. That drivers still give results within bounds is the mode "precise" of conformance/drivers.
"""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from codegen.backends import dialect, dialects_of
from codegen.emit.dialect import with_precise
from codegen.emit.module import emit
from codegen.errors import UserError
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F32
from codegen.ir.unit import Unit
from codegen.library import load_library
from codegen.passes.printing.precise import STEM, name_results
from targets.glsl import validate

LOCAL = re.compile(r"^ +(precise )?(float|u?int|bool|[u]?vec\d|vair_\w+) \w+ =", re.MULTILINE)


def test_every_computed_return_gets_a_local() -> None:
    selection = load_library().select()
    unit = name_results(Unit(selection.functions, selection.structs))
    for before, f in zip(selection.functions, unit.functions, strict=True):
        for s in ir.statements(f.body):
            assert not isinstance(s, ir.Return) or isinstance(s.value, ir.Var | ir.Const)
        names = [s.name for s in ir.statements(before.body) if isinstance(s, ir.Let)]
        added = {s.name for s in ir.statements(f.body) if isinstance(s, ir.Let)} - set(names)
        assert all(name.strip("_") == STEM for name in added)


def test_name_that_is_taken_is_not_taken_again() -> None:
    f = load_library().function("sin_angle")
    taken = ir.Let(STEM, ir.Const(f.returns, 1.0))
    from_taken = name_results(Unit((replace(f, body=(taken, *f.body)),), ())).functions[0]
    lets = [s.name for s in ir.statements(from_taken.body) if isinstance(s, ir.Let)]
    assert len(lets) == len(set(lets))
    assert f"{STEM}_" in lets


def test_name_of_a_parameter_or_of_a_loop_is_not_taken() -> None:
    one = ir.Const(F32, 1.0)
    sum_ = ir.Return(ir.Binary(F32, "+", one, one))
    like = load_library().function("sin_angle")
    for parameters, body in (
        ((ir.Parameter(STEM, F32, None),), (ir.Let("other", one), sum_)),
        ((), (ir.For(STEM, 0, 3, (), 1), sum_)),
    ):
        f = replace(like, parameters=parameters, body=body)
        (made,) = name_results(Unit((f,), ())).functions
        assert [s.name for s in made.body if isinstance(s, ir.Let)][-1] == f"{STEM}_"


@pytest.mark.parametrize("name", [d.name for d in dialects_of("glsl").values() if d.precise])
def test_whole_library_is_valid_and_every_float_local_is_qualified(name: str) -> None:
    text = emit(load_library(), with_precise(dialect("glsl", name)))
    found = list(LOCAL.finditer(text))
    assert found
    for match in found:
        whole_number = match.group(2) in ("int", "uint", "bool", "uvec2", "uvec3")
        assert bool(match.group(1)) != whole_number, match.group(0)
    assert "--precise" in text.splitlines()[1]
    if missing := validate.validator_available():
        pytest.skip(missing)
    validate.validate(text, name)


@pytest.mark.parametrize(("target", "name"), [("glsl", "330"), ("glsl", "es300"), ("opencl", "1.2")])
def test_dialect_without_the_qualifier_refuses(target: str, name: str) -> None:
    with pytest.raises(UserError, match="has no precise qualifier"):
        with_precise(dialect(target, name))


def test_results_are_named_on_every_side_and_in_loops() -> None:
    x = ir.Var(F32, "x")
    computed = ir.Return(ir.Binary(F32, "*", x, x))
    test = ir.Binary(BOOL, "<", x, x)
    body = (ir.For("i", 0, 2, (ir.If(test, (computed,), (computed,)),)), computed)
    function = replace(load_library().function("sin_angle"), body=body)
    (made,) = name_results(Unit((function,), ())).functions
    returned = [s.value for s in ir.statements(made.body) if isinstance(s, ir.Return)]
    assert returned == [ir.Var(F32, STEM)] * 3
    assert [type(s) for s in made.body] == [ir.For, ir.Let, ir.Return]
