"""What particles bounce off: a ground plane and one obstacle, for the shaders that step and for the picture."""

from __future__ import annotations

import math
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from viewer.engine.declarations import choice, color, file, formula, integer, slider, toggle
from viewer.engine.gpu import Gpu
from viewer.engine.params import Parameters
from viewer.engine.particles.obstacle_samples import SUFFIXES, Sampled, obstacle_stamp, sampled_formula, sampled_mesh
from viewer.engine.particles.solid import ShadedMesh
from viewer.engine.program import Program
from viewer.kit.field_function import FieldFunction

GROUP = "Collisions"
ANY = "obstacle!=none"
INCLUDED = {"none": 0, "sphere": 1, "box": 2, "torus": 3, "mesh": 4, "formula": 4}     # as in particles/collider.glsl
COLLISIONS = {"bounce": "It bounces off", "stick": "It stays where it hit", "die": "It ends"}
OBSTACLES = {"none": "Nothing but the ground", "sphere": "A ball", "box": "A box", "torus": "A ring",
             "mesh": "A mesh from a file", "formula": "The solid where a function of x, y and z is below 0"}


class ColliderParameters(Parameters):
    """The ground, the obstacle, and what becomes of a particle that runs into them."""

    ground: bool = toggle(True, "A ground that particles meet", group=GROUP)
    ground_height: float = slider(0.0, -20.0, 20.0, "Height of the ground at the origin", unit="m",
                                  handy=(-3.0, 3.0), group=GROUP, when="ground")
    ground_tilt: float = slider(0.0, -60.0, 60.0, "Tilt of the ground about the z axis", unit="degrees", group=GROUP,
                                when="ground")
    obstacle: str = choice("none", OBSTACLES, "What else particles meet", group=GROUP)
    hollow: bool = toggle(False, "The obstacle is a vessel: particles stay inside", group=GROUP, when=ANY)
    obstacle_x: float = slider(0.0, -20.0, 20.0, "Where the obstacle is", unit="m", handy=(-3.0, 3.0), group=GROUP,
                               when=ANY)
    obstacle_y: float = slider(1.0, -20.0, 20.0, "Where the obstacle is: up", unit="m", handy=(-3.0, 3.0),
                               group=GROUP, when=ANY)
    obstacle_z: float = slider(0.0, -20.0, 20.0, "Where the obstacle is: towards you", unit="m", handy=(-3.0, 3.0),
                               group=GROUP, when=ANY)
    obstacle_size: float = slider(0.5, 0.01, 20.0, "Radius of the ball or the ring, half the box's width", unit="m",
                                  handy=(0.05, 3.0), group=GROUP, when="obstacle=sphere|box|torus")
    obstacle_thickness: float = slider(0.2, 0.01, 20.0, "Radius of the ring's tube, half the box's height", unit="m",
                                       handy=(0.02, 2.0), group=GROUP, when="obstacle=box|torus")
    obstacle_scale: float = slider(1.0, 1e-3, 1e3, "How many times as large as in the file or the function",
                                   logarithmic=True, handy=(0.1, 10.0), group=GROUP, when="obstacle=mesh|formula")
    obstacle_turn: float = slider(0.0, -180.0, 180.0, "Turn about the vertical", unit="degrees", group=GROUP,
                                  when="obstacle=box|torus|mesh|formula")
    obstacle_lean: float = slider(0.0, -180.0, 180.0, "Lean about the z axis, before the turn", unit="degrees",
                                  group=GROUP, when="obstacle=box|torus|mesh|formula")
    obstacle_file = file(None, "A triangle mesh for the obstacle: name it, then choose obstacle = mesh",
                         suffixes=SUFFIXES, rebuild=False, group=GROUP)
    obstacle_formula = formula("length(x, y, z) - 0.5 - 0.1*sin(8*x)*sin(8*y)*sin(8*z)",
                               "A function that is below 0 inside the obstacle", variables=("x", "y", "z"),
                               group=GROUP, when="obstacle=formula")
    obstacle_reach: float = slider(1.0, 0.05, 20.0, "Half the width of the cube in which the function counts",
                                   unit="m", handy=(0.2, 4.0), group=GROUP, when="obstacle=formula")
    obstacle_detail: int = integer(64, 16, 128, "Samples of the distance along the longest side", group=GROUP,
                                   when="obstacle=mesh|formula")
    obstacle_color: tuple[float, float, float] = color("#6f8796", "Colour of the obstacle", group=GROUP, when=ANY)
    collision: str = choice("bounce", COLLISIONS, "What happens to a particle that runs into something", group=GROUP)
    restitution: float = slider(0.3, 0.0, 1.0, "Speed after a bounce, as a part of that before", group=GROUP,
                                when="collision=bounce")
    friction: float = slider(0.2, 0.0, 2.0, "Coulomb's coefficient of friction", group=GROUP, when="collision=bounce")


