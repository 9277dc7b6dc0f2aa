"""What a scene is: parameters, something to draw, and the numbers and geometry it can tell.

    class Sphere(Scene):
        \"\"\"The sentence that the menu shows.\"\"\"

        class Params(Parameters):
            radius: float = slider(1.0, 0.1, 2.0, "Radius")

        def __init__(self, gpu: Gpu, params: Params) -> None: ...
        def draw(self) -> None: ...
"""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, TypeAlias

import moderngl
import numpy as np
from numpy.typing import ArrayLike, NDArray

from viewer.engine.annotations import Click, Handle, Label, Table
from viewer.engine.camera import Orbit
from viewer.engine.clock import FRAME_SECONDS
from viewer.engine.color_field import Color
from viewer.engine.fields import ParameterError
from viewer.engine.gpu import Gpu
from viewer.engine.matrices import Matrix
from viewer.engine.params import Parameters
from viewer.engine.rewind import Snapshot
from viewer.errors import DemoscopeError

Geometry: TypeAlias = dict[str, NDArray[Any]]
Measurements: TypeAlias = Mapping[str, "float | Curve | Table"]


class SceneError(DemoscopeError):
    """A scene that cannot be loaded, or that raised."""


@dataclass(frozen=True)
class Curve:
    """One or more series over a common axis, for a plot and for JSON.

    ``x`` (n,) is named ``x_name``; every array in ``series`` is (n,). ``log_x`` and ``log_y`` ask for
    logarithmic axes; labels carry the units. ``now`` marks where on the axis the parameters stand; the series
    named in ``dots`` are drawn as some dots over the lines, for what was measured where another is expected.
    """

    x_name: str
    x: ArrayLike
    series: Mapping[str, ArrayLike] = field(default_factory=dict)
    x_label: str = ""
    y_label: str = ""
    log_x: bool = False
    log_y: bool = False
    now: float | None = None
    dots: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        lengths = {np.asarray(values, np.float64).size for values in (self.x, *self.series.values())}
        if len(lengths) > 1:
            raise ValueError(f"curve over {self.x_name}: axis and series differ in length")

    def lists(self) -> dict[str, list[float]]:
        """Axis and series by name, as lists of floats."""
        named = {self.x_name: self.x, **self.series}
        return {name: [float(value) for value in np.asarray(values).ravel()] for name, values in named.items()}


@dataclass(frozen=True)
class ColorScale:
    """What the colours of ``lib/color.glsl``'s viridis stand for, from its dark to its bright end."""

    title: str
    low: float
    high: float
    unit: str = ""

    def __post_init__(self) -> None:
        if not math.isfinite(self.low) or not math.isfinite(self.high):
            raise ValueError(f"colour scale {self.title} has no finite ends")


@dataclass(frozen=True)
class Studio:
    """The set a scene stands in: what to light and where the floor is.

    ``center`` and ``radius`` bound what the scene draws (the shadow covers that sphere); ``ground`` is
    the floor's height, None for no floor; ``backdrop`` the sRGB colours low and high behind it all.
    A scene that draws a floor and a backdrop of its own is not ``furnished``.
    """

    center: tuple[float, float, float] = (0.0, 0.0, 0.0)
    radius: float = 1.5
    ground: float | None = -1.0
    backdrop: tuple[str, str] = ("#c9ced6", "#7f8b9c")
    furnished: bool = True

    def __post_init__(self) -> None:
        if np.shape(self.center) != (3,) or not np.isfinite(np.asarray(self.center, np.float64)).all():
            raise SceneError(f"studio center = {self.center} is not three numbers")
        if not 0.0 < self.radius < math.inf:
            raise SceneError(f"studio radius = {self.radius} is not a number above 0")
        if self.ground is not None and not math.isfinite(self.ground):
            raise SceneError(f"studio ground = {self.ground} is neither a number nor None")
        for color in self.backdrop:
            try:
                Color(color, "")
            except ParameterError as error:
                raise SceneError(f"studio backdrop = {color} {Color.ALLOWED}") from error
        if len(self.backdrop) != 2:
            raise SceneError(f"studio backdrop = {self.backdrop} is not two colours, low and high")


