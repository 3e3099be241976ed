# SPDX-License-Identifier: BSD-3-Clause
"""A test pilot of any vehicle: commands it by MAVLink bytes like any client, and judges by the simulator's truth."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from benchmarks.recorded.pilot import ARM, Pilot
from sitl.autopilot.mission.item import MissionItem
from sitl.autopilot.modes import shown
from sitl.client import MissionRefusedError
from sitl.core.geodesy import add_offset
from sitl.core.mavlink import MavCmd, MavFrame
from sitl.physics.native import truth
from sitl.simulation import Core, Simulation

MIDDLE, LOW = 1500, 1000
KEEP = 65535


class Item(NamedTuple):
    """A mission item; the place in metres north and east of the origin, None for none."""

    command: int
    place: tuple[float, float] | None = None
    z: float = 0.0
    p: tuple[float, ...] = ()
    frame: int = MavFrame.GLOBAL_RELATIVE_ALT_INT


@cache
def _floats(dtype: np.dtype[Any]) -> dict[str, np.ndarray]:
    """Type of number -> where a record has such numbers, within nested records, too, counted in their size."""
    found: dict[str, list[int]] = {}

    def look(at: np.dtype[Any], offset: int) -> None:
        if at.subdtype is not None:
            item, shape = at.subdtype
            for k in range(math.prod(shape)):
                look(item, offset + k * item.itemsize)
        elif at.names:
            for name in at.names:
                look(at.fields[name][0], offset + at.fields[name][1])
        elif at.kind == "f":
            assert offset % at.itemsize == 0
            found.setdefault(at.str, []).append(offset // at.itemsize)

    look(dtype, 0)
    return {code: np.array(places) for code, places in found.items()}


def is_finite(value: Any) -> bool:
    """Whether all numbers are, of a record, an array or a row of records, within nested records, too."""
    if not value.dtype.names:
        return value.dtype.kind != "f" or bool(np.isfinite(value).all())
    if value.ndim:
        return all(map(is_finite, value))
    memory = value.tobytes()
    return all(
        np.isfinite(np.frombuffer(memory, code, len(memory) // np.dtype(code).itemsize)[places]).all()
        for code, places in _floats(value.dtype).items()
    )


class Witness(Pilot):
    """Commands one vehicle and keeps, at 25 Hz, where it truly was."""

    def __init__(self, core: Core, frame: str, *, seed: int = 0, estimator: str = "ekf", **params: float) -> None:
        self.track: list[tuple[float, ...]] = []
        self._pulses: tuple[int, ...] | None = None
        super().__init__(Simulation(frame, seed=seed, estimator=estimator, core=core, params=params))

    # ------------------------------------------------------------------ what is true

    @property
    def ap(self) -> Any:
        """The autopilot's record."""
        return self.simulation.v.autopilot

    @property
    def mode(self) -> int:
        """Custom mode number, as clients are told it."""
        return int(shown(self.ap.modes))

    @property
    def pos(self) -> np.ndarray:
        """True position, NED from home [m]."""
        return np.array(truth.read(self.simulation.v).pos)

    @property
    def vel(self) -> np.ndarray:
        """True velocity NED [m/s]."""
        return np.array(truth.read(self.simulation.v).vel)

    @property
    def euler(self) -> np.ndarray:
        """True roll, pitch, yaw [deg]."""
        return np.degrees(truth.read(self.simulation.v).euler)

    def since(self, time: float) -> np.ndarray:
        """Rows (time, position, velocity, roll, pitch, yaw [deg]) since a time [s]."""
        rows = np.array(self.track)
        return rows[rows[:, 0] > time]

    def said(self, text: str) -> bool:
        """Whether a status text had this in it."""
        return any(text in said for _, _, said in self.texts)

    def not_finite(self, *names: str) -> list[str]:
        """What is no number: of the truth, and in these parts of the autopilot's record."""
        found = [] if np.isfinite(self.track[-1]).all() else ["truth"]
        for name in names:
            record = self.simulation.fleet["autopilot"][name][0]
            if not is_finite(record):
                found += [f"{name}.{field}" for field in record.dtype.names if not is_finite(record[field])]
        return found

    # ------------------------------------------------------------------ commands

    def step(self, stop_us: int | None = None) -> None:
        """As a pilot does; sends the sticks that are held, at 25 Hz."""
        if self._pulses is not None:
            self.override(*self._pulses)
        super().step(stop_us)
        self._note()

    def _note(self) -> None:
        t = truth.read(self.simulation.v)
        self.track.append((self.now, *t.pos, *t.vel, *np.degrees(t.euler)))

    def set_mode(self, number: int) -> bool:
        """DO_SET_MODE; whether the vehicle is in that mode then."""
        self.send_command("DO_SET_MODE", 1, number)
        self.fly(0.1)
        return self.mode == number

    def ask(self, number: int, *params: float, wait: float = 0.1) -> int:
        """Send a command; its MAV_RESULT."""
        self.acks.clear()
        self.send_command(number, *params)
        self.fly(wait)
        return dict(self.acks)[number]

    def set_parameter(self, name: str, value: float) -> None:
        """PARAM_SET."""
        self.send(
            "PARAM_SET", param_id=name.encode(), param_value=value,
            param_type=9,
        )  # fmt: skip
        self.fly(0.05)
        assert math.isclose(getattr(self.ap.params, name), value, rel_tol=1e-6), name

    def target(self, mask: int, frame: int = 1, **fields: float) -> None:
        """SET_POSITION_TARGET_LOCAL_NED."""
        self.send(
            "SET_POSITION_TARGET_LOCAL_NED", coordinate_frame=frame,
            type_mask=mask, **fields,
        )  # fmt: skip

    def stream(self, seconds: float, mask: int, frame: int = 1, **fields: float) -> None:
        """The same at 10 Hz."""
        for _ in range(round(seconds * 10)):
            self.target(mask, frame, **fields)
            self.fly(0.1)

    def disarm_result(self) -> int:
        """MAV_RESULT of disarming now."""
        return self.ask(ARM, 0)

    # ------------------------------------------------------------------ sticks

    def override(self, *pulses: int) -> None:
        """One RC_CHANNELS_OVERRIDE; channels not given are left alone."""
        channels = {f"chan{k + 1}_raw": p for k, p in enumerate((*pulses, *[KEEP] * (8 - len(pulses))))}
        self.send("RC_CHANNELS_OVERRIDE", **channels)

    def let_go(self) -> None:
        """Send no sticks any more."""
        self._pulses = None

    # ------------------------------------------------------------------ missions

    def lat_lon(self, north: float, east: float) -> tuple[int, int]:
        """A place, metres from the origin [degE7]."""
        estimate = self.ap.estimate
        lat, lon = add_offset(int(estimate.origin_lat), int(estimate.origin_lon), north, east)
        return round(lat), round(lon)

    def upload(self, *items: Item) -> int:
        """Upload items (home is put in front) by the mission protocol; the MAV_MISSION_RESULT."""
        home = Item(MavCmd.NAV_WAYPOINT, (0.0, 0.0), 584.0, frame=MavFrame.GLOBAL_INT)
        try:
            self.transfer([self._mission_item(item) for item in (home, *items)])
        except MissionRefusedError as error:
            return error.result
        return 0

    def _mission_item(self, item: Item) -> MissionItem:
        x, y = self.lat_lon(*item.place) if item.place else (0, 0)
        return MissionItem(item.command, item.frame, *(*item.p, 0.0, 0.0, 0.0, 0.0)[:4], x=x, y=y, z=item.z)

    def reached_at(self, seq: int) -> float:
        """When MISSION_ITEM_REACHED first came for an item [s]; NaN when it did not."""
        return next((time for time, number in self.telemetry.reached if number == seq), math.nan)


class ByDice(Witness):
    """Acts by dice; mixed into a test pilot of some vehicle."""

    def __init__(self, core: Core, frame: str, seed: int) -> None:
        super().__init__(core, frame, seed=seed)
        self.dice = random.Random(seed)
        self.log: list[str] = []

    def do_one_of(self, deeds: Sequence[Callable[[], None]]) -> None:
        """One of these, noted."""
        deed = self.dice.choice(deeds)
        self.log.append(f"{self.now:.1f} {deed.__name__}")
        deed()

    def story(self) -> str:
        """What was done last."""
        return f"at {self.now:.1f} s in mode {self.mode}: {self.log[-12:]} {self.texts[-4:]} {self.track[-1]}"
