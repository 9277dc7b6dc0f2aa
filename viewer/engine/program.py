"""Shader programs that survive bad edits, and the vertex arrays that draw with them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.fields import Uniform
from viewer.engine.frame import FRAME_BINDING, SHADOW_NEAR_UNIT, SHADOW_WIDE_UNIT
from viewer.engine.labels import label
from viewer.engine.shaders import Generated, ShaderError, Source, explain

if TYPE_CHECKING:
    from viewer.engine.gpu import Gpu

DEPTH_ONLY = "#version 330 core\nvoid main() {}\n"
Captured: TypeAlias = tuple[str, ...]
Stamp: TypeAlias = tuple[tuple[str, int, int], ...]


class Variant:
    """One linked GL program and which parameter values it was last given."""

    def __init__(self, gl: moderngl.Program, fixed_units: Mapping[str, int], blocks: Mapping[str, int]) -> None:
        self.gl = gl
        self.revision = -1
        self.names = frozenset(gl)      # asking the program itself takes a search each time
        self.applied: dict[str, Uniform] = {}
        for name, unit in fixed_units.items():
            if name in gl:
                gl[name] = unit
        for name, binding in blocks.items():
            if name in gl:
                gl[name].binding = binding  # type: ignore[union-attr]

    def apply(self, uniforms: Mapping[str, Uniform], place: str) -> None:
        """Set the uniforms that this program has and that changed; raises ShaderError for a wrong type."""
        for name, value in uniforms.items():
            if name not in self.names or self.applied.get(name) == value:
                continue
            try:
                self.gl[name] = value
            except Exception as error:
                raise ShaderError(place, 0, f"uniform {name} is of a type that does not take {value}") from error
            self.applied[name] = value


class Program:
    """A vertex and a fragment shader, linked for each purpose when it first serves that purpose.

    The purposes are drawing in colour, drawing a shadow map (the fragment shader left out unless it
    discards), and capturing what the vertex shader computes. ``program["u_name"] = value`` sets a
    uniform for all of them. After an edit that does not compile, the last good one goes on and
    ``error`` says what is wrong.
    """

    def __init__(self, gpu: Gpu, vertex: str, fragment: str | None, generated: Generated) -> None:
        self.gpu = gpu
        self.name = fragment or vertex
        self.error: ShaderError | None = None
        self.generation = 0
        self._stages = {"vertex_shader": vertex} | ({"fragment_shader": fragment} if fragment else {})
        self._generated = {name: _careful(name, make) for name, make in generated.items()}
        self._own_uniforms: dict[str, Uniform] = {}
        self._variants: dict[object, Variant] = {}
        self._files: set[Path] = set()
        self._stamp: Stamp = ()
        texts = self._texts()
        self._sources = self._flatten(texts)
        self._watch(self._sources, texts)
        self.reads_time = _mention_time(self._sources.values())
        if fragment:
            self._variants["colour"] = self._link("colour", self._sources)

    def __setitem__(self, name: str, value: Uniform) -> None:
        self._own_uniforms[name] = value

    def variant(self, purpose: object) -> Variant:
        """The GL program for ``"colour"``, ``"depth"`` or a tuple of captured names, uniforms set."""
        found = self._variants.get(purpose)
        if found is None:
            found = self._variants[purpose] = self._link(purpose, self._sources)
        if found.revision != self.gpu.parameters_revision:
            found.revision = self.gpu.parameters_revision
            found.apply(self.gpu.parameters, self.name)
        found.apply(self._own_uniforms, self.name)
        return found

    def refresh(self) -> ShaderError | None:
        """Link anew if a file or generated text changed; returns the error that stands, if any."""
        stamp, self._stamp = self._stamp, ()    # a file that is missing may yet appear: look again next time
        try:
            texts = self._texts()
            if self._now(texts) == stamp:
                self._stamp = stamp
                return self.error
            sources = self._flatten(texts)
            self._watch(sources, texts)
            if not self._same_text(sources):
                self._replace(sources)
            self.error = None
        except ShaderError as error:
            self.error = error
        return self.error

    def release(self) -> None:
        """Free the GL programs."""
        for variant in self._variants.values():
            variant.gl.release()
        self._variants.clear()

    def _replace(self, sources: dict[str, Source]) -> None:
        purpose: object = "colour" if "fragment_shader" in sources else next(iter(self._variants), ("gl_Position",))
        fresh = self._link(purpose, sources)
        try:
            fresh.apply(self.gpu.parameters, self.name)
            fresh.apply(self._own_uniforms, self.name)
        except ShaderError:
            fresh.gl.release()
            raise
        self.release()
        self._variants = {purpose: fresh}
        self._sources = sources
        self.reads_time = _mention_time(sources.values())
        self.generation += 1

    def _texts(self) -> dict[str, str]:
        """The generated texts as they now are, made once for all that needs them: a formula's takes a millisecond."""
        return {name: make() for name, make in self._generated.items()}

    def _flatten(self, texts: Mapping[str, str]) -> dict[str, Source]:
        ready = {name: partial(str, text) for name, text in texts.items()}
        return {stage: self.gpu.shaders.flatten(name, ready) for stage, name in self._stages.items()}

    def _same_text(self, sources: dict[str, Source]) -> bool:
        return all(sources[stage].lines == self._sources[stage].lines for stage in sources)

    def _watch(self, sources: dict[str, Source], texts: Mapping[str, str]) -> None:
        self._files = {path for source in sources.values() for path in source.files}
        self._stamp = self._now(texts)

    def _now(self, texts: Mapping[str, str]) -> Stamp:
        """What tells whether anything changed: each file's time and size, each generated text's hash."""
        stamp = [(name, hash(text), 0) for name, text in texts.items()]
        for path in sorted(self._files):
            try:
                status = path.stat()
                stamp.append((str(path), status.st_mtime_ns, status.st_size))
            except OSError:
                stamp.append((str(path), 0, -1))
        return tuple(stamp)

    def _link(self, purpose: object, sources: dict[str, Source]) -> Variant:
        stages: dict[str, Any] = {stage: source.text for stage, source in sources.items()}
        if isinstance(purpose, tuple):
            stages = {"vertex_shader": stages["vertex_shader"], "varyings": list(purpose)}
        elif purpose == "depth" and "discard" not in stages.get("fragment_shader", ""):
            stages["fragment_shader"] = DEPTH_ONLY
        try:
            linked = self.gpu.context.program(**stages)
        except Exception as error:
            raise explain(str(error), sources, self.name) from error
        label(linked, f"{self.name} {purpose}")
        units = {"u_shadow_near": SHADOW_NEAR_UNIT, "u_shadow_wide": SHADOW_WIDE_UNIT}
        return Variant(linked, units, {"Frame": FRAME_BINDING})


