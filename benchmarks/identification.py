# SPDX-License-Identifier: BSD-3-Clause
"""How right ``sitl identify`` is: logs of our own vehicles, whose properties are known, on seeds that it never saw.

    python -m benchmarks.identification                          # 5 seeds of each airframe: 3 minutes
    python -m benchmarks.identification --seeds 101..125 --airframes erle_copter
    python -m benchmarks.identification --keep logs --details    # the logs stay; a line for each property of each log
    python -m benchmarks.identification --physics pybullet       # of vehicles on another engine

Each log is one flight of the mission of ``sitl identify --plan`` of five minutes, in a wind of 0 to 6 m/s with gusts;
of a rover, a drive of its mission and by the sticks as ``--plan`` says.
For each property and airframe the table has the truth, in how many logs it was observed, in how many of these the
interval holds the truth, the median error, and the median half of the interval.
"""

from __future__ import annotations

import argparse
import math
import random
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from tqdm import tqdm

from sitl import Simulation, vehicles
from sitl.client import Client
from sitl.errors import SitlError
from sitl.identify import Identification, identify
from sitl.identify.drag import SPEED
from sitl.identify.expected import Copter
from sitl.identify.flight_plan import write
from sitl.identify.rover.expected import expected
from sitl.identify.shared import NOISES
from sitl.logs.dataflash.log import attach
from sitl.logs.tlog import TlogWriter
from sitl.missions import files
from sitl.physics.engines import BACKENDS, NATIVE
from sitl.vehicles import Airframe, CopterAirframe, RoverAirframe

COPTERS = ("ardupilot_quad", "ardupilot_hexa_x", "erle_copter", "erle_copter, 10 mm tail-heavy")
ROVERS = {"erle_rover": 1.4, "erle_rover_small": 0.3, "skid_rover": 1.8, "ardupilot_rover": 5.0}
"""Airframe -> speed of the plan's fastest legs [m/s]."""
AIRFRAMES = (*COPTERS, *ROVERS)
_HEAVY_M = 0.01
_FAST_ATTITUDE = 1
_TURBULENCE = 0.15
"""Gusts [m/s] by wind."""


def airframe_of(name: str) -> Airframe:
    """A shipped airframe; with a battery that sags where the shipped one has an ideal source."""
    shipped, _, changed = name.partition(",")
    found = vehicles.load(shipped)
    if not found.value("battery_capacity"):
        found = replace(found, properties={**found.properties, "battery_capacity": 5.0})
    if changed and isinstance(found, CopterAirframe):
        found = replace(found, rotors=tuple(rotor._replace(x=rotor.x + _HEAVY_M) for rotor in found.rotors))
    return found


def drive(name: str, seed: int, path: Path, physics: str) -> dict[str, float]:
    """Drive the plan, and by the sticks as its advice says."""
    path.unlink(missing_ok=True)
    simulation = Simulation(airframe_of(name), seed=seed, params={"LOG_DISARMED": 1}, physics=physics)
    try:
        attach(simulation, path)
        vehicle = Client(simulation)
        vehicle.wait_ready()
        vehicle.delay(30 + seed % 7)
        plan = path.with_suffix(".waypoints")
        latitude, longitude, _ = vehicle.home()
        write(plan, (1e-7 * latitude, 1e-7 * longitude), "rover", ROVERS[name])
        mission = vehicle.upload(files.load(plan).mission)
        vehicle.arm()
        vehicle.start_mission()
        vehicle.wait_waypoint(len(mission) - 1, timeout=900)
        drill(vehicle)
        vehicle.disarm()
        vehicle.delay(3)
    finally:
        simulation.close()
    return {}


def drill(vehicle: Client) -> None:
    """What the advice says of MANUAL."""
    ends = {channel: (vehicle.params[f"RC{channel}_MIN"], vehicle.params[f"RC{channel}_MAX"]) for channel in (1, 3)}

    def sticks(steering: float, throttle: float, seconds: float) -> None:
        pulses = {}
        for channel, share in ((1, steering), (3, throttle)):
            low, high = ends[channel]
            pulses[channel] = round(0.5 * (low + high) + 0.5 * (high - low) * share)
        vehicle.rc(pulses)
        vehicle.delay(seconds)

    sticks(0.0, 0.0, 0.1)
    vehicle.set_mode("MANUAL")
    sticks(0.0, 0.0, 3.0)
    for way in (1.0, -1.0):
        for throttle in (0.3, 0.6, 1.0):
            sticks(0.0, way * throttle, 5.0)
            sticks(0.0, 0.0, 3.0)
    for throttle in (1.0, -1.0):
        sticks(0.0, throttle, 5.0)
    sticks(0.0, 0.0, 3.0)
    for throttle in (0.25, 0.5, -0.25):
        for steering in (0.25, 0.5, 1.0):
            for side in (1.0, -1.0):
                sticks(side * steering, throttle, 3.0)
    sticks(0.0, 0.0, 6.0)


