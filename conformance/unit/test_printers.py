"""Printed expressions mean what the tree means, in every language.

Plan.
  property   random typed trees over every operator, built-in, conversion, constructor, component, field and
             conditional of the IR, printed in every dialect, parse back to the same tree with the language's
             tree-sitter grammar, which knows nothing of the printers
  compilers  the same kind of trees, many in one module, are accepted by every dialect's own compiler
  literals   the printed decimal is a visible float, is the shortest, and reads back to the same float32 both
             through double precision and rounded once from the exact decimal
Not covered: statements (test_emit) and values (test_evaluate).
"""

import random
import struct
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from codegen.emit.dialect import Dialect
from codegen.emit.expr import ExprPrinter
from codegen.emit.literal import literal, shortest
from codegen.emit.stmt import StmtPrinter
from codegen.errors import Place
from codegen.ir import nodes as ir
from codegen.ir.types import BOOL, F16, F32, HVEC3, I32, U32, VALUE_TYPES, VEC3
from codegen.ir.verify import verify
from conformance.unit.support.dialects import DIALECTS, ONE_PER_TARGET, dialect_id, validate
from conformance.unit.support.neutral import of_ir, returned
from conformance.unit.support.trees import AXIS, expression, function_of, no_function, runnable

SEED = 20260730
EXAMPLES = 200
BATCH = 150
DEPTH = 4
TYPES = (*VALUE_TYPES.values(), AXIS)
NOWHERE = Place("test", 1)

# Random conditions compare things with themselves and with constants, which a compiler may point out.
SILENCED = (
    '#pragma clang diagnostic ignored "-Wtautological-compare"',
    '#pragma clang diagnostic ignored "-Wconstant-logical-operand"',
)


def wrapped(e: ir.Expr, dialect: Dialect) -> str:
    """The smallest text around a printed expression that a grammar reads."""
    text = ExprPrinter(dialect).show(e)
    head = "fn f() -> f32" if dialect.target == "wgsl" else "float f()"
    return f"{head} {{ return {text}; }}\n"


@st.composite
def trees(draw: st.DrawFn) -> ir.Expr:
    def choose(options: Sequence[Any]) -> Any:
        return options[draw(st.integers(0, len(options) - 1))]

    return expression(choose, choose(TYPES), DEPTH)


@pytest.mark.parametrize("dialect", ONE_PER_TARGET, ids=dialect_id)
@settings(
    max_examples=EXAMPLES,
    derandomize=True,
    database=None,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
)
@given(e=trees())
def test_text_parses_back_to_the_same_tree(dialect: Dialect, e: ir.Expr) -> None:
    text = wrapped(e, dialect)
    assert returned(dialect.target, text) == of_ir(e, dialect), text


@pytest.mark.parametrize("dialect", ONE_PER_TARGET, ids=dialect_id)
def test_text_of_deeper_trees_parses_back(dialect: Dialect) -> None:
    """Every dialect of a language prints expressions alike, so one of each is enough."""
    choose = random.Random(SEED).choice
    for _ in range(BATCH):
        e = expression(choose, choose(TYPES), DEPTH + 2)
        text = wrapped(e, dialect)
        assert returned(dialect.target, text) == of_ir(e, dialect), text


def module(dialect: Dialect, seed: int) -> str:
    """Many random functions and the struct they use, as one library text."""
    choose = random.Random(seed).choice
    printer = StmtPrinter(dialect)
    lines = [*SILENCED] if dialect.target == "opencl" else []
    lines += printer.struct(AXIS)
    for k in range(BATCH):
        function = function_of(
            runnable(expression(choose, TYPES[k % len(TYPES)], DEPTH)), f"tree_{k}", NOWHERE
        )
        verify(function, no_function)
        lines += printer.function(function)
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("dialect", DIALECTS, ids=dialect_id)
def test_compilers_accept_random_functions(dialect: Dialect) -> None:
    validate(module(dialect, SEED), dialect)


TRAPS: dict[str, Callable[[ir.Expr, ir.Expr, ir.Expr], ir.Expr]] = {
    "a - (b - c)": lambda a, b, c: ir.Binary(F32, "-", a, ir.Binary(F32, "-", b, c)),
    "(a - b) - c": lambda a, b, c: ir.Binary(F32, "-", ir.Binary(F32, "-", a, b), c),
    "a / (b * c)": lambda a, b, c: ir.Binary(F32, "/", a, ir.Binary(F32, "*", b, c)),
    "(a + b) + c": lambda a, b, c: ir.Binary(F32, "+", ir.Binary(F32, "+", a, b), c),
    "a + (b + c)": lambda a, b, c: ir.Binary(F32, "+", a, ir.Binary(F32, "+", b, c)),
    "a - (-b)": lambda a, b, c: ir.Binary(F32, "-", a, ir.Unary(F32, "negate", b)),
    "-(-a)": lambda a, b, c: ir.Unary(F32, "negate", ir.Unary(F32, "negate", a)),
    "-(-1)": lambda a, b, c: ir.Unary(F32, "negate", ir.Const(F32, -1.0)),
    "-(-0)": lambda a, b, c: ir.Unary(F32, "negate", ir.Const(F32, -0.0)),
    "a - (-0)": lambda a, b, c: ir.Binary(F32, "-", a, ir.Const(F32, -0.0)),
    "a * (-1)": lambda a, b, c: ir.Binary(F32, "*", a, ir.Const(F32, -1.0)),
}


