"""The front end turns sources into the IR that their text means.

Plan. Small sources against IR written by hand: inferred types, literals, constants (folded in double and
rounded once), operators, augmented assignment, branches, loops, components, structs, imports
and aliases, kinds, docs and domains. Everything lowered here also passes the verifier.
"""

from pathlib import Path

import numpy as np
import pytest

from codegen.frontend.constants import to_float32
from codegen.ir import nodes as ir
from codegen.ir.domains import Finite, Interval, Length, Unit
from codegen.ir.types import BOOL, F32, I32, U32, UVEC3, VEC2, VEC3, VEC4, Struct, Type
from codegen.ir.verify import verify_selection
from codegen.library import Library
from conformance.unit.support.sources import library_of, write_library

HEAD = "def probe(x: X, n: u32, k: i32, flag: bool, v: V, p: P) -> {}:\n"
X, N, K, FLAG = ir.Var(F32, "x"), ir.Var(U32, "n"), ir.Var(I32, "k"), ir.Var(BOOL, "flag")
TRUE = ir.Const(BOOL, True)
V, P = ir.Var(VEC3, "v"), ir.Var(VEC2, "p")


def body_of(folder: Path, lines: str, returns: str = "f32", before: str = "") -> tuple[ir.Stmt, ...]:
    """The lowered statements of `probe`."""
    text = "".join(f"    {line}\n" for line in lines.strip("\n").splitlines())
    library = library_of(folder, before + HEAD.format(returns) + text)
    verify_selection(library.select(["probe"]).functions)
    return library.function("probe").body


def f32(value: float) -> ir.Const:
    return ir.Const(F32, float(np.float32(value)))


def var(name: str, type_: Type = F32) -> ir.Var:
    return ir.Var(type_, name)