class Colliders:
    """Keeps the obstacle's distance field and mesh up to date with the parameters.

    ``generation`` grows whenever ``surface`` gives something else.
    """

    def __init__(self, gpu: Gpu, params: Any) -> None:
        self.gpu, self.params = gpu, params
        self.generation = 0
        self._sampled: Sampled | None = None
        self._sampled_of: object = None
        self._texture: moderngl.Texture3D | None = None
        self._shape: tuple[object, ...] = ()
        self._surface: ShadedMesh | None = None

    def prepare(self) -> None:
        """Make what the parameters ask for.

        Raises ParameterError for a mesh or formula of which no obstacle can be made, and keeps the former one.
        """
        if self.params.obstacle in ("mesh", "formula"):
            self._sample()
        shape = self._placement()
        if shape != self._shape:
            self._surface = self._made_surface()
            self._shape = shape
            self.generation += 1

    def constants(self) -> str:
        """The include ``generated/collider.glsl``."""
        obstacle = INCLUDED[self.params.obstacle]
        has_ground = bool(self.params.ground)
        flags = {"HAS_GROUND": has_ground, "HOLLOW": bool(self.params.hollow),
                 "HAS_COLLIDER": has_ground or obstacle > 0}
        numbers = {"OBSTACLE": obstacle, "ON_COLLISION": list(COLLISIONS).index(self.params.collision)}
        return "".join([*(f"const bool {name} = {str(value).lower()};\n" for name, value in flags.items()),
                        *(f"const int {name} = {value};\n" for name, value in numbers.items())])

    def bind(self, program: Program, first_unit: int) -> None:
        """Give ``program`` the uniforms of ``particles/collider.glsl``, and one texture unit."""
        p = self.params
        program["u_collider_plane"] = self._plane()
        program["u_collider_center"] = p.obstacle_x, p.obstacle_y, p.obstacle_z
        program["u_collider_turn"] = tuple(self._turn().ravel().tolist())   # GL reads columns: the transpose
        program["u_collider_size"] = self._size()
        program["u_distance_field"] = first_unit
        if p.obstacle in ("mesh", "formula") and self._sampled and self._texture:
            field = self._sampled.field
            program["u_field_origin"] = tuple(field.origin.tolist())
            program["u_field_extent"] = tuple(field.extent.tolist())
            program["u_field_cell"] = field.cell
            self._texture.use(first_unit)

    def surface(self) -> ShadedMesh | None:
        """The obstacle in the world: vertices (v, 3), normals (v, 3), both float32, and triangles (t, 3) int32."""
        return self._surface

    def ground_surface(self, radius: float) -> ShadedMesh:
        """A round piece of the ground in the world, around the height that it has at the origin; as ``surface``."""
        from viewer.kit.shapes import disc

        vertices, triangles = disc(radius)
        nx, ny = self._plane()[:2]
        tilted = vertices @ np.array([[ny, -nx, 0.0], [nx, ny, 0.0], [0.0, 0.0, 1.0]])
        normals = np.tile(np.array([nx, ny, 0.0], np.float32), (len(vertices), 1))
        return (tilted + np.array([0.0, self.params.ground_height, 0.0])).astype(np.float32), normals, triangles

    @property
    def thinnest(self) -> float:
        """How thin what is solid is at its thinnest, in metres; of a mesh or formula, what its samples resolve."""
        p = self.params
        size = self._size()
        if p.obstacle == "none" or (p.hollow and p.obstacle in ("sphere", "box")):
            return 1e9
        if p.obstacle in ("mesh", "formula"):
            return self._sampled.field.cell * size[0] if self._sampled else 1e9
        if p.hollow:        # the ring's hole, or the dents that are left of it
            return max(2.0 * (size[0] - size[1]), 0.1 * size[1])
        return 2.0 * {"sphere": size[0], "box": min(size), "torus": size[1]}[p.obstacle]

    def _plane(self) -> tuple[float, float, float, float]:
        """The ground's normal, and that times a place on it."""
        tilt = math.radians(self.params.ground_tilt)
        return -math.sin(tilt), math.cos(tilt), 0.0, self.params.ground_height * math.cos(tilt)

    def _size(self) -> tuple[float, float, float]:
        p = self.params
        if p.obstacle in ("mesh", "formula"):
            return p.obstacle_scale, 0.0, 0.0
        return p.obstacle_size, p.obstacle_thickness, p.obstacle_size

    def _turn(self) -> NDArray[np.float64]:
        """From the obstacle's own directions to the world's: leaning about z, then turned about y; (3, 3)."""
        turn, lean = math.radians(self.params.obstacle_turn), math.radians(self.params.obstacle_lean)
        about_y = np.array([[math.cos(turn), 0, math.sin(turn)], [0, 1, 0], [-math.sin(turn), 0, math.cos(turn)]])
        about_z = np.array([[math.cos(lean), -math.sin(lean), 0], [math.sin(lean), math.cos(lean), 0], [0, 0, 1]])
        return np.asarray(about_y @ about_z)

    def _placement(self) -> tuple[object, ...]:
        """Everything that the obstacle's mesh in the world depends on."""
        p = self.params
        if p.obstacle == "none":
            return ("none",)
        sampled = self._sampled_of if p.obstacle in ("mesh", "formula") else None
        return (p.obstacle, sampled, self._size(), p.obstacle_x, p.obstacle_y, p.obstacle_z, p.obstacle_turn,
                p.obstacle_lean)

    def _made_surface(self) -> ShadedMesh | None:
        p = self.params
        if p.obstacle == "none":
            return None
        vertices, normals, triangles = self._own_mesh()
        scale = p.obstacle_scale if p.obstacle in ("mesh", "formula") else 1.0
        turn = self._turn().T
        center = np.array([p.obstacle_x, p.obstacle_y, p.obstacle_z])
        return ((scale * vertices @ turn + center).astype(np.float32), (normals @ turn).astype(np.float32),
                triangles.astype(np.int32))

    def _own_mesh(self) -> ShadedMesh:
        """The obstacle's mesh around its own origin."""
        from viewer.kit import mesh, shapes

        size = self._size()
        if self.params.obstacle == "sphere":
            vertices, triangles = mesh.ico_sphere(5)
            return size[0] * vertices, vertices, triangles
        if self.params.obstacle == "box":
            return shapes.creased(*shapes.box(size))
        if self.params.obstacle == "torus":
            return shapes.creased(*shapes.torus(size[0], size[1]))
        assert self._sampled
        return self._sampled.mesh

    def _sample(self) -> None:
        """Bring the distance field up to date."""
        p = self.params
        wanted: tuple[object, ...]
        if p.obstacle == "mesh":
            wanted = ("mesh", p.obstacle_detail, *obstacle_stamp(p.obstacle_file))
        else:
            function = FieldFunction(p.obstacle_formula, tuple(p.numbers(p.obstacle_formula).items()))
            wanted = ("formula", p.obstacle_detail, function, p.obstacle_reach)
        if wanted == self._sampled_of:
            return
        if p.obstacle == "mesh":
            sampled = sampled_mesh(p.obstacle_file, p.obstacle_detail)
        else:
            sampled = sampled_formula(function, p.obstacle_reach, p.obstacle_detail)
        self._send(sampled)
        self._sampled, self._sampled_of = sampled, wanted

    def _send(self, sampled: Sampled) -> None:
        """Put a distance field on the GPU in place of the former one."""
        values = sampled.field.stepping_values
        texture = self.gpu.volume(values.shape, 1, values.T, label="distance field")
        if self._texture:
            drawn_into = self.gpu.context.fbo
            self.gpu.discard(self._texture)
            drawn_into.use()
        self._texture = texture
