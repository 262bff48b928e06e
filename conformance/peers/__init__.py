"""Forms that other libraries use, beside ours: same inputs, same harness, same reference.

They are sources like those of shaderlib, parsed by the same front end as a section of its own, and never part
of the emitted library. Each is declared as a variant of the function of ours that it competes with. They are
written here from published formulas; none of them promises to be finite, and some are not.
"""

from __future__ import annotations

from pathlib import Path

from codegen.library import Library, load_library

__all__ = ["FORMS", "PEERS", "library"]

FORMS = Path(__file__).parent / "peer_forms"
"""The folder of the sources; their section has its name."""

PEERS: dict[str, str] = {
    "peer_sine_unclamped": "sin_angle",
    "peer_highlight_unclamped": "strand_specular",
    "peer_highlight_half_power": "strand_specular_half",
    "peer_bessel_i0e_log": "bessel_i0e",
    "peer_ggx_one_minus_square": "ggx_value",
}
"""Every peer's form and the function of ours that it is held against."""


def library() -> Library:
    """Our library with the peers' forms as variants of ours."""
    return load_library(extra=(FORMS,))
