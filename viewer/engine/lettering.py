"""Labels drawn over the finished picture: one instanced draw of letters and plates."""

from __future__ import annotations

from collections.abc import Hashable
from typing import TYPE_CHECKING

import moderngl

from viewer.engine.gpu import Gpu
from viewer.engine.inscriptions import Inscription
from viewer.engine.program import VertexArray
from viewer.engine.shaders import ShaderError, ShaderFolders
from viewer.engine.state import plain_state

if TYPE_CHECKING:
    from viewer.engine.lettering_type import Typesetter

KEEPING_ALPHA = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA, moderngl.ZERO, moderngl.ONE
ROOM = 1024                     # rectangles that the buffer holds at first


class Lettering:
    """Draws labels; makes nothing before the first, and nothing new while they stay the same."""

    def __init__(self, context: moderngl.Context, shaders: ShaderFolders) -> None:
        self.context = context
        self._arena, self._sheet_arena = Gpu(context, shaders), Gpu(context, shaders)
        self._typesetter: Typesetter | None = None
        self._letters: VertexArray | None = None
        self._texture: moderngl.Texture | None = None
        self._room = ROOM
        self._sheet_sent: Hashable = None
        self._composed: Hashable = None
        self._count = 0

    @property
    def generation(self) -> int:
        """Grows whenever an edited shader is taken over."""
        return self._arena.generation

    def compose(self, inscriptions: tuple[Inscription, ...], size: tuple[int, int]) -> None:
        """Bring what ``draw`` draws up to date, for a picture of that size."""
        if (inscriptions, size) == self._composed:
            return
        self._composed, self._count = None, 0
        if inscriptions:
            self._send(inscriptions, size[1])
        self._composed = inscriptions, size

    def draw(self) -> None:
        """Draw the labels into the bound framebuffer, whose values are sRGB, leaving its alpha alone."""
        if not self._count or self._letters is None or self._texture is None:
            return
        self.context.enable_only(moderngl.BLEND)
        self.context.blend_func = KEEPING_ALPHA  # type: ignore[assignment]
        self._texture.use(0)
        self._letters.render(vertices=4, instances=self._count)
        plain_state(self.context)

    def refresh(self) -> ShaderError | None:
        """Take over edited shader files; returns the error that stands, if any."""
        return self._arena.refresh()

    def release(self) -> None:
        """Free everything on the GPU."""
        self._count, self._letters, self._texture, self._sheet_sent, self._composed = 0, None, None, None, None
        self._arena.release()
        self._sheet_arena.release()

    def _send(self, inscriptions: tuple[Inscription, ...], picture_height: int) -> None:
        from viewer.engine.lettering_type import Typesetter  # not before there is a word to set

        self._typesetter = self._typesetter or Typesetter()
        rectangles = self._typesetter.set(inscriptions, picture_height)
        if self._letters is None:
            self._letters = self._made(rectangles.itemsize)
        self._send_sheet(self._typesetter)
        while self._room < len(rectangles):
            self._room *= 2
        self._buffer.orphan(self._room * rectangles.itemsize)
        self._buffer.write(rectangles.tobytes())
        self._count = len(rectangles)

    def _made(self, itemsize: int) -> VertexArray:
        """Program and buffer, which grows in place."""
        program = self._arena.program("studio/label.vert", "studio/label.frag")
        program["u_sheet"] = 0
        self._buffer = self._arena.buffer(reserve=self._room * itemsize, label="letters")
        names = "in_anchor", "in_rectangle", "in_sheet", "in_radius", "in_color"
        return self._arena.vertex_array(program, [(self._buffer, "4f 4f 2f 1f 4f1 /i", *names)],
                                        mode=moderngl.TRIANGLE_STRIP)

    def _send_sheet(self, typesetter: Typesetter) -> None:
        """The sheet to the GPU, into a texture of its own if it was started anew."""
        sheet = typesetter.sheet
        if self._sheet_sent == (sheet, sheet.revision):
            return
        if self._texture is None or self._texture.width != sheet.extent:
            self._sheet_arena.release()
            self._texture = self._sheet_arena.texture((sheet.extent, sheet.extent), 1, label="sheet of letters")
        self._texture.write(sheet.coverage[:sheet.used], (0, 0, sheet.extent, sheet.used))
        self._sheet_sent = sheet, sheet.revision
