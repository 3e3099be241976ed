# SPDX-License-Identifier: BSD-3-Clause
"""What the MAVSDK 4 scripts of these tests share."""

import math
import sys
import time

from mavsdk import ComponentType, Configuration, Mavsdk
from mavsdk.plugins.action import Action
from mavsdk.plugins.telemetry import Telemetry


def check(what: str, ok: object, seen: object = "") -> None:
    """Print and go on, or end the script."""
    print(f"{'ok' if ok else 'FAILED'}: {what} {seen}", flush=True)
    if not ok:
        sys.exit(1)


def wait(what, condition, seconds=30.0) -> None:
    """Until the condition holds; the script ends when it does not in time."""
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.1)
    check(what, condition())


def refused(what, call, *arguments, result="") -> None:
    """The call must raise, naming ``result``."""
    start = time.monotonic()
    try:
        call(*arguments)
    except Exception as error:
        check(f"{what} is refused", result in str(error), f"{error} after {time.monotonic() - start:.2f} s")
    else:
        check(f"{what} is refused", False)


class Session:
    """A connected vehicle."""

    def __init__(self, as_pilot: bool = False) -> None:
        ground_station = Configuration.create_with_component_type(ComponentType.GROUND_STATION)
        self.mavsdk = Mavsdk(Configuration.create_manual(255, 190, True) if as_pilot else ground_station)
        self.mavsdk.add_any_connection(sys.argv[1])
        self.system = self.mavsdk.first_autopilot(30.0)
        check("autopilot", self.system is not None)
        self.action, self.telemetry = Action(self.system), Telemetry(self.system)

    def ready(self) -> None:
        """Until it can be armed and flown."""
        t = self.telemetry
        for name, rate in (
            ("position", 5),
            ("home", 1),
            ("health", 2),
            ("landed_state", 2),
            ("position_velocity_ned", 10),
        ):
            getattr(t, f"set_rate_{name}")(float(rate))
        t.set_rate_attitude_euler(10.0)
        wait("position", lambda: t.health().is_global_position_ok and t.health().is_home_position_ok, 90.0)
        wait("ready to arm", lambda: t.health().is_armable)

    def take_off(self, height=10.0) -> None:
        """Into the air."""
        self.ready()
        self.action.set_takeoff_altitude(height)
        self.action.arm()
        self.action.takeoff()
        wait("at height", lambda: self.telemetry.position().relative_altitude_m > height - 0.3)

    def land(self) -> None:
        """Down, motors off, and the library closed."""
        self.action.land()
        wait("disarmed", lambda: not self.telemetry.armed(), 90.0)
        self.mavsdk.destroy()

    def velocity(self) -> tuple[float, float, float]:
        """North, east, down [m/s]."""
        v = self.telemetry.position_velocity_ned().velocity
        return v.north_m_s, v.east_m_s, v.down_m_s

    def speed(self) -> float:
        """Over the ground [m/s]."""
        return math.hypot(*self.velocity()[:2])

    def place(self) -> tuple[float, float]:
        """North, east [m] of where the estimator began."""
        p = self.telemetry.position_velocity_ned().position
        return p.north_m, p.east_m
