# SPDX-License-Identifier: BSD-3-Clause
"""Files of arrays: NumPy's own are read as NumPy reads them, and no header is believed more than the file holds."""

from __future__ import annotations

import io
import struct
import zipfile

import numpy as np
import pytest

from sitl.core.array_files import KINDS, MIB, RECORDS, ArrayFileError, read_file, read_npy, read_npz

KEPT = [
    np.arange(6, dtype=">i2").reshape(2, 3),
    np.asfortranarray(np.arange(6.0).reshape(2, 3)),
    np.float32(3.0),
    np.zeros((0, 4)),
    np.array([True, False]),
    np.arange(3, dtype=np.uint8),
]


def npy(array):
    out = io.BytesIO()
    np.save(out, array)
    return out.getvalue()


def npz(**arrays):
    out = io.BytesIO()
    np.savez_compressed(out, **arrays)
    return out.getvalue()


def headed(text, data=b""):
    """A .npy whose header says what it likes."""
    header = text.encode("latin1")
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header + data


def described(shape="(2,)", descr="'<f8'", order="False"):
    return f"{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}\n"


@pytest.mark.parametrize("array", KEPT, ids=lambda array: f"{array.dtype}{array.shape}")
def test_what_numpy_writes_is_read_as_numpy_reads_it(array):
    found = read_npy(npy(array), MIB)
    assert found.dtype == array.dtype and found.shape == array.shape and np.array_equal(found, array)
    assert found.flags.f_contiguous == array.flags.f_contiguous
    again = read_npz(npz(a=array, b=array), MIB)
    assert list(again) == ["a", "b"] and np.array_equal(again["b"], array)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (headed(described("(300000, 300000)")), "of 720,000,000,000 bytes; 1,048,576 are allowed"),
        (headed(described("(3,)"), bytes(16)), "24 bytes, and 16 are there"),
        (headed(described()[:-12], bytes(16)), "header of an array is damaged"),
        (headed(described(descr="'<c16'"), bytes(32)), "'<c16'; it must be of truth values or whole numbers or real"),
        (headed(described(descr="'|O'"), bytes(16)), "an array of '|O'"),
        (headed(described(descr="[('a', '|O')]"), bytes(16)), "an array of"),
        (headed(described(descr="'<f3'"), bytes(16)), "an array of '<f3'"),
        (headed(described("(-1,)")), r"shape \(-1,\)"),
        (headed(described("(True,)"), bytes(16)), "shape"),
        (headed(described(str((1,) * 9)), bytes(16)), "up to 8 whole numbers"),
        (headed(described("(0, 140737488355328, 140737488355328)")), "an array of shape"),
        (headed("(" * 5000), "damaged"),
        (headed("__import__('os')"), "damaged"),
        (headed("[1]"), "damaged"),
        (b"\x93NUMPY\x01\x00\xff\xff{", "is cut or too long"),
        (b"\x93NUMPY\x09\x00\x10\x00{", "format 9"),
        (b"\x93NUMP", "no array of NumPy"),
        (b"", "no array of NumPy"),
    ],
)  # fmt: skip
def test_what_a_header_says_is_not_believed(content, says):
    for kinds in (KINDS, KINDS + RECORDS):
        with pytest.raises(ArrayFileError, match=says):
            read_npy(content, MIB, kinds)


def test_records_only_where_they_are_asked_for():
    rows = np.zeros(3, [("a", "<f8"), ("b", "<i4", (2,))])
    assert read_npy(npy(rows), MIB, RECORDS).dtype == rows.dtype
    with pytest.raises(ArrayFileError, match="it must be of truth values"):
        read_npy(npy(rows), MIB)


def test_what_unpacks_to_much_more_than_it_is():
    packed = npz(a=np.zeros(1_000_000))
    assert len(packed) < 10_000
    with pytest.raises(ArrayFileError, match=r"a\.npy unpacks to more than"):
        read_npz(packed, MIB)
    with pytest.raises(ArrayFileError, match="b"):  # each is allowed, and not both
        read_npz(npz(a=np.zeros(100_000), b=np.zeros(100_000)), MIB)


def test_what_is_damaged():
    whole = npz(a=np.arange(100.0))
    rng = np.random.default_rng(1)
    for _ in range(300):
        content = bytearray(whole)
        for place in rng.integers(len(content), size=3):
            content[place] = rng.integers(256)
        try:
            read_npz(bytes(content[: rng.integers(1, len(content) + 1)]), MIB)
        except ArrayFileError as error:
            assert str(error)
    with pytest.raises(ArrayFileError, match="1,025 arrays; 1,024 are allowed"):
        out = io.BytesIO()
        with zipfile.ZipFile(out, "w") as archive:
            for k in range(1025):
                archive.writestr(f"{k}.npy", npy(np.zeros(1)))
        read_npz(out.getvalue(), MIB)


def test_a_file_that_is_too_long(tmp_path):
    (tmp_path / "a.npy").write_bytes(bytes(100))
    assert len(read_file(tmp_path / "a.npy", 100)) == 100
    with pytest.raises(ArrayFileError, match="longer than 99 bytes"):
        read_file(tmp_path / "a.npy", 99)
