# SPDX-License-Identifier: BSD-3-Clause
"""How well twins of flights agree with logs whose vehicle is known: ours, and a real ArduPilot on its own physics.

    python -m benchmarks.twins                                  # logs of ours: half a minute
    python -m benchmarks.twins --ardupilot FOLDER --keep logs   # and of a real one: two minutes; the logs stay
    python -m benchmarks.twins --only tour drive                # these flights only

Prints the tables of docs/twin.md ("How well it agrees"). FOLDER has ``arducopter`` and ``ardurover``. In simulated
time, but a real one's clock goes on while a client writes: its flights, and so the last digits, vary.
"""

from __future__ import annotations

import argparse
import math
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from sitl import Simulation, vehicles
from sitl.client import Client
from sitl.core.mavlink import MavCmd
from sitl.identify import identify
from sitl.logs.dataflash.log import attach
from sitl.missions.twin import twin
from sitl.missions.twin.twin import Twin
from sitl.vehicles import Airframe

from .identification import drill
from .manoeuvres import executable

HOME = (-35.363262, 149.165237, 584.0, 0.0)
SPEEDUP = 3
"""Of a real one: at more its log loses messages."""
BOOT_S = 30.0
"""At rest before arming: sensors and receiver are judged there."""
LOGGED = {"LOG_DISARMED": 1.0}
FAST = {"LOG_BITMASK": 180223.0, "WP_YAW_BEHAVIOR": 0.0, "WPNAV_ACCEL": 400.0, "WPNAV_JERK": 10.0}
"""As ``sitl identify --plan`` advises; newer firmware takes WP_ACC and WP_JERK."""
NEWER = {"WP_ACC": 4.0, "WP_JERK": 10.0}
QUAD, ROVER, OWN = "ardupilot_quad", "ardupilot_rover", "identified"
MASS = {"copter": 3.0, "rover": 13.0}
"""Of ArduPilot's simulated vehicles, as shipped airframes have it [kg]."""


def fly_items(vehicle: Client, *items: object) -> None:
    """A mission from arming to disarming; of a rover to its last item."""
    mission = vehicle.upload([vehicle.item("NAV_WAYPOINT", 0, 0), *items])  # type: ignore[list-item]
    vehicle.set_mode("GUIDED")
    vehicle.arm()
    vehicle.start_mission()
    if mission.items[1].command == MavCmd.NAV_TAKEOFF:
        vehicle.wait_disarmed(timeout=600)
    else:
        vehicle.wait_waypoint(len(mission) - 1, timeout=600)
        vehicle.delay(5)
        vehicle.disarm()


def square(vehicle: Client) -> None:
    """Square of 20 m at 10 m."""
    corners = ((20, 0), (20, 20), (0, 20), (0, 0))
    go = [vehicle.item("NAV_WAYPOINT", north, east, altitude=10) for north, east in corners]
    fly_items(vehicle, vehicle.item("NAV_TAKEOFF", altitude=10), *go, vehicle.item("NAV_LAND"))


def tour(vehicle: Client, speeds: Sequence[float] = (0.0, 0.0, 0.0)) -> None:
    """AUTO for three minutes: waits, climbs, twelve legs, short legs; the mission sets speeds [m/s] that are not 0."""
    go = lambda north, east, up=15, hold=0: vehicle.item("NAV_WAYPOINT", north, east, altitude=up, hold=hold)  # noqa: E731
    items = [vehicle.item("NAV_TAKEOFF", altitude=15), go(0, 0, hold=15), go(0, 0, 25, 2), go(0, 0, 15, 2)]
    for speed in speeds:
        items += [vehicle.item("DO_CHANGE_SPEED", param1=1, param2=speed)] * (speed > 0.0)
        items += [go(north, east) for north, east in ((40, 0), (40, 40), (0, 40), (0, 0))]
    items += [go(6 * (k % 4 in (1, 2)), 6 * (k % 4 in (2, 3))) for k in range(9)]
    fly_items(vehicle, *items, vehicle.item("NAV_RETURN_TO_LAUNCH"))


def guided(vehicle: Client) -> None:
    """GUIDED: places and velocities."""
    vehicle.take_off(10)
    vehicle.goto(15, 0, 10)
    vehicle.goto(15, 15, 12)
    for forward, right in ((3.0, 0.0), (0.0, -3.0), (-2.0, 2.0), (0.0, 0.0)):
        vehicle.set_velocity(forward, right, 0.0)
        vehicle.delay(4)
    vehicle.land()


