"""Draws what ImGui prepared, with moderngl and GLSL 3.30, by the texture protocol of Dear ImGui 1.92.

ImGui asks for textures to be made, updated and destroyed as glyphs come and go; ``prepare`` obeys.
Pictures of our own are shown by telling the renderer their texture with ``lend``.
"""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, NamedTuple

import moderngl
import numpy as np
from imgui_bundle import imgui
from numpy.typing import NDArray

from viewer.engine.labels import label

if TYPE_CHECKING:
    from imgui_bundle.imgui import ImDrawCmd, ImDrawData, ImTextureData

VERTEX_BYTES = 20   # position 2f, texture coordinate 2f, colour 4 bytes
INDEX_BYTES = 4
FRAMES_IN_FLIGHT = 3
FIRST_ROOM = 8192, 16384    # vertices and indices
BLENDING = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA, moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA

VERTEX_SHADER = """
#version 330 core
uniform vec2 u_scale;
uniform vec2 u_offset;
in vec2 in_position;
in vec2 in_texcoord;
in vec4 in_color;
out vec2 v_texcoord;
out vec4 v_color;
void main() {
    v_texcoord = in_texcoord;
    v_color = in_color;
    gl_Position = vec4(in_position * u_scale + u_offset, 0.0, 1.0);
}
"""

FRAGMENT_SHADER = """
#version 330 core
uniform sampler2D u_texture;
in vec2 v_texcoord;
in vec4 v_color;
out vec4 out_color;
void main() {
    out_color = v_color * texture(u_texture, v_texcoord);
}
"""


class Batch(NamedTuple):
    """Triangles that share a texture and a scissor box, by their place among all indices."""

    texture: int
    box: tuple[int, int, int, int]
    indices: int
    first: int


class Room:
    """Memory for one frame's triangles, here and on the GPU; a few are used in turn, so that none is still read."""

    def __init__(self, context: moderngl.Context, program: moderngl.Program, vertex_count: int,
                 index_count: int) -> None:
        self.staged_vertices = np.zeros((vertex_count, VERTEX_BYTES), np.uint8)
        self.staged_indices = np.zeros(index_count, np.uint32)
        self.vertex_address, self.index_address = self.staged_vertices.ctypes.data, self.staged_indices.ctypes.data
        self.vertices = context.buffer(reserve=self.staged_vertices.nbytes, dynamic=True)
        self.indices = context.buffer(reserve=self.staged_indices.nbytes, dynamic=True)
        content = [(self.vertices, "2f 2f 4f1", "in_position", "in_texcoord", "in_color")]
        self.array = context.vertex_array(program, content, self.indices, index_element_size=INDEX_BYTES)

    def release(self) -> None:
        """Free the buffers."""
        for thing in (self.array, self.vertices, self.indices):
            thing.release()