def _careful(name: str, make: Callable[[], str]) -> Callable[[], str]:
    """``make`` as the rest of a shader: whatever it raises is an error in the generated text ``name``."""
    def made() -> str:
        try:
            return make()
        except Exception as error:
            raise ShaderError(name, 0, f"cannot be made: {type(error).__name__}: {error}") from error

    return made


def _mention_time(sources: Iterable[Source]) -> bool:
    """Whether shaders mention the time."""
    names = ("u_frame.time", "u_frame.number")
    return any(name in line for source in sources for line in source.lines for name in names)


class VertexArray:
    """Buffers bound to a program; it follows the program through reloads and purposes."""

    def __init__(self, program: Program, content: tuple[tuple[Any, ...], ...], index: moderngl.Buffer | None,
                 mode: int, closed: bool) -> None:
        self.program, self.content, self.index, self.mode, self.closed = program, content, index, mode, closed
        self._arrays: dict[object, tuple[Variant, moderngl.VertexArray]] = {}

    def render(self, *, vertices: int = -1, first: int = 0, instances: int = -1) -> None:
        """Draw, in colour or into the shadow map as the stage asks for; ``first`` leaves out vertices, or indices."""
        purpose = "depth" if self.program.gpu.casting_shadows else "colour"
        context = self.program.gpu.context
        if self.closed:
            context.enable(moderngl.CULL_FACE)
        self._bound(purpose).render(self.mode, vertices=vertices, first=first, instances=instances)
        if self.closed:
            context.disable(moderngl.CULL_FACE)

    def capture(self, varyings: Mapping[str, int], count: int) -> dict[str, NDArray[np.float32]]:
        """What the vertex shader computes for vertices 0 to ``count`` - 1, by transform feedback.

        ``varyings`` maps each output's name to its number of components; the result holds float32
        arrays of shape (count,) or (count, components).
        """
        width = sum(varyings.values())
        array = self._bound(tuple(varyings))
        target = self.program.gpu.context.buffer(reserve=4 * width * count)
        try:
            array.transform(target, moderngl.POINTS, vertices=count)
            rows = np.frombuffer(target.read(), np.float32).reshape(count, width)
        finally:
            target.release()
        columns = np.split(rows, np.cumsum(list(varyings.values()))[:-1], axis=1)
        return {name: np.ascontiguousarray(column if size > 1 else column[:, 0])
                for (name, size), column in zip(varyings.items(), columns, strict=True)}

    def release(self) -> None:
        """Free the GL vertex arrays; the buffers belong to the arena."""
        for _, array in self._arrays.values():
            array.release()
        self._arrays.clear()

    def _bound(self, purpose: object) -> moderngl.VertexArray:
        variant = self.program.variant(purpose)
        known = self._arrays.get(purpose)
        if known and known[0] is variant:
            return known[1]
        if known:
            known[1].release()
        index = None if isinstance(purpose, tuple) else self.index
        made = self.program.gpu.context.vertex_array(variant.gl, _used(self.content, variant.gl), index)
        self._arrays[purpose] = (variant, made)
        return made


def _used(content: Iterable[tuple[Any, ...]], program: moderngl.Program) -> list[tuple[Any, ...]]:
    """``content`` without the attributes that ``program`` has not: padding, lest GL is asked for a place -1."""
    used = []
    for buffer, layout, *names in content:
        present = [name for name in names if isinstance(program.get(name, None), moderngl.Attribute)]
        parts, slash, per = layout.partition("/")
        waiting = iter(names)
        kept = [part if "x" in part or next(waiting) in present else _padding(part) for part in parts.split()]
        if present:
            used.append((buffer, " ".join(kept) + slash + per, *present))
    return used


def _padding(part: str) -> str:
    """As many bytes as a part of a buffer's format such as ``3f`` or ``4f1``."""
    count, size = re.fullmatch(r"(\d*)[a-z]+(\d*)", part).groups()  # type: ignore[union-attr]
    return f"{int(count or 1) * int(size or 4)}x"
