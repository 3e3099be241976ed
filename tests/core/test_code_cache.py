# SPDX-License-Identifier: BSD-3-Clause
"""Machine code that another version or a full disk has left behind: it is compiled again, and nobody sees an error."""

from __future__ import annotations

import pickle
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numba
import pytest

from sitl.core.code_cache import ENTRY, load_entry

SOURCE = f"def {ENTRY}(point):\n    return point.x + offset\n"


class Counted:
    """Numba's decorator; counts what was compiled and not read."""

    def __init__(self, offset: Any) -> None:
        self.hits: list[int] = []
        self._signature = numba.typeof(offset)

    def __call__(self, function: Any) -> Any:
        made = numba.njit(numba.float64(self._signature), cache=True)(function)
        self.hits.append(sum(made.stats.cache_hits.values()))
        return made


@pytest.fixture
def moved(monkeypatch: pytest.MonkeyPatch) -> Any:
    """A named tuple in a module of its own; the module's name."""
    module = ModuleType("module_before")
    exec("from typing import NamedTuple\nclass Point(NamedTuple):\n    x: float\n", vars(module))
    monkeypatch.setitem(sys.modules, "module_before", module)
    return module


def load(folder: Path, name: str, decorate: Counted, source: str = SOURCE) -> Any:
    return load_entry(folder, name, source, {"offset": 1.0}, decorate)


def test_code_whose_types_have_moved_is_compiled_again(tmp_path: Path, moved: Any, monkeypatch: Any) -> None:
    point = moved.Point(2.0)
    first, again, after, once_more = (Counted(point) for _ in range(4))
    assert load(tmp_path / "unit", "first", first)(point) == 3.0
    load(tmp_path / "unit", "first", again)
    assert (first.hits, again.hits) == ([0], [1])
    monkeypatch.delitem(sys.modules, "module_before")  # as in a version that calls the module something else
    moved.Point.__module__ = "module_after"
    monkeypatch.setitem(sys.modules, "module_after", moved)
    with pytest.raises(ModuleNotFoundError):
        read_index(tmp_path)
    assert load(tmp_path / "unit", "first", after)(point) == 3.0
    load(tmp_path / "unit", "first", once_more)
    assert (after.hits, once_more.hits) == ([0], [1])


def read_index(folder: Path) -> None:
    """Read what Numba has noted in a folder, as Numba does."""
    [file] = folder.rglob("*.nbi")
    with file.open("rb") as handle:
        pickle.load(handle)  # the version of Numba
        pickle.load(handle)


def test_a_damaged_index_is_made_anew(tmp_path: Path) -> None:
    source = SOURCE.replace("point.x", "point")
    load(tmp_path / "unit", "second", Counted(2.0), source)
    [file] = tmp_path.rglob("*.nbi")
    file.write_bytes(file.read_bytes()[:-20])
    with pytest.raises((pickle.UnpicklingError, EOFError)):
        read_index(tmp_path)
    after = Counted(2.0)
    assert load(tmp_path / "unit", "second", after, source)(2.0) == 3.0 and after.hits == [0]


def test_what_cannot_be_compiled_is_said_as_before(tmp_path: Path) -> None:
    with pytest.raises(numba.TypingError):
        load_entry(tmp_path / "unit", "bad", f"def {ENTRY}(x):\n    return x.y\n", {}, Counted(1.0))