@pytest.mark.parametrize("name", TRAPS)
@pytest.mark.parametrize("dialect", ONE_PER_TARGET, ids=dialect_id)
def test_known_trap_parses_back(name: str, dialect: Dialect) -> None:
    a, b, c = (ir.Var(F32, name) for name in "abc")
    e = TRAPS[name](a, b, c)
    text = wrapped(e, dialect)
    assert returned(dialect.target, text) == of_ir(e, dialect), text


def test_comparisons_among_arguments_open_no_template() -> None:
    """f(a < b, c > (d)) is a template in WGSL; an argument that nothing can close stays bare."""
    a, b = ir.Var(F32, "a"), ir.Var(F32, "b")
    less, more = ir.Binary(BOOL, "<", a, b), ir.Binary(BOOL, ">", a, b)
    both, either = (ir.Binary(BOOL, op, more, less) for op in ("and", "or"))
    texts: dict[str, tuple[ir.Expr, ...]] = {
        "f((a < b), a > b)": (less, more),
        "f(a > b, a < b)": (more, less),
        "f((a > b && a < b), a > b)": (both, more),
        "f((a > b || a < b), a > b)": (either, more),
        "f(g(a < b), a > b)": (ir.Call(F32, "g", (less,)), more),
        "f(a, a < b)": (a, less),
    }
    for wanted, args in texts.items():
        for dialect in ONE_PER_TARGET:
            assert ExprPrinter(dialect).show(ir.Call(F32, "f", args)) == wanted


def test_conversions_of_vectors_are_calls_in_every_language() -> None:
    """Also in OpenCL C, where a conversion of a number is a cast, which an operand after a point is not."""
    v = ir.Convert(HVEC3, ir.Var(VEC3, "v"))
    part, double = ir.Swizzle(F16, v, "y"), ir.Binary(HVEC3, "*", v, v)
    texts = [(ExprPrinter(d).show(part), ExprPrinter(d).show(double)) for d in ONE_PER_TARGET]
    assert texts == [
        ("vec3(v).y", "vec3(v) * vec3(v)"),
        ("vec3<f16>(v).y", "vec3<f16>(v) * vec3<f16>(v)"),
        ("convert_half3(v).y", "convert_half3(v) * convert_half3(v)"),
    ]


def test_operations_on_literals_alone_are_single_precision() -> None:
    """WGSL computes 0.7 + 0.1 in double precision, and 0.7f + 0.1f as the other targets do."""
    wgsl = next(d for d in ONE_PER_TARGET if d.target == "wgsl")
    x, seven, one = ir.Var(F32, "x"), ir.Const(F32, 0.7), ir.Const(F32, 0.1)
    literals = ir.Binary(F32, "+", seven, one)
    pair = ir.Construct(VALUE_TYPES["vec2"], (seven, one))
    texts: dict[str, ir.Expr] = {
        "0.7f + 0.1f": literals,
        "x * (0.7f + 0.1f)": ir.Binary(F32, "*", x, literals),
        "max(0.7f, 0.1f) * x": ir.Binary(F32, "*", ir.Builtin(F32, "max", (seven, one)), x),
        "(vec2<f32>(0.7f, 0.1f) * 0.7f).x": ir.Swizzle(F32, ir.Binary(pair.type, "*", pair, seven), "x"),
        "0.7f < 0.1f": ir.Binary(BOOL, "<", seven, one),
        "select(0.7f, 0.1f, true) * (-0.7f)": ir.Binary(
            F32, "*", ir.Select(F32, ir.Const(BOOL, True), one, seven), ir.Const(F32, -0.7)
        ),
        "0.7 * x + 0.1": ir.Binary(F32, "+", ir.Binary(F32, "*", seven, x), one),
        "vec2<f32>(0.7, 0.1)": pair,
        "f(0.7) + 0.1": ir.Binary(F32, "+", ir.Call(F32, "f", (seven,)), one),
    }
    for wanted, e in texts.items():
        assert ExprPrinter(wgsl).show(e) == wanted
    others = {ExprPrinter(d).show(literals) for d in ONE_PER_TARGET if d is not wgsl}
    assert others == {"0.7 + 0.1", "0.7f + 0.1f"}


