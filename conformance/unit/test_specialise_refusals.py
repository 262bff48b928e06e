"""What specialisation refuses: each mistake is one sentence that names the path or the expression.

Plan. Every way in which constants, aliases, ranges, facts and variants can be wrong, on one function.
"""

from __future__ import annotations

from typing import Any

import pytest

from codegen.errors import UserError
from codegen.library import load_library
from codegen.passes.specialise import specialise

LIBRARY = load_library()

REFUSED: dict[str, tuple[dict[str, Any], str]] = {
    "unknown parameter": (
        {"constants": {"optics.rho_surfac": 0.0}},
        'unknown parameter of fakefur_shade "optics.rho_surfac"; did you mean "optics.rho_surface"?',
    ),
    "outside the domain": (
        {"constants": {"optics.rho_surface": 2.0}},
        "fakefur_shade: optics.rho_surface is 2, which is not in [0, 1]",
    ),
    "no unit vector": (
        {"constants": {"n": (0.0, 0.0, 2.0)}},
        "fakefur_shade: n is (0, 0, 2), which is no unit vector",
    ),
    "wrong shape": ({"constants": {"n": 1.0}}, "fakefur_shade: n: 1.0 is no vec3"),
    "not a number": (
        {"constants": {"optics.exponent": "16"}},
        "fakefur_shade: optics.exponent: '16' is no f32",
    ),
    "missing field": (
        {"constants": {"coat": {"density": 1.0}}},
        "fakefur_shade: coat lacks hair_length, radius_base, radius_tip",
    ),
    "unknown field": (
        {"constants": {"coat": {"densty": 1.0}}},
        'unknown field of coat "densty"; did you mean "density"?',
    ),
    "crossed range": (
        {"ranges": {"optics.exponent": (9.0, 4.0)}},
        "fakefur_shade: optics.exponent: the range starts at 9 and ends below, at 4",
    ),
    "range outside": (
        {"ranges": {"optics.overlap": (0.0, 2.0)}},
        "fakefur_shade: optics.overlap: the range [0, 2] leaves the domain, in [0, 1]",
    ),
    "range of a direction": ({"ranges": {"n": (0.0, 1.0)}}, "fakefur_shade: n is a vec3 and has no range"),
    "range of a constant": (
        {"constants": {"optics.overlap": 0.5}, "ranges": {"optics.overlap": (0.0, 1.0)}},
        "fakefur_shade: optics.overlap has a range although it is not a parameter any more",
    ),
    "alias of another type": (
        {"aliases": {"n": "optics.overlap"}},
        'fakefur_shade: "n" is a vec3 and cannot be "optics.overlap", a f32',
    ),
    "alias of itself": ({"aliases": {"n": "n"}}, 'fakefur_shade: "n" cannot be given as equal to itself'),
    "alias of an alias": (
        {"aliases": {"n": "t", "t": "l"}},
        'fakefur_shade: "n" is "t", which is "l": name that one',
    ),
    "alias and constant": (
        {"aliases": {"n": "t"}, "constants": {"n": (0.0, 0.0, 1.0)}},
        'fakefur_shade: "n" is given as a constant and as "t"',
    ),
    "alias outside": (
        {
            "aliases": {"coat.density": "coat.hair_length"},
            "ranges": {"coat.hair_length": (5.0, 6.0), "coat.density": (1.0, 2.0)},
        },
        "fakefur_shade: coat.density has a range although it is not a parameter any more",
    ),
    "empty fact": (
        {"facts": [("dot(n, v)", 0.5, 0.25)]},
        'fakefur_shade: fact "dot(n, v)": nothing is at least 0.5 and at most 0.25',
    ),
    "facts that contradict": (
        {"facts": [("dot(n, v)", 0.5, 1.0), ("dot(v, n)", 0.0, 0.25)]},
        'fakefur_shade: fact "dot(v, n)" contradicts another fact',
    ),
    "fact against constants": (
        {"constants": {"n": (0.0, 0.0, 1.0), "v": (0.0, 0.0, 1.0)}, "facts": [("dot(n, v)", 0.0, 0.5)]},
        'fakefur_shade: fact "dot(n, v)" contradicts the constants, which make it 1',
    ),
    "fact beyond unit vectors": (
        {"facts": [("dot(n, v)", 1.5, 2.0)]},
        'fact "dot(n, v)" in [1.5, 2] contradicts the ranges, which give [-1.00001, 1.00001]',
    ),
    "fact against ranges": (
        {"ranges": {"optics.overlap": (0.0, 0.5)}, "facts": [("optics.overlap * optics.overlap", 0.5, 1.0)]},
        'fact "optics.overlap * optics.overlap" in [0.499998, 1] '
        "contradicts the ranges, which give [0, 0.25]",
    ),
    "fact of nothing known": (
        {"facts": [("dot(n, w)", 0.0, 1.0)]},
        'unknown parameter in fakefur_shade: fact "dot(n, w)" "w"',
    ),
    "fact that is no expression": (
        {"facts": [("dot(n, v", 0.0, 1.0)]},
        'fakefur_shade: fact "dot(n, v" is no expression of built-ins and parameters',
    ),
    "fact of an unknown built-in": (
        {"facts": [("dott(n, v)", 0.0, 1.0)]},
        'fakefur_shade: fact "dott(n, v)" is no expression of built-ins and parameters',
    ),
    "variant of another signature": (
        {"variants": {"pow_one_minus": "sin_angle"}},
        '"sin_angle" takes other parameters than "pow_one_minus" and cannot stand in for it',
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_mistake_is_one_sentence(name: str) -> None:
    known, sentence = REFUSED[name]
    with pytest.raises(UserError) as raised:
        specialise(LIBRARY, "fakefur_shade", **known)
    assert str(raised.value) == sentence
