# SPDX-License-Identifier: BSD-3-Clause
"""Flights of copters: every mode with sticks, every kind of set-point, failsafes, a world, random deeds."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from functools import partial
from typing import Any

from .pilot import ARM, MODES, TAKEOFF, Item, Pilot

AIRFRAMES = ("erle_copter", "ardupilot_quad")
TOUR = ((1600, 1500, 1500, 1500), (1500, 1350, 1560, 1500), (1500, 1500, 1500, 1700), (1400, 1450, 1440, 1400))
"""Sticks: roll, pitch, throttle, yaw [us]."""
MASKS = (0xDF8, 0xDC7, 0xC3F, 0xDC0, 0xC00, 0x9F8, 0x5F8, 0x5C7, 0x9C7, 0xFFF)
"""Position, velocity, acceleration, the first two, all three; with yaw or its rate; nothing."""
TUNABLE = {
    "WPNAV_SPEED": (50, 1500), "WPNAV_ACCEL": (100, 400), "RTL_ALT": (0, 4000), "LAND_SPEED": (30, 100),
    "ANGLE_MAX": (2000, 4500), "LOIT_SPEED": (100, 1500), "WP_YAW_BEHAVIOR": (0, 3), "SIM_WIND_SPD": (0, 6),
    "SIM_WIND_DIR": (0, 359), "SIM_WIND_TURB": (0, 1), "SIM_GPS1_ENABLE": (0, 1), "SIM_RC_FAIL": (0, 1),
}  # fmt: skip


def come_down(pilot: Pilot) -> Pilot:
    """Centred sticks and LAND, until it is disarmed."""
    pilot.hold(*((1500,) * 4 if pilot.sticks else ()))
    pilot.set_mode("LAND")
    pilot.fly(40.0, lambda: not pilot.armed)
    pilot.fly(1.0)
    return pilot


def mode(frame: str, name: str) -> Pilot:
    """A mode entered at speed, and the sticks moved in it."""
    pilot = Pilot(frame, seed=3)
    pilot.hover()
    pilot.stream(3.0, 0xDC7, vx=4.0, vy=1.0)
    pilot.hold(1500, 1500, 1520, 1500)
    pilot.set_mode(name, 2.0)
    for sticks in TOUR:
        pilot.hold(*sticks)
        pilot.fly(2.5)
    return come_down(pilot)


def guided(frame: str, **options: Any) -> Pilot:
    """Set-points of every kind in every frame; attitudes; commands."""
    pilot = Pilot(frame, seed=4, **options)
    pilot.hover()
    values = {"x": 8.0, "y": -4.0, "z": -12.0, "vx": 2.0, "vy": -1.0, "vz": -0.3, "afx": 0.6, "afy": -0.4}
    for mask in MASKS:
        pilot.stream(1.5, mask, 1, **values, yaw=1.0, yaw_rate=0.4)
    for frame_number in (7, 8, 9):
        pilot.stream(1.5, 0xDF8, frame_number, x=3.0, y=1.0, z=-1.0)
        pilot.stream(1.5, 0x5C7, frame_number, vx=2.0, vy=0.5, yaw_rate=0.5)
    lat, lon, alt, _ = pilot.simulation.home
    for number in (0, 3, 5, 6, 10, 11):
        height = alt + 12.0 if number in (0, 5) else 14.0
        place = {"lat_int": round(lat * 1e7) + 900, "lon_int": round(lon * 1e7) - 700, "alt": height}
        pilot.send("SET_POSITION_TARGET_GLOBAL_INT", coordinate_frame=number, type_mask=0xDF8, **place)
        pilot.fly(2.0)
    for k in range(30):
        half = 0.05 * math.sin(0.2 * k)
        q = [math.cos(half), math.sin(half), 0.5 * math.sin(half), 0.0]
        pilot.send("SET_ATTITUDE_TARGET", type_mask=7 if k < 20 else 0, q=q, thrust=0.5 + 0.1 * math.sin(0.3 * k))
        pilot.fly(0.1)
    east = {"x": round(lat * 1e7) + 1000, "y": round(lon * 1e7) + 1500}
    pilot.command_int(192, 3.0, 1, 0, 0, **east, z=15.0)
    pilot.fly(5.0)
    for number, params in ((193, (0,)), (193, (1,)), (178, (1, 2.0)), (178, (2, 1.0)), (115, (120, 30, -1, 0))):
        pilot.command(number, *params)
        pilot.fly(2.0)
    pilot.command_int(195, **east, z=0.0)
    pilot.fly(3.0)
    pilot.command(197)
    return come_down(pilot)


def failsafe(parameter: str, value: float, before: str = "LOITER", **params: float) -> Pilot:
    """A fault in flight, and what becomes of it."""
    pilot = Pilot("erle_copter", seed=5, params=params)
    pilot.hover(15.0)
    pilot.stream(3.0, 0xDC7, vx=3.0)
    if before != "GUIDED":
        pilot.hold(1500, 1500, 1500, 1500)
    pilot.set_mode(before, 1.0)
    pilot.send("HEARTBEAT", type=6, autopilot=8, system_status=4, mavlink_version=3)
    pilot.set_parameter(parameter, value)
    if parameter == "FS_THR_VALUE":
        pilot.hold(1500, 1500, 1050, 1500)
    pilot.fly(3.0)
    if parameter == "SIM_RC_FAIL":
        pilot.hold()
    pilot.fly(40.0, lambda: not pilot.armed)
    return come_down(pilot)


def stop_motors() -> Pilot:
    """Forced to disarm in the air: a crash."""
    pilot = Pilot("erle_copter", seed=6)
    pilot.hover(6.0)
    pilot.command(ARM, 0, 21196.0)
    pilot.fly(5.0)
    return pilot


def on_ground() -> Pilot:
    """Motor test, refusals, parameters, home, requests, a reboot, arming by stick, take-off in LOITER, a log."""
    pilot = Pilot("erle_copter", seed=7)
    pilot.boot()
    for motor in range(1, 5):
        pilot.command(209, motor, 0, 20.0, 1.0, 0, 2)
        pilot.fly(1.5)
    pilot.command(TAKEOFF, 0, 0, 0, 0, 0, 0, 5.0)
    pilot.send("PARAM_REQUEST_LIST")
    pilot.fly(8.0)
    for name, value in (("ATC_RAT_RLL_P", 0.12), ("WPNAV_SPEED", 700.0), ("RTL_ALT", 1e9), ("NO_SUCH", 1.0)):
        pilot.set_parameter(name, value)
    for message in (148, 242, 435, 32, 250):
        pilot.command(512, message)
    pilot.command(179, 1)
    pilot.set_mode("RTL")
    pilot.command(ARM, 1)
    pilot.fly(1.0)
    pilot.reboot()
    pilot.set_mode("LOITER")
    pilot.hold(1500, 1500, 1000, 2000)
    pilot.fly(6.0)
    pilot.hold(1500, 1500, 1700, 1500)
    pilot.fly(5.0)
    return come_down(pilot)


def office(physics: str = "native") -> Pilot:
    """In a world: lidar and range-finder, along walls and against one."""
    pilot = Pilot("erle_copter", seed=8, world="office_erlecopter", physics=physics)
    pilot.hover(1.2)
    for vx, vy in ((0.6, 0.0), (0.0, 0.6), (-0.5, -0.5)):
        pilot.stream(4.0, 0xDC7, 8, vx=vx, vy=vy)
    pilot.stream(9.0, 0x5C7, 8, vx=1.5, yaw_rate=0.1)
    return come_down(pilot)


def repeated() -> Pilot:
    """A snapshot in the air, five seconds on, back, and another five."""
    pilot = Pilot("erle_copter", seed=9)
    pilot.hover()
    kept = pilot.simulation.snapshot()
    for vx in (3.0, -3.0):
        pilot.stream(5.0, 0xDC7, vx=vx)
        pilot.look()
        pilot.simulation.restore(kept)
        pilot.look()
    pilot.stream(2.0, 0xDC7, vy=2.0)
    return pilot


def by_dice(frame: str, seed: int, seconds: float = 100.0) -> Pilot:
    """Random modes, set-points, sticks, commands, parameters, faults, missions; the dice do not look at the vehicle."""
    dice = random.Random(seed)
    pilot = Pilot(frame, seed=seed)
    lat, lon = (round(angle * 1e7) for angle in pilot.simulation.home[:2])
    pilot.hover()
    while pilot.now < 60.0 + seconds:
        deed = dice.randrange(7)
        if deed == 0:
            name = dice.choice(list(MODES["copter"]))
            pilot.set_mode(name)
            if name == "STABILIZE":
                pilot.fly(1.5)
                pilot.set_mode("ALT_HOLD")
        elif deed == 1:
            span = {"x": 60, "y": 60, "vx": 8, "vy": 8, "vz": 1.5, "afx": 2, "afy": 2, "yaw": 3, "yaw_rate": 1}
            pilot.set_mode("GUIDED")
            values = {name: dice.uniform(-size, size) for name, size in span.items()}
            values["z"] = dice.uniform(-20, -5)
            pilot.target(dice.choice(MASKS), dice.choice((1, 7, 8, 9)), **values)
        elif deed == 2:
            pilot.hold(
                dice.randint(1150, 1850), dice.randint(1150, 1850), dice.randint(1430, 1700), dice.randint(1150, 1850)
            )
            pilot.fly(1.5)
            pilot.hold(1500, 1500, 1500, 1500)
        elif deed == 3:
            choices = (
                (115, (dice.uniform(0, 360), 30, 1, 0)),
                (178, (1, dice.uniform(1, 8))),
                (193, (0,)),
                (193, (1,)),
            )
            number, params = dice.choice(choices)
            pilot.command(number, *params)
        elif deed == 4:
            name = dice.choice(sorted(TUNABLE))
            pilot.set_parameter(name, dice.randint(*TUNABLE[name]))
        elif deed == 5:
            items = [Item(16, lat, lon, 584.0, frame=0), Item(22, z=8.0)]
            for command in dice.choices((16, 18, 19, 93, 115, 178, 195, 177), k=6):
                where = (lat + dice.randint(-4000, 4000), lon + dice.randint(-4000, 4000), dice.uniform(5, 20))
                x, y, z = where if command in (16, 18, 19, 195) else (0, 0, 0.0)
                p1, p2 = int(command in (18, 19, 93, 177, 178)), 2 * int(command in (177, 178))
                items.append(Item(command, x, y, z, p1, p2))
            pilot.upload(items, or_refused=True)
            pilot.set_mode("AUTO")
            pilot.command(300)
        else:
            pilot.set_parameter("SIM_RC_FAIL", 0)
            pilot.set_parameter("SIM_GPS1_ENABLE", 1)
            pilot.set_mode("GUIDED")
            pilot.command(ARM, 1)
            pilot.fly(0.5)
            pilot.command(TAKEOFF, 0, 0, 0, 0, 0, 0, 10.0)
        pilot.fly(dice.uniform(0.5, 5.0))
    return come_down(pilot)


FAILSAFES: dict[str, Callable[[], Pilot]] = {
    "rc": partial(failsafe, "SIM_RC_FAIL", 1),
    "throttle": partial(failsafe, "FS_THR_VALUE", 1100, FS_THR_ENABLE=3),
    "gcs": partial(failsafe, "FS_GCS_ENABLE", 1, "GUIDED"),
    "gps": partial(failsafe, "SIM_GPS1_ENABLE", 0),
    "gps-alt_hold": partial(failsafe, "SIM_GPS1_ENABLE", 0, "ALT_HOLD"),
    "battery": partial(failsafe, "BATT_LOW_VOLT", 12.45, BATT_FS_LOW_ACT=2),
    "battery-critical": partial(failsafe, "BATT_CRT_VOLT", 12.45, BATT_FS_CRT_ACT=1),
    "motor": partial(failsafe, "SIM_ENGINE_FAIL", 1),
}


def flights() -> dict[str, Callable[[], Pilot]]:
    """All of them, by name."""
    found: dict[str, Callable[[], Pilot]] = {
        "native/copter/stop_motors": stop_motors,
        "native/copter/on_ground": on_ground,
        "native/copter/office": office,
        "native/copter/repeated": repeated,
        "native/copter/guided-truth": partial(guided, "erle_copter", estimator="truth"),
        "pybullet/copter/office": partial(office, "pybullet"),
        "pybullet/copter/guided": partial(guided, "erle_copter", physics="pybullet"),
        "jsbsim/copter/guided": partial(guided, "erle_copter", physics="jsbsim"),
    }
    for frame in AIRFRAMES:
        found[f"native/copter/guided-{frame}"] = partial(guided, frame)
        found |= {f"native/copter/by_dice-{frame}-{seed}": partial(by_dice, frame, seed) for seed in (11, 12, 13)}
        for name in MODES["copter"]:
            if name != "AUTO":
                found[f"native/copter/{name}-{frame}"] = partial(mode, frame, name)
    found |= {f"native/copter/failsafe-{name}": script for name, script in FAILSAFES.items()}
    return found