def checked_geometry(geometry: Any) -> Geometry:
    """What a scene's ``geometry`` gave, as arrays; raises TypeError for what is not numbers by name."""
    arrays = {str(name): np.asarray(values) for name, values in (geometry or {}).items()}
    for name, array in arrays.items():
        if array.dtype.kind not in "biuf":
            raise TypeError(f"{name} is not an array of numbers")
    return arrays


def checked_scale(scale: Any) -> ColorScale | None:
    """What a scene's ``color_scale`` gave; raises TypeError for anything but a ColorScale or None."""
    if scale is not None and not isinstance(scale, ColorScale):
        raise TypeError("color_scale gives neither a ColorScale nor None")
    return scale


def checked_middle(middle: Any) -> tuple[float, float]:
    """What a scene's ``middle`` gave; raises TypeError for anything but two finite numbers."""
    try:
        across, up = map(float, middle)
    except (TypeError, ValueError):
        across = up = math.nan
    if not math.isfinite(across + up):
        raise TypeError(f"middle gives {middle}, which is not a place in the picture")
    return across, up


def checked_setting(setting: Any) -> Studio:
    """What a scene's ``setting`` gave; raises TypeError for anything but a Studio."""
    if not isinstance(setting, Studio):
        raise TypeError("setting gives no Studio")
    return setting


def checked_measurements(measurements: Any) -> Measurements:
    """What a scene's ``measure`` gave; raises TypeError for what is neither a number nor a Curve."""
    named = dict(measurements or {})
    for name, value in named.items():
        if not isinstance(value, (Curve, Table)) and not (
                np.ndim(value) == 0 and np.asarray(value).dtype.kind in "biuf"):
            raise TypeError(f"{name} is neither a number nor a Curve or Table")
    return named


