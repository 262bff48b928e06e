"""The furry bunny's scene on a ball, small enough to be drawn in a moment."""

from __future__ import annotations

from pathlib import Path

import trimesh

SCENES = Path(__file__).parents[3] / "examples" / "scenes"
CHANGES = (
    ("../data/bunny.obj", "ball.ply"),
    ("[640, 640]", "[64, 64]"),
    ("[0.1, 4.75, 0.0]", "[0.0, 0.0, 0.0]"),
    ("27.0", "7.0"),
    ("layers = 32", "layers = 6"),
    ("supersample = 2", "supersample = 1"),
)


def write_furry_ball(folder: Path) -> Path:
    """Writes ball.ply and scene.toml into a folder; returns the scene's path."""
    trimesh.creation.icosphere(subdivisions=2).export(folder / "ball.ply")
    text = (SCENES / "furry-bunny.toml").read_text(encoding="utf-8")
    for old, new in CHANGES:
        assert old in text, f"the scene no longer says {old}"
        text = text.replace(old, new)
    (folder / "scene.toml").write_text(text, encoding="utf-8")
    return folder / "scene.toml"
