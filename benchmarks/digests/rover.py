# SPDX-License-Identifier: BSD-3-Clause
"""Drives of rovers: every mode with sticks, every kind of set-point, failsafes, a world, random deeds."""

from __future__ import annotations

import random
from collections.abc import Callable
from functools import partial
from typing import Any

from .pilot import ARM, MODES, Item, Pilot

AIRFRAMES = ("erle_rover", "erle_rover_small", "ardupilot_rover", "skid_rover")
KEEP = 65535
MASKS = (0xDF8, 0xDC7, 0x9C7, 0x5C7, 0x9FF, 0x5FF, 0xDC0, 0xFFF)
"""Position; velocity, with yaw, with its rate; yaw, its rate alone; position and velocity; nothing."""
TUNABLE = {
    "WP_SPEED": (1, 4), "CRUISE_SPEED": (1, 4), "TURN_RADIUS": (1, 4), "SIM_GPS1_ENABLE": (0, 1), "SIM_RC_FAIL": (0, 1),
}  # fmt: skip


def mode(frame: str, name: str) -> Pilot:
    """A mode entered at speed, and the sticks moved in it."""
    pilot = Pilot(frame, "rover", seed=3)
    pilot.boot()
    pilot.arm()
    if name == "AUTO":
        lat, lon = (round(angle * 1e7) for angle in pilot.simulation.home[:2])
        corners = ((900, 0), (900, 900), (0, 900))
        pilot.upload([Item(16, lat, lon, 584.0, frame=0), *(Item(16, lat + n, lon + e) for n, e in corners)])
    pilot.stream(5.0, 0xDC7, vx=1.0, vy=0.3)
    pilot.hold(1500, KEEP, 1500)
    pilot.set_mode(name, 4.0)
    for steering, throttle in ((1500, 1700), (1700, 1650), (1250, 1600), (1500, 1350), (1600, 1300), (1500, 1500)):
        pilot.hold(steering, KEEP, throttle)
        pilot.fly(3.0)
    pilot.hold()
    pilot.set_mode("HOLD", 3.0)
    return pilot


def guided(frame: str, **options: Any) -> Pilot:
    """Set-points of every kind in every frame; attitudes; commands."""
    pilot = Pilot(frame, "rover", seed=4, **options)
    pilot.boot()
    pilot.arm()
    for mask in MASKS:
        for frame_number in (1, 8):
            pilot.stream(2.0, mask, frame_number, x=8.0, y=-4.0, vx=1.2, vy=-0.5, yaw=1.0, yaw_rate=0.4)
    for frame_number in (7, 9):
        pilot.stream(2.0, 0xDF8, frame_number, x=5.0, y=2.0)
    lat, lon, _, _ = pilot.simulation.home
    place = {"lat_int": round(lat * 1e7) + 900, "lon_int": round(lon * 1e7) - 700}
    for number in (0, 6, 11):
        pilot.send("SET_POSITION_TARGET_GLOBAL_INT", coordinate_frame=number, type_mask=0xDF8, **place)
        pilot.fly(4.0)
    for k in range(30):
        pilot.send(
            "SET_ATTITUDE_TARGET", type_mask=0x83, body_yaw_rate=0.3, thrust=0.3 if k < 20 else -0.2, q=[1, 0, 0, 0]
        )
        pilot.fly(0.1)
    pilot.command_int(192, 1.0, 1, 0, 0, x=round(lat * 1e7) + 500, y=round(lon * 1e7) + 800, z=0.0)
    pilot.fly(6.0)
    for number, params in ((178, (1, 0.7)), (194, (1,)), (194, (0,)), (213, (60, 0.5, 0, 0))):
        pilot.command(number, *params)
        pilot.fly(3.0)
    pilot.set_mode("SMART_RTL", 15.0)
    return pilot


def failsafe(parameter: str, value: float, before: str = "STEERING", **params: float) -> Pilot:
    """A fault on the way, and what becomes of it."""
    pilot = Pilot("erle_rover", "rover", seed=5, params=params)
    pilot.boot()
    pilot.arm()
    pilot.stream(4.0, 0xDC7, vx=1.0)
    if before != "GUIDED":
        pilot.hold(1550, KEEP, 1650)
    pilot.set_mode(before, 1.0)
    pilot.send("HEARTBEAT", type=6, autopilot=8, system_status=4, mavlink_version=3)
    pilot.set_parameter(parameter, value)
    pilot.fly(3.0)
    if parameter == "SIM_RC_FAIL":
        pilot.hold()
    pilot.fly(20.0)
    pilot.set_parameter("SIM_RC_FAIL", 0)
    pilot.set_parameter("SIM_GPS1_ENABLE", 1)
    pilot.set_mode("HOLD", 3.0)
    return pilot


