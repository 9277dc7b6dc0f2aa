"""Files appear whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from viewer.whole_file import OutputError, whole_file


def test_a_file_appears_when_it_is_whole(tmp_path: Path) -> None:
    """Its folder is made; nothing but the file is left, as readable as any other."""
    path = tmp_path / "new" / "deep" / "file.txt"
    with whole_file(path) as temporary:
        temporary.write_text("half")
        assert not path.exists()
        assert temporary.suffix == path.suffix
        temporary.write_text("whole")
    assert path.read_text() == "whole"
    assert list(path.parent.iterdir()) == [path]
    usual = tmp_path / "usual"
    usual.touch()
    assert path.stat().st_mode == usual.stat().st_mode


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt, OSError])
def test_an_error_leaves_the_old_file_and_no_litter(tmp_path: Path, error: type[BaseException]) -> None:
    """Even when something was written already."""
    path = tmp_path / "file.txt"
    path.write_text("old")
    with pytest.raises(OutputError if error is OSError else error), whole_file(path) as temporary:
        temporary.write_text("new")
        raise error("interrupted")
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_what_cannot_be_written_is_named(tmp_path: Path) -> None:
    """A folder in the file's place, a file in the folder's, a name too long."""
    (tmp_path / "file").touch()
    (tmp_path / "folder").mkdir()
    for path, reason in ((tmp_path / "folder", "it is a folder"), (tmp_path / "file/x/a.txt", "[Nn]ot a directory"),
                         (tmp_path / "file/a.txt", "file is not a folder"), (tmp_path / ("x" * 300), "name too long")):
        with pytest.raises(OutputError, match=f"^cannot write {path}: .*{reason}"), whole_file(path):
            raise AssertionError("not reached")
    assert sorted(each.name for each in tmp_path.iterdir()) == ["file", "folder"]


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_without_permission_is_named(tmp_path: Path) -> None:
    """As the operating system puts it."""
    tmp_path.chmod(0o500)
    with pytest.raises(OutputError, match="Permission denied"), whole_file(tmp_path / "a.txt"):
        raise AssertionError("not reached")
    tmp_path.chmod(0o700)
