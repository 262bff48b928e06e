"""No tolerance is typed into a test body: it is data with an origin, or a named constant with its reason.

Plan. Every test file of conformance is parsed, never imported. Inside functions a number is a tolerance
  named    where it is given to rel, abs, rtol or atol of a call, or stands where approx takes them
  small    where it is a term of an ordering comparison and not zero, but below SMALL
Constants of a module are not looked at: they have a name and room for a reason.
"""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FILES = sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "conformance").rglob("test_*.py"))
NAMES = {"rel", "abs", "rtol", "atol"}
SMALL = 1e-2
"""Numbers in comparisons below this are errors; those above are shares, ratios and sizes."""
ORDER = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)


def numbers(node: ast.expr) -> Iterator[float]:
    """The numbers among the terms and factors of an expression, zero left out."""
    match node:
        case ast.Constant(value=float() | int() as value) if value:
            yield abs(value)
        case ast.UnaryOp():
            yield from numbers(node.operand)
        case ast.BinOp():
            yield from numbers(node.left)
            yield from numbers(node.right)


def typed(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Line and text of every tolerance that stands in a function."""
    for function in ast.walk(tree):
        if not isinstance(function, ast.FunctionDef):
            continue
        for statement in function.body:
            for node in ast.walk(statement):
                if isinstance(node, ast.Call):
                    given = [k.value for k in node.keywords if k.arg in NAMES]
                    if ast.unparse(node.func).rpartition(".")[2] == "approx":
                        given += node.args[1:]
                    yield from ((x.lineno, ast.unparse(x)) for x in given if any(numbers(x)))
                elif isinstance(node, ast.Compare) and any(isinstance(op, ORDER) for op in node.ops):
                    sides = (node.left, *node.comparators)
                    yield from (
                        (x.lineno, ast.unparse(x)) for x in sides if any(n < SMALL for n in numbers(x))
                    )


def test_tolerances_are_named() -> None:
    found = [
        f"  {path}:{line} {text}"
        for path in FILES
        for line, text in sorted(set(typed(ast.parse((ROOT / path).read_text(encoding="utf-8"), path))))
    ]
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("assert x == approx(y, rel=1e-6)", ["1e-06"]),
        ("assert x == pytest.approx(y, 0.05)", ["0.05"]),
        ("np.testing.assert_allclose(x, y, rtol=8 * eps, atol=LEAST)", ["8 * eps"]),
        ("assert 0.0 < np.abs(x - y).max() <= -(1e-9)", ["-1e-09"]),
        ("assert (x <= y + 1e-15).all()", ["y + 1e-15"]),
        ("assert share(x) > 0.99", []),
        ("assert f(1e-9) < bound(y)", []),
        ("assert x == approx(y, rel=tolerance('rounded'), abs=0.0)", []),
    ],
)
def test_what_counts_as_typed(line: str, found: list[str]) -> None:
    assert [text for _, text in typed(ast.parse(f"def test():\n    {line}"))] == found
