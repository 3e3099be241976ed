# SPDX-License-Identifier: BSD-3-Clause
"""Pictures as a film: a GIF, or an MP4 where the program ffmpeg is installed."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from types import TracebackType
from typing import Protocol

from .errors import AgentError
from .gif import Gif, Picture, pillow

FASTEST_S = 0.04
"""Shortest duration of a frame [s]: viewers slow down GIFs with shorter ones."""


class Film(Protocol):
    """An animation file; complete when it is closed."""

    def add(self, picture: Picture) -> None:
        """Append a frame, shape (height, width, 3); all frames have the same size."""

    def close(self) -> None:
        """Write what is buffered, and close the file."""


class Mp4:
    """An MP4 (H.264), encoded by ffmpeg frame by frame."""

    def __init__(self, path: Path, seconds: float, program: str) -> None:
        self._path, self._rate, self._program = path, 1.0 / seconds, program
        self._process: subprocess.Popen[bytes] | None = None

    def add(self, picture: Picture) -> None:
        """See ``Film``."""
        if self._process is None:
            height, width = picture.shape[:2]
            raw = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", f"{self._rate:.6g}"]
            even = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p"]  # H.264 wants even sides
            words = [self._program, "-loglevel", "error", "-y", *raw, "-i", "-", *even, str(self._path)]
            pipe = subprocess.PIPE
            # In a session of its own: a terminal's Ctrl-C shall end the play, and ffmpeg what it has begun.
            self._process = subprocess.Popen(words, stdin=pipe, stderr=pipe, start_new_session=True)
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(picture.tobytes())
        except BrokenPipeError:
            self.close()

    def close(self) -> None:
        """See ``Film``."""
        if self._process is None:
            return
        _, errors = self._process.communicate()
        code, self._process = self._process.returncode, None
        if code != 0:
            last = errors.decode(errors="replace").strip().splitlines()
            raise AgentError(f"{self._path} cannot be written: ffmpeg: {last[-1] if last else f'exit code {code}'}")


class Reel:
    """An animation of an episode; steps are left out where frames would be shorter than FASTEST_S.

    Args:
        path: .gif or .mp4.
        step_s: how long a step shall last in the film [s].

    Raises:
        AgentError: another kind of file, or no ffmpeg for an MP4.
        MissingExtra: no Pillow for a GIF.
    """

    def __init__(self, path: Path, step_s: float) -> None:
        self.every = max(round(FASTEST_S / step_s), 1) if step_s < FASTEST_S else 1
        """Number of steps per frame."""
        seconds = self.every * step_s
        self._steps, self.pictures = 0, 0
        if not path.parent.is_dir():
            raise AgentError(f"{path} cannot be written: there is no folder {path.parent}")
        self._film: Film
        if path.suffix.lower() == ".gif":
            pillow()
            self._film = Gif(path, seconds)
        elif path.suffix.lower() == ".mp4":
            program = shutil.which("ffmpeg")
            if program is None:
                raise AgentError(f"{path}: an MP4 needs the program ffmpeg, which is not installed; a .gif does not")
            self._film = Mp4(path, seconds, program)
        else:
            raise AgentError(f"{path}: a film is a .gif or an .mp4")

    def wants(self) -> bool:
        """Whether this step becomes a frame; call it once per step."""
        wanted = self._steps % self.every == 0
        self._steps += 1
        return wanted

    def add(self, picture: Picture) -> None:
        """Append a frame, shape (height, width, 3)."""
        self._film.add(picture)
        self.pictures += 1

    def __enter__(self) -> Reel:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None):
        self._film.close()
