"""Skinning a million vertices beside NumPy and libigl, and opening a rigged model."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path

import moderngl
import numpy as np
from numpy.typing import NDArray

from tests.benchmarks.isosurfaces import seconds
from tests.benchmarks.report import Row, Section, at_most, in_time_of
from tests.kit.gltf_samples import big_model
from viewer.engine.catalog import builtin_pack
from viewer.engine.gpu import Gpu
from viewer.engine.shaders import ShaderFolders
from viewer.engine.skin import BonePalette, skin_attributes
from viewer.engine.skin_pass import SkinPass, texture_of
from viewer.kit.gltf import read_model
from viewer.kit.rig import composed
from viewer.output.headless import shared_context

PACK = Path(__file__).parent / "pack" / "shaders"
VERTICES, BONES, INFLUENCES = 1_000_000, 64, 4
OF_NUMPY, OF_LIBIGL = 0.71, 0.4         # of their time: 1.4 and 2.5 times as fast
MOST_SECONDS_TO_LOAD = 0.3
Numbers = NDArray[np.float32]


def sections(rounds: int) -> list[Section]:
    """All of it."""
    return [skinning(rounds), loading(rounds)]


def skinning(rounds: int) -> Section:
    """Positions and normals on the GPU; positions alone elsewhere. What is made on the GPU stays there."""
    chance = np.random.default_rng(0)
    joints = np.argsort(chance.random((VERTICES, BONES), np.float32), axis=1)[:, :INFLUENCES].astype(np.uint16)
    weights = chance.random((VERTICES, INFLUENCES), np.float32)
    weights /= weights.sum(axis=1, keepdims=True)
    positions, normals = chance.normal(0.0, 0.2, (2, VERTICES, 3)).astype(np.float32)
    matrices = composed(chance.normal(0.0, 0.1, (BONES, 3)), chance.normal(size=(BONES, 4)), np.ones((BONES, 3)))
    dense = np.zeros((VERTICES, BONES), np.float32)
    np.put_along_axis(dense, joints.astype(np.int64), weights, axis=1)
    arena = Gpu(shared_context(), ShaderFolders([PACK, builtin_pack() / "shaders"]))
    try:
        contest = [
            (Row("Demoscope: linear blending, with normals, as a pass", ours=True),
             as_pass(arena, "linear", positions, normals, joints, weights, matrices)),
            (Row("Demoscope: the same in the vertex shader", ours=True),
             in_vertex_shader(arena, "linear", positions, normals, joints, weights, matrices)),
            (Row("Demoscope: dual quaternions, with normals, as a pass", ours=True),
             as_pass(arena, "dual_quaternion", positions, normals, joints, weights, matrices)),
            (Row("Demoscope: the same in the vertex shader", ours=True),
             in_vertex_shader(arena, "dual_quaternion", positions, normals, joints, weights, matrices)),
            (Row("NumPy: a dense product"), dense_product(positions, dense, matrices)),
            (Row("NumPy: a gather and einsum"), gathered(positions, joints, weights, matrices)),
            (Row("libigl: its matrix times the transforms"), libigl_product(positions, dense, matrices))]
        for turn in range(rounds + 1):
            first = turn % len(contest)         # nobody always comes after the one who has emptied the caches
            for row, work in contest[first:] + contest[:first]:
                taken = seconds(work)
                row.times = [*row.times, *([taken] if turn else [])]
    finally:
        arena.release()
    quickest_of_ours, _, _, _, product, gather, libigl = rows = [row for row, _ in contest]
    quickest = min(product, gather, key=lambda row: row.median)
    quickest_of_ours.target = (f"{in_time_of(quickest_of_ours, quickest, OF_NUMPY, 'NumPy')}, "
                    f"{in_time_of(quickest_of_ours, libigl, OF_LIBIGL, 'libigl')}")
    return Section(f"Skinning {VERTICES:,} vertices, {INFLUENCES} of {BONES} bones each", rows)


def as_pass(arena: Gpu, method: str, positions: Numbers, normals: Numbers, joints: NDArray[np.uint16],
            weights: Numbers, matrices: NDArray[np.float64]) -> Callable[[], object]:
    """A fragment for each vertex, as large models are skinned; the palette is sent each time."""
    palette = BonePalette(arena, BONES, method)
    skin = SkinPass(arena, [texture_of(arena, positions), texture_of(arena, normals)], joints, weights, palette)

    def run() -> None:
        palette.send(matrices)
        skin.run(0)
        arena.context.finish()

    return run


def in_vertex_shader(arena: Gpu, method: str, positions: Numbers, normals: Numbers, joints: NDArray[np.uint16],
                     weights: Numbers, matrices: NDArray[np.float64]) -> Callable[[], object]:
    """By transform feedback, the palette sent each time."""
    palette = BonePalette(arena, BONES, method)
    program = arena.program("skinned.vert", generated=palette.generated)
    array = arena.vertex_array(program, [(arena.buffer(positions), "3f", "in_position"),
                                         (arena.buffer(normals), "3f", "in_normal"),
                                         *skin_attributes(arena, joints, weights)])
    arena.framebuffer([arena.texture((4, 4), 4)]).use()
    target = arena.buffer(reserve=24 * VERTICES)
    palette.bind(program, 0)
    bound = array._bound(("v_position", "v_normal"))

    def skin() -> None:
        palette.send(matrices)
        palette.bind(program, 0)
        bound.transform(target, moderngl.POINTS, vertices=VERTICES)
        arena.context.finish()

    return skin


def dense_product(positions: Numbers, dense: Numbers, matrices: NDArray[np.float64]) -> Callable[[], object]:
    """All weights by all matrices, then each vertex by its own."""
    rows = matrices[:, :3].reshape(BONES, 12).astype(np.float32)
    homogeneous = np.concatenate([positions, np.ones((VERTICES, 1), np.float32)], axis=1)
    return lambda: np.einsum("nij,nj->ni", (dense @ rows).reshape(VERTICES, 3, 4), homogeneous)


def gathered(positions: Numbers, joints: NDArray[np.uint16], weights: Numbers,
             matrices: NDArray[np.float64]) -> Callable[[], object]:
    """The matrices of each vertex' bones, weighted."""
    rows = matrices[:, :3].reshape(BONES, 12).astype(np.float32)
    homogeneous = np.concatenate([positions, np.ones((VERTICES, 1), np.float32)], axis=1)

    def skin() -> object:
        blended = sum(weights[:, [k]] * rows[joints[:, k]] for k in range(INFLUENCES))
        return np.einsum("nij,nj->ni", np.reshape(blended, (VERTICES, 3, 4)), homogeneous)

    return skin


def libigl_product(positions: Numbers, dense: Numbers, matrices: NDArray[np.float64]) -> Callable[[], object]:
    """The matrix that ``igl.lbs_matrix`` makes once for all poses, by the stacked transforms of one."""
    import igl

    whole = igl.lbs_matrix(positions.astype(np.float64), dense.astype(np.float64))
    stacked = np.concatenate([matrix[:3].T for matrix in matrices])
    return lambda: whole @ stacked


def loading(rounds: int) -> Section:
    """A skinned model of five megabytes, with an animation."""
    row = Row("Demoscope: read_model", ours=True)
    with tempfile.TemporaryDirectory() as folder:
        path = big_model(Path(folder) / "big.glb", 60_000)
        read_model(path)
        row.times = [seconds(lambda: read_model(path)) for _ in range(rounds)]
        row.extra = f"{path.stat().st_size / 1e6:.1f} MB"
    row.target = at_most(row, MOST_SECONDS_TO_LOAD)
    return Section("Opening a rigged model", [row])
