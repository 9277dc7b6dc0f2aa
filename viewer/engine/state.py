"""GL's state as every pass finds it, whatever the one before left behind."""

from __future__ import annotations

import moderngl


def plain_state(context: moderngl.Context) -> None:
    """Opaque triangles, both sides, the nearest winning."""
    context.enable_only(moderngl.DEPTH_TEST)
    context.depth_func = "<"
    context.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
    context.blend_equation = moderngl.FUNC_ADD, moderngl.FUNC_ADD
    context.cull_face = "back"
    context.front_face = "ccw"
    context.wireframe = False
    context.polygon_offset = 0.0, 0.0


def whole(target: moderngl.Framebuffer) -> None:
    """Draw into all of ``target`` from now on, depth included."""
    target.viewport = 0, 0, *target.size
    target.scissor = None  # type: ignore[assignment]
    target.depth_mask = True
    target.use()
