"""Templates of pages, which escape what they are filled with, and other files that packages carry."""

from __future__ import annotations

from importlib.resources import files

import jinja2


def templates(package: str, folder: str) -> jinja2.Environment:
    """The templates that lie in a folder of a package."""
    return jinja2.Environment(
        loader=jinja2.PackageLoader(package, folder),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )


def carried(package: str, path: str) -> str:
    """The text of a file that a package carries."""
    return files(package).joinpath(path).read_text(encoding="utf-8")