def fly(name: str, seed: int, path: Path, physics: str, telemetry_hz: int = 0) -> dict[str, float]:
    """Fly the plan; the wind that blew. With a rate its telemetry (.tlog) is kept, too, each message so often."""
    path.unlink(missing_ok=True)
    draw = random.Random(seed)
    wind, bearing = draw.uniform(0.0, 6.0), draw.uniform(0.0, 360.0)
    settings = {
        "SIM_WIND_SPD": wind,
        "SIM_WIND_DIR": bearing,
        "SIM_WIND_TURB": _TURBULENCE * wind,
        "SIM_WIND_T": 1,
        "LOG_DISARMED": 1,
        "WP_YAW_BEHAVIOR": 0,
        "WPNAV_ACCEL": 400,
        "WPNAV_JERK": 10,
    }
    simulation = Simulation(airframe_of(name), seed=seed, params=settings, physics=physics)
    try:
        attach(simulation, path)
        if telemetry_hz:
            simulation.bridge.taps.append(TlogWriter(path.with_suffix(".tlog"), simulation.bridge.epoch_us))
        vehicle = Client(simulation)
        if telemetry_hz:
            vehicle.params.read_all()
            vehicle.send("REQUEST_DATA_STREAM", req_message_rate=telemetry_hz, start_stop=1)
        vehicle.params["LOG_BITMASK"] = int(vehicle.params["LOG_BITMASK"]) | _FAST_ATTITUDE
        vehicle.wait_ready()
        vehicle.delay(30)
        vehicle.take_off(5)
        plan = path.with_suffix(".waypoints")
        latitude, longitude, _ = vehicle.home()
        write(plan, (1e-7 * latitude, 1e-7 * longitude))
        vehicle.upload(files.load(plan).mission)
        vehicle.start_mission()
        vehicle.wait_disarmed(timeout=900)
    finally:
        simulation.close()
    return {"wind_speed": wind, "wind_from": bearing}


def truth(name: str, found: Identification, wind: dict[str, float]) -> dict[str, float]:
    """What the properties of this flight were: those of the airframe, at the log's mean voltage and altitude."""
    airframe, log = airframe_of(name), found.logs[0]
    if isinstance(airframe, RoverAirframe):
        return {**expected(airframe), **_noises(airframe)}
    assert isinstance(airframe, CopterAirframe)
    value = lambda key: float(airframe.value(key))  # noqa: E731
    copter = Copter(airframe, log.parameters, log.conditions)
    known = {**copter.properties(), **wind}
    if found["hover_voltage"].is_observed:
        hovering = log.conditions._replace(voltage=found["hover_voltage"].value)
        known["hover_output"] = Copter(airframe, log.parameters, hovering).properties()["hover_output"]
    for axis, letter in (("along", "x"), ("across", "y")):
        quadratic = 0.5 * copter.density / known[f"drag_bcoef_{letter}"]
        known[f"drag_{axis}"] = known["drag_mcoef"] * SPEED + quadratic * SPEED * SPEED
    known["battery_resistance"] = value("battery_resistance")
    known["balance_forward"] = (-_HEAVY_M if "," in name else 0.0) / max(
        math.hypot(rotor.x - _HEAVY_M * ("," in name), rotor.y) for rotor in airframe.rotors
    )
    known["balance_right"] = 0.0
    known["dead_time"] = (
        0.0025  # a tick of 2.5 ms: half of it each until the output acts and until the rate is measured
    )
    return {**known, **_noises(airframe)}


def _noises(airframe: Airframe) -> dict[str, float]:
    """Of the sensors that have some."""
    return {name: float(airframe.value(name)) for name in NOISES if float(airframe.value(name)) > 0.0}


def seeds(text: str) -> tuple[int, ...]:
    """Of "101..105" or "3,7"."""
    first, _, last = text.partition("..")
    return tuple(range(int(first), int(last) + 1)) if last else tuple(map(int, text.split(",")))


