# SPDX-License-Identifier: BSD-3-Clause
"""Random legal commands: finite, known modes, an estimate near the truth, and HOLD always stops."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.recorded.pilot import ARM
from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.drives.rover_driver import AIRFRAMES, AUTO, GUIDED, HOLD, MODES, VELOCITY, Driver
from tests.pilots.witness import ByDice, Item

ALL = pytest.mark.parametrize("frame", AIRFRAMES)


MASKS = (0xDF8, 0xDC7, 0x9C7, 0x5C7, 0x9FF, 0x5FF, 0xDC0, 0xFFF, 0x1C7)
"""Place; velocity; with yaw, with yaw rate; yaw, yaw rate alone; place and velocity; nothing; both yaws."""
MISSION_CURRENT, REBOOT, MOTOR_TEST = 224, 246, 209
OFF = 3.0
"""Estimate to truth [m] while it stands; GPS comes late."""


class RoverSoak(ByDice, Driver):
    """Drives by dice, on a place that it crosses in half a minute."""

    @property
    def size(self) -> float:
        """Half the width of that place [m]."""
        return 10.0 * max(self.cruise, self.radius)

    def check(self) -> None:
        """What must hold at any time."""
        self.check_numbers()
        off = np.linalg.norm(np.array(self.ap.estimate.pos)[:2] - self.place)
        assert off < OFF + 0.2 * abs(self.speed), (off, self.story())

    def check_numbers(self) -> None:
        """A known mode, finite numbers, level on the ground, no faster than it can be, pulses within their range."""
        assert self.mode in MODES, self.story()
        broken = self.not_finite("estimate", "control", "modes")
        assert not broken, (broken, self.story())
        t = self.track[-1]
        assert t[3] == 0.0 and t[7] == t[8] == 0.0, self.story()
        top = float(self.simulation.v.physics.airframe.speed_max)
        assert math.hypot(t[4], t[5]) < 1.5 * top, self.story()
        pulses = [int(p) for p in self.simulation.v.actuators.pwm[:4]]
        assert all(p == 0 or 1000 <= p <= 2000 for p in pulses), (pulses, self.story())

    def go(self, seconds: float) -> None:
        """Let the dice act every few seconds; between rounds it must come home, and stop where it is told to."""
        self.ready()
        self.arm()
        stop = self.now + seconds
        while self.now < stop:
            for _ in range(self.dice.randint(5, 25)):
                self.act()
                for _ in range(self.dice.randint(1, 30)):
                    self.fly(0.2)
                    self.check()
            self.rest()

    def rest(self) -> None:
        """HOLD stops it from whatever it did; then it is armed in GUIDED and takes a set-point again."""
        self.log.append(f"{self.now:.1f} rest")
        self.let_go()
        self.fly(3.5)  # overrides are forgotten
        assert self.set_mode(HOLD), self.story()
        assert self.fly(40.0, self.stands), self.story()
        if np.hypot(*self.place) > 1000.0 or self.ap.battery.remaining_pct < 60.0:
            self.start_afresh()
        assert self.set_mode(GUIDED), self.story()
        if not self.armed:
            self.arm()
        before = self.place
        self.stream(6.0, VELOCITY, vx=self.cruise)
        assert np.hypot(*(self.place - before)) > 1.5 * self.cruise, self.story()
        self.check()

    def start_afresh(self) -> None:
        """Reboot, which puts it home with a full battery."""
        if self.armed:
            assert self.disarm_result() == 0, self.story()
            self.fly(1.1)
        assert self.ask(REBOOT, 1) == 0, self.story()
        self.ask_for_telemetry()
        self.telemetry.has_position = self.telemetry.checked = False
        self.ready()
        self.arm()

    # ------------------------------------------------------------------ deeds

    def act(self) -> None:
        """One random deed."""
        self.do_one_of(
            (self.change_mode, self.change_mode, self.set_target, self.set_target, self.stick, self.command,
             self.load_mission, self.set_attitude, self.watch)
        )  # fmt: skip

    def watch(self) -> None:
        """Leave it alone for a while."""
        for _ in range(self.dice.randint(10, 60)):
            self.fly(1.0)
            self.check()

    def change_mode(self) -> None:
        mode = self.dice.choice(MODES)
        self.log.append(f"mode {mode}")
        self.set_mode(mode)

    def set_target(self) -> None:
        d, v, far = self.dice, self.cruise, self.size
        if self.mode != GUIDED and d.random() < 0.8:
            self.set_mode(GUIDED)
        self.target(
            d.choice(MASKS), d.choice((1, 7, 8, 9)), x=d.uniform(-far, far), y=d.uniform(-far, far), z=d.uniform(-5, 5),
            vx=d.uniform(-v, v), vy=d.uniform(-v, v), vz=d.uniform(-1, 1), yaw=d.uniform(-3, 3),
            yaw_rate=d.uniform(-1, 1),
        )  # fmt: skip

    def set_attitude(self) -> None:
        d = self.dice
        half = 0.5 * d.uniform(-3.0, 3.0)
        self.send(
            "SET_ATTITUDE_TARGET", type_mask=d.choice((7, 3, 0x83)),
            q=[math.cos(half), 0.0, 0.0, math.sin(half)], thrust=d.uniform(-1, 1), body_yaw_rate=d.uniform(-1, 1),
        )  # fmt: skip

    def stick(self) -> None:
        d = self.dice
        self.hold(d.randint(1100, 1900), d.randint(1300, 1700))
        self.fly(d.uniform(0.2, 3.0))
        if d.random() < 0.5:
            self.let_go()
        else:
            self.hold()

    def command(self) -> None:
        d, v = self.dice, self.cruise
        number, params = d.choice(
            ((MavCmd.DO_CHANGE_SPEED, (d.choice((0, 1, 2)), d.uniform(-0.5, 2.0 * v))),
             (MavCmd.DO_SET_REVERSE, (d.choice((0, 1)),)),
             (ARM, (d.choice((0, 1, 1)),)),
             (MISSION_CURRENT, (d.randint(0, 5),)),
             (MOTOR_TEST, (d.randint(0, 5), 0, d.uniform(-20, 20), d.uniform(0, 2))),
             (192, (-1, 0, 0, 0, d.uniform(-1, 1), 0, 0)),
             (300, (0, 0)))
        )  # fmt: skip
        self.log.append(f"{number} {params}")
        self.send_command(number, *params)

    def load_mission(self) -> None:
        items = [Item(MavCmd.NAV_WAYPOINT, (self.dice.uniform(0.0, self.size), 0.0))]
        count = self.dice.randint(1, 8)
        items += [self.item(1 + count) for _ in range(count)]
        assert self.upload(*items) == 0, self.story()
        if self.dice.random() < 0.5:
            self.set_mode(AUTO)

    def item(self, last: int) -> Item:
        """Any item of a mission; ``last``: number of its last one."""
        d, v, far = self.dice, self.cruise, self.size
        place = (d.uniform(-far, far), d.uniform(-far, far))
        return d.choice(
            (Item(MavCmd.NAV_WAYPOINT, place), Item(MavCmd.NAV_WAYPOINT, place),
             Item(MavCmd.NAV_WAYPOINT, place, 0, (d.randint(0, 3),)),
             Item(MavCmd.NAV_WAYPOINT, (0.0, 0.0)), Item(MavCmd.NAV_LOITER_TIME, place, 0, (d.randint(0, 5),)),
             Item(MavCmd.NAV_LOITER_TURNS, place, 0, (d.randint(1, 2), 0, 0.3 * d.uniform(-far, far))),
             Item(MavCmd.NAV_LOITER_UNLIM, place), Item(MavCmd.NAV_DELAY, None, 0, (d.randint(0, 4), -1, -1, -1)),
             Item(MavCmd.DO_CHANGE_SPEED, None, 0, (1, d.uniform(0.1, 2 * v))),
             Item(MavCmd.NAV_SET_YAW_SPEED, None, 0, (d.uniform(0, 360), d.uniform(-v, v), d.choice((0, 1)))),
             Item(MavCmd.CONDITION_DELAY, None, 0, (d.uniform(0, 5),)),
             Item(MavCmd.CONDITION_DISTANCE, None, 0, (d.uniform(0, far),)),
             Item(MavCmd.DO_SET_REVERSE, None, 0, (d.choice((0, 1)),)), Item(MavCmd.DO_SET_ROI_LOCATION, place),
             Item(MavCmd.NAV_GUIDED_ENABLE, None, 0, (d.choice((0, 1)),)),
             Item(MavCmd.DO_GUIDED_LIMITS, None, 0, (d.uniform(1, 9),)),
             Item(MavCmd.DO_JUMP, None, 0, (min(d.randint(1, 3), last), d.randint(1, 2))),
             Item(MavCmd.NAV_RETURN_TO_LAUNCH))
        )  # fmt: skip


TUNABLE = {
    "WP_RADIUS": (0, 5), "WP_ACCEL": (0, 3), "WP_JERK": (0, 3), "TURN_RADIUS": (0, 3), "ATC_TURN_MAX_G": (1, 2),
    "ATC_STR_RAT_MAX": (0, 180), "ATC_ACCEL_MAX": (0, 3), "ATC_DECEL_MAX": (0, 3), "ATC_BRAKE": (0, 1),
    "PSC_POS_P": (0, 2), "PSC_VEL_P": (0, 3), "LOIT_TYPE": (0, 2), "LOIT_RADIUS": (0, 5), "CIRC_RADIUS": (0, 30),
    "CIRC_DIR": (0, 1), "SIMPLE_TYPE": (0, 1), "STICK_MIXING": (0, 1), "MIS_DONE_BEHAVE": (0, 3),
    "PILOT_STEER_TYPE": (0, 3), "GUID_OPTIONS": (0, 64), "WP_PIVOT_ANGLE": (0, 90), "WP_PIVOT_RATE": (0, 90),
    "RTL_SPEED": (0, 2), "MOT_SLEWRATE": (0, 200), "FS_ACTION": (0, 4), "FS_CRASH_CHECK": (0, 2),
    "ACRO_TURN_RATE": (0, 180), "SRTL_ACCURACY": (0, 4),
}  # fmt: skip
"""Parameters that a driver may change on the way, and between what; before a rest they are as they were."""


class RoverChaos(RoverSoak):
    """Drives by dice while things fail and parameters change."""

    def __init__(self, core: Core, frame: str, seed: int) -> None:
        super().__init__(core, frame, seed)
        self._before: dict[str, float] = {}

    def check(self) -> None:
        """As in a soak; without GPS the estimate may leave the truth, but hardly in heading."""
        self.check_numbers()
        off = math.degrees(float(self.ap.estimate.euler[2])) - self.heading
        assert abs((off + 180.0) % 360.0 - 180.0) < 15.0, (off, self.story())

    def act(self) -> None:
        """A fault or a parameter now and then."""
        if self.dice.random() < 0.7:
            super().act()
        else:
            self.do_one_of((self.gps, self.transmitter, self.ground_station, self.tune, self.tune))

    def gps(self) -> None:
        self.set_parameter("SIM_GPS1_ENABLE", self.dice.choice((0, 1)))

    def transmitter(self) -> None:
        self.set_parameter("SIM_RC_FAIL", self.dice.choice((0, 1)))

    def ground_station(self) -> None:
        self.send("HEARTBEAT", type=6, autopilot=8, mavlink_version=3)
        self.set_parameter("FS_GCS_ENABLE", self.dice.choice((0, 1, 2)))

    def tune(self) -> None:
        name = self.dice.choice(sorted(TUNABLE))
        self._before.setdefault(name, float(getattr(self.ap.params, name)))
        value = self.dice.randint(*TUNABLE[name])
        self.log.append(f"{name} {value}")
        self.set_parameter(name, value)

    def rest(self) -> None:
        """Everything works again; the estimate is back at the truth by the end."""
        for name, value in (("SIM_GPS1_ENABLE", 1), ("SIM_RC_FAIL", 0), ("FS_GCS_ENABLE", 0), *self._before.items()):
            self.set_parameter(name, value)
        self._before.clear()
        self.let_go()
        self.set_mode(HOLD)
        self.fly(30.0)
        super().rest()
        assert np.linalg.norm(np.array(self.ap.estimate.pos)[:2] - self.place) < 6.0, self.story()


@pytest.mark.parametrize("kind", [RoverSoak, RoverChaos])
@pytest.mark.parametrize("frame", ["erle_rover", "skid_rover"])
def test_two_minutes(core: Core, frame: str, kind: type[RoverSoak]) -> None:
    kind(core, frame, 0).go(120.0)


@pytest.mark.slow
@ALL
@pytest.mark.parametrize("kind", [RoverSoak, RoverChaos])
def test_twenty_minutes(core: Core, frame: str, kind: type[RoverSoak]) -> None:
    kind(core, frame, 1000).go(1200.0)


@pytest.mark.slow
def test_a_soak_repeats_to_the_bit(core: Core) -> None:
    drives = []
    for _ in range(2):
        soak = RoverSoak(core, "erle_rover", 7)
        soak.go(120.0)
        drives.append(soak.simulation.fleet.tobytes())
    assert drives[0] == drives[1]
