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

SIGNATURE = "a: X, b: X, c: X, p: bool, q: bool, n: u32, m: u32, k: u32"
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
        *("n & m & k", "n | m | k", "n ^ m ^ k", "~n & m", "~n | m", "~n ^ m", "~n << m", "~n >> m"),
        *("n % m + k", "n // m - k", "n * m % k"),
    ),
}
SIGNS = ("a + (-b)", "a - (-b)", "a * (-b)", "a / (-b)", "a + (-2.0)", "a - (-2.0)", "a * (-2.0)")
SPELLED = {"and": "&&", "or": "||", "not ": "!", "//": "/"}


@pytest.fixture(scope="module")
def printed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, ir.Expr]:
    """Each expression as the front end reads it."""
    written = {**BARE, "f32": (*BARE["f32"], *SIGNS)}
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
