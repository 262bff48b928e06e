"""Hard cases and random inputs for the functions under test.

load(family)                    the stored points of a family, by role
families_for(parameters)        the families that fit a function's parameters
draw(function, family, n, seed) inputs of a function: a family's, "domain_ends" or "uniform"
worst(function)                 the inputs on which searches found it to err most (has_worst: are there any?)
words(function, inputs, lane)    one lane of inputs as text, words in hex
coverage(function, family)      how many inputs use up a family
`python -m conformance.cases` writes the stored families anew, the same to the byte.
"""

from conformance.cases.drawing import DOMAIN_ENDS, UNIFORM, coverage, draw, families_for, load
from conformance.cases.found import has_worst, words, worst
from conformance.cases.registry import FAMILIES

WORST = "worst"
"""Name of the family of inputs that searches found."""

__all__ = [
    "DOMAIN_ENDS",
    "FAMILIES",
    "UNIFORM",
    "WORST",
    "coverage",
    "draw",
    "families_for",
    "has_worst",
    "load",
    "words",
    "worst",
]
