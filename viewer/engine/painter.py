"""How a frame comes about: shadow map, scene, set, then the finished picture."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from typing import Any

import moderngl
import numpy as np

from viewer.engine.camera import OrbitCamera
from viewer.engine.clock import FRAME_SECONDS
from viewer.engine.frame import FrameBlock
from viewer.engine.gpu import Gpu
from viewer.engine.inscriptions import Inscription
from viewer.engine.lettering import Lettering
from viewer.engine.picture import Picture
from viewer.engine.scene import Scene, Studio
from viewer.engine.shaders import ShaderError, ShaderFolders
from viewer.engine.state import plain_state
from viewer.engine.studio import StudioSet


class Painter:
    """Owns what is drawn with and into, apart from the scene's own: frame block, set, picture and labels."""

    def __init__(self, context: moderngl.Context, shaders: ShaderFolders, plan: Studio, size: tuple[int, int],
                 samples: int, *, sprites: bool = False) -> None:
        self.context = context
        self._set_arena = Gpu(context, shaders)
        self._picture_arena = Gpu(context, shaders)
        self._block = FrameBlock(context)
        self._lettering = Lettering(context, shaders)
        self._shadow_shows: Hashable = None
        try:
            self.studio = StudioSet(self._set_arena, plan)
            self.picture = Picture(self._picture_arena, size, samples, sprites=sprites)
        except BaseException:
            self.release()
            raise

    def paint(self, scene: Scene, camera: OrbitCamera, frame: int, draw: Callable[[], None],
              draw_over: Callable[[], None], draw_sprites: Callable[[moderngl.Texture], None],
              middle: tuple[float, float] = (0.0, 0.0),
              labels: Callable[[], tuple[Inscription, ...]] = tuple, *, turns: bool = False) -> None:
        """Draw ``scene`` by calling ``draw`` once for its shadow, where that can have changed, and once in colour.

        ``draw_over`` comes after the set; then ``draw_sprites``, with the scene's depth, where the scene has any;
        what ``labels`` gives is lettered over the finished picture. ``turns`` tells that the shadow depends on the
        camera.
        """
        self._follow_sprites(scene.has_sprites())
        self._cast_shadow(scene, frame, camera.look if turns else None, draw)
        self.set_moment(camera, frame, middle)
        self.picture.begin()
        plain_state(self.context)
        self.studio.shadow.bind()
        try:
            draw()
            inscriptions = labels()
        finally:
            plain_state(self.context)
        self.picture.go_on()
        self.studio.draw()
        self._paint_over(draw_over, draw_sprites)
        self.picture.go_on()
        self._lettering.compose(inscriptions, self.picture.size)
        self.picture.finish()
        self._lettering.draw()

    def set_moment(self, camera: OrbitCamera, frame: int, middle: tuple[float, float] = (0.0, 0.0)) -> None:
        """Write the frame block for ``camera`` at ``frame``, so that shaders may run."""
        view, projection = camera.view(), camera.projection(self.picture.size[0] / self.picture.size[1], middle)
        both = view @ projection
        self._write(frame, {"view": view, "projection": projection, "view_projection": both,
                            "clip_to_world": np.linalg.inv(both), "eye": camera.eye})

    def resize(self, size: tuple[int, int], samples: int) -> None:
        """Pictures of another size from now on; raises GpuError beyond the driver's limits, changing nothing."""
        self._exchange_picture(size, samples, sprites=self.picture.sprites is not None)

    def furnish(self, plan: Studio) -> None:
        """Put up another set, or if that fails keep the present one."""
        if plan != self.studio.plan:
            arena = Gpu(self.context, self._set_arena.shaders)
            try:
                studio = StudioSet(arena, plan)
            except BaseException:
                arena.release()
                raise
            self._set_arena.release()
            self._set_arena, self.studio = arena, studio
            self._shadow_shows = None

    def refresh(self) -> ShaderError | None:
        """Take over edited shader files of the set; returns the error that stands, if any."""
        return self._set_arena.refresh() or self._picture_arena.refresh() or self._lettering.refresh()

    def release(self) -> None:
        """Free everything on the GPU."""
        self._set_arena.release()
        self._picture_arena.release()
        self._lettering.release()
        self._block.release()

    def showing(self, scene: Scene, camera: OrbitCamera, frame: int) -> Hashable:
        """Everything that a picture depends on: while this stays equal, drawing again would change nothing."""
        return (self.scene_showing(scene, frame), camera.look, self.picture, self._picture_arena.generation,
                self._lettering.generation)

    def scene_showing(self, scene: Scene, frame: int) -> Hashable:
        """Everything that the scene and its shadow depend on; the frame counts only where time moves it."""
        moves = scene.simulates or scene.reads_time or scene.gpu.reads_time
        return (scene, scene.params.revision, scene.gpu.generation, self._set_arena.generation,
                frame if moves else None)

    def _follow_sprites(self, wanted: bool) -> None:
        """A picture with a layer for sprites while the scene draws some, and one without while it does not."""
        if wanted != (self.picture.sprites is not None):
            self._exchange_picture(self.picture.size, self.picture.samples, sprites=wanted)

    def _exchange_picture(self, size: tuple[int, int], samples: int, *, sprites: bool) -> None:
        arena = Gpu(self.context, self._picture_arena.shaders)
        try:
            picture = Picture(arena, size, samples, sprites=sprites)
        except BaseException:
            arena.release()
            raise
        self._picture_arena.release()
        self._picture_arena, self.picture = arena, picture

    def _paint_over(self, draw_over: Callable[[], None],
                    draw_sprites: Callable[[moderngl.Texture], None]) -> None:
        """Draw what comes after the set: over it, then, if the picture has a layer for them, sprites."""
        layer = self.picture.sprites
        try:
            plain_state(self.context)
            draw_over()
            if layer:
                layer.begin()
                plain_state(self.context)
                layer.blend()
                draw_sprites(layer.scene_depth)
        finally:
            plain_state(self.context)

    def _cast_shadow(self, scene: Scene, frame: int, look: Hashable, draw: Callable[[], None]) -> None:
        """Draw the shadow unless it shows the same already; ``look`` is the camera's, where that matters to it."""
        shows = (self.scene_showing(scene, frame), look)
        if shows == self._shadow_shows:
            return
        self._shadow_shows = None
        self._write(frame, self.studio.light_values)
        scene.gpu.casting_shadows = True
        try:
            self.studio.shadow.cast(draw)
        finally:
            scene.gpu.casting_shadows = False
        self._shadow_shows = shows

    def _write(self, frame: int, camera: Mapping[str, Any]) -> None:
        self._block.write({**self.studio.frame_values, **camera, "time": frame * FRAME_SECONDS,
                           "number": frame, "resolution": self.picture.size})
        self._block.bind()
