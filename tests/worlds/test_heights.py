# SPDX-License-Identifier: BSD-3-Clause
"""Heights of the ground from files."""

import numpy as np
import pytest

from sitl.errors import OptionError
from sitl.worlds.heights import load
from tests import mutations

HOME = (-35.363262, 149.165237, 584.0)


def test_flat_ground_is_as_high_as_home():
    flat = load("flat", HOME)
    assert flat(*HOME[:2]) == 584.0
    assert flat(-35.9, 149.9) == 584.0
    assert flat(12.0, 8.0) is None


@pytest.mark.parametrize("side", [1201, 13])
def test_a_tile_has_its_south_west_corner_in_its_name(tmp_path, side):
    rows = 100 + np.arange(side)[::-1, None] + 2 * np.arange(side)[None, :]  # from north to south
    rows[0, -1] = -32768
    path = tmp_path / "S36E149.hgt"
    path.write_bytes(rows.astype(">i2").tobytes())
    tile = load(str(path), HOME)
    assert tile(-36.0, 149.0) == 100.0
    assert tile(-35.5, 149.25) == pytest.approx(100 + 0.5 * (side - 1) + 2 * 0.25 * (side - 1))
    assert tile(-35.0, 149.0) == 100 + side - 1
    assert tile(-35.0, 150.0) is None  # not known
    assert tile(-36.1, 149.5) is None
    assert tile(-35.5, 150.1) is None


def test_an_array_has_its_middle_at_home(tmp_path):
    rows = np.array([[0.0, 0.0, 0.0], [10.0, 20.0, 30.0], [40.0, 40.0, 40.0]])
    np.save(tmp_path / "a.npy", rows)
    array = load(f"{tmp_path / 'a.npy'}:50", HOME)
    assert array(*HOME[:2]) == pytest.approx(20.0)
    north = HOME[0] + 25.0 / 111318.845
    assert array(north, HOME[1]) == pytest.approx(30.0, abs=0.01)
    assert array(HOME[0] + 60.0 / 111318.845, HOME[1]) is None


def test_what_cannot_be_read_is_named(tmp_path):
    np.save(tmp_path / "line.npy", np.zeros(4))
    np.save(tmp_path / "complex.npy", np.zeros((3, 3), complex))
    np.save(tmp_path / "high.npy", np.full((3, 3), 1e9))
    huge = b"{'descr': '<f8', 'fortran_order': False, 'shape': (300000, 300000), }".ljust(117) + b"\n"
    (tmp_path / "huge.npy").write_bytes(b"\x93NUMPY\x01\x00" + len(huge).to_bytes(2, "little") + huge + bytes(64))
    (tmp_path / "N00E000.hgt").write_bytes(bytes(9))
    np.save(tmp_path / "objects.npy", np.array([[{}, {}], [{}, {}]]), allow_pickle=True)
    (tmp_path / "S36E149.hgt").write_bytes(bytes(10))
    (tmp_path / "hills.hgt").write_bytes(bytes(8))
    refusals = {
        "line.npy": "rows and columns",
        "complex.npy": "<c16",
        "high.npy": "heights from 1e[+]09 to 1e[+]09 m",
        "huge.npy": r"300000, 300000\)",
        "N00E000.hgt": "9 bytes are no heights",
        "missing.npy": "cannot be read: No such file",
        "objects.npy": "object",
        "line.npy:x": "could not convert",
        "S36E149.hgt": "5 heights are no square",
        "hills.hgt": "S36E149.hgt",
        "missing.hgt": "N|name",
        "hills.tif": "is none of flat, FILE.hgt",
    }
    for name, said in refusals.items():
        with pytest.raises(OptionError, match=said):
            load(str(tmp_path / name), HOME)


def test_damaged_arrays_and_tiles_are_read_or_named(tmp_path):
    np.save(tmp_path / "a.npy", np.arange(30.0).reshape(5, 6))
    content = (tmp_path / "a.npy").read_bytes()
    for name, whole in (("b.npy", content), ("S36E149.hgt", bytes(2 * 13 * 13))):
        path = str(tmp_path / name)
        kinds = set()
        for damaged in mutations.of_bytes(whole, 200):
            (tmp_path / name).write_bytes(damaged)
            read = mutations.read_or_refused(lambda path=path: load(path, HOME), OptionError, path)
            kinds.add(read is None)
            assert read is None or isinstance(read(*HOME[:2]), float | None)
        assert kinds == {True, False}
