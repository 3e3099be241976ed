# SPDX-License-Identifier: BSD-3-Clause
"""Frames of a simulation in this process, from copies of its record: it is never waited for, and nothing in it changes.

``capture`` is called between two advances and copies bytes; ``frame`` makes sense of them, in the page's thread.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..autopilot import rally
from ..autopilot.fence.state import CIRCLE, CIRCLE_IN, CIRCLE_OUT
from ..autopilot.mission.location import point
from ..autopilot.mission.mission import Mission
from ..autopilot.modes import shown
from ..bridge.base_autopilot import BaseAutopilot
from ..client.commands import command_name
from ..core.geodesy import offset_ne
from ..core.mavlink import MavCmd
from ..core.vectors import Vec3
from ..simulation import Simulation
from .frame import Frame, Mark, Plan, Points, Reported, Text
from .record import Array, RecordSource

_CORNERS = 48
"""Of the outline of a circle."""
_FENCES = ("greatest height", "circle", "areas", "least height")
_GLITCH = "GPS glitch"


_REPORTED = (
    "GLOBAL_POSITION_INT.relative_alt", "LOCAL_POSITION_NED.x", "LOCAL_POSITION_NED.y", "VFR_HUD.groundspeed",
    "VFR_HUD.climb", "VFR_HUD.heading", "ATTITUDE.roll", "ATTITUDE.pitch",
)  # fmt: skip


class Captured(NamedTuple):
    """A moment of a simulation."""

    time_us: int
    record: bytes
    mission: Mission
    texts: tuple[Text, ...]


class AutopilotSource(RecordSource):
    """Vehicles with an autopilot of ours, of which one is shown.

    Args:
        simulation: whose kind, airframe, world and modes theirs are.
        fleet: the array with their records.
        index: of the one that is shown.
    """

    def __init__(self, simulation: Simulation, fleet: Array, index: int) -> None:
        self._names = names = simulation.firmware.mode_names
        modes = tuple(names[number] for number in sorted(names))
        super().__init__(simulation.kind, fleet, index, simulation.airframe.name, simulation.world, modes)
        self._plan: tuple[object, Plan] = (None, Plan())
        self._autopilot = simulation.bridge.autopilot
        self._read_reported: Callable[[], dict[str, float]] | None = None

    def frame(self, captured: Captured) -> Frame:
        """What the page shows of a moment."""
        v = self._take(captured.record)
        ap, gps = v.autopilot, v.sensors
        estimate, modes, battery = ap.estimate, ap.modes, ap.battery
        offset = self._origin()
        is_known = estimate.position_ok or estimate.origin_set
        target = self._view.set_point(v) if ap.arming.armed else None
        leg = modes.nav.current
        is_on_leg = ap.arming.armed and leg.segments > 0 and v.time_us - modes.nav.active_us < 100_000
        return Frame(
            time_us=captured.time_us,
            estimate_pos=estimate.pos + offset if is_known else None,
            estimate_q=estimate.q if estimate.attitude_ok else None,
            set_point=None if target is None else target + offset,
            leg=(leg.origin + offset, leg.origin + leg.unit * leg.length + offset) if is_on_leg else None,
            home=ap.home.pos + offset if ap.home.is_set else None,
            mode=self._names.get(int(shown(modes)), "?"), armed=bool(ap.arming.armed), ready=bool(ap.arming.prearm_ok),
            unready=self._unready(), reported=self._reported(),
            voltage=battery.voltage, current=battery.current, charge_left=battery.remaining_pct,
            satellites=int(gps.gps_satellites), fix=int(gps.gps_fix),
            failsafes=self._failsafes(), mission_current=int(modes.nav.mission_current),
            plan=self._planned(captured.mission, offset), texts=captured.texts, **self._moment(),
        )  # fmt: skip

    def _reported(self) -> Reported:
        """What its telemetry says."""
        if self._read_reported is None:
            found = self._find_signals()
            self._read_reported = found.reader(tuple(name for name in _REPORTED if name in found.names))
        height, north, east, speed, climb, heading, roll, pitch = map(self._read_reported().get, _REPORTED)
        position = None if north is None or east is None else (north, east)
        return Reported(
            height=None if height is None else height * 1e-3, position=position, speed=speed, climb=climb,
            heading=heading,
            roll=roll or 0.0, pitch=pitch or 0.0,
        )  # fmt: skip

    def _unready(self) -> tuple[str, ...]:
        arming = self._v.autopilot.arming
        if arming.armed or arming.prearm_ok or not isinstance(self._autopilot, BaseAutopilot):
            return ()
        return tuple(self._autopilot.prearm_texts(self._v))

    def _origin(self) -> Vec3:
        """The estimator's origin in the scene [m]."""
        estimate, ground = self._v.autopilot.estimate, self._v.physics.origin
        if not estimate.origin_set:
            return self._stands
        flat = offset_ne(ground.lat, ground.lon, estimate.origin_lat, estimate.origin_lon)
        return self._stands + Vec3(flat.x, flat.y, ground.alt - estimate.origin_alt)

    def _failsafes(self) -> tuple[str, ...]:
        ap = self._v.autopilot
        f = ap.modes.failsafe
        found = [name for name, on in (("radio", f.radio), ("GCS", f.gcs), ("EKF", f.ekf), (_GLITCH, f.glitch)) if on]
        if f.battery:
            found.append("battery critical" if f.battery > 1 else "battery low")
        found += [f"fence: {name}" for k, name in enumerate(_FENCES) if int(ap.fence.breached) >> k & 1]
        return tuple(found)

    def _planned(self, mission: Mission, offset: Vec3) -> Plan:
        """Mission, fences and rally points; the same object while none of them changes."""
        ap = self._v.autopilot
        fence, params = ap.fence, ap.params
        key = (
            mission, offset, ap.home.pos, fence.on, fence.shapes, bytes(fence.kind[:]), bytes(fence.north[:]),
            bytes(fence.east[:]), bytes(fence.radius[:]), params.FENCE.RADIUS, self._top(), params.RALLY.TOTAL,
            bytes(ap.rally.lat[:]), bytes(ap.rally.lon[:]), bytes(ap.rally.alt[:]),
        )  # fmt: skip
        if key != self._plan[0]:
            items, fences, rally_points = self._items(mission, offset), self._fences(offset), self._rally(offset)
            self._plan = (key, Plan(items, fences, self._top(), rally_points))
        return self._plan[1]

    def _items(self, mission: Mission, offset: Vec3) -> tuple[Mark, ...]:
        ap, marks, at = self._v.autopilot, [], self._v.autopilot.home.pos
        if not ap.estimate.origin_set:
            return ()
        for number, item in enumerate(mission.items):
            if number == 0 or item.command >= MavCmd.NAV_LAST or (item.no_location and item.z == 0.0):
                continue
            at = point(ap, item, at)
            name = command_name(item.command).removeprefix("NAV_").replace("_", " ").lower()
            marks.append(Mark(f"{number} {name}", at + offset, number))
        return tuple(marks)

    def _top(self) -> float:
        """Greatest height that the fence allows; a vehicle on the ground has no such limit [m]."""
        return float(getattr(self._v.autopilot.params.FENCE, "ALT_MAX", 1.0))

    def _fences(self, offset: Vec3) -> tuple[Points, ...]:
        ap, found = self._v.autopilot, []
        fence, home = ap.fence, ap.home.pos
        turn = np.linspace(0.0, 2.0 * math.pi, _CORNERS, endpoint=False)
        ring = np.stack([np.cos(turn), np.sin(turn)], axis=1)
        if fence.on & CIRCLE and ap.home.is_set:
            found.append(ring * float(ap.params.FENCE.RADIUS) + (home.x, home.y))
        if fence.is_placed:
            for k in range(int(fence.shapes)):
                first, count = int(fence.first[k]), int(fence.count[k])
                corners = np.stack([fence.north[first : first + count], fence.east[first : first + count]], axis=1)
                if int(fence.kind[k]) in (CIRCLE_IN, CIRCLE_OUT):
                    corners = ring * float(fence.radius[k]) + corners[0]
                found.append(corners)
        return tuple(np.asarray(each, float) + (offset.x, offset.y) for each in found)

    def _rally(self, offset: Vec3) -> tuple[Mark, ...]:
        ap = self._v.autopilot
        if not ap.estimate.origin_set:
            return ()
        count = min(int(ap.params.RALLY.TOTAL), len(ap.rally.lat))
        positions = [rally.position(ap.rally, k, ap.estimate, ap.home) + offset for k in range(count)]
        return tuple(Mark(f"rally {k}", position, k) for k, position in enumerate(positions))


class LiveSource(AutopilotSource):
    """A simulation as the page sees it. It listens to what the vehicle says to its pilot until it is closed."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        super().__init__(simulation, simulation.fleet, simulation.index)
        self._texts: list[Text] = []
        simulation.bridge.listeners.append(self)

    def said(self, severity: int, text: str) -> None:
        """The vehicle says a text (``sitl.bridge.bridge.Bridge.listeners``)."""
        self._texts.append(Text(self._simulation.time_us, severity, text))

    def reached(self, seq: int) -> None:
        """A mission's item is reached: frames show it."""

    def commanded(self, fields: Any, frame: int, is_location: bool, sender: tuple[int, int], result: int) -> None:
        """Frames show what comes of it."""

    def parameter_set(self, name: str) -> None:
        """A parameter was set: whoever wants to see it asks for it."""

    def close(self) -> None:
        """Listen no longer."""
        listeners = self._simulation.bridge.listeners
        listeners[:] = [each for each in listeners if each is not self]

    def capture(self) -> Captured:
        """The vehicle as it is now."""
        simulation = self._simulation
        texts, self._texts = tuple(self._texts), []
        return Captured(simulation.time_us, self._copy(), simulation.mission, texts)