EXPRESSIONS: dict[str, tuple[str, ir.Expr]] = {
    "name": ("x", X),
    "literal": ("0.1", f32(0.1)),
    "negative literal": ("-0.1", f32(-0.1)),
    "sign": ("-x", ir.Unary(F32, "negate", X)),
    "left to right": ("x - x - 1.0", ir.Binary(F32, "-", ir.Binary(F32, "-", X, X), f32(1.0))),
    "precedence": ("x + x * x", ir.Binary(F32, "+", X, ir.Binary(F32, "*", X, X))),
    "parentheses": ("x * (x + x)", ir.Binary(F32, "*", X, ir.Binary(F32, "+", X, X))),
    "folded in double": ("x * (1.0 / 3.0)", ir.Binary(F32, "*", X, f32(1.0 / 3.0))),
    "rounded once": ("0.1 + 0.2 + 1e-9", f32(0.1 + 0.2 + 1e-9)),
    "digits that single precision loses": ("0.1 + 0.2 - 0.3", f32(0.1 + 0.2 - 0.3)),
    "folded power": ("2.0 ** -24", f32(2.0**-24)),
    "folded mixture": ("2 * 0.25", f32(0.5)),
    "folded difference": ("0.3 - 0.1", f32(0.3 - 0.1)),
    "folded product": ("0.1 * 0.3", f32(0.1 * 0.3)),
    "folded whole numbers": (
        "n + (1 + 2 * 3 - 2 ** 2)",
        ir.Binary(U32, "+", N, ir.Const(U32, 3)),
    ),
    "folded whole division": ("n + 7 // 2", ir.Binary(U32, "+", N, ir.Const(U32, 3))),
    "folded shift": ("n + (5 << 2)", ir.Binary(U32, "+", N, ir.Const(U32, 20))),
    "folded sign": ("k + -(1 + 2)", ir.Binary(I32, "+", K, ir.Const(I32, -3))),
    "powers up to 64 are folded": ("k + 1 ** 64", ir.Binary(I32, "+", K, ir.Const(I32, 1))),
    "largest numbers": (
        "u32(k + 2147483647) + 4294967295",
        ir.Binary(
            U32,
            "+",
            ir.Convert(U32, ir.Binary(I32, "+", K, ir.Const(I32, 2147483647))),
            ir.Const(U32, 4294967295),
        ),
    ),
    "smallest number": ("k + -2147483647", ir.Binary(I32, "+", K, ir.Const(I32, -2147483647))),
    "integer vector and a literal": (
        "uvec3(n) * 2",
        ir.Binary(UVEC3, "*", ir.Construct(UVEC3, (N,)), ir.Const(U32, 2)),
    ),
    "literal and an integer vector": (
        "2 * uvec3(n)",
        ir.Binary(UVEC3, "*", ir.Const(U32, 2), ir.Construct(UVEC3, (N,))),
    ),
    "scaled": ("v * x", ir.Binary(VEC3, "*", V, X)),
    "scaled from the left": ("2.0 * v", ir.Binary(VEC3, "*", f32(2.0), V)),
    "component": ("v.y", ir.Swizzle(F32, V, "y")),
    "swizzle": ("v.zx", ir.Swizzle(VEC2, V, "zx")),
    "widening swizzle": ("p.xyxx", ir.Swizzle(VEC4, P, "xyxx")),
    "splat": ("vec3(x)", ir.Construct(VEC3, (X,))),
    "joined": ("vec3(p, 1.0)", ir.Construct(VEC3, (P, f32(1.0)))),
    "integer vector": ("uvec3(n, 1, 2)", ir.Construct(UVEC3, (N, ir.Const(U32, 1), ir.Const(U32, 2)))),
    "built-in": ("max(x, 0.0)", ir.Builtin(F32, "max", (X, f32(0.0)))),
    "built-in of vectors": ("dot(v, v)", ir.Builtin(F32, "dot", (V, V))),
    "unsigned literal": ("n + 1", ir.Binary(U32, "+", N, ir.Const(U32, 1))),
    "unsigned literal first": ("1 + n", ir.Binary(U32, "+", ir.Const(U32, 1), N)),
    "signed literal": ("k - 1", ir.Binary(I32, "-", K, ir.Const(I32, 1))),
    "unsigned argument": ("max(n, 3)", ir.Builtin(U32, "max", (N, ir.Const(U32, 3)))),
    "unsigned argument first": ("max(3, n)", ir.Builtin(U32, "max", (ir.Const(U32, 3), N))),
    "bits": (
        "(n >> 3) ^ ~n",
        ir.Binary(U32, "^", ir.Binary(U32, ">>", N, ir.Const(U32, 3)), ir.Unary(U32, "~", N)),
    ),
    "whole division": (
        "n // 3 % 2",
        ir.Binary(U32, "%", ir.Binary(U32, "//", N, ir.Const(U32, 3)), ir.Const(U32, 2)),
    ),
    "conversion": ("f32(n)", ir.Convert(F32, N)),
    "conversion to itself": ("f32(x)", X),
    "conversion of a number": ("u32(7)", ir.Const(U32, 7)),
    "comparison": ("x <= 1.0", ir.Binary(BOOL, "<=", X, f32(1.0))),
    "comparison of integers": ("n == 0", ir.Binary(BOOL, "==", N, ir.Const(U32, 0))),
    "logic": (
        "flag and not flag or x > 0.0",
        ir.Binary(
            BOOL,
            "or",
            ir.Binary(BOOL, "and", FLAG, ir.Unary(BOOL, "not", FLAG)),
            ir.Binary(BOOL, ">", X, f32(0.0)),
        ),
    ),
    "three terms of logic": (
        "flag and flag and True",
        ir.Binary(BOOL, "and", ir.Binary(BOOL, "and", FLAG, FLAG), ir.Const(BOOL, True)),
    ),
    "terms of logic that are known": ("True and 1.0 < 2.0 and flag", ir.Binary(BOOL, "and", TRUE, FLAG)),
    "conditional": ("x if flag else 0.0", ir.Select(F32, FLAG, X, f32(0.0))),
    "conditional of literals": ("1 if flag else n", ir.Select(U32, FLAG, ir.Const(U32, 1), N)),
}


