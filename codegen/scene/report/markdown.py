"""The report of a scene for people: Markdown, and a few lines for the terminal."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

from codegen.ir.domains import number
from codegen.scene.description.document import HALF_STEP
from codegen.scene.report.speed import CHAINS, ROUNDS

MOVING = ("scalars",)
"""Passes that compute nothing; their steps are counted but not listed."""


def as_markdown(data: dict[str, Any]) -> str:
    """The report for people."""
    scene = data["scene"]
    lines = [f"# {scene['name']}", ""]
    lines += [*_opening(data), "", "## Parameters", "", *_parameters(data), "", "## Gain", "", *_gains(data)]
    lines += ["", "## What the exact passes did", "", *_exact(data), "", "## What was approximated", ""]
    lines += [
        *_approximations(data),
        "",
        "## Proof",
        "",
        *_proofs(data),
        "",
        "## What remains",
        "",
        *_remains(data),
    ]
    if data["environment"]:
        lines += ["", "## The map", "", *_map(data)]
    return "\n".join(lines) + "\n"


def _opening(data: dict[str, Any]) -> list[str]:
    scene = data["scene"]
    budget = (
        "exact passes only"
        if not scene["budget"]
        else (f"the shaded value may err by {scene['budget']:.3g} (`{scene['budget_stated']}`)")
    )
    return [
        f"`{scene['function']}` is `{scene['model']}` for `{scene['file']}`; {budget}. One step of 8 bits is "
        f"1/255, and half a step {HALF_STEP:.3g}.",
    ]


def _parameters(data: dict[str, Any]) -> list[str]:
    left = [f"`{p['name']}`" for p in data["parameters"]["left"]]
    gone = [f"`{name}`" for name in data["parameters"]["gone"]]
    return [
        f"{len(left)} are left: {', '.join(left)}.",
        "",
        f"{len(gone)} are gone: {', '.join(gone) or 'none'}.",
    ]


def _gains(data: dict[str, Any]) -> list[str]:
    rows = [
        "| target | operations | lines | SPIR-V | ns per evaluation | ratio | build s |",
        "|" + "---|" * 7,
    ]
    for t in data["targets"]:
        o, spirv, speed = t["operations"], t["spirv_instructions"], t["speed"]
        counts = f"{spirv['general']} -> {spirv['final']}" if spirv and spirv["final"] else ""
        ns = ratio = build = ""
        if speed:
            a, b = speed["general"], speed["final"]
            ns = f"{_spread(a)} -> {_spread(b)}"
            ratio = f"{speed['ratio']:.2f}" if speed["ratio"] is not None else ""
            build = f"{a['build_seconds']:.2f} -> {b['build_seconds']:.2f}"
        rows.append(
            f"| {t['target']} | {o['general']['all']} -> {o['exact']['all']} -> {o['final']['all']} "
            f"| {t['lines']['general']} -> {t['lines']['final']} | {counts} | {ns} | {ratio} | {build} |"
        )
    differ = len({t["operations"]["final"]["all"] for t in data["targets"]}) > 1
    dearer = (
        "The search takes what saves most by the prices named below, which are recorded times where there "
        "are any: a larger count stands for more operations that take less time on that driver."
    )
    return [
        *rows,
        *(["", dearer] if differ else []),
        "",
        "Operations: general, after exact passes, written; additions, multiplications, divisions, roots, "
        "exponentials, comparisons and choices, one each. SPIR-V: of GLSL for Vulkan by glslang, not "
        "optimised, what is called for several lights counted once. Speed: interleaved in one process, "
        f"{ROUNDS} rounds forwards and backwards, {CHAINS} "
        "independent evaluations side by side, net of inputs and loop, median [quartiles], on "
        "ordinary inputs; CPU time on software drivers. It holds for the driver that is named below. Build: "
        "from text to a kernel of the same measurement.",
    ]


def _exact(data: dict[str, Any]) -> list[str]:
    if not data["exact_steps"]:
        return ["Nothing."]
    counts = Counter(step["pass"] for step in data["exact_steps"])
    rows = [
        f"{', '.join(f'{n} by {name}' for name, n in counts.items())}.",
        "",
        "| pass | what | why it is sound | where |",
    ]
    rows.append("|---|---|---|---|")
    for step in data["exact_steps"]:
        if step["pass"] in MOVING:
            continue
        rows.append(f"| {step['pass']} | `{_cell(step['what'])}` | {_cell(step['why'])} | {step['where']} |")
    return rows


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def _approximations(data: dict[str, Any]) -> list[str]:
    lines: list[str] = []
    for names, t in _alike(data["targets"]):
        lines.append(f"**{names}** (prices: {t['prices']})")
        lines.append("")
        if not t["approximations"]:
            lines += ["Nothing.", ""]
            continue
        lines += ["| kind | what | why | saving | predicted error, all up to here |", "|---|---|---|---|---|"]
        for a in t["approximations"]:
            refused = f"; refused before: {'; '.join(a['refused_before'])}" if a["refused_before"] else ""
            lines.append(
                f"| {a['kind']} | {_cell(a['what'])} | {_cell(a['why'] + refused)} | {a['saving'] or ''} "
                f"| {a['predicted_error']:.2g} |"
            )
        lines.append("")
    return lines[:-1]


def _alike(targets: list[dict[str, Any]]) -> list[tuple[str, dict[str, Any]]]:
    """Targets with the same approximations together: their names, and the first of them."""
    found: list[tuple[str, dict[str, Any]]] = []
    for t in targets:
        same = [k for k, (_, u) in enumerate(found) if _content(u) == _content(t)]
        if same:
            found[same[0]] = f"{found[same[0]][0]}, {t['target']}", found[same[0]][1]
        else:
            found.append((t["target"], t))
    return found


def _content(t: dict[str, Any]) -> tuple[Any, ...]:
    return t["prices"], t["approximations"]


def _proofs(data: dict[str, Any]) -> list[str]:
    rows = [
        "| target | driver | predicted | measured | in half steps | general itself | exact passes |",
        "|" + "---|" * 7,
    ]
    for t in data["targets"]:
        proof, exact = t["proof"], t["exact_proof"]
        error = proof["error"]
        rows.append(
            f"| {t['target']} | {t['driver']} | {t['predicted']['largest']:.2g} | {error['largest']:.2g} "
            f"| {error['half_steps_8bit']:.2f} | {proof['general_itself']['largest']:.2g} "
            f"| {exact['different_bits']} differ in a bit; {exact['outside_intervals']} of "
            f"{exact['judged_by_intervals']} judged lie outside |"
        )
    how = "Executed" if any(t["executed"] for t in data["targets"]) else "Evaluated in float32, not executed,"
    notes = [
        "",
        f"{how} over {data['proof_points']} points, {data['hard_points']} of them hard, before anything "
        "was written. Errors are absolute, of the largest component, against the general function in float64 "
        "or on the same driver, whichever is nearer; the maxima are the largest found. Exact passes: results "
        "that differ from the general function's on that driver are held against what its specification "
        "permits the general function.",
    ]
    missing = [t for t in data["targets"] if not t["executed"]]
    for t in missing:
        notes.append("")
        notes.append(
            f"**{t['target']} was not executed**: {t['not_executed_because'] or 'no driver'}. The float32 "
            "evaluation stood in for it."
        )
    return rows + notes


def _remains(data: dict[str, Any]) -> list[str]:
    t = data["targets"][0]
    now = t["operations"]["final"]
    kinds = ", ".join(f"{n} {name}" for name, n in now.items() if name != "all" and n)
    lines = [f"{now['all']} operations: {kinds}."]
    if data["remaining"]:
        dearest = data["remaining"][0]
        saved = now["all"] - dearest["operations_if_constant"]
        name = dearest["parameter"]
        lines[0] += f" The dearest parameter is `{name}`: {saved} operations would go if it were constant."
        lines[0] += (
            " Constants are tried as a host would choose them: an axis of the frame, white, the middle."
        )
        lines += ["", "| parameter | operations if it were constant |", "|---|---|"]
        lines += [f"| `{r['parameter']}` | {r['operations_if_constant']} |" for r in data["remaining"]]
    return lines


def _map(data: dict[str, Any]) -> list[str]:
    e = data["environment"]
    return [
        f"{len(e['lights'])} constant lights by median cut stand for the map. Against direct integration "
        f"over {e['texels']} texels at {e['points']} points, with the general function: rms "
        f"{e['rms_error']:.3g}, largest {e['largest_error']:.3g}, at a mean radiance of "
        f"{e['mean_radiance']:.3g}. This is not part of the budget: "
        "the budget is against the constant lights.",
        "",
        "| direction | colour |",
        "|---|---|",
        *(f"| {_triple(light['direction'])} | {_triple(light['colour'])} |" for light in e["lights"]),
    ]


def _spread(speed: dict[str, Any]) -> str:
    return f"{speed['ns']:.3g} [{speed['low']:.3g}-{speed['high']:.3g}]"


def _triple(values: Any) -> str:
    return " ".join(f"{x:.4g}" for x in values)


def summary(data: dict[str, Any], folder: Path) -> str:
    """A few lines for the terminal."""
    left = ", ".join(p["name"] for p in data["parameters"]["left"])
    lines = [f"{data['scene']['function']}({left})"]
    for t in data["targets"]:
        o, proof = t["operations"], t["proof"]
        ratio = f", {t['speed']['ratio']:.2f} of its time" if t["speed"] and t["speed"]["ratio"] else ""
        where = t["driver"].split(";")[0] if t["executed"] else "float32 evaluation, not executed"
        lines.append(
            f"  {t['file']}: {o['final']['all']} of {o['general']['all']} operations{ratio}; error "
            f"{number(float(format(proof['error']['largest'], '.2g')))} on {where}"
        )
    return "\n".join([*lines, f"  report: {folder / 'report.md'}"])