Result = tuple[float, float, float, float]
"""Truth, estimate, ends of the interval; not a number where it was not observed."""


def judge(name: str, seed: int, folder: Path, physics: str, telemetry_hz: int = 0) -> dict[str, Result]:
    """Fly and identify one log; with a rate its telemetry."""
    path = folder / f"{name.replace(', ', '-').replace(' ', '-')}-{seed}.bin"
    winds = drive(name, seed, path, physics) if name in ROVERS else fly(name, seed, path, physics, telemetry_hz)
    found = identify(path.with_suffix(".tlog") if telemetry_hz else path)
    known = truth(name, found, winds)
    return {
        estimate.name: (known[estimate.name], estimate.value, estimate.low, estimate.high)
        for estimate in found.estimates
        if math.isfinite(known.get(estimate.name, math.nan))
    }


def rows(name: str, results: list[dict[str, Result]]) -> Iterator[str]:
    """Lines of the table."""
    for key in results[0]:
        all_of = np.array([result[key] for result in results if key in result])
        seen = all_of[np.isfinite(all_of[:, 1])]
        true = np.median(all_of[:, 0])
        if not len(seen):
            yield f"| {key} | {name} | {true:.4g} | 0 of {len(all_of)} | | | |"
            continue
        miss, half = seen[:, 1] - seen[:, 0], 0.5 * (seen[:, 3] - seen[:, 2])
        if key == "wind_from":
            miss = (miss + 180.0) % 360.0 - 180.0
        held = int((abs(miss) <= _reach(seen, miss)).sum())
        if key in _ABSOLUTE:
            size = [f"{np.median(abs(x)):.2g}" for x in (miss, half)]
        else:
            size = [f"{100.0 * np.median(abs(x / seen[:, 0])):.1f} %" for x in (miss, half)]
        yield f"| {key} | {name} | {true:.4g} | {len(seen)} of {len(all_of)} | {held} | {size[0]} | {size[1]} |"


_ABSOLUTE = ("balance_forward", "balance_right", "motor_lag", "dead_time", "wind_from", "wind_speed", "thrust_expo") + (
    "roll_damping", "pitch_damping", "yaw_damping", "steering_trim", "side_difference", "rear_axle",
)  # fmt: skip
"""Properties that may be 0: their errors are in their own unit."""


def _reach(seen: np.ndarray, miss: np.ndarray) -> np.ndarray:
    """How far the interval reaches on the side where the truth is."""
    return np.where(miss > 0.0, seen[:, 1] - seen[:, 2], seen[:, 3] - seen[:, 1]) + 1e-12


def main(argv: list[str] | None = None) -> int:
    """Fly, identify, print the table."""
    parser = argparse.ArgumentParser(prog="benchmarks.identification", description=__doc__.partition("\n")[0])
    parser.add_argument("--airframes", nargs="+", default=list(AIRFRAMES), metavar="NAME")
    parser.add_argument("--seeds", type=seeds, default=seeds("101..105"), metavar="A..B", help="or 3,7")
    parser.add_argument("--keep", type=Path, metavar="DIR", help="keep the logs there")
    parser.add_argument("--telemetry", type=int, default=0, metavar="HZ", help="judge telemetry of this rate instead")
    parser.add_argument("--physics", choices=BACKENDS, default=NATIVE, help="what the vehicles move on")
    parser.add_argument("--details", action="store_true", help="a line for each property of each log")
    options = parser.parse_args(argv)
    if options.telemetry and not {*ROVERS}.isdisjoint(options.airframes):
        parser.error(f"--telemetry is of copters: --airframes {' '.join(COPTERS[:3])}")
    lines: list[str] = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for name in options.airframes:
            results = []
            for seed in tqdm(options.seeds, name, leave=False, disable=None):
                try:
                    results.append(judge(name, seed, folder, options.physics, options.telemetry))
                except SitlError as error:
                    print(f"{name}, seed {seed}: {error}")
                    continue
                if options.details:
                    for key, (true, value, low, high) in results[-1].items():
                        mark = "" if not math.isfinite(value) or low <= true <= high else "  <- not in it"
                        print(f"{name} {seed} {key}: {value:.5g} ({low:.5g} .. {high:.5g}), truth {true:.5g}{mark}")
            if results:
                lines += rows(name, results)
    print(
        "| property | airframe | truth | observed in | interval holds the truth | median error | median half interval |"
    )
    print("|---|---|---|---|---|---|---|")
    print("\n".join(lines))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
