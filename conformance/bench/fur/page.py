"""The recorded results as a figure and as the table of README.md."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from codegen.files import write_text
from conformance.marked import with_part
from conformance.plots import BLUE, GREEN, INK, LINE, ORANGE, PURPLE, SOFT

FOLDER = Path(__file__).parent
RESULTS = FOLDER / "results"
FIGURE = RESULTS / "scaling.png"
RECORDED_PLATE = FOLDER / "plate.json"
README = FOLDER / "README.md"
BEGIN, END = "<!-- begin {} -->", "<!-- end {} -->"
COLOURS = (BLUE, ORANGE, GREEN, PURPLE)
INCHES, DOTS_PER_INCH = (7.4, 3.3), 160

Results = list[dict[str, Any]]


def read_results(folder: Path = RESULTS) -> Results:
    """The recorded results by the name of their files."""
    return [json.loads(path.read_text(encoding="utf-8")) for path in sorted(folder.glob("*.json"))]


def draw_figure(results: Results, path: Path) -> None:
    """Milliseconds per frame against shells and against pixels, with the lines through them, as PNG."""
    figure = Figure(figsize=INCHES, dpi=DOTS_PER_INCH, layout="constrained")
    panels = figure.subplots(1, 2)
    for axes, key, title in zip(
        panels, ("layers", "pixels"), ("shells, {0} x {0} pixels", "million pixels, 32 layers"), strict=True
    ):
        for data, colour in zip(results, COLOURS, strict=False):
            grown = data[key]
            x, ms = np.asarray(grown["x"], np.float64), np.asarray(grown["ms"], np.float64)
            ends = np.array([0.0, x.max()])
            axes.plot(ends, grown["slope"] * ends + grown["intercept"], color=colour, linewidth=1.0)
            axes.plot(x, ms, "o", color=colour, markersize=4.5, label=data["device"]["short"])
        axes.set_xlabel(title.format(results[0]["layers"]["side"]), color=INK)
        axes.set_ylim(bottom=0.0)
        axes.set_xlim(left=0.0)
        axes.grid(color=LINE, linewidth=0.6)
        axes.spines[["top", "right"]].set_visible(False)
        axes.tick_params(colors=SOFT)
    panels[0].set_ylabel("processor ms per frame", color=INK)
    panels[0].legend(frameon=False, loc="upper left")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, metadata={"Software": None})


def table(results: Results) -> str:
    """The lines of README.md that say what was measured."""
    rows = []
    for data in results:
        for name, scene in data["scenes"].items():
            for key, ms in scene["ms"].items():
                error = scene.get("error", {}).get(key)
                figures = f"{error['max']:.2g} | {error['median']:.2g}" if error else " | "
                rows.append(
                    f"| {data['device']['short']} | {name} | {key} | {ms['median']:.0f} | {figures} |"
                )
    lines = [
        "| driver | scene | stages | ms | largest error | median |",
        "|---|---|---|---|---|---|",
        *rows,
        "",
        "| driver | scene | time of | over | ratio [quartiles] | of the lighting alone |",
        "|---|---|---|---|---|---|",
    ]
    for data in results:
        for name, scene in data["scenes"].items():
            for entry in scene["ratios"]:
                low, high = entry["ratio"]["quartiles"]
                net = f"{entry['net']['median']:.2f}" if "net" in entry else ""
                shown = f"{entry['ratio']['median']:.2f} [{low:.2f}, {high:.2f}]"
                cells = (data["device"]["short"], name, entry["of"], entry["over"], shown, net)
                lines.append(f"| {' | '.join(cells)} |")
    lines += ["", "| driver | cost of a frame | besides | off the line by at most |", "|---|---|---|---|"]
    for data in results:
        for key in ("layers", "pixels"):
            grown = data[key]
            per = "shell" if key == "layers" else "million pixels"
            cost = f"{_digits(grown['slope'])} ms per {per} | {_digits(grown['intercept'])} ms"
            lines.append(f"| {data['device']['short']} | {cost} | {100 * grown['residual']:.1f} % |")
    lines.append("")
    for data in results:
        load = max(data["load_average"]["before"][0], data["load_average"]["after"][0])
        method = f"{data['method']['picture']}; {data['method']['rounds']} rounds; {data['method']['clock']}"
        where = f"{data['date']}, {data['machine']['cpu']}, load average {load:.1f}"
        lines.append(f"- {data['device']['short']}: {method}; {where}.")
    return "\n".join(lines)


def _digits(x: float) -> str:
    """Three significant digits, without an exponent."""
    return f"{x:.0f}" if abs(x) >= 100.0 else f"{x:.3g}"


def plate_table(data: dict[str, Any]) -> str:
    """The lines of README.md on the plate of what each piece buys."""
    rows = [f"| {panel['caption']} | {panel['ms']:.0f} |" for panel in data["panels"]]
    about = (
        f"{data['device']['short']}, {data['method']['picture']}, {data['date']}; {data['method']['clock']}."
    )
    return "\n".join(["| panel | ms |", "|---|---|", *rows, "", about])


def sections() -> dict[str, str]:
    """What README.md says of recorded results, by the name of the section."""
    results = read_results()
    found = {"frames": table(results)} if results else {}
    if RECORDED_PLATE.is_file():
        found["plate"] = plate_table(json.loads(RECORDED_PLATE.read_text(encoding="utf-8")))
    return found


def update_readme(path: Path = README) -> None:
    """Put what is recorded in its places."""
    text = path.read_text(encoding="utf-8")
    for name, section in sections().items():
        text = with_part(text, BEGIN.format(name), END.format(name), f"\n{section}\n")
    write_text(path, text)
