"""Where a limb comes from: a rigged model in a file, or the arm that is always there."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from viewer.kit.arm import arm
from viewer.kit.gltf import Part, RiggedModel, read_model

ARM_COLOR = (0.86, 0.68, 0.52, 1.0)     # linear


def model_in(path: Path | None) -> RiggedModel:
    """The model in a file, or with None our arm; a file is read once for each version of it.

    What lies beside a ``.gltf`` is read again only when that file itself has changed.
    Raises ModelFileError as ``read_model`` does.
    """
    if path is None:
        return our_arm()
    try:
        status = path.stat()
    except OSError:
        return read_model(path)         # which says what is wrong
    return _read(path, (status.st_mtime_ns, status.st_size))


@lru_cache(maxsize=1)
def _read(path: Path, version: tuple[int, int]) -> RiggedModel:
    return read_model(path)


@lru_cache(maxsize=1)
def our_arm() -> RiggedModel:
    """The arm, as if it came from a file."""
    mesh = arm()
    part = Part(0, len(mesh.triangles), ARM_COLOR, None, 0.0, 0.5, False)
    return RiggedModel("arm", mesh, (part,), (), 0, mesh.influences, True, ())