def sticks(vehicle: Client) -> None:
    """By the sticks: up in ALT_HOLD, STABILIZE, ALT_HOLD again, down."""

    def hold(seconds: float, roll: int = 1500, pitch: int = 1500, throttle: int = 1500, yaw: int = 1500) -> None:
        vehicle.rc({1: roll, 2: pitch, 3: throttle, 4: yaw})
        vehicle.delay(seconds)

    vehicle.rc({1: 1500, 2: 1500, 3: 1000, 4: 1500})
    vehicle.set_mode("ALT_HOLD")
    vehicle.arm()
    hold(8, throttle=1750)
    for mode in ("ALT_HOLD", "STABILIZE"):
        vehicle.set_mode(mode)
        hold(2)
        for side in (-1, 1):
            hold(1.5, roll=1500 + 150 * side)
            hold(1.5, roll=1500 - 150 * side)
            hold(1.5, pitch=1500 + 150 * side)
            hold(1.5, pitch=1500 - 150 * side)
            hold(1.5, yaw=1500 + 150 * side)
    vehicle.set_mode("ALT_HOLD")
    hold(3)
    vehicle.rc({1: 1500, 2: 1500, 3: 1000, 4: 1500})
    vehicle.wait_disarmed(timeout=60)


def drive(vehicle: Client, speeds: Sequence[float] = (0.0, 0.0, 0.0)) -> None:
    """AUTO for two to three minutes: twelve legs, a slalom; the mission sets speeds [m/s] that are not 0."""
    side = 10.0 * vehicle.params["WP_SPEED"]
    items = []
    for speed in speeds:
        items += [vehicle.item("DO_CHANGE_SPEED", param1=1, param2=speed)] * (speed > 0.0)
        items += [vehicle.item("NAV_WAYPOINT", *place) for place in ((side, 0), (side, side), (0, side), (0, 0))]
    items += [vehicle.item("NAV_WAYPOINT", side * (0.2 + 0.2 * k), 0.3 * side * (k % 2)) for k in range(5)]
    fly_items(vehicle, *items)


def by_sticks(vehicle: Client) -> None:
    """MANUAL: throttle and steering, as ``sitl identify --plan`` advises."""
    vehicle.arm()
    drill(vehicle)
    vehicle.disarm()


class Flight(NamedTuple):
    """What is flown."""

    kind: str
    fly: Callable[[Client], None]
    params: Mapping[str, float] = LOGGED


FLIGHTS = {
    "square": Flight("copter", square),
    "guided": Flight("copter", guided),
    "sticks": Flight("copter", sticks),
    "tour": Flight("copter", tour, {**LOGGED, **FAST}),
    "tour at 3, 6, 9 m/s": Flight("copter", lambda vehicle: tour(vehicle, (3.0, 6.0, 9.0)), {**LOGGED, **FAST}),
    "drive": Flight("rover", drive),
    "drive at 3, 5, 8 m/s": Flight("rover", lambda vehicle: drive(vehicle, (3.0, 5.0, 8.0))),
    "by sticks": Flight("rover", by_sticks),
}
IDENTIFIED_BY = {"tour": ("tour",), "drive": ("drive", "by sticks"), "by sticks": ("drive", "by sticks")}
"""The flights whose logs tell the airframe."""


class Row(NamedTuple):
    """A log and its twin."""

    flight: str
    logged: str
    """Airframe of ours; empty: the real one."""
    twin: str
    seed: int = 0
    """Of the twin; our logs are of seed 3."""


ROWS = (
    Row("square", "erle_copter", "erle_copter", 3),
    Row("square", "erle_copter", "erle_copter"),
    Row("square", QUAD, QUAD),
    Row("square", "erle_copter", QUAD),
    Row("square", "", QUAD),
    Row("guided", "", QUAD),
    Row("sticks", "", QUAD),
    Row("tour", QUAD, QUAD),
    Row("tour", "", QUAD),
    Row("tour", "", OWN),
    Row("tour at 3, 6, 9 m/s", "", QUAD),
    Row("drive", ROVER, ROVER),
    Row("drive", "erle_rover", "erle_rover"),
    Row("drive", "", ROVER),
    Row("drive", "", OWN),
    Row("drive at 3, 5, 8 m/s", "", ROVER),
    Row("by sticks", "", ROVER),
    Row("by sticks", "", OWN),
)


def log_of(row: Row, programs: Path | None, folder: Path) -> Path:
    """The log of a flight, flown when it is not there yet."""
    flight = FLIGHTS[row.flight]
    if row.logged:
        path = folder / f"{row.flight}-{row.logged}.bin"
        if not path.exists():
            simulation = Simulation(row.logged, home=HOME, seed=3, params=dict(flight.params))
            attach(simulation, path)
            try:
                _flown(flight, Client(simulation))
            finally:
                simulation.close()
        return path
    own = folder / f"{row.flight.replace('/', ' ')}-real"
    path = own / "logs" / "00000001.BIN"
    if not path.exists():
        assert programs is not None
        own.mkdir(parents=True, exist_ok=True)
        params = {**vehicles.load(QUAD if flight.kind == "copter" else ROVER).parameters, **flight.params}
        if "WPNAV_ACCEL" in params:
            params |= NEWER
        program = executable.find(programs, flight.kind)
        with executable.started(program, flight.kind, HOME, SPEEDUP, params, own=own) as connection:
            _flown(flight, Client(connection, patience=60.0))
    return path