@pytest.mark.parametrize("name", EXPRESSIONS)
def test_expression(name: str, tmp_path: Path) -> None:
    text, expected = EXPRESSIONS[name]
    (statement,) = body_of(tmp_path, f"return {text}", expected.type.name)
    assert statement == ir.Return(expected)


CONSTANTS = """
THIRD = 1.0 / 3.0
SIXTH = THIRD / 2.0
MASK: u32 = 0x55555555
COUNT = 3
"""


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("x * THIRD", ir.Binary(F32, "*", X, f32(1.0 / 3.0))),
        ("x * SIXTH", ir.Binary(F32, "*", X, f32(1.0 / 3.0 / 2.0))),
        ("x * (2.0 * THIRD)", ir.Binary(F32, "*", X, f32(2.0 * (1.0 / 3.0)))),
        ("x * -THIRD", ir.Binary(F32, "*", X, f32(-1.0 / 3.0))),
        ("n & MASK", ir.Binary(U32, "&", N, ir.Const(U32, 0x55555555))),
        ("MASK", ir.Const(U32, 0x55555555)),
        ("MASK + 1", ir.Const(U32, 0x55555556)),
        ("MASK + COUNT ** 0", ir.Const(U32, 0x55555556)),
        ("MASK >> 1", ir.Const(U32, 0x2AAAAAAA)),
        ("MASK << 1 ^ ~u32(1)", ir.Const(U32, 0x55555554)),
        ("u32(2147483647) << 11", ir.Const(U32, 0xFFFFF800)),
        ("u32(i32(-5))", ir.Const(U32, 2**32 - 5)),
        ("u32(max(1, 4)) if 1.0 < 2.0 else n", ir.Select(U32, ir.Const(BOOL, True), ir.Const(U32, 4), N)),
    ],
)
def test_constants_are_folded_in_double_and_rounded_once(
    text: str, expected: ir.Expr, tmp_path: Path
) -> None:
    (statement,) = body_of(tmp_path, f"return {text}", expected.type.name, CONSTANTS)
    assert statement == ir.Return(expected)


def test_parameter_hides_a_constant(tmp_path: Path) -> None:
    """Also within an expression that would be a constant one."""
    (result,) = body_of(tmp_path, "return 2.0 * x", before="x = 3.0\n")
    assert result == ir.Return(ir.Binary(F32, "*", f32(2.0), X))


def test_locals_are_inferred_and_mutable_where_assigned_again(tmp_path: Path) -> None:
    body = body_of(tmp_path, "a = v\nb = x\nb = b + 1.0\nreturn b * a.x")
    assert body[0] == ir.Let("a", V)
    assert body[1] == ir.Let("b", X, mutable=True)
    assert body[2] == ir.Assign("b", ir.Binary(F32, "+", var("b"), f32(1.0)))


def test_locals_inside_blocks_are_mutable_where_assigned_again(tmp_path: Path) -> None:
    body = body_of(tmp_path, NESTED)
    loop = next(s for s in body if isinstance(s, ir.For))
    branch = next(s for s in loop.body if isinstance(s, ir.If))
    lets = [s for s in (*loop.body, *branch.then, *branch.orelse) if isinstance(s, ir.Let)]
    assert {s.name: s.mutable for s in lets} == {"b": True, "c": False, "d": True, "e": True}


NESTED = """
a = 0.0
for i in range(3):
    b = x
    c = x
    b += 1.0
    if flag:
        d = b
        d += c
        a += d
    else:
        e = c
        e *= 2.0
        a += e
return a
"""


def test_constants_that_float32_does_not_hold_are_none() -> None:
    """Beyond the largest number nothing is near; below the smallest normal one a target may read 0."""
    smallest, largest = float(np.finfo(np.float32).tiny), float(np.finfo(np.float32).max)
    assert [to_float32(x) for x in (smallest, -smallest, largest, 0.0)] == [smallest, -smallest, largest, 0.0]
    assert to_float32(float(np.nextafter(np.float32(smallest), np.float32(0.0)))) is None
    assert to_float32(1.01 * largest) is None
    assert to_float32(float("nan")) is None


