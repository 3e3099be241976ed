# SPDX-License-Identifier: BSD-3-Clause
"""What a vehicle has said last, read from MAVLink's bytes without more work than an environment's step needs."""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from sitl.bridge.dialect import MessageType, message
from sitl.bridge.frame import Splitter
from sitl.bridge.telemetry.own import ExtendedSysState
from sitl.client.endpoint import HEARTBEAT, TEXT, Inbox
from sitl.core.mavlink import MavAutopilot, MavLandedState, MavModeFlag

from .reports import LANDED, REPORTED, note_report

POSITION, ATTITUDE, SCAN = message("LOCAL_POSITION_NED"), message("ATTITUDE"), message("DEBUG_FLOAT_ARRAY")
SECTORS = message("OBSTACLE_DISTANCE")
ORIGIN, GLOBAL = message("GPS_GLOBAL_ORIGIN"), message("GLOBAL_POSITION_INT")
LANDED_STATE, ESTIMATOR = ExtendedSysState.kind, message("ESTIMATOR_STATUS")
PART = 58
"""Readings in a part of a scan."""
SCAN_NAME = b"LASER"
HIT = b"SIM Hit obstacle"
"""How the text begins that reports a touch."""
_part = struct.Struct("<QH10s").unpack_from
_seven = struct.Struct("<I6f").unpack_from