def _flown(flight: Flight, vehicle: Client) -> None:
    vehicle.wait_ready()
    vehicle.delay(BOOT_S)
    flight.fly(vehicle)
    vehicle.delay(3)


def twin_of(row: Row, programs: Path | None, folder: Path) -> Twin:
    """The twin, on a shipped airframe or on what is identified from logs."""
    frame: str | Airframe = row.twin
    if row.twin == OWN:
        logs = [log_of(row._replace(flight=name), programs, folder) for name in IDENTIFIED_BY[row.flight]]
        frame = identify(logs, mass=MASS[FLIGHTS[row.flight].kind]).airframe()
    return twin.fly(log_of(row, programs, folder), frame, seed=row.seed)


def cells(found: Twin, names: Sequence[str], digits: int = 2) -> str:
    """Metrics of one cell."""
    metrics = found.metrics()
    texts = []
    for name in names:
        value = metrics.get(name, math.nan)
        if name.endswith(".vaf"):
            texts.append("-" if not math.isfinite(value) else "below 0" if value < 0.0 else f"{value:.0f}")
        else:
            texts.append("-" if not math.isfinite(value) else f"{value:.{digits}g}")
    return ", ".join(texts)


def _named(part: str, what: str, *names: str) -> tuple[str, ...]:
    return tuple(f"{part}{name}.{what}" for name in names)


_RATES = ("roll_rate", "pitch_rate", "yaw_rate")
COLUMNS: dict[str, Mapping[str, tuple[str, ...]]] = {
    "copter": {
        "height [m]": ("height.rms",),
        "position [m]": ("position.rms",),
        "roll, pitch [deg]": ("roll.rms", "pitch.rms"),
        "rates roll, pitch, yaw [%]": _named("", "vaf", *_RATES),
        "in step: rates [%]": _named("legs.", "vaf", *_RATES),
        "segments: attitude [%]": _named("segments.", "vaf", "roll", "pitch"),
        "segments: yaw rate [%]": ("segments.yaw_rate.vaf",),
    },
    "rover": {
        "position [m]": ("position.rms",),
        "in step: position [m]": ("legs.position.rms",),
        "in step: speed, heading [m/s, deg]": ("legs.speed.rms", "legs.yaw.rms"),
        "speed, turn rate [%]": _named("", "vaf", "speed", "yaw_rate"),
        "in step: speed, turn rate [%]": _named("legs.", "vaf", "speed", "yaw_rate"),
        "in step: throttle [%]": ("legs.throttle.vaf",),
    },
}
"""Column -> its metrics, by kind of vehicle."""


def table(kind: str, flown: Iterable[tuple[Row, Twin]]) -> Iterator[str]:
    """Lines of the table of a kind of vehicle."""
    columns = COLUMNS[kind]
    yield "| flight | log | twin | " + " | ".join(columns) + " |"
    yield "|---" * (len(columns) + 3) + "|"
    for row, found in flown:
        seed = f", seed {row.seed}" if row.logged else ""
        logged = f"`{row.logged}`, seed 3" if row.logged else found.log.columns.firmware.split(" (")[0]
        frame = row.twin if row.twin == OWN else f"`{row.twin}`"
        metrics = " | ".join(cells(found, names) for names in columns.values())
        yield f"| {row.flight}, {found.log.span.length:.0f} s | {logged} | {frame}{seed} | {metrics} |"


def main(argv: Sequence[str] | None = None) -> int:
    """Fly, and print the tables."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.twins", description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--ardupilot", type=Path, metavar="FOLDER", help="with arducopter and ardurover")
    parser.add_argument("--keep", type=Path, metavar="DIR", help="keep the logs there; those that are there are taken")
    parser.add_argument("--only", nargs="+", choices=FLIGHTS, default=list(FLIGHTS), help="these flights")
    options = parser.parse_args(argv)
    if options.ardupilot:
        executable.enter_namespace()
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        flown = []
        for row in ROWS:
            if row.flight in options.only and (row.logged or options.ardupilot):
                found = twin_of(row, options.ardupilot, folder)
                flown.append((row, found))
                print(
                    f"{row.flight} {row.logged or 'real'} {row.twin}: {'; '.join(found.went + found.findings)}",
                    flush=True,
                )
        for kind in COLUMNS:
            of_kind = [(row, found) for row, found in flown if FLIGHTS[row.flight].kind == kind]
            if of_kind:
                print("\n".join(["", *table(kind, of_kind)]))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