class ImguiRenderer:
    """Belongs to the ImGui context that is current when it is made; ``release`` while that still lives."""

    def __init__(self, context: moderngl.Context) -> None:
        self.context = context
        imgui.get_io().backend_flags |= imgui.BackendFlags_.renderer_has_textures
        platform = imgui.get_platform_io()
        platform.renderer_texture_max_width = context.info["GL_MAX_TEXTURE_SIZE"]
        platform.renderer_texture_max_height = context.info["GL_MAX_TEXTURE_SIZE"]
        self._program = context.program(vertex_shader=VERTEX_SHADER, fragment_shader=FRAGMENT_SHADER)
        self._program["u_texture"] = 0
        self._textures: dict[int, moderngl.Texture] = {}
        self._lent: dict[int, moderngl.Texture] = {}
        self._rooms = [Room(context, self._program, *FIRST_ROOM) for _ in range(FRAMES_IN_FLIGHT)]
        self._room = self._rooms[0]
        self._batches: list[Batch] = []
        self._size = (0, 0)

    def lend(self, texture: moderngl.Texture) -> imgui.ImTextureRef:
        """What to hand to ``imgui.image`` to show ``texture``; good until the panels are built anew."""
        self._lent[texture.glo] = texture
        return imgui.ImTextureRef(texture.glo)

    def forget_lent(self) -> None:
        """The panels are about to be built anew, and lend what they show again."""
        self._lent.clear()

    def prepare(self, data: ImDrawData) -> None:
        """Bring textures up to date, send the triangles to the GPU and note how to draw them."""
        for texture in data.textures:
            if texture.status != imgui.ImTextureStatus.ok:
                self._update(texture)
        self._size = (round(data.display_size.x * data.framebuffer_scale.x),
                      round(data.display_size.y * data.framebuffer_scale.y))
        self._batches = self._noted(data) if min(self._size) > 0 and data.total_idx_count else []
        if self._batches:
            scale = 2.0 / data.display_size.x, -2.0 / data.display_size.y
            self._program["u_scale"] = scale
            self._program["u_offset"] = -1.0 - data.display_pos.x * scale[0], 1.0 - data.display_pos.y * scale[1]
            self._upload(data)

    def draw(self, target: moderngl.Framebuffer) -> None:
        """Draw what was prepared over ``target``, which covers the whole of ImGui's display; again, if need be."""
        if not self._batches:
            return
        target.use()
        target.viewport = (0, 0, *self._size)
        self.context.enable_only(moderngl.BLEND)
        self.context.blend_equation = moderngl.FUNC_ADD  # type: ignore[assignment]
        self.context.blend_func = BLENDING  # type: ignore[assignment]
        try:
            self._draw_batches(target)
        finally:
            target.scissor = None  # type: ignore[assignment]
            self.context.disable(moderngl.BLEND)

    def release(self) -> None:
        """Free everything on the GPU and tell ImGui that its textures are gone."""
        for texture in imgui.get_platform_io().textures:
            if texture.get_tex_id() in self._textures:
                self._destroy(texture)
        imgui.get_io().backend_flags &= ~imgui.BackendFlags_.renderer_has_textures
        for left in self._textures.values():
            left.release()
        self._textures.clear()
        for room in self._rooms:
            room.release()
        self._program.release()

    def _noted(self, data: ImDrawData) -> list[Batch]:
        """Every command that shows something, in order."""
        batches, first_index, height = [], 0, self._size[1]
        for commands in data.cmd_lists:
            for command in commands.cmd_buffer:
                box = _clip(command, data, height)
                if box and command.elem_count:
                    batches.append(Batch(command.get_tex_id(), box, command.elem_count,
                                         first_index + command.idx_offset))
            first_index += commands.idx_buffer.size()
        return batches

    def _draw_batches(self, target: moderngl.Framebuffer) -> None:
        bound = -1
        for batch in self._batches:
            if batch.texture != bound:
                self._bind(batch.texture)
                bound = batch.texture
            target.scissor = batch.box
            self._room.array.render(moderngl.TRIANGLES, vertices=batch.indices, first=batch.first)

    def _bind(self, name: int) -> None:
        texture = self._textures.get(name) or self._lent.get(name)
        if texture is None:
            raise KeyError(f"ImGui draws with texture {name}, which nobody lent to its renderer")
        texture.use(0)

    def _upload(self, data: ImDrawData) -> None:
        """Send all lists at once; indices count from the start of the whole, as GL 3.3 wants them here."""
        room = self._room = self._next_room(data.total_vtx_count, data.total_idx_count)
        vertices, indices = 0, 0
        for commands in data.cmd_lists:
            vertex_count, index_count = commands.vtx_buffer.size(), commands.idx_buffer.size()
            ctypes.memmove(room.vertex_address + vertices * VERTEX_BYTES, commands.vtx_buffer.data_address(),
                           vertex_count * VERTEX_BYTES)
            ctypes.memmove(room.index_address + indices * INDEX_BYTES, commands.idx_buffer.data_address(),
                           index_count * INDEX_BYTES)
            if vertices:
                room.staged_indices[indices:indices + index_count] += vertices
            vertices, indices = vertices + vertex_count, indices + index_count
        room.vertices.write(room.staged_vertices[:vertices])
        room.indices.write(room.staged_indices[:indices])

    def _next_room(self, vertex_count: int, index_count: int) -> Room:
        room = self._rooms.pop(0)
        if vertex_count > len(room.staged_vertices) or index_count > len(room.staged_indices):
            room.release()
            room = Room(self.context, self._program, 2 * vertex_count, 2 * index_count)
        self._rooms.append(room)
        return room

    def _update(self, texture: ImTextureData) -> None:
        if texture.status == imgui.ImTextureStatus.want_create:
            made = self.context.texture((texture.width, texture.height), 4, _pixels(texture).tobytes())
            label(made, "imgui glyphs")
            self._textures[made.glo] = made
            texture.set_tex_id(made.glo)
            texture.set_status(imgui.ImTextureStatus.ok)
        elif texture.status == imgui.ImTextureStatus.want_updates:
            pixels, made = _pixels(texture), self._textures[texture.get_tex_id()]
            for box in texture.updates:
                part = pixels[box.y:box.y + box.h, box.x:box.x + box.w]
                made.write(np.ascontiguousarray(part), viewport=(box.x, box.y, box.w, box.h))
            texture.set_status(imgui.ImTextureStatus.ok)
        elif texture.status == imgui.ImTextureStatus.want_destroy and texture.unused_frames > 0:
            self._destroy(texture)

    def _destroy(self, texture: ImTextureData) -> None:
        made = self._textures.pop(texture.get_tex_id(), None)
        if made:
            made.release()
        texture.set_tex_id(0)
        texture.set_status(imgui.ImTextureStatus.destroyed)


def _pixels(texture: ImTextureData) -> NDArray[np.uint8]:
    """A texture's pixels in ImGui's memory, (height, width, 4)."""
    flat = np.asarray(texture.get_pixels_array(), np.uint8)
    return flat.reshape(texture.height, texture.width, 4)


def _clip(command: ImDrawCmd, data: ImDrawData, height: int) -> tuple[int, int, int, int] | None:
    """A command's clip rectangle as GL's scissor box in pixels, or None where nothing shows."""
    clip, origin, scale = command.clip_rect, data.display_pos, data.framebuffer_scale
    left, top = max(0, int((clip.x - origin.x) * scale.x)), max(0, int((clip.y - origin.y) * scale.y))
    right, bottom = int((clip.z - origin.x) * scale.x), min(height, int((clip.w - origin.y) * scale.y))
    if right <= left or bottom <= top:
        return None
    return left, height - bottom, right - left, bottom - top
