# SPDX-License-Identifier: BSD-3-Clause
"""Files are whole or as they were, and errors name the file that is meant."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from sitl.core.whole_file import whole_file, write_whole
from sitl.errors import OptionError, SitlError
from tests.full_disk import WORDS, full_disk


def test_a_file_is_replaced_whole(tmp_path: Path) -> None:
    path = tmp_path / "x.txt"
    write_whole(path, "one")
    write_whole(str(path), b"two")
    assert path.read_bytes() == b"two"
    assert list(tmp_path.iterdir()) == [path]


def test_what_cannot_be_written_leaves_the_file_of_before_and_names_it(tmp_path: Path) -> None:
    path = tmp_path / "x.txt"
    write_whole(path, "old")
    with full_disk(10), pytest.raises(OptionError) as error:
        write_whole(path, "new" * 100, OptionError, "report x.txt")
    assert str(error.value) == f"report x.txt cannot be written: {WORDS}"
    assert path.read_text() == "old"
    with full_disk(), pytest.raises(SitlError, match=f"{tmp_path}/y.txt cannot be written"):
        write_whole(tmp_path / "y.txt", "new")
    assert list(tmp_path.iterdir()) == [path]
    with pytest.raises(SitlError, match=r"no/z\.txt cannot be written: No such file or directory"):
        write_whole(tmp_path / "no" / "z.txt", "new")


def test_an_error_of_another_kind_passes_and_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(KeyError), whole_file(tmp_path / "x.txt") as beside:
        beside.write_text("half")
        raise KeyError
    assert not list(tmp_path.iterdir())


def test_links_and_what_is_no_file_are_written_themselves(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "x.txt")
    write_whole(tmp_path / "link", "one")
    assert (tmp_path / "link").is_symlink() and (tmp_path / "x.txt").read_text() == "one"
    write_whole("/dev/null", "gone")
    assert stat.S_ISCHR(os.stat("/dev/null").st_mode)
    with pytest.raises(SitlError, match="/dev/full cannot be written: No space left on device"):
        write_whole("/dev/full", "new")
