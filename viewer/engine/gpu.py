"""A scene's arena of GPU objects: it makes, labels and records each one, and frees them all at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import moderngl
import numpy as np
from numpy.typing import ArrayLike

from viewer.engine.fields import Uniform
from viewer.engine.labels import label as name_object
from viewer.engine.params import Parameters
from viewer.engine.program import Program, VertexArray
from viewer.engine.shaders import Generated, ShaderError, ShaderFolders
from viewer.errors import DemoscopeError


class GpuError(DemoscopeError):
    """Something that this GPU cannot hold or do."""


class Gpu:
    """What a scene makes its buffers, textures and programs with.

    Nobody frees what came from here but ``release``. ``parameters`` holds the uniforms that every
    program with a uniform of that name receives; ``casting_shadows`` tells that the drawing under way
    is the shadow map's, for which programs leave out their fragment shader.
    """

    def __init__(self, context: moderngl.Context, shaders: ShaderFolders) -> None:
        self.context = context
        self.shaders = shaders
        self.parameters: dict[str, Uniform] = {}
        self.parameters_revision = -1
        self.casting_shadows = False
        self.programs: list[Program] = []
        self._owned: list[Any] = []
        self._largest_texture: int = context.info["GL_MAX_TEXTURE_SIZE"]

    def own(self, thing: Any, label: str) -> Any:
        """Record a GL object made elsewhere, so that ``release`` frees it too."""
        if label:
            name_object(thing, label)
        self._owned.append(thing)
        return thing

    def discard(self, *things: Any) -> None:
        """Free some of what was made here before the rest, to make room for larger ones."""
        self.context.detect_framebuffer(0).use()    # GL may not go back to a framebuffer that is gone
        for thing in things:
            self._owned.remove(thing)
            thing.release()

    def share(self, params: Parameters) -> None:
        """Give every program the parameters' uniforms, as they now are."""
        if params.revision != self.parameters_revision:
            self.parameters = params.uniforms()
            self.parameters_revision = params.revision

    @property
    def generation(self) -> int:
        """Grows whenever a program is replaced by an edited one."""
        return sum(program.generation for program in self.programs)

    @property
    def reads_time(self) -> bool:
        """Whether any shader mentions the time."""
        return any(program.reads_time for program in self.programs)

    def program(self, vertex: str, fragment: str | None = None, *, generated: Generated | None = None) -> Program:
        """A program from two files under ``shaders/``; raises ShaderError with file and line.

        ``generated`` gives the text of includes that are not files. Without ``fragment`` it can
        only be captured from, not drawn with.
        """
        program = Program(self, vertex, fragment, generated or {})
        self.programs.append(program)
        return program

    def buffer(self, data: ArrayLike | None = None, *, reserve: int = 0, label: str = "") -> moderngl.Buffer:
        """A buffer with the bytes of ``data``, or with room for ``reserve`` bytes."""
        content = None if data is None else np.ascontiguousarray(data)
        made = self.context.buffer(content, reserve=reserve)
        self.own(made, label)
        return made

    def texture(self, size: tuple[int, int], components: int, data: ArrayLike | None = None, *,
                samples: int = 0, dtype: str = "f1", label: str = "") -> moderngl.Texture:
        """A 2D texture, or with ``samples`` one to draw into; raises GpuError where ``size`` is beyond the limit."""
        self.check_size(size, "a texture")
        pixels = None if data is None else np.ascontiguousarray(data)
        made = self.context.texture(size, components, pixels, samples=samples, dtype=dtype)
        self.own(made, label)
        return made

    def volume(self, size: tuple[int, int, int], components: int, data: ArrayLike | None = None, *,
               dtype: str = "f4", label: str = "") -> moderngl.Texture3D:
        """A 3D texture, interpolated linearly and without end beyond its border; raises GpuError beyond the limit.

        ``data`` holds the texels of the first row along x first, then the next along y, then the next layer along z.
        """
        most = int(self.context.info["GL_MAX_3D_TEXTURE_SIZE"])
        if not all(1 <= extent <= most for extent in size):
            raise GpuError(f"a volume of {'x'.join(map(str, size))} is outside 1x1x1 to {most}x{most}x{most}, "
                           "what this GPU takes")
        texels = None if data is None else np.ascontiguousarray(data)
        made = self.context.texture3d(size, components, texels, dtype=dtype)
        made.filter = moderngl.LINEAR, moderngl.LINEAR
        made.repeat_x = made.repeat_y = made.repeat_z = False
        self.own(made, label)
        return made

    def depth_texture(self, size: tuple[int, int], label: str = "", *, samples: int = 0) -> moderngl.Texture:
        """A depth texture, readable by shaders."""
        self.check_size(size, "a depth texture")
        made = self.context.depth_texture(size, samples=samples)
        self.own(made, label)
        return made

    def framebuffer(self, color: Sequence[moderngl.Texture | moderngl.Renderbuffer] = (),
                    depth: moderngl.Texture | moderngl.Renderbuffer | None = None,
                    label: str = "") -> moderngl.Framebuffer:
        """A framebuffer that draws into ``color`` and ``depth``."""
        made = self.context.framebuffer(list(color), depth)
        self.own(made, label)
        return made

    def depth_renderbuffer(self, size: tuple[int, int], *, samples: int = 0,
                           label: str = "") -> moderngl.Renderbuffer:
        """A depth buffer that is drawn into but not sampled."""
        made = self.context.depth_renderbuffer(size, samples=samples)
        self.own(made, label)
        return made

    def vertex_array(self, program: Program, content: Sequence[tuple[Any, ...]] = (),
                     index: moderngl.Buffer | None = None, *, mode: int = moderngl.TRIANGLES,
                     closed: bool = False) -> VertexArray:
        """Buffers bound to a program's attributes: ``[(buffer, "3f", "in_position"), ...]``.

        A format that ends in ``/i`` steps once per instance. Attributes that the program does not
        use are skipped. ``index`` holds 32-bit indices. ``closed`` promises a surface of which only the
        outside, with its triangles counter-clockwise, is ever seen: the rest is left out, which is faster.
        """
        made = VertexArray(program, tuple(content), index, mode, closed)
        self.own(made, "")
        return made

    @property
    def largest_texture(self) -> int:
        """How wide and how high a texture may be."""
        return self._largest_texture

    def check_size(self, size: tuple[int, int], what: str) -> None:
        """Raise GpuError where ``size`` is empty or larger than the driver takes."""
        if not all(1 <= extent <= self._largest_texture for extent in size):
            raise GpuError(f"{what} of {size[0]}x{size[1]} is outside 1x1 to "
                           f"{self._largest_texture}x{self._largest_texture}, what this GPU takes")

    def refresh(self) -> ShaderError | None:
        """Bring every program up to date with its files and generated text.

        Returns the first error; a program that has one goes on with what it last had.
        """
        errors = [error for program in self.programs if (error := program.refresh())]
        return errors[0] if errors else None

    def release(self) -> None:
        """Free everything that was made here, the newest first."""
        # GL goes back to the framebuffer that was bound, and raises if that one is gone by then.
        self.context.detect_framebuffer(0).use()
        for thing in reversed(self._owned):
            thing.release()
        for program in self.programs:
            program.release()
        self._owned.clear()
        self.programs.clear()
