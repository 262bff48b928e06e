"""Functions keep what their sources promise beside a bound, and a fault that breaks a promise is noticed."""

from __future__ import annotations

import ast

import pytest

from codegen.library import load_library
from conformance.check.promises import PROMISES, keeps, takes_exponentials
from conformance.check.rewritten import is_call, rewritten

LIBRARY = load_library()
HELD = sorted({*PROMISES, *(name for name in LIBRARY.functions if takes_exponentials(name))})
FAULTS = [
    ("angle_share", "max"),
    ("ashikhmin_shirley_value", "max"),
    ("fur_average", "clamp"),
    ("fur_geometry", "clamp"),
    ("fur_weights_goldman", "min"),
    ("fur_weights_slab", "min"),
    ("hammersley", "min"),
    ("pow_one_minus", "max"),
    ("satin_facet_density", "max"),
    ("shell_alpha_resample", "max"),
    ("shell_sine_power", "max"),
    ("shell_strand_mask", "floor"),
    ("ward_sample", "normalize"),
]
"""Function, and the guard whose calls are replaced by their first argument."""


@pytest.mark.parametrize("name", HELD)
def test_function_keeps_its_promises(name: str) -> None:
    assert keeps(LIBRARY, name)


@pytest.mark.parametrize(("name", "guard"), FAULTS)
def test_a_guard_that_is_missing_breaks_a_promise(name: str, guard: str) -> None:
    def without(node: ast.Call | ast.BinOp) -> ast.expr:
        return node.args[0] if isinstance(node, ast.Call) and is_call(node, guard) else node

    assert not keeps(rewritten(LIBRARY, name, without), name)


def test_a_lobe_that_goes_on_breaks_a_promise() -> None:
    """Ward's density is 0 where its exponent is beyond 80."""

    def limitless(node: ast.Call | ast.BinOp) -> ast.expr:
        return (
            node.left if isinstance(node, ast.BinOp) and ast.unparse(node) == "EXP_LIMIT * upright" else node
        )

    assert not keeps(rewritten(LIBRARY, "ward_pdf", limitless), "ward_pdf")


def test_a_half_vector_the_other_way_round_breaks_a_promise() -> None:
    def exchanged(node: ast.Call | ast.BinOp) -> ast.expr:
        return ast.parse("half_vector(v, l)", mode="eval").body if is_call(node, "half_vector") else node

    assert not keeps(rewritten(LIBRARY, "scheuermann_shade", exchanged), "scheuermann_shade")


def test_a_top_that_is_a_quotient_breaks_a_promise() -> None:
    """The height of the outermost shell is decided on whole numbers: not where the fault cuts no quotient."""

    def uncut(node: ast.Call | ast.BinOp) -> ast.expr:
        is_top = isinstance(node, ast.BinOp) and ast.unparse(node) == "max(layers, 2) - 1"
        return ast.parse("max(layers, 2)", mode="eval").body if is_top else node

    assert not keeps(rewritten(LIBRARY, "shell_height", uncut), "shell_height")
