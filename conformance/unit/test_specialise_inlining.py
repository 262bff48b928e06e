"""Inlining, statement by statement: what is left of branches, loops and calls, and that it computes the same.

Plan. Functions of a few lines, each with how many branches and loops it has to leave; on a grid, the
specialised function gives what the source gives, bit for bit, and is well formed.
  branches  decided ones leave one side and all that follows; cheap ones become choices, nested ones too
  loops     unrolled with what follows, kept with their ends, numbers known by their range
  structs   handed on whole where one field changes; fields keep their names
  names     what a branch or loop binds is no parameter, whatever that is called
  log       each step is told with its function and line, also behind a call, a branch or a loop
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.errors import UserError
from codegen.evaluate import evaluate
from codegen.ir import nodes as ir
from codegen.ir.types import F32
from codegen.ir.verify import verify
from codegen.library import Library
from codegen.passes.inline import MOST_UNROLLED
from codegen.passes.specialise import Specialised, specialise
from conformance.unit.support.sources import library_of
from conformance.unit.support.trees import no_function

PAIR = '@struct\nclass Pair:\n    """A pair."""\n    first: X\n    second: V\n'
BODIES: dict[str, tuple[str, dict[str, Any], int, int]] = {
    "return in a loop and more behind it": (
        "    y = x\n    for i in range(3):\n        if y > f32(i) * k:\n            return y * k\n"
        "        y = y + k * 0.5\n    z = y - 1.0\n    return z * x\n",
        *({}, 1, 0),
    ),
    "return in a loop that a number ends": (
        "    y = x\n    for i in range(min(n, 5)):\n        if y > 1.0:\n            return exp(y)\n"
        "        y = y + k\n    return -y\n",
        *({"n": 2}, 1, 0),
    ),
    "return in a loop that never runs": (
        "    y = x\n    for i in range(min(n, 5)):\n        if y > 1.0:\n            return y\n"
        "        y = y + k\n    return -y\n",
        *({"n": 0}, 0, 0),
    ),
    "decided, with what follows": (
        "    y = x\n    if p:\n        y = k * 2.0\n    else:\n        y = x + y\n    return y - x * y\n",
        *({"p": True}, 0, 0),
    ),
    "decided the other way": (
        "    y = x\n    if p:\n        y = k * 2.0\n    else:\n        y = x + y\n    return y - x * y\n",
        *({"p": False}, 0, 0),
    ),
    "decided to return": ("    if p:\n        return x\n    return k\n", {"p": True}, 0, 0),
    "decided not to return": ("    if p:\n        return x\n    return k\n", {"p": False}, 0, 0),
    "decided by a parameter that is no constant": (
        "    y = x\n    if p and not p:\n        y = k\n    return y\n",
        *({}, 0, 0),
    ),
    "cheap inside cheap": (
        "    y = x\n    if x > k:\n        if k > 0.0:\n            y = k * 2.0\n    return y\n",
        *({}, 0, 0),
    ),
    "cheap returns": ("    if x > k:\n        return x * k\n    return x + k\n", {}, 0, 0),
    "dear returns": (
        "    if x > k:\n        return exp(x)\n    return log(2.0 + k * k) * sin(k)\n",
        {},
        1,
        0,
    ),
    "dear on one side only": (
        "    y = k\n    if x > k:\n        y = exp(x) * sin(k)\n    return y * 2.0\n",
        *({}, 1, 0),
    ),
    "dear on the other side only": (
        "    y = k\n    if x > k:\n        y = x\n    else:\n        y = exp(x) * sin(k)\n    return y\n",
        *({}, 1, 0),
    ),
    "loop that starts late": (
        "    y = x\n    for i in range(2, 12):\n        y = y * 0.5 + f32(i) * k\n    return y\n",
        *({}, 0, 1),
    ),
    "loop that is just short enough": (
        "    y = x\n    for i in range(3, 7):\n        y = y * 0.5 + f32(i) * k\n    return y\n",
        *({}, 0, 0),
    ),
    "loop that is just too long": (
        "    y = x\n    for i in range(3, 8):\n        y = y * 0.5 + f32(i) * k\n    return y\n",
        *({}, 0, 1),
    ),
    "loop without a turn": (
        "    y = x\n    for i in range(3, 3):\n        y = y + k\n    return y\n",
        {},
        0,
        0,
    ),
    "loop that is over before it begins": (
        "    y = x\n    for i in range(5, 3):\n        y = y + k\n    return y\n",
        *({}, 0, 0),
    ),
    "loop that a parameter ends": (
        "    y = x\n    for i in range(min(n, 9)):\n        y = y * 0.5 + f32(i) * k\n    return y\n",
        *({}, 0, 1),
    ),
    "loop inside one side": (
        "    y = x\n    z = k * k\n    if x > 0.0:\n        for i in range(9):\n            y = y * 0.5 + z\n"
        "    return y + z\n",
        *({}, 1, 1),
    ),
    "loop inside a loop over its number": (
        "    y = x\n    for i in range(6):\n        for j in range(7):\n"
        "            y = y * 0.25 + f32(i * j + 1) * k\n    return y\n",
        *({}, 0, 2),
    ),
    "struct of which one field changes": (
        "    pair = Pair(x, vec3(k))\n    for i in range(9):\n"
        "        pair = Pair(pair.first * 0.5 + pair.second.y, pair.second)\n    return pair.first\n",
        *({}, 0, 1),
    ),
    "struct of which the other field changes": (
        "    pair = Pair(x, vec3(k))\n    for i in range(9):\n"
        "        pair = Pair(pair.first, pair.second * 0.5 + vec3(pair.first, 1.0, k))\n"
        "    return dot(pair.second, vec3(1.0, 2.0, 3.0))\n",
        *({}, 0, 1),
    ),
    "struct of one side": (
        "    pair = Pair(x, vec3(k))\n    if x > k:\n        pair = Pair(x * 2.0, pair.second)\n"
        "    return pair.first + pair.second.x\n",
        *({}, 0, 0),
    ),
    "one of two stays": (
        "    y = x\n    z = k\n    for i in range(9):\n        y = y * 0.5 + z\n        z = z * 1.0\n"
        "    return y * z\n",
        *({}, 0, 1),
    ),
    "branch inside a loop": (
        "    y = x\n    for i in range(9):\n        if y > k:\n            y = y - exp(k)\n"
        "        y = y + 0.25\n    return y\n",
        *({}, 0, 1),
    ),
    "two that change places": (
        "    a = x\n    b = k\n    for i in range(7):\n        c = a\n        a = b\n        b = c\n"
        "    return a - 3.0 * b\n",
        *({}, 0, 1),
    ),
    "number of a loop within its range": (
        "    y = x\n    for i in range(2, 10):\n        y = y + min(f32(i), 8.5) * max(f32(i), 2.5)\n"
        "    return y\n",
        *({}, 0, 1),
    ),
    "calls in calls": (
        "    return outer(x, k) - outer(k, x) * inner(x)\n",
        *({}, 0, 0),
    ),
    "calls that return early": (
        "    return early(x) + early(k) * 2.0\n",
        *({}, 0, 0),
    ),
    "a parameter that is assigned": ("    return counted(x, k) + x\n", {}, 0, 0),
}
CALLED = (
    "@helper\ndef inner(x: X) -> f32:\n    return x * x - 1.0\n"
    "@helper\ndef outer(x: X, y: X) -> f32:\n    z = inner(y)\n    return z * x + inner(x + y)\n"
    "@helper\ndef early(x: X) -> f32:\n    if x > 1.0:\n        return 1.0\n    if x < -1.0:\n"
    "        return -1.0\n    return x\n"
    "@helper\ndef counted(x: X, y: X) -> f32:\n    z = x\n    z = z + y\n    if z > 1.0:\n        z = 1.0\n"
    "    return z\n"
)


def probes() -> str:
    head = "(x: X, k: X, n: u32, p: bool) -> f32:\n"
    return PAIR + CALLED + "".join(f"def probe_{m}{head}{body[0]}" for m, body in enumerate(BODIES.values()))


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Library:
    return library_of(tmp_path_factory.mktemp("inlining"), probes())


def assert_same(library: Library, name: str, found: Specialised) -> None:
    verify(found.function, no_function)
    a, b, n = (v.ravel() for v in np.meshgrid(np.linspace(-2.0, 3.0, 7), np.linspace(-1.5, 2.0, 6), range(4)))
    inputs = found.impose(
        {"x": a.astype(np.float32), "k": b.astype(np.float32), "n": n.astype(np.uint32), "p": n > 1}
    )
    special = evaluate(library.with_functions([found.function]), "g", found.arguments(inputs))
    general = evaluate(library, name, inputs)
    assert isinstance(special, np.ndarray)
    assert isinstance(general, np.ndarray)
    np.testing.assert_array_equal(np.broadcast_to(special, general.shape), general)


@pytest.mark.parametrize("name", BODIES)
def test_what_is_left_computes_what_the_source_says(name: str, library: Library) -> None:
    _, constants, branches, loops = BODIES[name]
    source = f"probe_{list(BODIES).index(name)}"
    found = specialise(library, source, constants=constants, new_name="g", unroll=4)
    left = [type(s) for s in ir.statements(found.function.body)]
    assert (left.count(ir.If), left.count(ir.For)) == (branches, loops)
    assert_same(library, source, found)


def test_what_a_branch_leaves_alone_is_not_assigned(library: Library) -> None:
    found = specialise(library, f"probe_{list(BODIES).index('loop inside one side')}", new_name="g", unroll=4)
    assigned = {s.name for s in ir.statements(found.function.body) if isinstance(s, ir.Assign)}
    assert len(assigned) == 2, "y of the branch and y of the loop"
    assert all(name.startswith("y") for name in assigned)
    assert not [s for s in found.log if "z if" in s.what]
    found = specialise(library, f"probe_{list(BODIES).index('one of two stays')}", new_name="g", unroll=4)
    assert [s.name for s in ir.statements(found.function.body) if isinstance(s, ir.Assign)] == ["y"]


def test_choices_are_called_like_what_the_source_chooses(tmp_path: Path) -> None:
    text = "def f(x: X, k: X) -> f32:\n    y = x\n    if x > k:\n        y = k * 2.0\n    return y * y + y\n"
    body = specialise(library_of(tmp_path, text), "f").function.body
    assert [s.name for s in body if isinstance(s, ir.Let)] == ["y"]


def test_what_returns_leave_is_called_result(tmp_path: Path) -> None:
    text = (
        "@helper\ndef early(x: X, k: X) -> f32:\n    if x > k:\n        return x * k\n    return x + k\n"
        "def f(x: X, k: X) -> f32:\n    return early(x, k) * 1.0\n"
    )
    (step,) = specialise(library_of(tmp_path, text), "f").log
    assert step.what.startswith("result * 1 -> ")


@pytest.mark.parametrize(("ends", "turns"), [("3, 3", 0), ("5, 3", 0), ("2, 4", 2)])
def test_turns_of_a_loop_are_counted(ends: str, turns: int, tmp_path: Path) -> None:
    text = f"def f(x: X) -> f32:\n    y = x\n    for i in range({ends}):\n        y = y * x\n    return y\n"
    log = specialise(library_of(tmp_path, text), "f", unroll=2).log
    assert [(s.name, s.what) for s in log] == [("unroll", f"{turns} iterations over i")]


def test_numbers_of_loops_are_known_to_lie_in_their_range(tmp_path: Path) -> None:
    text = (
        "def f(x: X) -> f32:\n    y = x\n    for i in range(2, 10):\n"
        "        y = y * 0.5 + min(f32(i), 9.0) + max(f32(i), 2.0)\n    return y\n"
        "def h(x: X) -> f32:\n    y = x\n    for i in range(2, 10):\n"
        "        y = y * 0.5 + min(f32(i), 8.0) + max(f32(i), 3.0)\n    return y\n"
    )
    library = library_of(tmp_path, text)
    for name, guards in (("f", 0), ("h", 2)):
        body = specialise(library, name, unroll=0).function.body
        assert sum(isinstance(e, ir.Builtin) for e in ir.expressions(body)) == guards


def test_parameters_may_be_called_like_what_a_loop_binds(tmp_path: Path) -> None:
    """Whatever numbers leaves get."""
    names = [f"{stem}{k}" for stem in "iyz" for k in range(9)]
    given = ", ".join(f"{name}: X" for name in names)
    total = " + ".join(f"{name} * {k + 1}.0" for k, name in enumerate(names))
    text = (
        f"def f({given}) -> f32:\n    y = y0\n    z = z0\n    for i in range(9):\n        y = y * 0.5 + z\n"
        f"        z = z - y * f32(i)\n    if y > 0.0:\n        z = exp(y) * sin(z)\n"
        f"    return y + z + {total}\n"
    )
    library = library_of(tmp_path, text)
    found = specialise(library, "f", new_name="g")
    rng = np.random.Generator(np.random.PCG64(20261123))
    inputs = {name: rng.uniform(-1.0, 1.0, 40).astype(np.float32) for name in names}
    special = evaluate(library.with_functions([found.function]), "g", found.arguments(inputs))
    np.testing.assert_array_equal(special, evaluate(library, "f", inputs))


def test_fields_of_kept_calls_are_told_by_their_names(tmp_path: Path) -> None:
    text = (
        PAIR + "@helper\ndef h(x: X) -> Pair:\n    return Pair(x, vec3(x))\n"
        "def f(x: X) -> f32:\n    made = h(x)\n    return made.first * 0.0 + made.second.y * 1.0\n"
    )
    found = specialise(library_of(tmp_path, text), "f", keep={"h"})
    assert [s.what for s in found.log][:2] == ["first * 0 -> 0", "second.y * 1 -> second.y"]
    calls = [e for e in ir.expressions(found.function.body) if isinstance(e, ir.Call)]
    assert [c.function for c in calls] == ["h"]


def test_kept_calls_take_structs_and_variants(tmp_path: Path) -> None:
    text = (
        PAIR + "@helper\ndef one(pair: Pair, x: X) -> f32:\n    return pair.first + pair.second.y * x\n"
        "@helper\ndef other(pair: Pair, x: X) -> f32:\n    return pair.first - pair.second.x * x\n"
        "def f(x: X, k: X) -> f32:\n    return one(Pair(x * k, vec3(k)), x + k)\n"
    )
    library = library_of(tmp_path, text)
    found = specialise(library, "f", variants={"one": "other"}, keep={"other"})
    (call,) = [e for e in ir.expressions(found.function.body) if isinstance(e, ir.Call)]
    assert call.function == "other"
    pair, total = call.args
    assert isinstance(pair, ir.Construct)
    assert pair.type == library.struct("Pair").type
    assert total == ir.Binary(F32, "+", ir.Var(F32, "x"), ir.Var(F32, "k"))
    x = {name: np.linspace(-1.0, 2.0, 20).astype(np.float32) for name in ("x", "k")}
    special = evaluate(library.with_functions([found.function]), "f_specialised", x)
    np.testing.assert_array_equal(special, x["x"] * x["k"] - x["k"] * (x["x"] + x["k"]))


UNROLLED = """def f(x: X) -> f32:
    for i in range({}):
        if i > 5000:
            return x
    return -x
