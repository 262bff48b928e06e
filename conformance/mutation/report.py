"""The generated part of README.md: all draws, and of each group's last one its files and survivors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from scipy.stats import beta

from codegen.files import write_text
from conformance.marked import with_part
from conformance.mutation.plan import groups
from conformance.mutation.record import FILE_COLUMNS, Draw, read

README = Path(__file__).parent / "README.md"
BEGIN, END = "<!-- results: written by python -m conformance.mutation --record -->", "<!-- end of results -->"


def confidence(killed: int, tried: int, level: float = 0.95) -> tuple[float, float]:
    """Ends of the interval that holds the share of all mutants (Clopper and Pearson 1934), from a sample."""
    tail = (1.0 - level) / 2.0
    low = float(beta.ppf(tail, killed, tried - killed + 1)) if killed else 0.0
    high = float(beta.ppf(1.0 - tail, killed + 1, tried - killed)) if killed < tried else 1.0
    return low, high


def _share(draw: Draw) -> str:
    tried = draw["killed"] + draw["survived"]
    return f"{draw['killed'] / max(tried, 1):.1%}"


def _row(name: str, draw: Draw, last: bool) -> str:
    tried = draw["killed"] + draw["survived"]
    low, high = confidence(draw["killed"], tried)
    seed = "all" if draw["seed"] is None else str(draw["seed"])
    share = f"**{_share(draw)}**" if last else _share(draw)
    return (
        f"| {name if last else ''} | {draw['date']} | {seed} | {tried} of {draw['of']} | {draw['killed']} | "
        f"{draw['equivalent']} | {share} | {low:.1%} to {high:.1%} | {groups()[name].share:.0%} |"
    )


def overview(found: Mapping[str, Sequence[Draw]]) -> list[str]:
    """All draws, the last one of a group first."""
    lines = [
        "| group | drawn | seed | mutants tried | killed | equivalent besides | share | "
        "of all, confidence 95 % | required |",
        "|---|---|--:|--:|--:|--:|--:|--:|--:|",
    ]
    for name in groups():
        for k, draw in enumerate(reversed(found.get(name, ()))):
            lines.append(_row(name, draw, k == 0))
    return lines


def section(name: str, draw: Draw) -> list[str]:
    """The last draw of a group: its files, survivors and equivalent mutants."""
    sampled = "" if draw["seed"] is None else f" --sampled --count {_count(draw)} --seed {draw['seed']}"
    lines = [
        f"### {name}: {groups()[name].what}",
        "",
        f"`python -m conformance.mutation {name}{sampled}`{_pace(draw)}.",
        "",
        f"| file | {' | '.join(FILE_COLUMNS)} |",
        "|---|--:|--:|--:|--:|",
        *(f"| {path} | {' | '.join(map(str, row))} |" for path, row in draw["files"].items()),
    ]
    if draw["survivors"]:
        lines += ["", "Survivors:", "", *(f"- `{mutant}`" for mutant in draw["survivors"])]
    if draw["reasons"]:
        lines += ["", "Equivalent mutants by reason:", ""]
        lines += [f"- {count}: {reason}" for reason, count in draw["reasons"].items()]
    return lines


def _pace(draw: Draw) -> str:
    return "" if draw["seconds"] is None else f"; {draw['seconds']} s a mutant, two at a time"


def _count(draw: Draw) -> int:
    return int(draw["killed"] + draw["survived"] + draw["equivalent"] + draw["refused"])


def text(found: Mapping[str, Sequence[Draw]]) -> str:
    """Everything between the marks."""
    lines = overview(found)
    for name in groups():
        if found.get(name):
            lines += ["", *section(name, found[name][-1])]
    return "\n".join(lines)


def write() -> None:
    """Replace the generated part of README.md."""
    page = README.read_text(encoding="utf-8")
    write_text(README, with_part(page, BEGIN, END, f"\n\n{text(read())}\n\n"))
