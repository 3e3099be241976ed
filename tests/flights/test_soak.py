# SPDX-License-Identifier: BSD-3-Clause
"""Random legal commands: finite, known modes, an estimate near the truth, and LAND always lands."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.recorded.pilot import ARM
from sitl.core.mavlink import MavCmd
from sitl.simulation import Core
from tests.flights.aviator import AIRFRAMES, ALT_HOLD, AUTO, BRAKE, GUIDED, LAND, LOITER, RTL, STABILIZE, Aviator, Item
from tests.pilots.witness import LOW, MIDDLE, ByDice

MODES = (STABILIZE, ALT_HOLD, AUTO, GUIDED, LOITER, RTL, LAND, BRAKE)
CHANGE_SPEED, PAUSE, MISSION_CURRENT, REBOOT = 178, 193, 224, 246
CEILING = 80.0
"""The pilot lands from here [m]."""
MASKS = (0xDF8, 0xDC7, 0xC3F, 0xDC0, 0xC00, 0xC07, 0x9F8, 0x5C7, 0x9C7, 0x5F8)
"""Position; velocity; acceleration; combinations of them; with yaw, with yaw rate."""


class Soak(ByDice, Aviator):
    """Flies by dice."""

    def __init__(self, core: Core, frame: str, seed: int) -> None:
        super().__init__(core, frame, seed)
        self.landings = self.crashes = 0

    def check(self) -> None:
        """What must hold at any time."""
        assert self.mode in MODES, self.story()
        self.check_numbers()
        off = np.linalg.norm(np.array(self.ap.estimate.pos) - self.pos)
        assert off < 5.0, (off, self.story())

    def check_numbers(self) -> None:
        """Finite, above the ground, neither too fast nor overturned."""
        t = self.track[-1]
        broken = self.not_finite("estimate", "control", "modes")
        assert not broken, (broken, self.story())
        assert t[3] < 0.01, self.story()
        assert math.hypot(t[4], t[5], t[6]) < 30.0, self.story()
        assert max(abs(t[7]), abs(t[8])) < 60.0 or self.height < 1.0, self.story()

    def go(self, seconds: float) -> None:
        """Let the dice act every few seconds; land in between and at the end."""
        self.ready()
        stop = self.now + seconds
        while self.now < stop:
            self.lift()
            for _ in range(self.dice.randint(5, 25)):
                self.act()
                for _ in range(self.dice.randint(1, 40)):
                    self.fly(0.2)
                    self.check()
                if self.height > CEILING:
                    break
            self.land()

    def lift(self) -> None:
        """Arm and take off in GUIDED or AUTO."""
        self.hold(throttle=LOW)
        self.fly(1.0)
        assert self.set_mode(GUIDED), self.story()
        self.arm()
        self.hold()
        self.fly(0.5)
        self.take_off(self.dice.uniform(3.0, 20.0))
        self.check()

    def land(self) -> None:
        """LAND must end on the ground, disarmed, from wherever this is."""
        self.log.append(f"{self.now:.1f} land")
        self.set_parameter("LAND_SPEED_HIGH", 0)
        self.hold()
        if self.armed and not self.set_mode(LAND):
            raise AssertionError(f"LAND refused {self.story()}")
        self.fly(60.0 + 2.0 * self.height, lambda: not self.armed)
        assert not self.armed, self.story()
        self.fly(3.0)
        assert self.on_ground, self.story()
        self.landings += 1
        if max(abs(self.euler[:2])) > 5.0 or self.ap.battery.remaining_pct < 60.0:
            self.set_upright()
        self.set_parameter("SIM_WIND_SPD", 0)
        self.set_parameter("SIM_WIND_TURB", 0)

    def set_upright(self) -> None:
        """A vehicle that was flown into the ground, or whose battery is low: reboot, which starts it afresh at home."""
        self.crashes += 1 if max(abs(self.euler[:2])) > 5.0 else 0
        assert self.ask(REBOOT, 1) == 0, self.story()
        self.let_go()
        self.ask_for_telemetry()
        self.telemetry.has_position = self.telemetry.checked = False
        self.ready()

    def act(self) -> None:
        """One random deed."""
        self.do_one_of(
            (self.change_mode, self.change_mode, self.set_target, self.set_target, self.stick, self.command,
             self.load_mission, self.weather, self.set_attitude)
        )  # fmt: skip

    def change_mode(self) -> None:
        mode = self.dice.choice(MODES)
        if self._pulses is None or (mode == STABILIZE and self.mode != STABILIZE):
            self.hold(throttle=1520)
            self.fly(0.3)
        self.log.append(f"mode {mode}")
        self.set_mode(mode)

    def set_target(self) -> None:
        d = self.dice
        if self.mode != GUIDED:
            self.set_mode(GUIDED)
        self.send(
            "SET_POSITION_TARGET_LOCAL_NED", target_system=1, target_component=1,
            coordinate_frame=d.choice((1, 7, 8, 9)), type_mask=d.choice(MASKS), x=d.uniform(-60, 60),
            y=d.uniform(-60, 60), z=d.uniform(-25, -4), vx=d.uniform(-8, 8), vy=d.uniform(-8, 8),
            vz=d.uniform(-1.5, 1), afx=d.uniform(-2, 2), afy=d.uniform(-2, 2), afz=d.uniform(-0.5, 0.3),
            yaw=d.uniform(-3, 3), yaw_rate=d.uniform(-1, 1),
        )  # fmt: skip

    def set_attitude(self) -> None:
        d = self.dice
        half = 0.5 * d.uniform(-0.4, 0.4)
        axis = d.uniform(-3.0, 3.0)
        q = [math.cos(half), math.sin(half) * math.cos(axis), math.sin(half) * math.sin(axis), 0.0]
        self.send("SET_ATTITUDE_TARGET", type_mask=7, q=q, thrust=d.uniform(0.3, 0.7))

    def stick(self) -> None:
        d = self.dice
        throttle = d.randint(1450, 1600) if self.mode == STABILIZE else d.randint(1200, 1800)
        self.hold(d.randint(1100, 1900), d.randint(1100, 1900), throttle, d.randint(1100, 1900))
        self.fly(d.uniform(0.2, 3.0))
        self.hold(throttle=1520)

    def command(self) -> None:
        d = self.dice
        number, params = d.choice(
            ((MavCmd.CONDITION_YAW, (d.uniform(0, 360), d.uniform(0, 60), d.choice((-1, 0, 1)), d.choice((0, 1)))),
             (CHANGE_SPEED, (d.choice((0, 1, 2, 3)), d.uniform(0.5, 8))),
             (PAUSE, (d.choice((0, 1)),)),
             (MavCmd.NAV_TAKEOFF, (0, 0, 0, 0, 0, 0, d.uniform(1, 20))),
             (ARM, (d.choice((0, 1)),)),
             (MISSION_CURRENT, (d.randint(0, 5),)),
             (300, (0, 0)))
        )  # fmt: skip
        self.log.append(f"{number} {params}")
        self.send_command(number, *params)

    def weather(self) -> None:
        self.set_parameter("SIM_WIND_SPD", self.dice.uniform(0, 6))
        self.set_parameter("SIM_WIND_DIR", self.dice.uniform(0, 359))
        self.set_parameter("SIM_WIND_TURB", self.dice.uniform(0, 1.5))

    def load_mission(self) -> None:
        count = self.dice.randint(1, 8)
        items = [Item(MavCmd.NAV_TAKEOFF, None, 8.0), *(self.item(1 + count) for _ in range(count))]
        assert self.upload(*items) == 0, self.story()

    def item(self, last: int) -> Item:
        """Any item of a mission; ``last``: number of its last one."""
        d = self.dice
        place = (d.uniform(-50, 50), d.uniform(-50, 50))
        height = d.uniform(3, 25)
        return d.choice(
            (Item(MavCmd.NAV_WAYPOINT, place, height), Item(MavCmd.NAV_WAYPOINT, place, height, (d.randint(0, 3),)),
             Item(MavCmd.NAV_LOITER_TIME, place, height, (d.randint(0, 5),)),
             Item(MavCmd.NAV_LOITER_TURNS, place, height, (d.randint(1, 2), 0, d.uniform(-12, 12), 1)),
             Item(MavCmd.NAV_DELAY, None, 0, (d.randint(0, 4), -1, -1, -1)),
             Item(MavCmd.DO_CHANGE_SPEED, None, 0, (1, d.uniform(1, 10), -1)),
             Item(MavCmd.CONDITION_YAW, None, 0, (d.uniform(0, 360), d.uniform(10, 60), d.choice((-1, 0, 1)), 0)),
             Item(MavCmd.CONDITION_DELAY, None, 0, (d.uniform(0, 5),)),
             Item(MavCmd.DO_SET_ROI_LOCATION, place, 0), Item(MavCmd.DO_SET_ROI_NONE),
             Item(MavCmd.DO_JUMP, None, 0, (min(d.randint(1, 3), last), d.randint(1, 2))),
             Item(MavCmd.NAV_RETURN_TO_LAUNCH), Item(MavCmd.NAV_LAND), Item(MavCmd.NAV_LAND, place))
        )  # fmt: skip


TUNABLE = {
    "WPNAV_SPEED": (50, 1500), "WPNAV_ACCEL": (100, 400), "WPNAV_RADIUS": (20, 800), "WPNAV_SPEED_UP": (50, 500),
    "WPNAV_SPEED_DN": (50, 300), "RTL_ALT": (0, 4000), "LAND_SPEED": (30, 100), "ANGLE_MAX": (2000, 4500),
    "LOIT_SPEED": (100, 1500), "PILOT_SPEED_UP": (50, 500), "WP_YAW_BEHAVIOR": (0, 3), "GUID_TIMEOUT": (1, 5),
}  # fmt: skip
"""Parameters that a pilot may change in flight, and between what."""


class Chaos(Soak):
    """Flies by dice while things fail."""

    def check(self) -> None:
        """As in a soak; without GPS the estimate may leave the truth, but hardly in attitude."""
        assert self.mode in (0, 2, 3, 4, 5, 6, 9, 17), self.story()
        self.check_numbers()
        off = np.degrees(np.array(self.ap.estimate.euler)) - self.euler
        off = (off + 180.0) % 360.0 - 180.0
        assert np.abs(off).max() < 12.0 or self.height < 0.5, (off, self.story())

    def act(self) -> None:
        """A fault or a parameter now and then."""
        if self.dice.random() < 0.75:
            super().act()
            return
        self.do_one_of((self.gps, self.transmitter, self.ground_station, self.weather, self.tune))

    def set_target(self) -> None:
        if self.mode == GUIDED or self.set_mode(GUIDED):
            super().set_target()

    def gps(self) -> None:
        self.set_parameter("SIM_GPS1_ENABLE", self.dice.choice((0, 1)))

    def transmitter(self) -> None:
        fails = self.dice.choice((0, 1))
        self.set_parameter("SIM_RC_FAIL", fails)
        if fails:
            self.let_go()

    def ground_station(self) -> None:
        self.send("HEARTBEAT", type=6, autopilot=8, mavlink_version=3)
        self.set_parameter("FS_GCS_ENABLE", self.dice.choice((0, 1, 5, 7)))

    def tune(self) -> None:
        name = self.dice.choice(sorted(TUNABLE))
        self.set_parameter(name, self.dice.randint(*TUNABLE[name]))

    def land(self) -> None:
        """Everything works again; the estimate is back at the truth by the end."""
        for name, value in (("SIM_GPS1_ENABLE", 1), ("SIM_RC_FAIL", 0), ("FS_GCS_ENABLE", 0), ("WPNAV_SPEED_DN", 150)):
            self.set_parameter(name, value)
        self.hold(throttle=MIDDLE)
        self.fly(12.0)
        super().land()
        assert np.linalg.norm(np.array(self.ap.estimate.pos) - self.pos) < 6.0, self.story()


@pytest.mark.parametrize("frame", AIRFRAMES)
@pytest.mark.parametrize("seed", range(3))
def test_ten_minutes(core: Core, frame: str, seed: int) -> None:
    soak = Soak(core, frame, seed)
    soak.go(600.0)
    assert soak.landings >= 4


@pytest.mark.parametrize("frame", AIRFRAMES)
@pytest.mark.parametrize("seed", range(3))
def test_ten_minutes_in_which_things_fail(core: Core, frame: str, seed: int) -> None:
    chaos = Chaos(core, frame, seed)
    chaos.go(600.0)
    assert chaos.landings >= 3


@pytest.mark.slow
@pytest.mark.parametrize("frame", AIRFRAMES)
def test_two_hours(core: Core, frame: str) -> None:
    soak = Soak(core, frame, 1000)
    soak.go(7200.0)
    assert soak.landings > 40


@pytest.mark.slow
def test_a_soak_repeats_to_the_bit(core: Core) -> None:
    flights = []
    for _ in range(2):
        soak = Soak(core, "erle_copter", 7)
        soak.go(300.0)
        flights.append(soak.simulation.fleet.tobytes())
    assert flights[0] == flights[1]