"""


@pytest.mark.parametrize(
    ("ends", "turns"), [("128", 0), ("1000, 1128", 0), ("129", 129), ("-100, 100", 200), ("1000, 1129", 129)]
)
def test_loops_that_may_return_are_unrolled_to_a_depth(ends: str, turns: int, tmp_path: Path) -> None:
    library = library_of(tmp_path, UNROLLED.format(ends))
    if not turns:
        assert len(specialise(library, "f").function.body) == 1
        return
    with pytest.raises(UserError) as error:
        specialise(library, "f")
    assert (
        str(error.value) == f"a loop that may return runs {turns} times; at most {MOST_UNROLLED} are unrolled"
    )


LOGGED = """@helper
def twice(x: X) -> f32:
    y = x * 1.0
    return y * 2.0


@helper
def thrice(x: X) -> f32:
    return x * 3.0 + 0.0 * x


def f(x: X, k: X, p: bool) -> f32:
    y = twice(x) * 1.0
    if x > k:
        y = y + 0.0 * k
    else:
        y = y * 2.0 + exp(k) * sin(x)
    y = y - 0.0 * x
    if p:
        y = y + 0.0 * k * x
    for i in range(2):
        y = y * k + 0.0 * x
    z = k * 4.0
    for i in range(20):
        z = z * 0.75 + 0.0 * x
    return y * thrice(k) + z * 0.0
