# SPDX-License-Identifier: BSD-3-Clause
"""GIF files that are written frame by frame, so that an hour of animation needs no more memory than one frame.

Source: the GIF89a specification; Netscape's extension lets an animation repeat. Pillow's own writer, and imageio on it,
hold all frames until the file is saved and merge frames that do not change; imageio's frame-by-frame writer fails with
current NumPy releases when it crops frames to what changed.
"""

from __future__ import annotations

import contextlib
import struct
from pathlib import Path
from typing import Any, BinaryIO, NoReturn

import numpy as np
import numpy.typing as npt

from sitl.errors import MissingExtra

from .errors import AgentError

Picture = npt.NDArray[np.uint8]
"""Shape (height, width, 3)."""
_FIRST_COLOURS = 64
"""Number of palette entries taken from the first frame."""
_MAX_COLOURS, _MIN_PIXELS, _MIN_DISTANCE = 4096, 12, 16
"""A frame with more colours is a photograph, and adds none to the palette; number of pixels a new colour needs to be
added; its distance to the nearest palette entry, as the largest difference of a channel (0 .. 255)."""


def pillow() -> Any:
    """The module ``PIL.Image``. Raises MissingExtra."""
    try:
        from PIL import Image
    except ImportError:
        raise MissingExtra("a GIF needs Pillow: pip install 'gym-sitl[viz]'") from None
    return Image


class Gif:
    """A GIF that repeats forever; each frame holds the rectangle that differs from the frame before.

    The palette starts with the colours of the first frame and grows with later ones (a trail comes later).
    It stands at the start of the file, and is written when the file is closed.

    Args:
        path: the file.
        seconds: duration of a frame [s], at least 0.02.
    """

    def __init__(self, path: Path, seconds: float) -> None:
        self._path, self._ms = path, max(round(100.0 * seconds), 2) * 10  # GIFs count hundredths
        self._file: BinaryIO | None = None
        self.size = 0
        """Bytes written so far."""
        self._shown: npt.NDArray[np.uint8] | None = None
        self._palette: Any = pillow().new("P", (1, 1))
        self._colours: npt.NDArray[np.int64] = np.zeros((0, 3), np.int64)

    def add(self, picture: Picture, times: int = 1) -> None:
        """See ``Film``."""
        image = pillow().fromarray(picture)
        self._extend_palette(image)
        drawn = image.quantize(palette=self._palette, dither=0)
        pixels = np.asarray(drawn)
        try:
            if self._file is None:
                self._file = open(self._path, "wb")  # noqa: SIM115 (``close`` closes it)
                self._file.write(_gif_head(*drawn.size))
            left, top, right, bottom = _changed(self._shown, pixels)
            self._file.writelines(_gif_picture(drawn.crop((left, top, right, bottom)), (left, top), self._ms * times))
            self.size = self._file.tell()
        except OSError as error:
            self._give_up(error)
        self._shown = pixels

    def _give_up(self, error: OSError) -> NoReturn:
        """Half a film is none: it is removed, unless it is no file."""
        if self._file is not None:
            file, self._file = self._file, None
            with contextlib.suppress(OSError):
                file.close()
            if self._path.is_file():
                self._path.unlink(missing_ok=True)
        raise AgentError(f"{self._path} cannot be written: {error.strerror}") from None

    def _extend_palette(self, image: Any) -> None:
        """Add frequent colours of a frame to the palette where it has none near."""
        known = len(self._colours)
        if known == 0:
            first = image.quantize(_FIRST_COLOURS)
            count = 1 + max(index for _, index in first.getcolors())
            self._colours = np.array(first.getpalette()[: 3 * count], np.int64).reshape(-1, 3)
        for count, colour in image.getcolors(_MAX_COLOURS) or ():  # None for a photograph
            if count >= _MIN_PIXELS and np.abs(self._colours - colour).max(axis=1).min() > _MIN_DISTANCE:
                self._colours = np.concatenate([self._colours, [colour]])[:256]
        if len(self._colours) > known:
            self._palette.putpalette(self._table())

    def _table(self) -> bytes:
        """The palette as 768 bytes; unused entries hold the first colour."""
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
            self._give_up(error)
        self._file = None


_GIF_TABLE, _GIF_END = 13, b";"
"""Offset of the palette in the file; the trailer byte."""


def _gif_head(width: int, height: int) -> bytes:
    """Header, a palette of 256 entries to be filled in later, and the extension that makes it repeat."""
    screen = struct.pack("<6sHHBBB", b"GIF89a", width, height, 0xF7, 0, 0)
    return screen + bytes(768) + b"\x21\xff\x0bNETSCAPE2.0\x03\x01" + struct.pack("<H", 0) + b"\x00"


def _gif_picture(image: Any, corner: tuple[int, int], ms: int) -> list[bytes]:
    """A frame drawn over the one before at ``corner`` (left, top) for ``ms`` milliseconds."""
    from PIL import GifImagePlugin

    return GifImagePlugin.getdata(image, corner, duration=ms, disposal=1)


def _changed(before: npt.NDArray[np.uint8] | None, now: npt.NDArray[np.uint8]) -> tuple[int, int, int, int]:
    """Left, top, right, bottom of the pixels that differ; one pixel when none do."""
    if before is None:
        return 0, 0, now.shape[1], now.shape[0]
    differs = before != now
    rows, columns = np.flatnonzero(differs.any(axis=1)), np.flatnonzero(differs.any(axis=0))
    if not len(rows):
        return 0, 0, 1, 1
    return int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1
