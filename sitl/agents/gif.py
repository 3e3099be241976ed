# SPDX-License-Identifier: BSD-3-Clause
"""GIF files that are written as they grow, so that a film of an hour needs no more memory than one picture.

Source: the GIF89a specification; Netscape's extension lets a film repeat.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt

from sitl.core.extras import MissingExtra

from .errors import AgentError

Picture = npt.NDArray[np.uint8]
"""Shape (height, width, 3)."""
_COLOURS = 64
"""Of the first picture of a GIF."""
_DRAWN, _SEEN, _NEAR = 4096, 12, 16
"""A picture of more colours is a photograph; pixels that a colour must have to count; how far apart colours differ."""


def pillow() -> Any:
    """The library. Raises MissingExtra."""
    try:
        from PIL import Image
    except ImportError:
        raise MissingExtra("a GIF needs Pillow: pip install 'gym-sitl[viz]'") from None
    return Image


class Gif:
    """A GIF that repeats for ever, written as it grows: of each picture what differs from the one before.

    Its colours are those of the first picture, and others as they come: a trail is not there at the begin. The palette
    stands at the begin of the file and is written last.
    """

    def __init__(self, path: Path, seconds: float) -> None:
        self._path, self._ms = path, max(round(100.0 * seconds), 2) * 10  # GIFs count hundredths
        self._file: BinaryIO | None = None
        self._shown: npt.NDArray[np.uint8] | None = None
        self._palette: Any = pillow().new("P", (1, 1))
        self._colours: npt.NDArray[np.int64] = np.zeros((0, 3), np.int64)

    def add(self, picture: Picture) -> None:
        """See ``Film``."""
        image = pillow().fromarray(picture)
        self._meet(image)
        drawn = image.quantize(palette=self._palette, dither=0)
        pixels = np.asarray(drawn)
        try:
            if self._file is None:
                self._file = open(self._path, "wb")  # noqa: SIM115 (``close`` closes it)
                self._file.write(_gif_head(*drawn.size))
            left, top, right, bottom = _changed(self._shown, pixels)
            self._file.writelines(_gif_picture(drawn.crop((left, top, right, bottom)), (left, top), self._ms))
        except OSError as error:
            raise AgentError(f"{self._path} cannot be written: {error.strerror}") from None
        self._shown = pixels

    def _meet(self, image: Any) -> None:
        """Take the colours of much of a picture into the palette, where there is nothing near."""
        known = len(self._colours)
        if known == 0:
            first = image.quantize(_COLOURS)
            count = 1 + max(index for _, index in first.getcolors())
            self._colours = np.array(first.getpalette()[: 3 * count], np.int64).reshape(-1, 3)
        for count, colour in image.getcolors(_DRAWN) or ():  # none of a photograph: the first one's colours must do
            if count >= _SEEN and np.abs(self._colours - colour).max(axis=1).min() > _NEAR:
                self._colours = np.concatenate([self._colours, [colour]])[:256]
        if len(self._colours) > known:
            self._palette.putpalette(self._table())

    def _table(self) -> bytes:
        """256 colours; places without one hold the first."""
        unused = np.repeat(self._colours[:1], 256 - len(self._colours), axis=0)
        return np.concatenate([self._colours, unused]).astype(np.uint8).tobytes()

    def close(self) -> None:
        """See ``Film``."""
        if self._file is None:
            return
        try:
            with self._file as file:
                file.write(_GIF_END)
                file.seek(_GIF_TABLE)
                file.write(self._table())
        except OSError as error:
            raise AgentError(f"{self._path} cannot be written: {error.strerror}") from None
        self._file = None


_GIF_TABLE, _GIF_END = 13, b";"
"""Where the table of colours stands; the last byte."""


def _gif_head(width: int, height: int) -> bytes:
    """Screen of 256 colours, which are not yet known, and that it repeats."""
    screen = struct.pack("<6sHHBBB", b"GIF89a", width, height, 0xF7, 0, 0)
    return screen + bytes(768) + b"\x21\xff\x0bNETSCAPE2.0\x03\x01" + struct.pack("<H", 0) + b"\x00"


def _gif_picture(image: Any, place: tuple[int, int], ms: int) -> list[bytes]:
    """A picture that is laid on what is there, and stands so long."""
    from PIL import GifImagePlugin

    return GifImagePlugin.getdata(image, place, duration=ms, disposal=1)


def _changed(before: npt.NDArray[np.uint8] | None, now: npt.NDArray[np.uint8]) -> tuple[int, int, int, int]:
    """Left, top, right, bottom of what differs, at least one pixel."""
    if before is None:
        return 0, 0, now.shape[1], now.shape[0]
    differs = before != now
    rows, columns = np.flatnonzero(differs.any(axis=1)), np.flatnonzero(differs.any(axis=0))
    if not len(rows):
        return 0, 0, 1, 1
    return int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1
