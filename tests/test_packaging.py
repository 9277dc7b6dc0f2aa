"""What an install brings: one package that carries the built-in pack, one command, and bounded dependencies."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tomllib
from configparser import ConfigParser
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import pytest
from hatchling.builders.wheel import WheelBuilder
from packaging.requirements import Requirement

ROOT = Path(__file__).parents[1]
PACK_FOLDERS = ("scenes", "shaders", "assets")
TOP_LEVEL = {"pyproject.toml", "README.md", "LICENSE", "Makefile", "viewer", *PACK_FOLDERS, "tests"}


@pytest.fixture(scope="module")
def project() -> dict[str, Any]:
    """The project's own declaration."""
    declared: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    return declared


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A wheel of this checkout, built in this process so that nothing is downloaded."""
    folder = tmp_path_factory.mktemp("wheel")
    return Path(next(WheelBuilder(str(ROOT)).build(directory=str(folder), versions=["standard"])))


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder outside the repository that holds what the wheel would put into site-packages."""
    folder = tmp_path_factory.mktemp("site-packages")
    with ZipFile(wheel) as archive:
        archive.extractall(folder)
    return folder


def source_files(folder: str) -> set[str]:
    """Every file of a folder of the repository, by its path from the root, without what Python or a desktop left."""
    paths = (path.relative_to(ROOT) for path in (ROOT / folder).rglob("*") if path.is_file())
    return {path.as_posix() for path in paths if not any(part.startswith((".", "__pycache__")) for part in path.parts)}


def run_installed(installed: Path, *arguments: str) -> str:
    """What Python prints when it sees the unpacked wheel before anything else, this checkout included."""
    environment = {**os.environ, "PYTHONPATH": str(installed)}
    command = [sys.executable, *arguments]
    outcome = subprocess.run(command, cwd=installed.parent, env=environment, capture_output=True, text=True)
    assert outcome.returncode == 0, outcome.stderr
    return outcome.stdout


def test_wheel_adds_one_package(wheel: Path, project: dict[str, Any]) -> None:
    """`scenes`, `shaders` and `tests` are names that another project may own, so they stay out of site-packages."""
    with ZipFile(wheel) as archive:
        names = {name.split("/")[0] for name in archive.namelist()}
    assert names == {"viewer", f"{project['name']}-{project['version']}.dist-info"}


@pytest.mark.parametrize("folder", PACK_FOLDERS)
def test_wheel_carries_the_built_in_pack(wheel: Path, folder: str) -> None:
    """Every scene, shader, preset and lesson travels inside the package."""
    with ZipFile(wheel) as archive:
        packed = {name.removeprefix("viewer/pack/") for name in archive.namelist()}
    assert not source_files(folder) - packed


def test_wheel_carries_the_package(wheel: Path) -> None:
    """Every file of `viewer` is there, and no compiled leftovers."""
    with ZipFile(wheel) as archive:
        names = set(archive.namelist())
    assert not source_files("viewer") - names
    assert not [name for name in names if "__pycache__" in name]


def test_wheel_declares_the_command(wheel: Path) -> None:
    """An install brings the `demoscope` command."""
    scripts = ConfigParser()
    with ZipFile(wheel) as archive:
        [entry_points] = [name for name in archive.namelist() if name.endswith(".dist-info/entry_points.txt")]
        scripts.read_string(archive.read(entry_points).decode())
    assert dict(scripts["console_scripts"]) == {"demoscope": "viewer.cli:main"}


@pytest.mark.slow
def test_installed_package_finds_its_scenes(installed: Path) -> None:
    """Away from the repository, the command lists the scenes that came in the wheel."""
    location = run_installed(installed, "-c", "import viewer; print(viewer.__file__)")
    assert Path(location.strip()).is_relative_to(installed)
    assert "rippling_sphere" in run_installed(installed, "-m", "viewer", "list")


def test_every_dependency_is_capped(project: dict[str, Any]) -> None:
    """A new major version of a dependency never reaches a classroom untested."""
    extras = project["optional-dependencies"].values()
    declared = [Requirement(line) for lines in (project["dependencies"], *extras) for line in lines]
    caps = {"<", "<=", "==", "~="}
    assert not [str(line) for line in declared if not caps & {part.operator for part in line.specifier}]


def test_no_stray_files_at_the_root() -> None:
    """A newcomer who opens the repository sees only the folders that the README explains."""
    if shutil.which("git") is None or not (ROOT / ".git").exists():
        pytest.skip("this is not a git checkout")
    listing = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True)
    if listing.returncode:
        pytest.skip(f"git does not list this checkout: {listing.stderr.strip()}")
    tracked = {line.split("/")[0] for line in listing.stdout.splitlines()}
    assert not {name for name in tracked if not name.startswith(".")} - TOP_LEVEL
