"""What a source writes without parentheses is emitted without: no grammar and no reader misses them there.
Only a sign on the right of an operator gets some: a - (-b).

Python, C, GLSL and WGSL read these expressions alike. That parentheses stand wherever one of them would read
another tree is the business of test_printers.py.
"""

from __future__ import annotations

import pytest

from codegen.emit.dialect import Dialect
from codegen.emit.expr import ExprPrinter
from codegen.ir import nodes as ir
from conformance.unit.support.dialects import ONE_PER_TARGET, dialect_id
from conformance.unit.support.sources import library_of

SIGNATURE = "a: X, b: X, c: X, p: bool, q: bool, n: u32, m: u32, o: u32, k: i32"
BARE = {
    "f32": (
        *("a * b * c", "a / b * c", "a * b / c", "a + b - c", "a - b + c", "a * b + c", "a - b * c"),
        *("a + b / c", "-a * b", "-a / b", "-a + b", "-a - b", "a + sqrt(b)", "sqrt(a) * b"),
    ),
    "bool": (
        *("a < b and b <= c and p", "p or a >= b or q", "a + b < b * c", "a * b != c - a", "-a > -b"),
        *("not p and q", "p and not q", "not p or not q", "p and a == b", "p or a == b", "n + m < n * m"),
    ),
    "u32": (
        *("n & m & o", "n | m | o", "n ^ m ^ o", "~n & m", "~n | m", "~n ^ m", "~n << m", "~n >> m"),
        *("n % m + o", "n // m - o", "n * m % o"),
    ),
}
SIGNS = ("a + (-b)", "a - (-b)", "a * (-b)", "a / (-b)", "a + (-2.0)", "a - (-2.0)", "a * (-2.0)")
CASTS = {
    "f32": {
        "a * f32(n)": ("a * float(n)", "a * f32(n)", "a * (float)n"),
        "f32(n) * a": ("float(n) * a", "f32(n) * a", "(float)n * a"),
        "a - f32(-k)": ("a - float(-k)", "a - f32(-k)", "a - (float)(-k)"),
        "vec3(a, b, c).y - a": (
            "vec3(a, b, c).y - a",
            "vec3<f32>(a, b, c).y - a",
            "((float3)(a, b, c)).y - a",
        ),
        "-2.0 * a": ("-2.0 * a", "-2.0 * a", "-2.0f * a"),
        "-2.0 + a": ("-2.0 + a", "-2.0 + a", "-2.0f + a"),
        "-f32(n)": ("-float(n)", "-f32(n)", "-((float)n)"),
        "a * (b if p else c)": ("a * (p ? b : c)", "a * select(c, b, p)", "a * (p ? b : c)"),
        "(a if p else b) * c": ("(p ? a : b) * c", "select(b, a, p) * c", "(p ? a : b) * c"),
        "a + b if a < b else -c": ("a < b ? a + b : -c", "select(-c, a + b, a < b)", "a < b ? a + b : -c"),
    },
    "vec3": {
        "a * vec3(b, c, a)": ("a * vec3(b, c, a)", "a * vec3<f32>(b, c, a)", "a * (float3)(b, c, a)"),
        "vec3(b, c, a) * a": ("vec3(b, c, a) * a", "vec3<f32>(b, c, a) * a", "(float3)(b, c, a) * a"),
    },
    "u32": {"n << u32(a)": ("n << uint(a)", "n << u32(a)", "n << (uint)a")},
}
"""A cast may stand bare beside an operator, a choice only where it is a call."""
SPELLED = {"and": "&&", "or": "||", "not ": "!", "//": "/"}


@pytest.fixture(scope="module")
def printed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, ir.Expr]:
    """Each expression as the front end reads it."""
    written = {type_: (*some, *CASTS.get(type_, ())) for type_, some in {**BARE, "vec3": ()}.items()}
    written["f32"] += SIGNS
    texts = {f"probe_{type_}_{i}": (type_, e) for type_, some in written.items() for i, e in enumerate(some)}
    source = "\n\n".join(f"def {f}({SIGNATURE}) -> {r}:\n    return {e}\n" for f, (r, e) in texts.items())
    library = library_of(tmp_path_factory.mktemp("bare"), source)
    found = {}
    for name, (_, text) in texts.items():
        (statement,) = library.function(name).body
        assert isinstance(statement, ir.Return)
        found[text] = statement.value
    return found


@pytest.mark.parametrize("text", [text for some in BARE.values() for text in some])
@pytest.mark.parametrize("dialect", ONE_PER_TARGET, ids=dialect_id)
def test_no_parentheses_are_added(dialect: Dialect, text: str, printed: dict[str, ir.Expr]) -> None:
    wanted = text
    for ours, theirs in SPELLED.items():
        wanted = wanted.replace(ours, theirs)
    assert ExprPrinter(dialect).show(printed[text]) == wanted


@pytest.mark.parametrize("text", SIGNS)
@pytest.mark.parametrize("dialect", ONE_PER_TARGET, ids=dialect_id)
def test_sign_on_the_right_stands_in_parentheses(
    dialect: Dialect, text: str, printed: dict[str, ir.Expr]
) -> None:
    assert ExprPrinter(dialect).show(printed[text]).replace("f)", ")") == text


@pytest.mark.parametrize("text", [text for some in CASTS.values() for text in some])
def test_casts_and_choices_stand_as_their_language_has_them(text: str, printed: dict[str, ir.Expr]) -> None:
    wanted = next(some[text] for some in CASTS.values() if text in some)
    assert tuple(ExprPrinter(dialect).show(printed[text]) for dialect in ONE_PER_TARGET) == wanted