def test_typed_constant_gives_a_local_its_type(tmp_path: Path) -> None:
    body = body_of(tmp_path, "m = MASK\nm >>= 1\nk2 = 1 + MASK\nreturn f32(m + k2)", before=CONSTANTS)
    assert body[2] == ir.Let("k2", ir.Const(U32, 0x55555556))
    assert body[0] == ir.Let("m", ir.Const(U32, 0x55555555), mutable=True)
    assert body[1] == ir.Assign("m", ir.Binary(U32, ">>", var("m", U32), ir.Const(U32, 1)))


@pytest.mark.parametrize(("text", "op"), [("+=", "+"), ("-=", "-"), ("*=", "*"), ("/=", "/")])
def test_augmented_assignment_is_the_operation(text: str, op: str, tmp_path: Path) -> None:
    body = body_of(tmp_path, f"a = x\na {text} 2.0\nreturn a")
    assert body[1] == ir.Assign("a", ir.Binary(F32, op, var("a"), f32(2.0)))


BRANCHES = """
a = 0.0
if flag:
    a = x
elif n > 3:
    b = x
    a = b
else:
    return 1.0
return a
"""


def test_branches_nest(tmp_path: Path) -> None:
    body = body_of(tmp_path, BRANCHES)
    inner = ir.If(
        ir.Binary(BOOL, ">", N, ir.Const(U32, 3)),
        (ir.Let("b", X), ir.Assign("a", var("b"))),
        (ir.Return(f32(1.0)),),
    )
    assert body[1] == ir.If(FLAG, (ir.Assign("a", X),), (inner,))


def test_name_may_be_reused_in_another_block(tmp_path: Path) -> None:
    body = body_of(tmp_path, "if flag:\n    a = x\n    return a\nelse:\n    a = n\n    return f32(a)")
    assert isinstance(body[0], ir.If)
    assert body[0].then[0] == ir.Let("a", X)
    assert body[0].orelse[0] == ir.Let("a", N)


@pytest.mark.parametrize(
    ("bounds", "start", "stop"),
    [
        ("4", 0, 4),
        ("1, 4", 1, 4),
        ("COUNT", 0, 3),
        ("-2, 2 * COUNT", -2, 6),
        ("0", 0, 0),
        ("65536", 0, 65536),
        ("65536, 131072", 65536, 131072),
        ("-2147483647, -2147483640", -2147483647, -2147483640),
        ("2147483640, 2147483647", 2147483640, 2147483647),
    ],
)
def test_loop_bounds_are_constants(bounds: str, start: int, stop: int, tmp_path: Path) -> None:
    body = body_of(
        tmp_path, f"a = 0.0\nfor i in range({bounds}):\n    a += f32(i)\nreturn a", before=CONSTANTS
    )
    step = ir.Assign("a", ir.Binary(F32, "+", var("a"), ir.Convert(F32, var("i", I32))))
    assert body[1] == ir.For("i", start, stop, (step,))


@pytest.mark.parametrize(("name", "type_"), [("n", U32), ("k", I32)])
def test_loop_that_a_parameter_ends_is_numbered_by_its_type(name: str, type_: Type, tmp_path: Path) -> None:
    text = f"a = 0.0\nfor i in range(min({name}, COUNT)):\n    a += f32(i)\nreturn a"
    body = body_of(tmp_path, text, before=CONSTANTS)
    step = ir.Assign("a", ir.Binary(F32, "+", var("a"), ir.Convert(F32, var("i", type_))))
    assert body[1] == ir.For("i", 0, 3, (step,), limit=var(name, type_))


PAIR = "@struct\nclass Pair:\n    '''Two of them.'''\n    first: X\n    second: Annotated[vec3, Unit()]\n"


@pytest.mark.parametrize(
    "text", ["Pair(x, v)", "Pair(first=x, second=v)", "Pair(second=v, first=x)", "Pair(x, second=v)"]
)
def test_struct_is_built_in_the_order_of_its_fields(text: str, tmp_path: Path) -> None:
    (statement,) = body_of(tmp_path, f"return {text}", "Pair", PAIR)
    assert isinstance(statement, ir.Return)
    assert isinstance(statement.value, ir.Construct)
    assert isinstance(statement.value.type, Struct)
    assert [f.name for f in statement.value.type.fields] == ["first", "second"]
    assert statement.value.args == (X, V)


