"""report.html: one file that needs no network, with the scripts of plotly and DataTables in it."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping
from typing import Any

import jinja2

from codegen.library import Library
from conformance.bench.selfcheck import EXPECTED, MEANING
from conformance.report.light import light_view
from conformance.report.view import KINDS, MODES, view
from conformance.templates import carried, templates

PLOTLY = ("plotly", "package_data/plotly.min.js")
TABLES = ("itables", "html/dt_bundle.js")
TABLES_STYLE = ("itables", "html/dt_bundle.css")


def page(library: Library, report: Mapping[str, Any]) -> str:
    """The whole page."""
    shown = view(library, report)
    scripts = ["plots.js", "report.js"] + (["light.js"] if report["light"] else [])
    return _template("report.html.j2").render(
        **_shared(report, scripts),
        view=shown,
        rows=[(g, e) for g in shown["groups"] for e in g["entries"]],
        kinds=KINDS,
        modes=MODES,
        expected=EXPECTED,
        meaning=MEANING,
        data=embedded({key: shown[key] for key in ("drivers", "modes", "groups")}),
        tables=base64.b64encode(carried(*TABLES).encode()).decode(),
        tables_style=carried(*TABLES_STYLE),
    )


def light_page(light: Mapping[str, Any]) -> str:
    """A page of its own for the estimators of light, from the data of conformance.light.run.measure."""
    report = {"drivers": [], "emission": [], "light": light}
    return _template("light_page.html.j2").render(**_shared(report, ["plots.js", "light.js"]))


def _template(name: str) -> jinja2.Template:
    environment = templates("conformance.report", "page")
    environment.filters["number"] = number
    return environment.get_template(name)


def _shared(report: Mapping[str, Any], scripts: list[str]) -> dict[str, Any]:
    """What both pages show or need."""
    light = light_view(report["light"])
    return {
        "report": report,
        "light": light,
        "light_data": embedded(light["data"]) if light else "",
        "figures": figures(report),
        "plotly": carried(*PLOTLY),
        "style": carried("conformance.report", "page/report.css"),
        "script": "\n".join(carried("conformance.report", f"page/{name}") for name in scripts),
    }


def embedded(data: Any) -> str:
    """JSON that may stand inside a script element."""
    return json.dumps(data, separators=(",", ":"), allow_nan=False).replace("</", "<\\/")


def figures(report: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The promised figures, one row for each with the values of all drivers; then those of emission."""
    found: dict[tuple[Any, ...], dict[str, Any]] = {}
    for result in report["drivers"]:
        for f in result["figures"]:
            key = (f["what"], f["domain"], f["goal"], f["unit"])
            found.setdefault(key, {**f, "values": []})["values"].append((result["device"]["short"], f))
    light = report["light"]["float64"]["figures"] if report["light"] else []
    rows = [*found.values(), *({**f, "values": [("", f)]} for f in (*light, *report["emission"]))]
    return [{**row, "met": _met([f["met"] for _, f in row["values"]])} for row in rows]


def _met(verdicts: list[bool | None]) -> bool | None:
    told = [v for v in verdicts if v is not None]
    return all(told) if told else None


def number(value: float | None, digits: int = 3) -> str:
    """A number for people: 0.87, 12.3, 1,540, 2.6e-7; a dash for none."""
    if value is None:
        return "\u2013"
    if value == 0.0:
        return "0"
    size = abs(value)
    if 1e-3 <= size < 1e5:
        decimals = max(digits - 1 - max(int(f"{size:e}".split("e")[1]), -3), 0)
        return f"{value:,.{decimals}f}"
    mantissa, exponent = f"{value:.{digits - 2}e}".split("e")
    return f"{mantissa}e{int(exponent)}"