class Scene:
    """Base of every scene. The constructor builds; the arena ``gpu`` frees."""

    Params: ClassVar[type[Parameters]] = Parameters
    camera: ClassVar[Orbit] = Orbit()
    studio: ClassVar[Studio] = Studio()
    poster: ClassVar[int] = 0       # the frame that shows it best: drawn where nobody chose one

    gpu: Gpu
    params: Any
    reads_time: bool = False
    view: Matrix = np.eye(4)        # world to camera, for what has to face the camera
    aspect: float = 1.0             # the picture's width over its height
    _frame: int = 0

    def __init__(self, gpu: Gpu, params: Any) -> None:
        """Build everything that will be drawn; ``gpu`` and ``params`` are attributes already."""

    @classmethod
    def create(cls, gpu: Gpu, params: Parameters) -> Scene:
        """A scene built in ``gpu``; a constructor need neither call its base nor keep its arguments."""
        scene = cls.__new__(cls)
        scene.gpu, scene.params = gpu, params
        scene.__init__(gpu, params)  # type: ignore[misc]
        return scene

    @classmethod
    def has_sprites(cls) -> bool:
        """Whether it has a ``draw_sprites``, so that its picture needs the layer for them."""
        return cls.draw_sprites is not Scene.draw_sprites

    @classmethod
    def has_handle(cls) -> bool:
        """Whether it has a ``handle``, so that there is a reason to ask for it."""
        return cls.handle is not Scene.handle

    @property
    def frame(self) -> int:
        """The frame that is to be drawn or measured. Asking marks the scene as one that time moves."""
        self.reads_time = True
        return self._frame

    @property
    def time(self) -> float:
        """Scene time in seconds."""
        return self.frame * FRAME_SECONDS

    @property
    def eye(self) -> NDArray[np.float64]:
        """Where the camera is, (3,)."""
        return np.asarray(-self.view[3, :3] @ self.view[:3, :3].T)

    @property
    def simulates(self) -> bool:
        """Whether it has an ``update``, so that each frame follows from the one before."""
        return type(self).update is not Scene.update

    def stand_at(self, frame: int) -> None:
        """Tell the scene which frame it is; the stage does."""
        self._frame = frame

    def look(self, view: Matrix, aspect: float) -> None:
        """Tell the scene how it is looked at; the stage does."""
        self.view, self.aspect = view, aspect

    def update(self, dt: float) -> None:
        """Advance a simulation by one fixed step of ``dt`` seconds; scenes without one leave this out."""

    def steered_by(self) -> Hashable:
        """What the simulation follows from, by default everything: while it stays equal, the same frames come again."""
        return int(self.params.revision)

    def snapshot(self) -> Snapshot | None:
        """All that the frames to come follow from, so that going back in time can start there; None: not kept."""
        return None

    def restore(self, snapshot: Any) -> None:
        """Stand again where a ``snapshot`` was taken."""

    def prepare(self) -> None:
        """Make what follows from parameters and frame; called before each drawing, measuring and exporting.

        May draw into framebuffers of its own. Scenes that only draw leave this out.
        """

    def draw(self) -> None:
        """Draw. Called for the shadow map and for the picture; changes nothing that is simulated."""
        raise NotImplementedError(f"{type(self).__name__} has no draw()")

    def draw_over(self) -> None:
        """Draw what comes after the set, in colour only: what one sees through, and cards in the picture."""

    def draw_sprites(self, scene_depth: moderngl.Texture) -> None:
        """Draw what is translucent and many into a layer over the picture; scenes without leave this out.

        The layer has one sample a pixel and is blended in linear light: a fragment's rgb is the light that it
        adds, its alpha how much of what lies behind it hides: 0 only adds, 1 is opaque (premultiplied alpha,
        Porter and Duff 1984). What lies behind solid things is hidden; no depth is written, so that the order
        of drawing counts where alpha is not 0. ``scene_depth`` holds the depth of the solid things, 0 to 1 as in
        the window, in red; fetch it at ``ivec2(gl_FragCoord.xy)`` to let sprites fade where they touch them.
        """

    def geometry(self) -> Geometry:
        """What the GPU made for this frame, as named arrays."""
        return {}

    def labels(self) -> Sequence[Label]:
        """Words in the picture; called after ``draw``."""
        return ()

    def remarks(self) -> Sequence[str]:
        """Sentences about what is unusual now, such as a surface that is empty; shown beside the picture."""
        return ()

    def click(self, click: Click) -> Mapping[str, object]:
        """Which parameters a click on the picture sets, and to what; none by default."""
        return {}

    def handle(self) -> Handle | None:
        """What a hand can turn or move in the window now; nothing by default."""
        return None

    def drag_handle(self, handle: Handle) -> Mapping[str, object]:
        """Which parameters to set, and to what, so that the handle stands as in ``handle.matrix``.

        Asked again and again while a hand holds it, which may be where the scene cannot follow: give the nearest
        values that are allowed. A matrix does not tell whole turns: of the angles that fit, the one nearest to the
        present value is meant.
        """
        return {}

    def setting(self) -> Studio:
        """The set that the scene stands in now; its ``studio``, unless parameters choose another."""
        return self.studio

    def middle(self) -> tuple[float, float]:
        """Where in the picture, each -1 to 1, the camera's target stands: aside where something else needs room."""
        return 0.0, 0.0

    def turns_with_camera(self) -> bool:
        """Whether what casts shadows now depends on where the camera is."""
        return False

    def color_scale(self) -> ColorScale | None:
        """What the colours now stand for, where they stand for a number; the window shows the scale."""
        return None

    def measure(self) -> Measurements:
        """The numbers a lecturer would point at, and the curves to plot."""
        return {}