def standing(frame: str) -> Pilot:
    """Motor test, refusals, parameters, requests, a reboot, arming by stick."""
    pilot = Pilot(frame, "rover", seed=7)
    pilot.boot()
    for motor in (1, 2, 3, 4):
        pilot.command(209, motor, 0, 30.0, 1.0, 0, 0)
        pilot.fly(1.5)
    pilot.send("PARAM_REQUEST_LIST")
    pilot.fly(8.0)
    for name, value in (("ATC_STR_RAT_P", 0.3), ("WP_SPEED", 1.5), ("TURN_RADIUS", 1e9), ("NO_SUCH", 1.0)):
        pilot.set_parameter(name, value)
    for message in (148, 242, 435, 32, 250):
        pilot.command(512, message)
    pilot.set_mode("RTL")
    pilot.command(ARM, 1)
    pilot.fly(1.0)
    pilot.reboot()
    pilot.set_mode("MANUAL")
    pilot.hold(2000, KEEP, 1500)
    pilot.fly(5.0)
    pilot.hold(1600, KEEP, 1700)
    pilot.fly(5.0)
    return pilot


def maze(physics: str = "native") -> Pilot:
    """In a world: lidar, against a wall, back, and round."""
    pilot = Pilot("erle_rover", "rover", seed=8, world="maze_erlerover", physics=physics)
    pilot.boot()
    pilot.arm()
    pilot.set_mode("MANUAL")
    for steering, throttle, seconds in ((1500, 1650, 8.0), (1500, 1300, 3.0), (1750, 1650, 5.0), (1250, 1400, 4.0)):
        pilot.hold(steering, KEEP, throttle)
        pilot.fly(seconds)
    return pilot


def by_dice(frame: str, seed: int, seconds: float = 100.0) -> Pilot:
    """Random modes, set-points, sticks, commands, parameters, faults, missions; the dice do not look at the vehicle."""
    dice = random.Random(seed)
    pilot = Pilot(frame, "rover", seed=seed)
    lat, lon = (round(angle * 1e7) for angle in pilot.simulation.home[:2])
    pilot.boot()
    pilot.arm()
    while pilot.now < 60.0 + seconds:
        deed = dice.randrange(7)
        if deed == 0:
            pilot.set_mode(dice.choice(list(MODES["rover"])))
        elif deed == 1:
            span = {"x": 20, "y": 20, "vx": 2, "vy": 2, "yaw": 3, "yaw_rate": 1}
            pilot.set_mode("GUIDED")
            values = {name: dice.uniform(-size, size) for name, size in span.items()}
            pilot.target(dice.choice(MASKS), dice.choice((1, 7, 8, 9)), **values)
        elif deed == 2:
            pilot.hold(dice.randint(1150, 1850), KEEP, dice.randint(1250, 1850))
        elif deed == 3:
            choices = ((178, (1, dice.uniform(0.5, 3))), (194, (1,)), (194, (0,)), (ARM, (1,)), (213, (40, 0.5, 0, 0)))
            number, params = dice.choice(choices)
            pilot.command(number, *params)
        elif deed == 4:
            name = dice.choice(sorted(TUNABLE))
            pilot.set_parameter(name, dice.randint(*TUNABLE[name]))
        elif deed == 5:
            items = [Item(16, lat, lon, 584.0, frame=0)]
            for command in dice.choices((16, 18, 19, 93, 178, 194, 177), k=6):
                where = (lat + dice.randint(-1500, 1500), lon + dice.randint(-1500, 1500))
                x, y = where if command < 90 else (0, 0)
                p1, p2 = int(command in (18, 19, 93, 177, 178)), 2 * int(command in (177, 178))
                items.append(Item(command, x, y, 0.0, p1, p2))
            pilot.upload(items, or_refused=True)
            pilot.set_mode("AUTO")
        else:
            pilot.set_parameter("SIM_RC_FAIL", 0)
            pilot.set_parameter("SIM_GPS1_ENABLE", 1)
            pilot.command(ARM, 1)
        pilot.fly(dice.uniform(0.5, 5.0))
    return pilot


FAILSAFES: dict[str, Callable[[], Pilot]] = {
    "rc": partial(failsafe, "SIM_RC_FAIL", 1),
    "rc-smart_rtl": partial(failsafe, "SIM_RC_FAIL", 1, FS_ACTION=3),
    "gcs": partial(failsafe, "FS_GCS_ENABLE", 1, "GUIDED"),
    "gps": partial(failsafe, "SIM_GPS1_ENABLE", 0),
    "gps-guided": partial(failsafe, "SIM_GPS1_ENABLE", 0, "GUIDED"),
    "battery": partial(failsafe, "BATT_LOW_VOLT", 99.0, BATT_FS_LOW_ACT=1),
}


def flights() -> dict[str, Callable[[], Pilot]]:
    """All of them, by name."""
    found: dict[str, Callable[[], Pilot]] = {
        "native/rover/maze": maze,
        "native/rover/guided-truth": partial(guided, "erle_rover", estimator="truth"),
        "pybullet/rover/maze": partial(maze, "pybullet"),
        "pybullet/rover/guided": partial(guided, "erle_rover", physics="pybullet"),
    }
    for frame in AIRFRAMES:
        found[f"native/rover/guided-{frame}"] = partial(guided, frame)
        found[f"native/rover/standing-{frame}"] = partial(standing, frame)
        found |= {f"native/rover/by_dice-{frame}-{seed}": partial(by_dice, frame, seed) for seed in (11, 12)}
    for frame in ("erle_rover", "skid_rover"):
        found |= {f"native/rover/{name}-{frame}": partial(mode, frame, name) for name in MODES["rover"]}
    found |= {f"native/rover/failsafe-{name}": script for name, script in FAILSAFES.items()}
    return found
