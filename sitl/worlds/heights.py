# SPDX-License-Identifier: BSD-3-Clause
"""Heights of the ground from a file: SRTM tiles (.hgt) and arrays (.npy); docs/terrain.md."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..core.array_files import read_file, read_npy
from ..core.geodesy import METRES_PER_DEGE7, longitude_scale
from ..errors import OptionError

FORMS = "flat, FILE.hgt, FILE.npy or FILE.npy:SPACING"
FLAT = "flat"
SPACING = 30.0
"""Of the points of an array by default [m]."""
MOST_BYTES = 1 << 28
"""Of a file."""
MOST_POINTS = 1 << 25
"""Of an array; a tile of one second has 13 million."""
LOWEST, HIGHEST = -12_000.0, 10_000.0
"""Heights above mean sea level on Earth [m]."""
VOID = -32768
"""In a tile: not known."""
_NAME = re.compile(r"([NS])(\d{2})([EW])(\d{3})")


class Heights(NamedTuple):
    """Points at equal steps of latitude and longitude."""

    rows: np.ndarray[Any, Any]
    """Heights above mean sea level [m], from south to north and from west to east; NaN: not known."""
    south: float
    """Of the first point [deg]."""
    west: float
    step_lat: float
    """From one point to the next [deg]."""
    step_lon: float

    def __call__(self, lat: float, lon: float) -> float | None:
        """Height [m] at a location [deg], between the four points around it; None: not known, or outside."""
        row, column = (lat - self.south) / self.step_lat, (lon - self.west) / self.step_lon
        count_n, count_e = self.rows.shape
        if not (0.0 <= row <= count_n - 1 and 0.0 <= column <= count_e - 1):
            return None
        n, e = min(int(row), count_n - 2), min(int(column), count_e - 2)
        u, w = row - n, column - e
        (sw, se), (nw, ne) = self.rows[n : n + 2, e : e + 2].tolist()
        height = (1.0 - u) * ((1.0 - w) * sw + w * se) + u * ((1.0 - w) * nw + w * ne)
        return float(height) if math.isfinite(height) else None


def load(text: str, home: tuple[float, float, float]) -> Heights:
    """Heights as an option names them: one of ``FORMS``.

    Args:
        text: "flat": as high as home everywhere within a degree; an SRTM tile by the name of its south-west corner
            (S36E149.hgt); an array of heights above mean sea level [m], rows from south to north, its middle at home,
            with SPACING [m] between points (30).
        home: latitude, longitude [deg], height [m].

    Raises:
        OptionError: no such form, or the file cannot be read as one.
    """
    lat, lon, alt = home
    path, _, spacing = text.partition(":")
    if text == FLAT:
        return Heights(np.full((3, 3), alt), lat - 1.0, lon - 1.0, 1.0, 1.0)
    try:
        if path.endswith(".npy"):
            return _array(read_npy(read_file(Path(path), MOST_BYTES), MOST_BYTES), float(spacing or SPACING), lat, lon)
        if path.endswith(".hgt") and not spacing:
            return _tile(Path(path))
    except OSError as error:
        raise OptionError(f"terrain {text!r} cannot be read: {error.strerror or error}") from None
    except ValueError as error:
        raise OptionError(f"terrain {text!r}: {error}") from None
    raise OptionError(f"terrain {text!r} is none of {FORMS}")


def _tile(path: Path) -> Heights:
    name = _NAME.fullmatch(path.stem.upper())
    if name is None:
        raise ValueError("a tile's name is that of its south-west corner, as S36E149.hgt")
    south, west = (float(name[k + 1]) * (-1.0 if name[k] in "SW" else 1.0) for k in (1, 3))
    content = read_file(path, MOST_BYTES)
    if len(content) % 2:
        raise ValueError(f"{len(content)} bytes are no heights of two bytes each")
    points = np.frombuffer(content, ">i2")
    side = math.isqrt(points.size)
    if side < 2 or side * side != points.size:
        raise ValueError(f"{points.size} heights are no square")
    rows = points.reshape(side, side)[::-1].astype(float)
    rows[rows == VOID] = np.nan
    return Heights(rows, south, west, 1.0 / (side - 1), 1.0 / (side - 1))


def _array(rows: np.ndarray[Any, Any], spacing: float, lat: float, lon: float) -> Heights:
    if rows.size > MOST_POINTS:
        raise ValueError(f"{rows.size} heights; at most {MOST_POINTS} are read")
    if rows.ndim != 2 or min(rows.shape) < 2 or rows.dtype.kind == "b":
        raise ValueError(
            f"an array of numbers with rows and columns is needed, found {rows.dtype} of shape {rows.shape}"
        )
    if not 0.0 < spacing < math.inf:
        raise ValueError(f"spacing {spacing} is not a positive number of metres")
    step_lat = spacing / (METRES_PER_DEGE7 * 1e7)
    step_lon = step_lat / longitude_scale(lat * 1e7)
    known = rows[np.isfinite(rows)]
    if len(known) and (known.min() < LOWEST or known.max() > HIGHEST):
        raise ValueError(f"heights from {known.min():g} to {known.max():g} m; {LOWEST:g} to {HIGHEST:g} are read")
    middle_n, middle_e = 0.5 * (rows.shape[0] - 1), 0.5 * (rows.shape[1] - 1)
    return Heights(rows.astype(float), lat - middle_n * step_lat, lon - middle_e * step_lon, step_lat, step_lon)
