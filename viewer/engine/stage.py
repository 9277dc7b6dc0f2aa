"""A stage owns a scene, a camera, a clock and a picture; windows and captures read the same picture."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.camera import Orbit, OrbitCamera
from viewer.engine.catalog import SceneEntry, scene_error
from viewer.engine.clock import FRAME_SECONDS, Clock
from viewer.engine.fields import ParameterError
from viewer.engine.frame import FrameBlock
from viewer.engine.gpu import Gpu
from viewer.engine.params import Parameters
from viewer.engine.picture import Picture
from viewer.engine.scene import Geometry, Measurements, Scene
from viewer.engine.shaders import ShaderError
from viewer.engine.studio import StudioSet
from viewer.errors import DemoscopeError

Result = TypeVar("Result")
DEFAULT_SIZE = (1280, 720)


class Stage:
    """One scene, live. Nothing in it is shared with another stage but the GL context.

    Every method raises a DemoscopeError where the scene, a shader or a value is at fault, and leaves
    the last good scene, values and picture in place.
    """

    def __init__(self, context: moderngl.Context, entry: SceneEntry, *, size: tuple[int, int] = DEFAULT_SIZE,
                 samples: int = 4, params: Mapping[str, object] | None = None, seed: int = 0) -> None:
        self.context = context
        self.entry = entry
        self.clock = Clock()
        self.gpu_milliseconds: float | None = None
        self._frame_block = FrameBlock(context)
        self._house = Gpu(context, entry.shaders)
        self._picture_arena = Gpu(context, entry.shaders)
        self._arena: Gpu | None = None
        try:
            self.scene_class = entry.load()
            self.params = self._guard("cannot take its parameters", lambda: self.scene_class.Params(params, seed=seed))
            self.camera = OrbitCamera(self.scene_class.camera)
            self.studio = StudioSet(self._house, self.scene_class.studio)
            self.picture = Picture(self._picture_arena, size, samples)
            self.scene = self._built(self.scene_class, self.params)
        except BaseException:
            self.release()
            raise

    # What is on

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture in pixels."""
        return self.picture.size

    @property
    def frame(self) -> int:
        """The frame that the scene stands at."""
        return self.scene.frame

    def set(self, **values: object) -> None:
        """Set parameters by name, to values or to their text; all of them or, on an error, none."""
        self.update_params(values)

    def update_params(self, values: Mapping[str, object]) -> set[str]:
        """Like ``set``, from a mapping; returns the names of the parameters that changed."""
        before = self._snapshot()
        changed = self.params.update(values)
        self._after_change(changed, before)
        return changed

    def reset_params(self, name: str | None = None) -> set[str]:
        """Set one parameter, or all, to the default; returns the names that changed."""
        before = self._snapshot()
        changed = self.params.reset(name)
        self._after_change(changed, before)
        return changed

    def pose(self, pose: Orbit) -> None:
        """Put the camera there."""
        self.camera.pose(pose)

    def resize(self, size: tuple[int, int], samples: int | None = None) -> None:
        """Draw pictures of another size from now on; raises GpuError beyond the driver's limits."""
        if size == self.size and samples in (None, self.picture.samples):
            return
        arena = Gpu(self.context, self.entry.shaders)
        try:
            picture = Picture(arena, size, self.picture.samples if samples is None else samples)
        except BaseException:
            arena.release()
            raise
        self._picture_arena.release()
        self._picture_arena, self.picture = arena, picture

    # Time

    def seek(self, frame: int) -> None:
        """Go to ``frame``: exactly where playing from 0 gets, forwards or backwards."""
        if frame < 0:
            raise ParameterError(f"frame = {frame} is before the first, which is 0")
        if frame < self.scene.frame and self._simulates:
            self.rebuild(frame=0)
        while self._simulates and self.scene.frame < frame:
            self._step()
        self.scene.frame = self.clock.frame = frame

    def step(self, frames: int = 1) -> None:
        """Go on by ``frames``, or back where negative."""
        self.seek(max(0, self.scene.frame + frames))

    def advance(self, wall_seconds: float) -> int:
        """Go on by as many frames as ``wall_seconds`` of playing ask for; returns how many."""
        due = self.clock.steps_due(wall_seconds)
        if due:
            self.step(due)
        return due

    # Results

    def render(self) -> None:
        """Draw the current frame into the picture."""
        self._share_parameters()
        self._set_frame_block(self.studio.light_values())
        self._opaque_state()
        self.studio.cast_shadow(self._draw)
        self._set_frame_block(self._camera_values())
        self.picture.begin()
        self._opaque_state()
        self.studio.light()
        self._draw()
        self.studio.draw()
        self.picture.finish()

    def pixels(self) -> NDArray[np.uint8]:
        """The current frame drawn: uint8 (height, width, 4), top row first."""
        self.render()
        return self.picture.pixels()

    def geometry(self) -> Geometry:
        """What the GPU made for the current frame, by name: see the scene."""
        return self._off_screen("failed in geometry", lambda: self.scene.geometry())

    def measure(self) -> Measurements:
        """The scene's numbers and curves at the current frame."""
        return self._off_screen("failed in measure", lambda: self.scene.measure())

    # Life

    def rebuild(self, frame: int | None = None) -> None:
        """Build the scene anew with the present parameters, at ``frame`` or where it stands."""
        frame = self.scene.frame if frame is None else frame
        self._exchange(self.scene_class, self.params)
        self.seek(frame)

    def reload_scene(self) -> None:
        """Read the scene's file again and build it, with the present values as far as they still apply."""
        scene_class = self.entry.load()
        params = scene_class.Params(seed=self.params.seed)
        for name, value in self.params.stored().items():
            try:
                params.update({name: value})
            except ParameterError:
                continue
        frame = self.scene.frame
        self._exchange(scene_class, params)
        self.scene_class, self.params = scene_class, params
        self.camera.start = scene_class.camera
        self._set_studio(scene_class)
        self.seek(frame)

    def refresh_shaders(self) -> ShaderError | None:
        """Take over edited shader files and changed formulas; returns the error that stands, if any."""
        errors = [arena.refresh() for arena in (self._arena, self._house, self._picture_arena) if arena]
        return next(filter(None, errors), None)

    def release(self) -> None:
        """Free everything on the GPU."""
        for arena in (self._arena, self._house, self._picture_arena):
            if arena:
                arena.release()
        self._frame_block.release()

    # Inside

    @property
    def _simulates(self) -> bool:
        return type(self.scene).update is not Scene.update

    def _snapshot(self) -> tuple[Parameters, dict[str, Any]]:
        return self.params, self.params.stored()

    def _after_change(self, changed: set[str], before: tuple[Parameters, dict[str, Any]]) -> None:
        if not changed:
            return
        try:
            if any(name in self.params.fields and self.params.field(name).rebuild for name in changed):
                self.rebuild()
            elif self._arena:
                self._share_parameters()
                error = self._arena.refresh()
                if error and error.place.startswith("generated/"):
                    raise error
        except DemoscopeError:
            self.params.update({name: value for name, value in before[1].items() if name in self.params.fields
                                or name in before[0].declared})
            self._share_parameters()
            if self._arena:
                self._arena.refresh()
            raise

    def _guard(self, doing: str, work: Callable[[], Result]) -> Result:
        """Run the scene's own code; whatever it raises becomes one line that says where."""
        try:
            return work()
        except DemoscopeError:
            raise
        except Exception as error:
            raise scene_error(self.entry, doing, error) from error

    def _built(self, scene_class: type[Scene], params: Parameters) -> Scene:
        """A new scene in an arena of its own; the arena is freed again if the scene fails to build."""
        arena = Gpu(self.context, self.entry.shaders)
        arena.share(params.uniforms())

        def build() -> Scene:
            scene = scene_class.__new__(scene_class)
            scene.gpu, scene.params = arena, params
            scene.__init__(arena, params)  # type: ignore[misc]
            return scene

        self.picture.use()
        try:
            scene = self._guard("failed to build", build)
        except BaseException:
            arena.release()
            raise
        self._arena = arena
        self._shared_revision = params.revision
        return scene

    def _exchange(self, scene_class: type[Scene], params: Parameters) -> None:
        former = self._arena
        self.scene = self._built(scene_class, params)
        if former:
            former.release()

    def _set_studio(self, scene_class: type[Scene]) -> None:
        if scene_class.studio != self.studio.plan:
            self._house.release()
            self.studio = StudioSet(self._house, scene_class.studio)

    def _step(self) -> None:
        self.scene.frame += 1
        self._share_parameters()
        self._set_frame_block(self._camera_values())
        self._guard("failed in update", lambda: self.scene.update(FRAME_SECONDS))

    def _draw(self) -> None:
        self._guard("failed in draw", self.scene.draw)

    def _off_screen(self, doing: str, work: Callable[[], Result]) -> Result:
        self._share_parameters()
        self._set_frame_block(self._camera_values())
        self.picture.use()
        return self._guard(doing, work)

    def _share_parameters(self) -> None:
        if self._arena and self._shared_revision != self.params.revision:
            self._arena.share(self.params.uniforms())
            self._shared_revision = self.params.revision

    def _opaque_state(self) -> None:
        self.context.enable_only(moderngl.DEPTH_TEST)
        self.context.depth_func = "<"

    def _set_frame_block(self, camera: Mapping[str, Any]) -> None:
        width, height = self.size
        self._frame_block.write({
            **self.studio.frame_values(), **camera, "u_time": self.scene.frame * FRAME_SECONDS,
            "u_frame": self.scene.frame, "u_resolution": (width, height)})
        self._frame_block.bind()

    def _camera_values(self) -> dict[str, Any]:
        view, projection = self.camera.view(), self.camera.projection(self.size[0] / self.size[1])
        both = view @ projection
        return {"u_view": view, "u_projection": projection, "u_view_projection": both,
                "u_clip_to_world": np.linalg.inv(both), "u_eye": self.camera.eye}
