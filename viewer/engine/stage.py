"""A stage owns a scene, a camera, a clock and a picture; windows and captures read the same picture."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import TypeVar

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.annotations import Click, Handle, checked_handle
from viewer.engine.camera import OrbitCamera
from viewer.engine.catalog import SceneEntry, scene_error
from viewer.engine.clock import FRAME_SECONDS, Clock, checked_frame
from viewer.engine.fields import ParameterError
from viewer.engine.gpu import Gpu
from viewer.engine.inscriptions import checked_labels
from viewer.engine.painter import Painter
from viewer.engine.params import Parameters
from viewer.engine.picture import Picture, checked_size
from viewer.engine.presets import Preset
from viewer.engine.rewind import Rewind
from viewer.engine.scene import (
    ColorScale,
    Geometry,
    Measurements,
    Scene,
    checked_geometry,
    checked_measurements,
    checked_middle,
    checked_scale,
    checked_setting,
)
from viewer.engine.shaders import ShaderError
from viewer.errors import DemoscopeError

Result = TypeVar("Result")
DEFAULT_SIZE = (640, 360)


class Stage:
    """One scene, live. Nothing in it is shared with another stage but the GL context.

    Every method raises a DemoscopeError where the scene, a shader or a value is at fault, and leaves
    the last good scene, values and picture in place.
    """

    def __init__(self, context: moderngl.Context, entry: SceneEntry, *, size: tuple[int, int] = DEFAULT_SIZE,
                 samples: int = 4, params: Mapping[str, object] | None = None, seed: int = 0) -> None:
        self.context = context
        self.entry = entry
        self._released = False
        self._prepares_well, self._rendered_revision = True, -1
        self.clock = Clock()
        self._rewind = Rewind()
        self.scene_class = entry.load()
        self.params: Parameters = self._guard("cannot take its parameters",
                                              lambda: self.scene_class.Params(params, seed=seed))
        self.camera = OrbitCamera(self.scene_class.camera)
        self.painter = Painter(context, entry.shaders, self.scene_class.studio, checked_size(size), samples,
                               sprites=self.scene_class.has_sprites())
        try:
            self.scene = self._built(self.scene_class, self.params)
        except BaseException:
            self.painter.release()
            raise

    # What is on

    @property
    def picture(self) -> Picture:
        """The picture, with its ``texture``."""
        return self.painter.picture

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture in pixels."""
        return self.picture.size

    @property
    def frame(self) -> int:
        """The frame that the scene stands at."""
        return self.clock.frame

    @property
    def showing(self) -> Hashable:
        """Everything that the picture depends on: while this stays equal, ``render`` would change nothing."""
        return self.painter.showing(self.scene, self.camera, self.clock.frame)

    @property
    def scene_showing(self) -> Hashable:
        """Like ``showing``, without the camera and the picture: what measurements depend on."""
        return self.painter.scene_showing(self.scene, self.clock.frame)

    def set(self, **values: object) -> None:
        """Set parameters by name, to values or to their text; all of them or, on an error, none."""
        self.update_params(values)

    def update_params(self, values: Mapping[str, object]) -> frozenset[str]:
        """Like ``set``, from a mapping; returns the names of the parameters that changed."""
        return self._change(lambda: self.params.update(values))

    def reset_params(self, name: str | None = None) -> frozenset[str]:
        """Set one parameter, or all, to the default; returns the names that changed."""
        return self._change(lambda: self.params.reset(name))

    def apply_preset(self, preset: Preset) -> None:
        """Take over a preset: its values, the defaults for what it leaves out, and its camera if it has one."""
        preset.check(self.scene_class.Params)
        self.update_params(self.params.completed(preset.values))
        if preset.camera:
            self.camera.stand(preset.camera)

    def resize(self, size: tuple[int, int], samples: int | None = None) -> None:
        """Draw pictures of another size from now on; raises GpuError beyond the driver's limits."""
        self._check_held()
        size = checked_size(size)
        samples = self.picture.samples if samples is None else samples
        if (size, samples) != (self.size, self.picture.samples):
            self.painter.resize(size, samples)

    # Time

    def seek(self, frame: int) -> None:
        """Go to ``frame``: exactly where playing from 0 gets, forwards or backwards."""
        frame = checked_frame(frame)
        if self.scene.simulates and frame < self.clock.frame:
            self._go_back(frame)
        else:
            self._play_to(frame)

    def step(self, frames: int = 1) -> None:
        """Go on by ``frames``, or back where negative."""
        self.seek(max(0, self.clock.frame + frames))

    def advance(self, wall_seconds: float) -> int:
        """Go on by as many frames as ``wall_seconds`` of playing ask for; returns how many."""
        due = self.clock.steps_due(wall_seconds)
        if due:
            self.step(due)
        return due

    # Results

    def render(self) -> None:
        """Draw the current frame into the picture."""
        if self.params.revision != self._rendered_revision:
            self.scene.reads_time, self._rendered_revision = False, self.params.revision
        self._prepare()
        self.painter.furnish(self._guard("failed in setting", lambda: checked_setting(self.scene.setting())))
        self.painter.paint(self.scene, self.camera, self.clock.frame,
                           lambda: self._guard("failed in draw", self.scene.draw),
                           lambda: self._guard("failed in draw_over", self.scene.draw_over),
                           lambda depth: self._guard("failed in draw_sprites", lambda: self.scene.draw_sprites(depth)),
                           self.middle,
                           lambda: self._guard("failed in labels", lambda: checked_labels(self.scene.labels())),
                           turns=bool(self._guard("failed in turns_with_camera", self.scene.turns_with_camera)))

    def pixels(self) -> NDArray[np.uint8]:
        """The current frame drawn: uint8 (height, width, 4), top row first."""
        self.render()
        return self.picture.pixels()

    def geometry(self) -> Geometry:
        """What the GPU made for the current frame, by name: see the scene."""
        self._prepare()
        return self._off_screen("failed in geometry", lambda: checked_geometry(self.scene.geometry()))

    def measure(self) -> Measurements:
        """The scene's numbers and curves at the current frame."""
        self._prepare()
        return self._off_screen("failed in measure", lambda: checked_measurements(self.scene.measure()))

    def remarks(self) -> Sequence[str]:
        """What the scene finds unusual about the current frame, in sentences."""
        self._prepare()
        return self._off_screen("failed in remarks", lambda: [str(remark) for remark in self.scene.remarks()])

    def clicked(self, across: float, down: float) -> Mapping[str, object]:
        """The parameters that a click asks for, at a place in pixels from the picture's upper left corner."""
        width, height = self.size
        place = (2.0 * across / width - 1.0, 1.0 - 2.0 * down / height)
        self._prepare()
        origin, direction = self.camera.ray(place, width / height, self.middle)
        click = Click(place, origin, direction, width / height, height)
        return self._off_screen("failed in click", lambda: dict(self.scene.click(click)))

    def handle(self) -> Handle | None:
        """What a hand can turn or move in the current frame, if anything."""
        if not self.scene_class.has_handle():
            return None
        self._prepare()
        return self._off_screen("failed in handle", lambda: checked_handle(self.scene.handle()))

    def dragged(self, handle: Handle) -> Mapping[str, object]:
        """The parameters that let the scene's handle stand as in ``handle``, where a hand has dragged it."""
        self._prepare()
        return self._off_screen("failed in drag_handle", lambda: dict(self.scene.drag_handle(handle)))

    @property
    def middle(self) -> tuple[float, float]:
        """Where in the picture, each -1 to 1, the camera's target stands."""
        return self._guard("failed in middle", lambda: checked_middle(self.scene.middle()))

    def color_scale(self) -> ColorScale | None:
        """What the picture's colours stand for, if they stand for a number."""
        return self._guard("failed in color_scale", lambda: checked_scale(self.scene.color_scale()))

    # Life

    def rebuild(self) -> None:
        """Build the scene anew with the present parameters, at the frame where it stands."""
        self._exchange(self.scene_class, self.params, self.clock.frame)

    def reload_scene(self) -> None:
        """Read the scene's file again and build it, with the present values as far as they still apply."""
        scene_class = self.entry.load()
        params = self._guard("cannot take its parameters", lambda: scene_class.Params(seed=self.params.seed))
        for name, value in self.params.stored().items():
            try:
                params.update({name: value})
            except ParameterError:
                continue
        self._exchange(scene_class, params, self.clock.frame)
        self.scene_class, self.params = scene_class, params
        self.camera.start = scene_class.camera
        self.painter.furnish(scene_class.studio)

    def refresh_shaders(self) -> ShaderError | None:
        """Take over edited shader files; returns the error that stands, if any."""
        generation = self.scene.gpu.generation
        error = self.scene.gpu.refresh() or self.painter.refresh()
        if self.scene.gpu.generation != generation:
            self._rewind.forget()       # what an edited shader would have done is not what was kept
        return error

    def release(self) -> None:
        """Free everything on the GPU; nothing can be drawn after that."""
        self._released = True
        self.scene.gpu.release()
        self.painter.release()

    # Inside

    def _change(self, change: Callable[[], frozenset[str]]) -> frozenset[str]:
        """Make a change to the parameters felt, or, if the scene or a shader cannot follow, undo it."""
        before, well = self.params.snapshot(), self._prepares_well
        changed = change()
        try:
            if any(self.params.field(name).rebuild for name in changed if name in self.params.fields):
                self.rebuild()
            elif changed:
                self._share_parameters()
                error = self.scene.gpu.refresh()
                if error and error.generated:
                    raise error
                self._follow()
        except DemoscopeError:
            self.params.restore(before)
            self._prepares_well = well
            self._share_parameters()
            self.scene.gpu.refresh()
            raise
        return changed

    def _guard(self, doing: str, work: Callable[[], Result]) -> Result:
        """Run the scene's own code; whatever it raises becomes one line that says where."""
        try:
            return work()
        except DemoscopeError:
            raise
        except (Exception, SystemExit) as error:
            raise scene_error(self.entry, doing, error) from error

    def _check_held(self) -> None:
        if self._released:
            raise DemoscopeError(f"the stage of {self.entry.name} has been released; use it inside its block")

    def _built(self, scene_class: type[Scene], params: Parameters) -> Scene:
        """A new scene in an arena of its own; the arena is freed again if the scene fails to build."""
        self._check_held()
        arena = Gpu(self.context, self.entry.shaders)
        arena.share(params)
        self.painter.set_moment(self.camera, 0)
        self.picture.use()
        try:
            return self._guard("failed to build", lambda: scene_class.create(arena, params))
        except BaseException:
            arena.release()
            raise

    def _exchange(self, scene_class: type[Scene], params: Parameters, frame: int) -> None:
        """Let a new scene, played to ``frame``, take the place of the present one, or if it fails none."""
        former, stood_at = self.scene, self.clock.frame
        self._rewind.forget()
        self.scene = self._built(scene_class, params)
        try:
            self._go_to(0)
            self._play_to(frame)
            self._follow()
        except BaseException:
            self.scene.gpu.release()
            self.scene = former
            self._go_to(stood_at)
            raise
        former.gpu.release()

    def _go_back(self, frame: int) -> None:
        """Play to an earlier frame from the last moment before it that was kept, or from the beginning."""
        kept = self._rewind.before(frame, self._steered_by())
        if kept is None:
            self._exchange(self.scene_class, self.params, frame)
            return
        moment, snapshot = kept
        try:
            self._off_screen("failed in restore", lambda: self.scene.restore(snapshot))
        except DemoscopeError:
            self._exchange(self.scene_class, self.params, self.clock.frame)     # it may be halfway between two moments
            raise
        self._go_to(moment)
        self._play_to(frame)

    def _play_to(self, frame: int) -> None:
        if self.scene.simulates and self.clock.frame == 0 < frame:
            self._prepare()     # at the beginning it follows every change as if it had been built so
            self._rewind.begin(self._steered_by())
            self._remember()
        while self.scene.simulates and self.clock.frame < frame:
            self._simulate_one()
            self._remember()
        self._go_to(frame)

    def _go_to(self, frame: int) -> None:
        self.clock.frame = frame
        self.scene.stand_at(frame)

    def _simulate_one(self) -> None:
        before = self.clock.frame
        self._go_to(before + 1)
        try:
            self._off_screen("failed in update", lambda: self.scene.update(FRAME_SECONDS))
        except BaseException:
            self._go_to(before)     # a step that failed is one still to be made
            raise

    def _remember(self) -> None:
        """Keep this moment, if it is time and the scene can tell all about it."""
        if self._rewind.is_due(self.clock.frame, self._steered_by()):
            snapshot = self._off_screen("failed in snapshot", self.scene.snapshot)
            if snapshot is not None:
                self._rewind.keep(self.clock.frame, snapshot)

    def _steered_by(self) -> Hashable:
        return self._guard("failed in steered_by", self.scene.steered_by)

    def _prepare(self) -> None:
        self.scene.look(self.camera.view(), self.size[0] / self.size[1])
        self._prepares_well = False
        self._off_screen("failed in prepare", self.scene.prepare)
        self._prepares_well = True

    def _follow(self) -> None:
        """Let the scene prepare for what has changed; a failure counts only if it did not fail before."""
        well = self._prepares_well
        try:
            self._prepare()
        except DemoscopeError:
            if well:
                raise

    def _off_screen(self, doing: str, work: Callable[[], Result]) -> Result:
        self._check_held()
        self._share_parameters()
        self.painter.set_moment(self.camera, self.clock.frame)
        self.picture.use()
        return self._guard(doing, work)

    def _share_parameters(self) -> None:
        self.scene.gpu.share(self.scene.params)