def test_conditional_keeps_its_sides() -> None:
    e = ir.Select(VEC3, ir.Var(VALUE_TYPES["bool"], "c"), ir.Var(VEC3, "a"), ir.Var(VEC3, "b"))
    texts = [ExprPrinter(d).show(e) for d in ONE_PER_TARGET]
    assert texts == ["c ? a : b", "select(b, a, c)", "c ? a : b"]


def float_of(bits: int) -> float:
    value: float = struct.unpack("<f", struct.pack("<I", bits))[0]
    return value


SPECIAL_BITS = [
    0x00000000,  # 0
    0x80000000,  # -0
    0x00800000,  # smallest normal
    0x00800001,
    0x7F7FFFFF,  # largest
    0xFF7FFFFF,
    0x3F800000,  # 1
    0x3F7FFFFF,  # below 1
    0x3F800001,  # above 1
    0x3DCCCCCD,  # 0.1
    0x3EAAAAAB,  # 1/3
    0x40490FDB,  # pi
    0x3EA2F983,  # 1/pi
    0x4B7FFFFF,  # 2^24 - 1
    0x4B800000,  # 2^24
    0x4B189680,  # 1e7
    0x4B18967F,
    0x38D1B717,  # 1e-4
    0x38D1B716,
    0x501502F9,  # 1e10
    0x7149F2CA,  # 1e30
    0x0DA24260,  # 1e-30
    0x5D5E0B6B,  # 1e18
    0x15AE43FD,  # 7.038531e-26: nine digits decide it
    *(0x00800000 * k for k in range(1, 255)),  # every power of two
]
RANDOM_BITS = 4000


def sample_floats() -> list[float]:
    """Special floats and random normal ones of both signs."""
    rng = random.Random(SEED)
    drawn = [rng.randrange(0x00800000, 0x7F800000) | rng.choice((0, 0x80000000)) for _ in range(RANDOM_BITS)]
    return [float_of(bits) for bits in (*SPECIAL_BITS, *drawn)]


def rounded_once(text: str) -> float:
    """The float32 nearest to the exact decimal, ties to even, without going through a double."""
    exact = Fraction(text)
    guess = float(text)
    near = struct.unpack("<I", struct.pack("<f", abs(guess)))[0]
    candidates = [bits for bits in (near - 1, near, near + 1) if 0 <= bits < 0x7F800000]
    best = min(candidates, key=lambda bits: (abs(Fraction(float_of(bits)) - abs(exact)), bits & 1))
    return -float_of(best) if text.startswith("-") else float_of(best)


def same_float(a: float, b: float) -> bool:
    return struct.pack("<f", a) == struct.pack("<f", b)


def test_literals_read_back_to_the_same_float() -> None:
    wrong = []
    for value in sample_floats():
        text = shortest(value)
        if not (same_float(float(text), value) and same_float(rounded_once(text), value)):
            wrong.append((value.hex(), text))
    assert not wrong


def digits(text: str) -> int:
    mantissa = text.lstrip("-").split("e")[0].replace(".", "").lstrip("0")
    return len(mantissa.rstrip("0")) or 1


def test_literals_are_as_short_as_possible() -> None:
    """No decimal with one digit less reads back to the same float."""
    wrong = []
    for value in sample_floats():
        text = shortest(value)
        fewer = digits(text) - 1
        if fewer and same_float(float(f"{value:.{fewer}g}"), value):
            wrong.append((value.hex(), text))
    assert not wrong


WRITTEN = {
    0.0: "0.0",
    0.5: "0.5",
    1.0: "1.0",
    0.1: "0.1",
    -2.25: "-2.25",
    1e-4: "0.0001",
    9.0e-5: "9e-5",
    1.25e-5: "1.25e-5",
    9999999.0: "9999999.0",
    1e7: "1e7",
    16777216.0: "1.6777216e7",
    1e30: "1e30",
}
"""As a person would write them: with an exponent only below 1e-4 and from 1e7 on."""


@pytest.mark.parametrize("value", WRITTEN)
def test_literals_are_written_as_a_person_would(value: float) -> None:
    assert shortest(float(np.float32(value))) == WRITTEN[value]


@pytest.mark.parametrize("dialect", ONE_PER_TARGET, ids=dialect_id)
def test_float_literals_look_like_floats(dialect: Dialect) -> None:
    texts = [literal(ir.Const(F32, value), dialect) for value in sample_floats()]
    suffix = "f" if dialect.target == "opencl" else ""
    wrong = [t for t in texts if not t.endswith(suffix) or not set(t.removesuffix("f")) & {".", "e"}]
    assert not wrong


@pytest.mark.parametrize("dialect", ONE_PER_TARGET, ids=dialect_id)
def test_other_literals(dialect: Dialect) -> None:
    consts = [
        ir.Const(U32, 7),
        ir.Const(U32, 2**32 - 1),
        ir.Const(I32, -7),
        ir.Const(BOOL, True),
        ir.Const(BOOL, False),
    ]
    assert [literal(c, dialect) for c in consts] == ["7u", "4294967295u", "-7", "true", "false"]
