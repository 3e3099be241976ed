# SPDX-License-Identifier: BSD-3-Clause
"""Flights of copters and drives of rovers: modes with sticks, set-points, failsafes, worlds, missions, random deeds."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

from sitl.core.mavlink import MavCmd

from . import tree
from .pilot import DRAWN, MODES, Item, Pilot

KEEP = 65535
OVER_TERRAIN = (10, 11)
"""Frames of items whose heights are above terrain."""
POSITION, VELOCITY = 0xDF8, 0xDC7
ALL = {
    "x": 8.0, "y": -4.0, "z": -12.0, "vx": 1.5, "vy": -0.7, "vz": -0.3, "afx": 0.6, "afy": -0.4, "yaw": 1.0,
    "yaw_rate": 0.4,
}  # fmt: skip
"""Every field of a set-point; a type mask says which of them count."""


class Programme(NamedTuple):
    """In what the flights of two kinds of vehicles differ. Sticks are pulses of channels 1 .. 4 [us]."""

    airframes: tuple[str, ...]
    masks: tuple[int, ...]
    """Type masks of set-points."""
    tour: tuple[tuple[int, ...], ...]
    """Sticks of a flight through a mode; the first ones when it is entered."""
    arming: tuple[str, tuple[int, ...], tuple[int, ...]]
    """A mode, the sticks that arm in it, and those that move it."""
    commands: tuple[tuple[float, ...], ...]
    """Commands with their parameters, in GUIDED."""
    tunable: dict[str, tuple[int, int]]
    """Parameters and their limits."""
    items: tuple[int, ...]
    """Commands of random missions,"""
    spread: int
    """whose places are so far from home [degE7]."""
    world: str
    legs: tuple[tuple[float, dict[str, float]], ...]
    """Seconds and body velocities in it."""
    faults: dict[str, tuple[str, str, float, dict[str, float]]]
    """Name -> mode, the parameter that brings the fault, its value, parameters from the start."""


PROGRAMMES = {
    "copter": Programme(
        airframes=("erle_copter", "ardupilot_quad"),
        masks=(POSITION, VELOCITY, 0xC3F, 0xDC0, 0xC00, 0x9F8, 0x5F8, 0x5C7, 0x9C7, 0xFFF),
        tour=(
            (1500, 1500, 1520, 1500), (1600, 1500, 1500, 1500), (1500, 1350, 1560, 1500), (1500, 1500, 1500, 1700),
            (1400, 1450, 1440, 1400),
        ),
        arming=("LOITER", (1500, 1500, 1000, 2000), (1500, 1500, 1700, 1500)),
        commands=((193, 0), (193, 1), (178, 1, 2.0), (178, 2, 1.0), (115, 120, 30, -1, 0), (115, 45, 30, 1, 1)),
        tunable={
            "ATC_RAT_RLL_P": (0, 1), "WPNAV_SPEED": (50, 1500), "RTL_ALT": (0, 4000), "WPNAV_ACCEL": (100, 400),
            "LAND_SPEED": (30, 100), "ANGLE_MAX": (2000, 4500), "LOIT_SPEED": (100, 1500), "WP_YAW_BEHAVIOR": (0, 3),
            "SIM_WIND_SPD": (0, 6), "SIM_WIND_DIR": (0, 359), "SIM_WIND_TURB": (0, 1), "SIM_GPS1_ENABLE": (0, 1),
            "SIM_RC_FAIL": (0, 1),
        },
        items=(16, 18, 19, 93, 115, 178, 195, 177),
        spread=4000,
        world="office_erlecopter",
        legs=((4.0, {"vx": 0.6}), (4.0, {"vy": 0.6}), (4.0, {"vx": -0.5, "vy": -0.5}), (9.0, {"vx": 1.5})),
        faults={
            "rc": ("LOITER", "SIM_RC_FAIL", 1, {}),
            "throttle": ("LOITER", "FS_THR_VALUE", 1700, {"FS_THR_ENABLE": 3}),
            "gcs": ("GUIDED", "FS_GCS_ENABLE", 1, {}),
            "gps": ("LOITER", "SIM_GPS1_ENABLE", 0, {}),
            "gps-alt_hold": ("ALT_HOLD", "SIM_GPS1_ENABLE", 0, {}),
            "battery": ("LOITER", "BATT_LOW_VOLT", 12.45, {"BATT_FS_LOW_ACT": 2}),
            "battery-critical": ("LOITER", "BATT_CRT_VOLT", 12.45, {"BATT_FS_CRT_ACT": 1}),
            "motor": ("LOITER", "SIM_ENGINE_FAIL", 1, {}),
        },
    ),
    "rover": Programme(
        airframes=("erle_rover", "skid_rover", "erle_rover_small", "ardupilot_rover"),
        masks=(POSITION, VELOCITY, 0x9C7, 0x5C7, 0x9FF, 0x5FF, 0xDC0, 0xFFF),
        tour=(
            (1500, KEEP, 1500), (1500, KEEP, 1700), (1700, KEEP, 1650), (1250, KEEP, 1600), (1500, KEEP, 1350),
            (1600, KEEP, 1300),
        ),
        arming=("MANUAL", (2000, KEEP, 1500), (1600, KEEP, 1700)),
        commands=((178, 1, 0.7), (194, 1), (194, 0), (213, 60, 0.5, 0, 0), (MavCmd.COMPONENT_ARM_DISARM, 1)),
        tunable={
            "ATC_STR_RAT_P": (0, 1), "WP_SPEED": (1, 4), "TURN_RADIUS": (1, 4), "CRUISE_SPEED": (1, 4),
            "SIM_GPS1_ENABLE": (0, 1), "SIM_RC_FAIL": (0, 1),
        },
        items=(16, 18, 19, 93, 178, 194, 177),
        spread=1500,
        world="maze_erlerover",
        legs=((8.0, {"vx": 1.0}), (3.0, {"vx": -0.7}), (5.0, {"vx": 0.7, "vy": 0.7}), (6.0, {"vx": 0.7, "vy": -0.7})),
        faults={
            "rc": ("STEERING", "SIM_RC_FAIL", 1, {}),
            "rc-smart_rtl": ("STEERING", "SIM_RC_FAIL", 1, {"FS_ACTION": 3}),
            "gcs": ("GUIDED", "FS_GCS_ENABLE", 1, {}),
            "gps": ("STEERING", "SIM_GPS1_ENABLE", 0, {}),
            "gps-guided": ("GUIDED", "SIM_GPS1_ENABLE", 0, {}),
            "battery": ("STEERING", "BATT_LOW_VOLT", 99.0, {"BATT_FS_LOW_ACT": 1}),
        },
    ),
}  # fmt: skip


def power_on(frame: str, kind: str, **options: Any) -> Pilot:
    """The first second only: short enough for plain Python (NUMBA_DISABLE_JIT=1)."""
    pilot = Pilot(frame, kind, **{"seed": 1, **options})
    pilot.fly(0.5)
    pilot.look()
    pilot.fly(0.5)
    return pilot


def logged(kind: str) -> Pilot:
    """A velocity and the way back, with logs."""
    pilot = Pilot(PROGRAMMES[kind].airframes[0], kind, log=True, seed=1)
    pilot.set_out()
    pilot.stream(10.0, VELOCITY, vx=1.0)
    pilot.set_mode("RTL", 10.0)
    pilot.come_to_rest()
    return pilot


def mode(frame: str, kind: str, name: str) -> Pilot:
    """A mode entered at speed, and the sticks moved in it."""
    pilot = Pilot(frame, kind, seed=3)
    pilot.set_out()
    entering, *tour = PROGRAMMES[kind].tour
    pilot.stream(5.0, VELOCITY, vx=1.5, vy=0.5)
    pilot.hold(*entering)
    pilot.set_mode(name, 3.0)
    for sticks in tour:
        pilot.hold(*sticks, seconds=2.5)
    pilot.come_to_rest()
    return pilot


def guided(frame: str, kind: str, **options: Any) -> Pilot:
    """Set-points of every kind in every frame; attitudes; commands."""
    pilot = Pilot(frame, kind, seed=4, **options)
    pilot.set_out()
    for mask in PROGRAMMES[kind].masks:
        for number in (1, 8):
            pilot.stream(1.5, mask, number, **ALL)
    for number in (7, 9):
        pilot.stream(1.5, POSITION, number, x=3.0, y=1.0, z=-1.0)
        pilot.stream(1.5, 0x5C7, number, vx=2.0, vy=0.5, yaw_rate=0.5)
    lat, lon, alt, _ = pilot.simulation.home
    for number in (0, 3, 5, 6, 10, 11):
        height = alt + 12.0 if number in (0, 5) else 14.0
        place = {"lat_int": round(lat * 1e7) + 900, "lon_int": round(lon * 1e7) - 700, "alt": height}
        pilot.send("SET_POSITION_TARGET_GLOBAL_INT", coordinate_frame=number, type_mask=POSITION, **place)
        pilot.fly(2.0)
    for k in range(30):
        half = 0.05 * math.sin(0.2 * k)
        fields = {"q": [math.cos(half), math.sin(half), 0.5 * math.sin(half), 0.0], "body_yaw_rate": 0.3}
        thrust = 0.5 + 0.1 * math.sin(0.3 * k) if kind == "copter" else 0.3
        pilot.send("SET_ATTITUDE_TARGET", type_mask=7 if k < 10 else 0 if k < 20 else 0x83, thrust=thrust, **fields)
        pilot.fly(0.1)
    east = {"frame": 3, "x": round(lat * 1e7) + 1000, "y": round(lon * 1e7) + 1500}
    pilot.send("COMMAND_INT", command=192, param1=3.0, param2=1, z=15.0, **east)
    pilot.fly(5.0)
    for command, *params in PROGRAMMES[kind].commands:
        pilot.command(int(command), *params)
        pilot.fly(2.0)
    pilot.send("COMMAND_INT", command=195, **east)
    pilot.fly(3.0)
    pilot.command(197)
    if kind == "rover":
        pilot.set_mode("SMART_RTL", 15.0)
    pilot.come_to_rest()
    return pilot


def failsafe(kind: str, name: str) -> Pilot:
    """A fault on the way, and what becomes of it."""
    before, parameter, value, params = PROGRAMMES[kind].faults[name]
    pilot = Pilot(PROGRAMMES[kind].airframes[0], kind, seed=5, params=params)
    pilot.set_out(15.0)
    pilot.stream(4.0, VELOCITY, vx=1.5)
    if before != "GUIDED":
        pilot.hold(*PROGRAMMES[kind].tour[1])
    pilot.set_mode(before, 1.0)
    pilot.send("HEARTBEAT", type=6, autopilot=8, system_status=4, mavlink_version=3)
    pilot.set_parameter(parameter, value)
    pilot.fly(3.0)
    if parameter == "SIM_RC_FAIL":
        pilot.hold()
    pilot.fly(30.0, lambda: not pilot.armed)
    repair(pilot)
    pilot.come_to_rest()
    return pilot


def repair(pilot: Pilot) -> None:
    """The receiver and GPS work again."""
    pilot.set_parameter("SIM_RC_FAIL", 0)
    pilot.set_parameter("SIM_GPS1_ENABLE", 1)


def faults(frame: str, kind: str) -> Pilot:
    """Everything that can fail, one after the other, for two seconds each."""
    pilot = Pilot(frame, kind, seed=10, world=PROGRAMMES[kind].world)
    table = tree.locate("known", "sitl.vehicle.faults")(pilot.simulation.firmware.table)
    pilot.set_out(1.5)
    for unit, types in table.items():
        for name, effect in types.items():
            strength = "=0.9" if unit in ("motor", "servo") and name == "off" else ""
            instance = ":1" if effect.instances > 1 else ""
            try:
                pilot.simulation.fail(f"{unit}{instance}/{name}{strength}@0..2")
            except ValueError:  # it has no such thing
                continue
            pilot.set_mode("GUIDED")
            pilot.stream(2.5, VELOCITY, 8, vx=0.2)
    pilot.come_to_rest()
    return pilot


def stop_motors() -> Pilot:
    """Forced to disarm in the air: a crash."""
    pilot = Pilot("erle_copter", "copter", seed=6)
    pilot.set_out(6.0)
    pilot.command(MavCmd.COMPONENT_ARM_DISARM, 0, 21196.0)
    pilot.fly(5.0)
    return pilot


def on_ground(frame: str, kind: str) -> Pilot:
    """Motor test, refusals, parameters, home, requests, a reboot, arming by stick."""
    pilot = Pilot(frame, kind, seed=7)
    pilot.boot()
    for motor in range(1, 5):
        pilot.command(209, motor, 0, 25.0, 1.0, 0, 2 if kind == "copter" else 0)
        pilot.fly(1.5)
    pilot.command(MavCmd.NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 5.0)
    pilot.send("PARAM_REQUEST_LIST")
    pilot.fly(8.0)
    gain, speed, other = list(PROGRAMMES[kind].tunable)[:3]
    for name, value in ((gain, 0.12), (speed, 2.0), (other, 1e9), ("NO_SUCH", 1.0)):
        pilot.set_parameter(name, value)
    for message in (148, 242, 435, 32, 250):
        pilot.command(512, message)
    pilot.command(179, 1)
    pilot.set_mode("RTL")
    pilot.command(MavCmd.COMPONENT_ARM_DISARM, 1)
    pilot.fly(1.0)
    pilot.reboot()
    name, arming, moving = PROGRAMMES[kind].arming
    pilot.set_mode(name)
    pilot.hold(*arming, seconds=6.0)
    pilot.hold(*moving, seconds=5.0)
    pilot.come_to_rest()
    return pilot


def in_world(kind: str, physics: str = "native") -> Pilot:
    """Lidar and range-finder, along walls and against one."""
    programme = PROGRAMMES[kind]
    pilot = Pilot(programme.airframes[0], kind, seed=8, world=programme.world, physics=physics)
    pilot.set_out(1.2)
    for seconds, velocities in programme.legs:
        pilot.stream(seconds, VELOCITY, 8, **velocities)
    pilot.come_to_rest()
    return pilot


def repeated() -> Pilot:
    """A snapshot in the air, five seconds on, back, and another five."""
    pilot = Pilot("erle_copter", "copter", seed=9)
    pilot.set_out()
    kept = pilot.simulation.snapshot()
    for vx in (3.0, -3.0):
        pilot.stream(5.0, VELOCITY, vx=vx)
        pilot.look()
        pilot.simulation.restore(kept)
        pilot.look()
    pilot.stream(2.0, VELOCITY, vy=2.0)
    return pilot


def by_dice(frame: str, kind: str, seed: int, seconds: float = 100.0) -> Pilot:
    """Random modes, set-points, sticks, commands, parameters, faults, missions; the dice do not look at the vehicle."""
    dice, programme = random.Random(seed), PROGRAMMES[kind]
    pilot = Pilot(frame, kind, seed=seed)
    lat, lon = (round(angle * 1e7) for angle in pilot.simulation.home[:2])
    pilot.set_out()
    while pilot.now < 60.0 + seconds:
        deed = dice.randrange(7)
        if deed == 0:
            pilot.set_mode(dice.choice(DRAWN[kind]))
        elif deed == 1:
            pilot.set_mode("GUIDED")
            values = {name: dice.uniform(-4.0, 4.0) * value for name, value in ALL.items()} | {"z": -10.0}
            pilot.stream(0.1, dice.choice(programme.masks), dice.choice((1, 7, 8, 9)), **values)
        elif deed == 2:
            pilot.hold(*(dice.randint(1250, 1750) for _ in range(4)), seconds=1.5)
            pilot.hold(1500, 1500, 1500, 1500)
        elif deed == 3:
            number, *params = dice.choice(programme.commands)
            pilot.command(int(number), *params)
        elif deed == 4:
            name = dice.choice(list(programme.tunable)[1:])
            pilot.set_parameter(name, dice.randint(*programme.tunable[name]))
        elif deed == 5:
            items = [
                Item(16, lat, lon, 584.0, frame=0),
                *([Item(MavCmd.NAV_TAKEOFF, z=8.0)] if kind == "copter" else []),
            ]
            for command in dice.choices(programme.items, k=6):
                x, y = (at + dice.randint(-programme.spread, programme.spread) for at in (lat, lon))
                z = dice.uniform(5, 20)
                p1, p2 = int(command in (18, 19, 93, 177, 178)), 2 * int(command in (177, 178))
                is_location = command in (16, 18, 19, 195)
                items.append(Item(command, x, y, z, p1, p2) if is_location else Item(command, p1=p1, p2=p2))
            pilot.upload(items, or_refused=True)
            pilot.set_mode("AUTO")
            pilot.command(MavCmd.MISSION_START)
        else:
            repair(pilot)
            pilot.set_mode("GUIDED")
            pilot.command(MavCmd.COMPONENT_ARM_DISARM, 1)
            pilot.fly(0.5)
            pilot.command(MavCmd.NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, 10.0)
        pilot.fly(dice.uniform(0.5, 5.0))
    pilot.come_to_rest()
    return pilot


def mission(name: str, **options: Any) -> Pilot:
    """A mission of the library; splines are flown as waypoints, which all versions of the firmware take."""
    row = tree.library()[name]
    items = [Item(**item) for item in tree.mission_items(row["path"])]
    items = [item._replace(command=16) if item.command == 82 else item for item in items]
    options = {**{key: row[key] for key in ("world", "start", "params") if key in row}, "seed": 1, **options}
    has_home = (items[0].x, items[0].y) != (0, 0)
    home = (items[0].x * 1e-7, items[0].y * 1e-7, items[0].z, 0.0) if has_home else None
    pilot = Pilot(row["frame"], name.partition("/")[0], home=home, **options)
    if not has_home:
        lat, lon, alt, _ = pilot.simulation.home
        items[0] = Item(16, round(lat * 1e7), round(lon * 1e7), alt, frame=0)
    pilot.knows_terrain = any(item.frame in OVER_TERRAIN for item in items)
    pilot.boot()
    pilot.fly_mission(items)
    return pilot


def flights() -> dict[str, Callable[[], Pilot]]:
    """All of them, by name."""
    found: dict[str, Callable[[], Pilot]] = {
        "native/copter/stop_motors": stop_motors,
        "native/copter/repeated": repeated,
        **{f"native/mission/{name}": partial(mission, name) for name in tree.library()},
        "jsbsim/copter/guided": partial(guided, "erle_copter", "copter", physics="jsbsim"),
        "jsbsim/mission/copter/spline_figure": partial(mission, "copter/spline_figure", physics="jsbsim"),
    }
    wind = {"SIM_WIND_SPD": 5.0, "SIM_WIND_DIR": 120.0, "SIM_WIND_TURB": 1.0}
    for name in ("copter/square", "copter/survey", "copter/circles"):
        found[f"native/mission/{name}-wind"] = partial(mission, name, seed=2, params=wind)
    for kind, programme in PROGRAMMES.items():
        first = programme.airframes[0]
        found |= {
            f"native/power_on/{kind}": partial(power_on, first, kind),
            f"native/log/{kind}": partial(logged, kind),
            f"native/{kind}/faults": partial(faults, first, kind),
            f"native/{kind}/guided-truth": partial(guided, first, kind, estimator="truth"),
            f"native/{kind}/world": partial(in_world, kind),
            f"pybullet/{kind}/world": partial(in_world, kind, "pybullet"),
            f"pybullet/{kind}/guided": partial(guided, first, kind, physics="pybullet"),
            f"native/mission/{kind}/square-truth": partial(mission, f"{kind}/square", estimator="truth"),
            f"pybullet/mission/{kind}/square": partial(mission, f"{kind}/square", physics="pybullet"),
            **{f"native/{kind}/failsafe-{name}": partial(failsafe, kind, name) for name in programme.faults},
        }
        for frame in programme.airframes:
            found[f"native/{kind}/guided-{frame}"] = partial(guided, frame, kind)
            found[f"native/{kind}/on_ground-{frame}"] = partial(on_ground, frame, kind)
            found |= {f"native/{kind}/by_dice-{frame}-{seed}": partial(by_dice, frame, kind, seed) for seed in (11, 12)}
        for frame in programme.airframes[:2]:
            for name in MODES[kind]:
                if name != "AUTO":
                    found[f"native/{kind}/{name}-{frame}"] = partial(mode, frame, kind, name)
    return found
