"""What specialisation does to control flow and to powers, beside what the source computes.

Plan. Returns inside branches and loops, values that loops hand on, loops that nothing needs: the specialised
function gives the same values bit for bit, kept as a loop or unrolled, and verifies. Whole exponents become
multiplications only when asked, within the error that the table of powers states.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from codegen.backends import dialect
from codegen.emit.stmt import StmtPrinter
from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.ir import nodes as ir
from codegen.ir.domains import Interval
from codegen.ir.verify import verify
from codegen.library import load_library
from codegen.passes.analysis.operations import operations
from codegen.passes.inline import MOST_UNROLLED
from codegen.passes.rules.powers import ROWS, error, multiplications
from codegen.passes.specialise import Specialised, specialise
from conformance.unit.support.sources import library_of
from conformance.unit.support.trees import no_function

LIBRARY = load_library()
SATURATED = 5e34
"""Just below e^80, where safe_pow stops growing."""
SMALLEST = 1e-30
"""Powers below this may be denormal on the way; their relative error is not stated."""
GLSL = StmtPrinter(dialect("glsl", None))


def lines(found: Specialised) -> list[str]:
    """The body as GLSL."""
    return GLSL.block(found.function.body, "")


LOOP = (
    "def f(x: X, k: X) -> f32:\n    total = x\n    product = 1.0\n    for i in range(20):\n"
    "        total = total + product * sqrt(abs(k)) + f32(i)\n"
    "        product = product * 0.5 + total * 0.001\n"
    "    return total * product\n"
)


def test_what_a_loop_does_not_change_is_computed_before_it(tmp_path: Path) -> None:
    found = lines(specialise(library_of(tmp_path, LOOP), "f", new_name="f"))
    assert found[0] == "float root = sqrt(abs(k));"
    assert any(line.startswith("for (") for line in found)
    assert not any("sqrt" in line for line in found[1:])


@pytest.mark.parametrize("unroll", [0, 100])
def test_loops_compute_what_they_did(tmp_path: Path, unroll: int) -> None:
    library = library_of(tmp_path, LOOP)
    found = specialise(library, "f", new_name="g", unroll=unroll)
    verify(found.function, no_function)
    loops = [s for s in ir.statements(found.function.body) if isinstance(s, ir.For)]
    assert len(loops) == (0 if unroll else 1)
    x = {name: np.linspace(-1.0, 2.0, 50).astype(np.float32) for name in ("x", "k")}
    special = evaluate(library.with_functions([found.function]), "g", x)
    np.testing.assert_array_equal(special, evaluate(library, "f", x))


PAIR = '@struct\nclass Pair:\n    """A pair."""\n    first: X\n    second: X\n'
CONTROL = {
    "swap": (
        "    a = x\n    b = k\n    for i in range(9):\n        c = a\n        a = b\n        b = c\n"
        "    return a - 2.0 * b\n"
    ),
    "each from both": (
        "    a = x\n    b = k\n    for i in range(9):\n        c = a * 0.5 + b\n        b = a - b * 0.5\n"
        "        a = c\n    return a - 2.0 * b\n"
    ),
    "each from both in a loop": (
        "    a = x\n    b = k\n    for i in range(5):\n        for j in range(6):\n"
        "            c = a * 0.5 + b\n            b = a - b * 0.5\n            a = c\n        b = b + 1.0\n"
        "    return a - 2.0 * b\n"
    ),
    "return in a loop": (
        "    y = x\n    for i in range(12):\n        if y > 3.0:\n            return y * k\n"
        "        y = y + 0.5\n    return -y\n"
    ),
    "nested": (
        "    y = x\n    for i in range(10):\n        if k > 0.5:\n            for j in range(11):\n"
        "                y = y + k * 0.1\n        else:\n            y = y - exp(k) * f32(i)\n    return y\n"
    ),
    "returns all over": (
        "    y = k\n    if x < 0.0:\n        if k < 0.0:\n            return 1.0\n"
        "        y = x * k\n    else:\n"
        "        y = x + k\n        if y > 2.0:\n            return exp(y) / exp(x)\n    z = y * y\n"
        "    return z + y\n"
    ),
    "variable of one side": (
        "    y = 1.0\n    z = 2.0\n    if x < k:\n        y = exp(x)\n        z = y * log(3.0 + k)\n"
        "    return y + z\n"
    ),
    "struct of one side": (
        "    pair = Pair(x, k)\n    if x < k:\n        pair = Pair(exp(x), log(3.0 + k) * exp(k))\n"
        "    return pair.first - 2.0 * pair.second\n"
    ),
    "struct that keeps a field": (
        "    pair = Pair(x, k)\n    if x < 0.5:\n        pair = Pair(x * 2.0, k)\n"
        "    return pair.first + pair.second\n"
    ),
    "struct in a loop": (
        "    pair = Pair(x, k)\n    for i in range(9):\n"
        "        pair = Pair(pair.second * 0.5 + 1.0, pair.first)\n    return pair.first - pair.second\n"
    ),
    "nothing changes": (
        "    y = x\n    z = k\n    for i in range(9):\n        y = y + 0.25\n        z = k\n"
        "    return y * z\n"
    ),
    "one of two stays": (
        "    y = x\n    z = k\n    for i in range(9):\n        y = y + 0.25 * z\n        z = z * 1.0\n"
        "    return y * z\n"
    ),
    "loop in a loop": (
        "    y = x\n    z = 0.0\n    for i in range(2, 7):\n        for j in range(6):\n"
        "            y = y * 0.5 + f32(i) * k\n            z = z + f32(j)\n        y = y - z * 0.01\n"
        "    return y + z\n"
    ),
    "branch on the number": (
        "    y = x\n    for i in range(7):\n        if i == 3:\n            y = y + k\n        else:\n"
        "            y = y * 0.5\n    return y\n"
    ),
    "loop of one side": (
        "    y = k\n    if x > 0.0:\n        for i in range(6):\n            y = y * x\n    return y\n"
    ),
    "truth that is carried": (
        "    found = x > 2.0\n    y = x\n    for i in range(8):\n        y = y + k\n"
        "        found = found or y > 2.5\n    return 1.0 if found else 0.0\n"
    ),
    "number of one side": (
        "    n = u32(3)\n    if x > k:\n        n = u32(abs(x) + exp(k)) * u32(7) + u32(exp(abs(x)))\n"
        "    return f32(n)\n"
    ),
    "loop without use": "    y = x\n    for i in range(30):\n        y = exp(y)\n    return k\n",
}


@pytest.mark.parametrize("name", CONTROL)
def test_control_flow_computes_what_it_did(tmp_path: Path, name: str) -> None:
    library = library_of(tmp_path, PAIR + "def f(x: X, k: X) -> f32:\n" + CONTROL[name])
    found = specialise(library, "f", new_name="g", unroll=4)
    verify(found.function, no_function)
    a, b = np.meshgrid(np.linspace(-2.0, 3.0, 23), np.linspace(-1.0, 2.0, 17))
    x = {"x": a.ravel().astype(np.float32), "k": b.ravel().astype(np.float32)}
    special = evaluate(library.with_functions([found.function]), "g", found.arguments(x))
    assert isinstance(special, np.ndarray)
    general = evaluate(library, "f", x)
    assert isinstance(general, np.ndarray)
    np.testing.assert_array_equal(np.broadcast_to(special, general.shape), general)
    if name == "loop without use":
        assert lines(found) == ["return k;"]


UNNEEDED = """def f(x: X, k: X) -> f32:
    y = x
    z = k
    if x < k:
        for i in range(9):
            z = exp(z)
        y = sqrt(abs(y)) * sin(k)
    else:
        for i in range(8):
            z = exp(z)
        y = cos(y) * sin(x)
    for i in range(7):
        for j in range(6):
            z = exp(z)
        if z > k:
            z = exp(z)
        y = y * 0.5 + k
    return y
