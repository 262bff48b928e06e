"""Draws fur with OpenGL 3.3: `python examples/fur/opengl.py KIT -o fur.png`, KIT from `vair fur`.

The draw loop is the lecture's: the base with depth writes and no blending, then shells from the inside out
and fins with blending and no depth writes.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from kit import Kit, main  # type: ignore[import-not-found]


def draw(kit: Kit, size: tuple[int, int]) -> npt.NDArray[np.float32]:
    """Premultiplied linear samples (height, width, 4), top row first."""
    import moderngl

    headless: Any = "egl"
    context = moderngl.create_standalone_context(backend=headless, require=330)
    colour = context.texture(size, 4, dtype="f2")
    frame = context.framebuffer([colour], context.depth_renderbuffer(size))
    frame.use()
    frame.clear(0.0, 0.0, 0.0, 0.0)
    context.buffer(kit.uniforms("opengl")).bind_to_uniform_block(0)
    for item in kit.about["passes"]:
        vertex, fragment = (kit.text(name) for name in item["glsl"]["330"])
        program = context.program(vertex_shader=vertex, fragment_shader=fragment)
        block: Any = program[kit.about["uniforms"]["block"]]
        block.binding = 0
        apply(context, frame, item["state"])
        # moderngl wants to know which attributes a program has left; it skips over the others.
        attributes = kit.about["buffers"][item["vertices"]]["attributes"]
        used = [a["name"] for a in attributes if a["name"] in program]
        form = " ".join(f"{a['floats']}{'f' if a['name'] in used else 'x4'}" for a in attributes)
        vertices = context.buffer(kit.buffer(item["vertices"]))
        triangles = context.buffer(kit.buffer(item["triangles"]))
        array = context.vertex_array(program, [(vertices, form, *used)], triangles)
        array.render(instances=item["instances"])
    samples = np.frombuffer(colour.read(), np.float16).reshape(size[1], size[0], 4)
    return samples[::-1].astype(np.float32)


def apply(context: Any, frame: Any, state: dict[str, Any]) -> None:
    """Set the state of a pass."""
    flags = context.DEPTH_TEST
    if state["cull"] != "none":
        flags |= context.CULL_FACE
    if state["blend"]:
        flags |= context.BLEND
        names = [
            state["blend"][part][end].upper().replace("-", "_")
            for part in ("colour", "alpha")
            for end in ("source", "destination")
        ]
        context.blend_func = tuple(getattr(context, name) for name in names)
    context.enable_only(flags)
    context.depth_func = "<="
    frame.depth_mask = state["depth_write"]


if __name__ == "__main__":
    main(draw)
