"""Options of `vair emit` together: each combination compiles or is refused in one sentence, as known.

Plan. For one dialect per target (by night all of them) every combination of --precise, --precision half,
--max-error, --prefix and --line-directives is written and read by the target's compiler, or is refused where
a dialect lacks the option or two of them contradict each other; nothing is written then.
"""

import itertools
from pathlib import Path

import pytest

from codegen.cli import run
from codegen.emit.dialect import Dialect
from conformance.unit.support.dialects import DIALECTS, ONE_PER_TARGET, dialect_id, validate

FUNCTION = "strand_specular"
OPTIONS = (
    ("--precise",),
    ("--precision", "half"),
    ("--max-error", "0.01"),
    ("--prefix", "own_"),
    ("--line-directives",),
)


def refusal(d: Dialect, chosen: tuple[tuple[str, ...], ...]) -> str:
    """What a combination is refused with; empty where it is none."""
    names = [option[0] for option in chosen]
    if "--precise" in names and not d.precise:
        return "has no precise qualifier"
    if "--max-error" in names and "--precision" in names:
        return "--max-error chooses by errors in single precision"
    if "--line-directives" in names and not d.line_map:
        return "has no line directives"
    return ""


@pytest.mark.parametrize(
    "d",
    [
        pytest.param(d, id=dialect_id(d), marks=() if d in ONE_PER_TARGET else pytest.mark.nightly)
        for d in DIALECTS
    ],
)
def test_every_combination_compiles_or_is_refused(
    d: Dialect, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    base = ["emit", "--target", d.target, "--dialect", d.name, "--function", FUNCTION]
    texts: dict[tuple[str, ...], str] = {}
    for count in range(len(OPTIONS) + 1):
        for chosen in itertools.combinations(OPTIONS, count):
            out = tmp_path / f"{len(texts)}.{d.extension}"
            arguments = [word for option in chosen for word in option]
            status = run([*base, *arguments, "-o", str(out)])
            # What --max-error chose from stands above a refusal.
            said = [line for line in capsys.readouterr().err.splitlines() if line.startswith("vair: ")]
            sentence = refusal(d, chosen)
            if sentence:
                assert (status, out.exists()) == (2, False), arguments
                assert len(said) == 1 and sentence in said[0], arguments
            else:
                assert status == 0, (arguments, said)
                texts[tuple(arguments)] = out.read_text(encoding="utf-8")
    for given, text in texts.items():
        print(*given)
        validate(text, d)
    assert len(texts) >= 6
