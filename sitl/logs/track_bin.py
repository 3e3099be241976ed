# SPDX-License-Identifier: BSD-3-Clause
"""The track of a flight in a DataFlash log (.bin), ours or a real vehicle's.

Messages: https://ardupilot.org/copter/docs/logmessages.html
"""

from __future__ import annotations

import contextlib
import io
import math
import re
from collections import defaultdict
from pathlib import Path
from typing import Any

import numpy as np
from pymavlink import DFReader

from ..core.geodesy import offset_ne
from .kind import kinds_with_logs, mode_name
from .tlog import LogError
from .track import STEP_US, Array, Track, TrackError, is_angle, sampled

_STEP = STEP_US * 1e-6
_TYPES = ["POS", "XKF1", "ATT", "BAT", "MODE", "ARM", "EV", "MSG", "ORGN"]
_ARMED, _DISARMED, _HOME = 10, 11, 1
_INFO = 6
_REACHED = re.compile(r"Reached (?:command|waypoint) #(\d+)")
_STARTED = re.compile(r"Mission: (\d+) (\S+)")


class _Reader:
    """Takes in what a log says."""

    def __init__(self) -> None:
        self.track = Track("", np.zeros((0, 11)))
        self.rows: dict[str, list[tuple[float, ...]]] = defaultdict(list)
        self.modes: list[tuple[float, int]] = []
        self.homes: list[tuple[float, float, float, float]] = []
        self._takes_off = 0
        self.began: float | None = None
        """Time of the first message [s]."""

    def take(self, m: Any) -> None:
        """One message."""
        t, name = m.TimeUS * 1e-6, m.get_type()
        if self.began is None:
            self.began = t
        if name == "POS":
            self.rows["place"].append((t, m.Lat * 1e7, m.Lng * 1e7, m.Alt))
        elif name == "XKF1" and m.C == 0:
            self.rows["speed"].append((t, m.VN, m.VE, m.VD))
        elif name == "ATT":
            self.rows["attitude"].append((t, *(math.radians(angle) for angle in (m.Roll, m.Pitch, m.Yaw))))
        elif name == "BAT" and getattr(m, "Inst", getattr(m, "Instance", 0)) == 0:
            self.rows["energy"].append((t, m.EnrgTot))
        elif name == "MODE":
            if not self.modes or self.modes[-1][1] != m.ModeNum:
                self.modes.append((t, m.ModeNum))
        elif name == "ARM":
            self._arm(t, bool(m.ArmState))
        elif name == "EV" and m.Id in (_ARMED, _DISARMED):
            self._arm(t, m.Id == _ARMED)
        elif name == "ORGN" and m.Type == _HOME:
            self.homes.append((t, m.Lat, m.Lng, m.Alt))
        elif name == "MSG":
            self._text(t, m.Message)

    def _arm(self, t: float, state: bool) -> None:
        if not self.track.armed and not state:  # LOG_DISARMED 0: the log was opened by the arming, which it misses
            self.track.armed.append((t if self.began is None else self.began, True))
        if not self.track.armed or self.track.armed[-1][1] != state:
            self.track.armed.append((t, state))

    def _text(self, t: float, text: str) -> None:
        if not self.track.kind:
            self.track.kind = next((kind for kind, logs in kinds_with_logs().items() if logs.word in text), "")
        self.track.texts.append((t, _INFO, text))
        reached, started = _REACHED.match(text), _STARTED.match(text)
        if started is not None:
            if self._takes_off:
                self.track.items.append((t, self._takes_off))
            self._takes_off = int(started[1]) if started[2] == "Takeoff" else 0
        elif reached is not None:
            self.track.items.append((t, int(reached[1])))


def read(path: str | Path) -> Track:
    """The flight in a .bin.

    Mission items are known by what is said of them (DataFlash has no message for it), texts are of severity INFO.

    Raises:
        LogError: the file cannot be read, or it tells of no copter and no rover that moves.
    """
    reader = _Reader()
    title = f"log {str(path)!r}"
    try:
        with contextlib.redirect_stdout(io.StringIO()):  # what it thinks of the log is not for us
            log = DFReader.DFReader_binary(str(path), zero_time_base=False)
            while (message := log.recv_match(type=_TYPES)) is not None:
                reader.take(message)
            log.close()
    except OSError as error:
        raise LogError(f"{title} cannot be read: {error.strerror or error}") from None
    except Exception as error:  # the reader raises whatever damaged bytes lead it to
        raise TrackError(f"{title} is no DataFlash log, or damaged: {error}") from None
    track = reader.track
    if not track.kind:
        raise TrackError(f"{title} does not say that it is of a copter or a rover (MSG)")
    if len(reader.rows["place"]) < 2:
        raise TrackError(f"{title} tells no way: it has no POS")
    track.modes = [(t, mode_name(track.kind, number)) for t, number in reader.modes]
    return _place(track, reader)


def _place(track: Track, reader: _Reader) -> Track:
    place = np.array(reader.rows["place"])
    t = place[:, 0]
    armed = next((at for at, state in track.armed if state), float(t[0]))
    homes = [home for home in reader.homes if home[0] <= armed + 1.0] or reader.homes[:1]
    first = place[min(int(np.searchsorted(t, armed)), len(t) - 1)]
    track.home = homes[-1][1:] if homes else (first[1] * 1e-7, first[2] * 1e-7, float(first[3]))
    lat, lon, alt = track.home
    ne = np.array([offset_ne(lat * 1e7, lon * 1e7, row[1], row[2]) for row in place])
    series: dict[str, tuple[Array, Array]] = {
        "north": (t, ne[:, 0]),
        "east": (t, ne[:, 1]),
        "down": (t, alt - place[:, 3]),
    }
    for rows, names in (("speed", ("vn", "ve", "vd")), ("attitude", ("roll", "pitch", "yaw")), ("energy", ("energy",))):
        if reader.rows[rows]:
            found = np.array(reader.rows[rows])
            series |= {name: (found[:, 0], found[:, k]) for k, name in enumerate(names, 1)}
    if not reader.rows["speed"]:
        series |= {v: (t, np.gradient(series[x][1], t)) for v, x in (("vn", "north"), ("ve", "east"), ("vd", "down"))}
    times = np.arange(math.ceil(t[0] / _STEP - 1e-6), math.floor(t[-1] / _STEP + 1e-6) + 1) * _STEP
    track.data = sampled(times, series, is_angle)
    return track
