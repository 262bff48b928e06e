"""The generated part of README.md: figures per group, survivors, equivalent mutants with their reasons."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

from scipy.stats import beta

from conformance.mutation.isolated import SURVIVED
from conformance.mutation.plan import excuse, groups
from conformance.mutation.run import EQUIVALENT, SEED, Result, all_jobs, tally

README = Path(__file__).parent / "README.md"
BEGIN, END = "<!-- {}: written by python -m conformance.mutation -->", "<!-- end of {} -->"


def _table(results: Sequence[Result]) -> list[str]:
    rows = ["| file | mutants | killed | equivalent | survived |", "|---|--:|--:|--:|--:|"]
    by_file: dict[str, list[Result]] = {}
    for r in results:
        if r.outcome != "refused":
            folder = r.mutant.path.rpartition("/")[0]
            shown = f"{folder}/" if folder.startswith("shaderlib") else r.mutant.path
            by_file.setdefault(shown, []).append(r)
    for path, some in sorted(by_file.items()):
        t = tally(some)
        rows.append(f"| {path} | {len(some)} | {t.killed} | {t.equivalent} | {t.survived} |")
    return rows


def confidence(killed: int, tried: int, level: float = 0.95) -> tuple[float, float]:
    """Ends of the interval that holds the share of all mutants (Clopper and Pearson 1934), from a sample."""
    tail = (1.0 - level) / 2.0
    low = float(beta.ppf(tail, killed, tried - killed + 1)) if killed else 0.0
    high = float(beta.ppf(1.0 - tail, killed + 1, tried - killed)) if killed < tried else 1.0
    return low, high


def section(name: str, results: Sequence[Result], seed: int = SEED) -> str:
    """The text of one group; `seed` is that of the sample."""
    group, t = groups()[name], tally(results)
    total = len(all_jobs(group))
    tried = sampling = ""
    if len(results) != total:
        tried = f"A sample of {len(results)} out of {total} changes: "
        low, high = confidence(t.killed, t.killed + t.survived)
        sampling = f" The share of all of them lies between {low:.1%} and {high:.1%} (confidence 95 %)."
        sampling += f" `python -m conformance.mutation {name} --sampled --count {len(results)} --seed {seed}`"
    refused = f" (and {t.refused} that the front end refuses)" if t.refused else ""
    lines = [
        f"### {name}: {group.what}",
        "",
        f"{tried}{t.killed} of {t.killed + t.survived} mutants killed{refused}: {t.share:.1%}; "
        f"{group.share:.0%} are required. {t.equivalent} more are equivalent.{sampling}",
        "",
        *_table(results),
    ]
    survivors = [r.mutant for r in results if r.outcome == SURVIVED]
    if survivors:
        lines += ["", "Survivors:", "", *(f"- `{mutant}`" for mutant in survivors)]
    reasons = Counter(excuse(r.mutant) for r in results if r.outcome == EQUIVALENT)
    if reasons:
        lines += ["", "Equivalent mutants by reason:", ""]
        lines += [f"- {count}: {reason}" for reason, count in reasons.most_common()]
    return "\n".join(lines)


def write(found: Mapping[str, Sequence[Result]], seed: int = SEED) -> None:
    """Replace the sections of these groups."""
    text = README.read_text(encoding="utf-8")
    for name, results in found.items():
        begin, end = BEGIN.format(name), END.format(name)
        before, _, rest = text.partition(begin)
        _, _, after = rest.partition(end)
        text = f"{before}{begin}\n\n{section(name, results, seed)}\n\n{end}{after}"
    README.write_text(text, encoding="utf-8")