def test_field_of_a_struct(tmp_path: Path) -> None:
    body = body_of(tmp_path, "pair = Pair(x, v)\nreturn pair.second.z", before=PAIR)
    assert isinstance(body[0], ir.Let)
    pair = body[0].value.type
    expected = ir.Swizzle(F32, ir.Member(VEC3, ir.Var(pair, "pair"), "second"), "z")
    assert body[1] == ir.Return(expected)


def test_names_come_across_files_and_under_other_names(tmp_path: Path) -> None:
    write_library(
        tmp_path,
        {
            "constants.py": "PI = 3.141592653589793\nTAU = 2.0 * PI\n",
            "direction/other.py": "from shaderlib.constants import TAU as FULL_TURN\n"
            + PAIR
            + "def turn_of(x: X) -> f32:\n    return x * FULL_TURN\n",
            "numeric/probe.py": "from shaderlib.direction.other import FULL_TURN, Pair, turn_of as turned\n"
            "def probe(x: X, pair: Pair) -> f32:\n    return turned(pair.first) + FULL_TURN\n",
        },
    )
    library = Library(tmp_path)
    (statement,) = library.function("probe").body
    pair = library.structs["Pair"].type
    call = ir.Call(F32, "turn_of", (ir.Member(F32, ir.Var(pair, "pair"), "first"),))
    assert statement == ir.Return(ir.Binary(F32, "+", call, f32(2.0 * np.pi)))
    assert [f.name for f in library.select(["probe"]).functions] == ["turn_of", "probe"]
    assert [s.name for s in library.select(["probe"]).structs] == ["Pair"]


KINDS = """
def probe(x: X, d: Annotated[vec3, Unit()], t: Annotated[f32, Interval(0.0, 2.0 ** 10, scale="log")],
          w: Annotated[vec3, Length(1e-30, 1e30)], n: u32) -> f32:
    '''A probe, over
    two lines.

    x        first, and
             on
    n        a count
    returns  nothing new
    source   this test
    '''
    return x

@variant("probe")
def probe_quick(x: X) -> f32:
    return x

@printed("probe")
def probe_printed(x: X) -> f32:
    return x

@helper
def inner_probe(x: X) -> f32:
    return x
"""


def test_kinds_docs_and_domains(tmp_path: Path) -> None:
    library = library_of(tmp_path, KINDS)
    kinds = {name: (f.kind, f.base, f.module) for name, f in library.functions.items()}
    assert kinds == {
        "probe": ("base", None, "numeric"),
        "inner_probe": ("helper", None, "numeric"),
        "probe_quick": ("variant", "probe", "numeric"),
        "probe_printed": ("printed", "probe", "numeric"),
    }
    assert list(library.public) == ["probe", "probe_quick", "probe_printed"]
    assert [f.name for f in library.variants("probe")] == ["probe_quick", "probe_printed"]
    probe = library.function("probe")
    assert probe.doc.summary == "A probe, over two lines."
    assert probe.doc.entries == {
        "x": "first, and on",
        "n": "a count",
        "returns": "nothing new",
        "source": "this test",
    }
    domains = [p.domain for p in probe.parameters]
    assert domains[0] == Finite()
    assert domains[1] == Unit()
    assert isinstance(domains[2], Interval)
    assert (domains[2].low, domains[2].high, domains[2].scale) == (0.0, 1024.0, "log")
    assert domains[3] == Length(1e-30, 1e30)
    assert domains[4] is None


def test_reading_a_library_executes_nothing(tmp_path: Path) -> None:
    mark = tmp_path / "executed"
    text = f"Y = open({str(mark)!r}, 'w')\ndef probe(x: X) -> f32:\n    return x\n"
    assert library_of(tmp_path / "sources", text).functions
    assert not mark.exists()
