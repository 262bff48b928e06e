"""The three passes that draw fur, with the states of the lecture, as data for any engine."""

from __future__ import annotations

from typing import Any

State = dict[str, Any]

OVER: State = {
    "colour": {"source": "src-alpha", "destination": "one-minus-src-alpha", "operation": "add"},
    "alpha": {"source": "one", "destination": "one-minus-src-alpha", "operation": "add"},
}
"""Straight alpha over what is there. On a target cleared to 0 the sum is premultiplied, with its coverage."""


def pass_states(closed: bool) -> dict[str, State]:
    """State by pass, in the order in which the passes are drawn.

    closed  whether the mesh has no border: only then are back faces never seen
    """
    cull = "back" if closed else "none"
    base: State = {"blend": None, "depth_test": "less-equal", "depth_write": True, "cull": cull}
    shell: State = {"blend": OVER, "depth_test": "less-equal", "depth_write": False, "cull": cull}
    fin: State = {"blend": OVER, "depth_test": "less-equal", "depth_write": False, "cull": "none"}
    return {"base": base, "shell": shell, "fin": fin}