"""


def test_what_the_result_does_not_need_is_gone_at_every_depth(tmp_path: Path) -> None:
    """On both sides of a branch that stays, and inside a loop that stays."""
    found = specialise(library_of(tmp_path, UNNEEDED), "f", new_name="g", unroll=0)
    left = [type(s) for s in ir.statements(found.function.body) if isinstance(s, ir.For | ir.If)]
    assert left == [ir.If, ir.For]
    assert not any("exp" in line for line in lines(found))


LIMITED = (
    "def f(x: X, n: u32) -> f32:\n    y = x\n    for i in range(min(n, 6)):\n        y = y * 0.5 + f32(i)\n"
    "    return y\n"
)


@pytest.mark.parametrize("n", [None, 0, 3, 6, 9])
@pytest.mark.parametrize("unroll", [0, 8])
def test_loop_that_a_parameter_ends(tmp_path: Path, n: int | None, unroll: int) -> None:
    library = library_of(tmp_path, LIMITED)
    known = {} if n is None else {"n": n}
    found = specialise(library, "f", constants=known, new_name="g", unroll=unroll)
    verify(found.function, no_function)
    loops = [s for s in ir.statements(found.function.body) if isinstance(s, ir.For)]
    assert len(loops) == (1 if n is None or (n > 0 and not unroll) else 0)
    x = np.repeat(np.linspace(-1.0, 2.0, 12).astype(np.float32), 9)
    inputs = found.impose({"x": x, "n": np.tile(np.arange(9, dtype=np.uint32), 12)})
    special = evaluate(library.with_functions([found.function]), "g", found.arguments(inputs))
    np.testing.assert_array_equal(special, evaluate(library, "f", inputs))


RETURNING = (
    "def f(x: X, n: u32) -> f32:\n    y = x\n    for i in range({}):\n        if y > 3.0:\n"
    "            return y\n        y = y + 0.5\n    return -y\n"
)


@pytest.mark.parametrize("turns", [9, MOST_UNROLLED])
@pytest.mark.parametrize("n", [None, 0, 4])
def test_loop_that_may_return_is_unrolled(tmp_path: Path, n: int | None, turns: int) -> None:
    library = library_of(tmp_path, RETURNING.format(f"min(n, {turns})"))
    known = {} if n is None else {"n": n}
    found = specialise(library, "f", constants=known, new_name="g")
    verify(found.function, no_function)
    assert not any(isinstance(s, ir.For) for s in ir.statements(found.function.body))
    x = np.repeat(np.linspace(-1.0, 4.0, 50).astype(np.float32), 11)
    inputs = found.impose({"x": x, "n": np.tile(np.arange(11, dtype=np.uint32), 50)})
    special = evaluate(library.with_functions([found.function]), "g", found.arguments(inputs))
    np.testing.assert_array_equal(special, evaluate(library, "f", inputs))


def test_long_loop_that_may_return_is_refused(tmp_path: Path) -> None:
    library = library_of(tmp_path, RETURNING.format(MOST_UNROLLED + 1))
    with pytest.raises(UserError, match=f"at most {MOST_UNROLLED}"):
        specialise(library, "f")


def test_kept_call_gives_back_a_struct(tmp_path: Path) -> None:
    text = (
        PAIR + "@helper\ndef h(x: X) -> Pair:\n    return Pair(x * 2.0, x + 1.0)\n"
        "def f(x: X, k: X) -> f32:\n    pair = h(k)\n    return pair.first * x - h(x).second + pair.second\n"
    )
    library = library_of(tmp_path, text)
    found = specialise(library, "f", keep={"h"}, new_name="g")
    calls = [e for e in ir.expressions(found.function.body) if isinstance(e, ir.Call)]
    assert {c.function for c in calls} == {"h"}
    x = {name: np.linspace(-1.0, 2.0, 50).astype(np.float32) for name in ("x", "k")}
    special = evaluate(library.with_functions([found.function]), "g", x)
    np.testing.assert_array_equal(special, evaluate(library, "f", x))


def test_power_inside_a_call_becomes_products_too(tmp_path: Path) -> None:
    found = specialise(LIBRARY, "strand_specular", constants={"exponent": 8.0}, new_name="f", powers=64)
    assert [s for s in found.log if s.name == "powers"]
    assert not [e for e in ir.expressions(found.function.body) if isinstance(e, ir.Builtin) and e.op == "exp"]


def test_whole_exponents_become_products_only_when_asked() -> None:
    exact = specialise(LIBRARY, "pow_one_minus", constants={"p": 16.0}, new_name="f")
    assert operations(exact.function)["special"] > 0
    found = specialise(LIBRARY, "pow_one_minus", constants={"p": 13.0}, new_name="f", powers=64)
    assert operations(found.function)["special"] == 0
    assert operations(found.function)["arithmetic"] == multiplications(13) + 2
    assert any(s.name == "powers" for s in found.log)


@pytest.mark.parametrize("name", ROWS)
@pytest.mark.parametrize("exponent", [8, 11, 16, 64, 100])
def test_product_of_a_whole_exponent_errs_as_stated(name: str, exponent: int) -> None:
    row = ROWS[name]
    known = {row.exponent: float(exponent)}
    found = specialise(LIBRARY, name, constants=known, new_name="f", powers=100)
    least = 0.5 if name == "safe_pow_near_one" else 0.0
    base = np.linspace(least, 1.0, 2001).astype(np.float32)
    inputs = {row.argument: base}
    got = evaluate(LIBRARY.with_functions([found.function]), "f", inputs, "float32")
    assert isinstance(got, np.ndarray)
    exact = ((1.0 - base.astype(np.float64)) if row.roundings else base.astype(np.float64)) ** exponent
    normal = exact > SMALLEST
    assert (np.abs(got - exact)[normal] <= error(exponent, row.roundings) * exact[normal]).all()


@pytest.mark.parametrize("name", [name for name, row in ROWS.items() if not row.roundings])
@pytest.mark.parametrize("exponent", [1, 11, 64, 1000])
def test_product_of_a_large_base_saturates_as_the_power_does(name: str, exponent: int) -> None:
    found = specialise(LIBRARY, name, constants={"y": float(exponent)}, new_name="f", powers=1000)
    domain = LIBRARY.function(name).parameters[0].domain
    assert isinstance(domain, Interval)
    base = np.linspace(1.0, domain.high, 500).astype(np.float32)
    got = evaluate(LIBRARY.with_functions([found.function]), "f", {"x": base}, "float32")
    assert isinstance(got, np.ndarray)
    assert np.isfinite(got).all()
    with np.errstate(over="ignore"):
        exact = np.minimum(base.astype(np.float64) ** exponent, SATURATED)
    below = exact < SATURATED
    assert (np.abs(got - exact)[below] <= error(exponent, 0) * exact[below]).all()
    assert (got[~below] > 0.9 * SATURATED).all()
