# SPDX-License-Identifier: BSD-3-Clause
"""Modes, set-points and default actions of the kinds of vehicles with an autopilot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from sitl.autopilot.copter.modes.alt_hold import ALT_HOLD
from sitl.autopilot.copter.modes.guided import GUIDED
from sitl.autopilot.rover.modes import guided as rover
from sitl.autopilot.rover.modes.manual import MANUAL
from sitl.vehicles import Airframe

from ..actions import Action, Continuous, Discrete
from ..mavlink import px4
from ..mavlink.setpoints import COPTER, ROVER, Encode
from ..options import EnvOptionError
from ..setpoints import ATTITUDE, POSITION, RC_OVERRIDE, VELOCITY, Setpoint
from .robot import Volume

Rows = Mapping[str, tuple[float, ...]]
Limits = tuple[tuple[float, ...], tuple[float, ...], tuple[int, ...]]
"""Low limits, high limits, and the columns of the set-point that they belong to."""


@dataclass(frozen=True)
class Kind:
    """A kind of vehicle."""

    setpoints: tuple[Setpoint, ...]
    modes: Mapping[str, int]
    """Flight mode for each kind of set-point."""
    guided: int
    encode: Mapping[str, Encode]
    tick: float
    """Period of its autopilot's loop [s]."""
    crash_range: float
    """Range below which a reading is a crash, as in the paper [m]."""
    discrete: Mapping[str, Rows]
    continuous: Mapping[str, Limits]

    def action(self, form: str, setpoint: Setpoint) -> Action:
        """The default actions of a form, "discrete" or "continuous", for a kind of set-point."""
        if form == "discrete":
            if setpoint.name not in self.discrete:
                allowed = ", ".join(self.discrete)
                raise EnvOptionError(f"no discrete actions for setpoint {setpoint.name!r}; there are for {allowed}")
            return Discrete(setpoint, self.discrete[setpoint.name])
        return Continuous(setpoint, *self.continuous[setpoint.name])


def volume(airframe: Airframe, climbs: float) -> Volume:
    """The volume of a vehicle, extended upwards by the height that it climbs [m]."""
    reach = max(abs(x) for x in airframe.value("contact_along")) if airframe.value("contact_discs") > 1 else 0.0
    return Volume(
        float(reach + airframe.value("contact_radius")),
        0.0 - float(airframe.value("contact_bottom")),
        float(airframe.value("contact_top")) + climbs,
    )


def pulses(one: int, two: int, three: int) -> tuple[float, ...]:
    """A row of RC_OVERRIDE: channels 1 to 3 [us], the others released."""
    return (one, two, three, 0.0, 0.0, 0.0, 0.0, 0.0)


FAR = 10_000.0

COPTER_KIND = Kind(
    setpoints=(VELOCITY, RC_OVERRIDE, POSITION, ATTITUDE),
    modes={"rc": ALT_HOLD, "velocity": GUIDED, "position": GUIDED, "attitude": GUIDED},
    guided=GUIDED,
    encode=COPTER,
    tick=0.0025,
    crash_range=0.2,
    discrete={
        "rc": {  # the paper's
            "forward": pulses(1500, 1400, 1500),
            "left": pulses(1400, 1500, 1500),
            "right": pulses(1600, 1500, 1500),
        },
        "velocity": {
            "forward": (0.5, 0.0, 0.0, 0.0),
            "left": (0.2, 0.0, 0.0, 0.6),
            "right": (0.2, 0.0, 0.0, -0.6),
        },
    },
    continuous={
        "rc": ((1300, 1300, 1300, 1300), (1700, 1700, 1700, 1700), (0, 1, 2, 3)),
        "velocity": ((-1.0, -1.0, -0.5, -1.0), (1.0, 1.0, 0.5, 1.0), (0, 1, 2, 3)),
        "position": ((-FAR, -FAR, 0.5, -3.2), (FAR, FAR, 100.0, 3.2), (0, 1, 2, 3)),
        "attitude": ((-0.2, -0.2, -1.0, -1.0), (0.2, 0.2, 1.0, 1.0), (0, 1, 2, 3)),
    },
)
ROVER_KIND = Kind(
    setpoints=(VELOCITY, RC_OVERRIDE, POSITION, ATTITUDE),
    modes={"rc": MANUAL, "velocity": rover.GUIDED, "position": rover.GUIDED, "attitude": rover.GUIDED},
    guided=rover.GUIDED,
    encode=ROVER,
    tick=0.02,
    crash_range=1.5,
    discrete={
        "rc": {  # the paper's
            "forward": pulses(1500, 0, 1900),
            "left": pulses(1100, 0, 1900),
            "right": pulses(1900, 0, 1900),
        },
        "velocity": {
            "forward": (1.2, 0.0, 0.0, 0.0),
            "left": (1.0, 0.0, 0.0, 0.45),
            "right": (1.0, 0.0, 0.0, -0.45),
        },
    },
    continuous={
        "rc": ((1100, 1100), (1900, 1900), (0, 2)),
        "velocity": ((-1.2, -0.6), (1.2, 0.6), (0, 3)),
        "position": ((-FAR, -FAR), (FAR, FAR), (0, 1)),
        "attitude": ((-0.6, -1.0), (0.6, 1.0), (2, 3)),
    },
)
KINDS = {"copter": COPTER_KIND, "rover": ROVER_KIND}
PX4_KIND = replace(
    COPTER_KIND,
    setpoints=(VELOCITY, POSITION),
    modes={"velocity": px4.OFFBOARD, "position": px4.OFFBOARD},
    guided=px4.OFFBOARD,
    encode=px4.COPTER,
    discrete={"velocity": COPTER_KIND.discrete["velocity"]},
    continuous={name: COPTER_KIND.continuous[name] for name in ("velocity", "position")},
)
"""A copter that PX4 flies: it has no climb rate in attitude set-points, and takes sticks in modes of its own."""