class StepTelemetry(Inbox):
    """The latest of each message.

    Args:
        readings: of a scan; 0: there is no lidar.
        wanted: messages that are asked for besides (``reports``).
    """

    def __init__(self, readings: int, wanted: Sequence[MessageType] = ()) -> None:
        super().__init__()
        self.wanted = wanted
        self.reports = np.zeros(REPORTED)
        """What these have told."""
        self.reported: set[MessageType] = set()
        """Which of them have come since this was last cleared."""
        self._parts = -(-readings // PART)
        self._fresh: set[int] = set()
        self._scan_us = -1
        self.scan: npt.NDArray[np.float32] = np.full(self._parts * PART, np.inf, np.float32)
        """The last whole scan and beyond [m], from right to left."""
        self._next = self.scan.copy()
        self.position: tuple[float, ...] = (0, math.nan, math.nan, math.nan, 0.0, 0.0, 0.0)
        """Time since boot [ms]; north, east, down from the origin of its estimate [m]; the same of velocity [m/s]."""
        self.attitude: tuple[float, ...] = (0,) + 6 * (0.0,)
        """Time since boot [ms]; roll, pitch, heading [rad]; their rates [rad/s]."""
        self.scans = 0
        """Whole scans so far."""
        self.scan_kind = SCAN
        """Where scans are taken from: SCAN, or SECTORS of a vehicle that does not send the other."""
        self.angles: npt.NDArray[np.float64] = np.zeros(readings)
        """Of the readings, counter-clockwise from straight ahead [rad]: SECTORS are spread over them."""
        self.hits = 0
        """Touches reported so far."""
        self.mode, self.armed = -1, False
        self.is_px4 = False
        self.origin: tuple[int, int, int] | None = None
        """Latitude, longitude [degE7], altitude [mm] of local positions."""
        self.estimator = 0
        """ESTIMATOR_STATUS_FLAGS: what the vehicle's filter holds for valid, where that was asked for."""
        self.height = math.nan
        """Above home [m]."""
        self.scans_by_mavlink = True
        """Whether scans and touches come by MAVLink; else the connection reads them off the physics."""
        self.scans_used = readings > 0
        """Whether anybody reads scans; else they are not asked for."""
        self.longest_interval_us = 1 << 62
        """Greatest interval of telemetry that is new enough at the end of a step [us]."""
        self.was_rebooted = False
        self.learned: float | None = None
        """What the vehicle may have changed by itself, as it was at first (``preparation.reboot``)."""

    @property
    def time_ms(self) -> int:
        """The vehicle's clock, by its last position and attitude: both are so new [ms]."""
        return int(min(self.position[0], self.attitude[0]))

    @property
    def landed(self) -> bool:
        """Whether the vehicle has said last that it is on the ground (EXTENDED_SYS_STATE, where that was asked for)."""
        return bool(self.reports[LANDED] == MavLandedState.ON_GROUND)

    def feed(self, data: bytes) -> None:
        """Take bytes from the vehicle, in any pieces."""
        for kind, payload, _, system, component, _, _ in self._cut(data):
            if not self._is_of_vehicle(kind, system, component):
                continue
            if kind is POSITION:
                self.position = _seven(payload.ljust(28, b"\0"))
            elif kind is ATTITUDE:
                self.attitude = _seven(payload.ljust(28, b"\0"))
            elif kind is SCAN:
                self._scan_part(payload.ljust(252, b"\0"))
            elif kind in self.wanted:
                note_report(self.reports, kind, payload)
                self.reported.add(kind)
            else:
                self._other(kind, payload, system)
                continue
            self.count += 1

    def _scan_part(self, payload: bytes) -> None:
        time_us, number, name = _part(payload)
        if number >= self._parts or not name.startswith(SCAN_NAME):
            return
        if time_us != self._scan_us:
            self._scan_us = time_us
            self._fresh.clear()
        self._next[PART * number : PART * (number + 1)] = np.frombuffer(payload, "<f4", PART, 20)
        self._fresh.add(number)
        if len(self._fresh) == self._parts:
            self._fresh.clear()
            self.scan, self._next = self._next, self.scan
            self.scans += 1

    def _sectors(self, fields: Any) -> None:
        """OBSTACLE_DISTANCE: the reading of each angle is that of its sector."""
        step = fields.increment_f or float(fields.increment)
        if self.scan_kind is not SECTORS or step == 0.0:
            return
        distances = np.array(fields.distances, np.float32) * np.float32(0.01)
        distances[distances > fields.max_distance * 0.01] = np.inf
        clockwise = (-np.degrees(self.angles) - fields.angle_offset) / step
        number = np.rint(clockwise % abs(360.0 / step)).astype(int)
        number[number >= round(abs(360.0 / step))] = 0
        self.scan[: len(number)] = np.where(number < len(distances), distances.take(number, mode="clip"), np.inf)
        self.scans += 1

    def _other(self, kind: MessageType, payload: bytes, system: int) -> None:
        fields = kind.decode(payload)
        if not self.is_for_us(kind, fields):
            return
        self._note(kind, fields, system)
        if kind is HEARTBEAT:
            self.mode, self.armed = fields.custom_mode, bool(fields.base_mode & MavModeFlag.SAFETY_ARMED)
            self.is_px4 = fields.autopilot == MavAutopilot.PX4
        elif kind is SECTORS:
            self._sectors(fields)
        elif kind is GLOBAL:
            self.height = 0.001 * fields.relative_alt
        elif kind is ESTIMATOR:
            self.estimator = fields.flags
        elif kind is LANDED_STATE:
            note_report(self.reports, kind, payload)
        elif kind is ORIGIN:
            self.origin = (fields.latitude, fields.longitude, fields.altitude)
        elif kind is TEXT and fields.text.startswith(HIT):
            self.hits += 1

    def forget(self) -> None:
        """The vehicle boots: what it said before does not count any more."""
        self.position = (0, math.nan, math.nan, math.nan, 0.0, 0.0, 0.0)
        self.origin, self.armed, self._scan_us, self.estimator = None, False, -1, 0
        self._fresh.clear()
        self.acks.clear()
        self.last_texts.clear()

    def memory(self) -> tuple[Any, ...]:
        """What ``recall`` needs to go on as from here; can be pickled."""
        scan = self.scan_kind is SECTORS, self.scan.copy(), self._scan_us
        reports = tuple(self.reports.tolist())
        return self.position, self.attitude, scan, self.mode, self.armed, self.origin, reports

    def recall(self, memory: tuple[Any, ...]) -> None:
        """Go on as from a ``memory``; parts of bytes and of scans are gone."""
        self.position, self.attitude, (in_sectors, scan, self._scan_us), self.mode, self.armed, self.origin, values = (
            memory
        )
        self.reports[:] = values
        self.scan_kind = SECTORS if in_sectors else SCAN
        self.scan[:] = scan
        self._splitter = Splitter()
        self._fresh.clear()
        self.acks.clear()
