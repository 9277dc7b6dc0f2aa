"""The lecture's vertex shader: move each vertex of a sphere, then ask what its normal has become."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from viewer import (
    ColorScale,
    Curve,
    Geometry,
    Gpu,
    Measurements,
    Orbit,
    Parameters,
    Scene,
    Studio,
    choice,
    color,
    formula,
    formula_include,
    integer,
    slider,
    toggle,
)
from viewer.kit import mesh
from viewer.kit.needle import needle_corners
from viewer.kit.surface_normal import angles_to_nearest, normal_candidates

EPSILONS = np.logspace(-7, 0, 29)
PROBES = 4096
BATCH = 16384       # vertices measured at once: as many as stay in the processor's cache
WAYS = {
    "none": "The sphere's own normal, as if nothing had moved",
    "notes": "As the lecture wrote it: add the derivative to the normal",
    "gradient": "Subtract the derivative from the normal",
    "exact": "The formula's own derivatives, through the cofactors of the Jacobian",
    "forward": "Differences to neighbours at distance epsilon",
    "central": "Differences between neighbours on either side, at distance epsilon",
}


class RipplingSphere(Scene):
    """A sphere that ripples in the vertex shader, with six ways to get its normals."""

    class Params(Parameters):
        displacement = formula("amplitude*cos(frequency*x)", "How far each point of the sphere moves, in radii")
        amplitude: float = slider(0.05, 0.0, 0.5, "Ripple height", unit="radii")
        frequency: float = slider(10.0, 0.0, 60.0, "Ripples: radians for each radius", unit="rad")
        direction: str = choice("normal", {
            "x": "Every point moves along x", "normal": "Every point moves along the sphere's normal"},
            "Which way the points move")
        normals: str = choice("exact", WAYS, "How the shader finds the normal")
        epsilon: float = slider(1e-3, 1e-7, 1.0, "Distance to the neighbours of finite differences", unit="radii",
                                logarithmic=True)
        colouring: str = choice("surface", {
            "surface": "A lit surface", "normal": "The normal's x, y, z as red, green, blue",
            "error": "The angle between the normal and the exact one"}, "What the colours show")
        error_scale: float = slider(45.0, 0.001, 90.0, "The error at the bright end of the colours", unit="degrees",
                                    logarithmic=True)
        wipe: float = slider(0.0, 0.0, 1.0, "Part of the picture, from the right, drawn with exact normals")
        show_normals: bool = toggle(False, "Needles along the normals: orange as chosen, green exact")
        needles: int = integer(1200, 50, 20000, "How many needles", logarithmic=True, rebuild=True)
        needle_length: float = slider(0.16, 0.02, 0.5, "Length of the needles", unit="radii")
        color: tuple[float, float, float] = color("#d8572a", "Colour of the surface")
        tessellation: str = choice("ico", {
            "uv": "Latitude and longitude, crowded at the poles", "cube": "A cube blown up to equal angles",
            "ico": "An icosahedron, each triangle cut into four again and again"},
            "How the sphere is cut into triangles", rebuild=True)
        subdivision: int = integer(5, 0, 9, "How finely: each step makes four triangles of one", rebuild=True)

    camera = Orbit(yaw=28, pitch=16, distance=4.6)
    studio = Studio(radius=1.6, ground=-1.12)

    def __init__(self, gpu: Gpu, params: Params) -> None:
        self.gpu = gpu
        self.params = params
        self.vertices, self.triangles = tessellated(params.tessellation, params.subdivision)
        include = {"generated/displacement.glsl": lambda: formula_include(params, "displacement")}

        surface = gpu.program("rippling_sphere/surface.vert", "rippling_sphere/surface.frag", generated=include)
        corners = gpu.buffer(self.vertices.astype("f4"), label="sphere")
        self.surface = gpu.vertex_array(surface, [(corners, "3f", "in_position")], gpu.buffer(self.triangles))

        self.needle = gpu.program("rippling_sphere/needle.vert", "rippling_sphere/needle.frag", generated=include)
        roots = gpu.buffer(mesh.fibonacci_sphere(params.needles).astype("f4"), label="needle roots")
        self.needles = gpu.vertex_array(
            self.needle, [(gpu.buffer(needle_corners()), "3f", "in_corner"), (roots, "3f/i", "in_root")])

        self.probe = gpu.program("rippling_sphere/probe.vert", generated=include)
        self.probe_points = mesh.fibonacci_sphere(PROBES).astype("f4")
        self.probes = gpu.vertex_array(self.probe, [(gpu.buffer(self.probe_points), "3f", "in_position")])

    def draw(self) -> None:
        self.surface.render()
        if self.params.show_normals:
            for way in dict.fromkeys(["exact", self.params.normals]):
                self.needle["u_way"] = list(WAYS).index(way)
                self.needles.render(instances=self.params.needles)

    def color_scale(self) -> ColorScale | None:
        if self.params.colouring != "error":
            return None
        return ColorScale("normal error", 0.0, self.params.error_scale, "°")

    def geometry(self) -> Geometry:
        captured = self.surface.capture({"v_position": 3, "v_normal": 3}, len(self.vertices))
        return {"vertices": captured["v_position"], "triangles": self.triangles, "normals": captured["v_normal"]}

    def measure(self) -> Measurements:
        normals = self.surface.capture({"v_normal": 3}, len(self.vertices))["v_normal"]
        points, batches = self.vertices.astype("f4"), range(0, len(normals), BATCH)
        error = np.concatenate([angles_to_nearest(normals[start:start + BATCH],
                                                  self.true_normals(points[start:start + BATCH])) for start in batches])
        area = areas(self.params.tessellation, self.params.subdivision)
        return {
            "vertices": len(self.vertices),
            "triangles": len(self.triangles),
            "normal_error_mean_deg": float(np.average(error, weights=area)),
            "normal_error_max_deg": float(error.max()),
            "error_vs_epsilon": self.error_vs_epsilon(),
        }

    def error_vs_epsilon(self) -> Curve:
        """Mean error of both finite differences over seven decades of epsilon: truncation meets round-off."""
        truth = self.true_normals(self.probe_points)
        means: dict[str, list[float]] = {"forward": [], "central": []}
        for epsilon in EPSILONS:
            self.probe["u_probe_epsilon"] = float(epsilon)
            captured = self.probes.capture({"v_forward": 3, "v_central": 3}, PROBES)
            for scheme, mean in means.items():
                mean.append(float(angles_to_nearest(captured[f"v_{scheme}"], truth).mean()))
        return Curve("epsilon", EPSILONS, means, x_label="epsilon (radii)", y_label="mean error (degrees)",
                     log_x=True, log_y=True, now=self.params.epsilon)

    def true_normals(self, points: NDArray[np.float32]) -> NDArray[np.float64]:
        """The reference: differences of the formula's values in double precision."""
        return normal_candidates(self.rippled, points.astype(np.float64))

    def rippled(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Where ``points`` (n, 3) go, in double precision and without the GPU."""
        points = mesh.normalized(points)
        function = self.params.displacement
        x, y, z = points.T
        moment = {"t": self.time} if "t" in function.variables else {}
        height = np.asarray(function.evaluate(x=x, y=y, z=z, **moment, **self.params.numbers(function)))
        height = np.where(np.abs(height) <= 100.0, height, 0.0)
        way = np.array([1.0, 0.0, 0.0]) if self.params.direction == "x" else points
        rippled: NDArray[np.float64] = points + height[:, None] * way
        return rippled


@lru_cache(maxsize=2)
def tessellated(kind: str, level: int) -> mesh.Mesh:
    """The unit sphere's vertices and triangles; each level has four times as many as the one before."""
    if kind == "uv":
        return mesh.uv_sphere(max(2, 3 * 2**level // 2), 3 * 2**level)
    return mesh.cube_sphere(2**level) if kind == "cube" else mesh.ico_sphere(level)


@lru_cache(maxsize=2)
def areas(kind: str, level: int) -> NDArray[np.float64]:
    """The share of the undisplaced sphere that each vertex stands for."""
    return mesh.vertex_areas(*tessellated(kind, level))