"""


def test_steps_are_told_where_they_are(tmp_path: Path) -> None:
    """The source begins at line 2; what a branch or loop binds is numbered in order."""
    found = specialise(
        library_of(tmp_path, LOGGED), "f", constants={"p": True}, variants={"thrice": "twice"}, unroll=2
    )
    places = [(s.where, s.name, s.what) for s in found.log]
    assert places == [
        ("f:13", "substitute", "p = true"),
        ("twice:4", "identities", "x * 1 -> x"),
        ("f:14", "identities", "twice * 1 -> x * 2"),
        ("f:16", "identities", "0 * k -> 0"),
        ("f:16", "identities", "y + 0 -> x * 2"),
        ("f:18", "fold", "2 * 2 -> 4"),
        ("f:18", "identities", "y * 2 -> 4 * x"),
        ("f:19", "identities", "0 * x -> 0"),
        ("f:19", "identities", "y@1 - 0 -> y@1"),
        ("f:20", "branches", "if true: one side is left"),
        ("f:21", "identities", "y@1 + 0 -> y@1"),
        ("f:22", "unroll", "2 iterations over i"),
        ("f:23", "identities", "(y@1 * k) + 0 -> y@1 * k"),
        ("f:23", "identities", "(y * k) + 0 -> y * k"),
        ("f:26", "identities", "(z@3 * 0.75) + 0 -> z@3 * 0.75"),
        ("f:27", "variants", "thrice -> twice"),
        ("twice:4", "identities", "k * 1 -> k"),
        ("f:27", "identities", "z@4 * 0 -> 0"),
        ("f:27", "identities", "(y * twice) + 0 -> y * twice"),
    ]
    reasons = {s.name: s.why for s in found.log}
    assert reasons["branches"] == "the condition is true"
    assert reasons["unroll"] == "the bounds are constant"
    assert reasons["variants"] == "asked for"
