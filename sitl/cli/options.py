# SPDX-License-Identifier: BSD-3-Clause
"""Options that ``sitl run`` and ``sitl exec`` share, and what they mean."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Mapping
from pathlib import Path

from .. import vehicles
from ..autopilot.params import parm_files
from ..physics.engines import NATIVE
from ..plants.plant import FORMS
from ..scenario import DEFAULT_HOME, ESTIMATORS, Home, Scenario, StartPose, checked_home
from ..simulation import OptionError, Simulation
from ..vehicle.kinds import DEFAULT, KINDS
from ..vehicles.receivers import AS_IT_IS, SETS, equipped
from ..worlds.heights import FORMS as FORMS_OF_HEIGHTS
from .fault_options import add_fail_option, vehicle_faults, watch_faults
from .progress import CompileProgress


def home(text: str) -> Home:
    """``LAT,LON,ALT,HEADING`` in degrees and metres, checked."""
    try:
        lat, lon, alt, heading = (float(word) for word in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r} is not LAT,LON,ALT,HEADING (degrees, degrees, metres, degrees), "
            f"as in {','.join(f'{number:.10g}' for number in DEFAULT_HOME)}"
        ) from None
    try:
        return checked_home((lat, lon, alt, heading))
    except OptionError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def start(text: str) -> StartPose:
    """Name of a start pose, or ``X,Y,Z,YAW`` in metres and degrees."""
    if "," not in text:
        return text
    try:
        x, y, z, yaw = (float(word) for word in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r} is neither the name of a start pose nor X,Y,Z,YAW (metres, degrees), as in 0,1.5,0,90"
        ) from None
    return (x, y, z, yaw)


def instance(text: str) -> int:
    """A whole number from 0 to 254 (an instance)."""
    if not text.isdigit() or int(text) > 254:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 0 to 254")
    return int(text)


def port(text: str) -> int:
    """A TCP port; 0 for a free one."""
    if not text.isdigit() or int(text) > 65535:
        raise argparse.ArgumentTypeError(f"{text!r} is not a port (0 .. 65535)")
    return int(text)


def stream_rate(text: str) -> int:
    """A rate of telemetry [Hz]; -1 for none of its own."""
    if text != "-1" and not (text.isdigit() and int(text) <= 400):
        raise argparse.ArgumentTypeError(f"{text!r} is not a rate (0 .. 400 Hz, or -1)")
    return int(text)


def seconds(text: str) -> float:
    """A positive number of simulated seconds."""
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 < value < 1e9:
        raise argparse.ArgumentTypeError(f"{text!r} is not a positive number of simulated seconds")
    return value


def add_vehicle_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that describe the vehicle and its start."""
    parser.add_argument("--frame", metavar="NAME", help="airframe, or a .toml or .py file of one (sitl help vehicles)")
    parser.add_argument(
        "--sensors",
        choices=SETS,
        default=AS_IT_IS,
        help="what tells the vehicle where it is (default gps: as the airframe has it)",
    )
    parser._negative_number_matcher = re.compile(r"-[\d.]")  # a value such as -35.3,149.1,584,0 is no option
    parser.add_argument(
        "--home",
        type=home,
        metavar="LAT,LON,ALT,HEADING",
        help="home [deg, deg, m above mean sea level, deg]",
    )
    parser.add_argument(
        "--physics", default=NATIVE, metavar="NAME", help=f"physics engine: {', '.join(FORMS)} (default {NATIVE})"
    )
    parser.add_argument(
        "--world", metavar="NAME|FILE", help="world with walls and obstacles; its origin is home (sitl world list)"
    )
    parser.add_argument("--terrain", metavar="HEIGHTS", help=f"terrain altitudes: {FORMS_OF_HEIGHTS}")
    parser.add_argument("--start", type=start, metavar="NAME|X,Y,Z,YAW", help="start pose in the world [m, deg]")
    parser.add_argument("--seed", type=int, metavar="N", help="seed of sensor noise and turbulence")
    parser.add_argument(
        "--estimator",
        choices=ESTIMATORS,
        default="ekf",
        help="ekf (default), or truth: the true state, without estimator errors",
    )
    parser.add_argument(
        "--params",
        action="append",
        default=[],
        metavar="FILE",
        help="file of parameters of any ground station: .parm, .param, .params (repeatable)",
    )
    add_fail_option(parser)
    parser.add_argument(
        "--log-dir", type=Path, default=Path("logs"), metavar="DIR", help="folder for the .tlog and .bin logs"
    )


def check_kind(frame: str, airframe: vehicles.Airframe, vehicle: str) -> None:
    """OptionError when the airframe of ``--frame`` is not one of this kind of vehicle."""
    if airframe.kind != vehicle:
        others = ", ".join(vehicles.names(vehicle))
        raise OptionError(f"--frame {frame} is a {airframe.kind}; those of a {vehicle} are {others}")


def scenario_of(options: argparse.Namespace, params: Mapping[str, float] | None = None) -> Scenario:
    """What the options of a command describe, with these parameters in their units; says what files of parameters have
    that this vehicle does not take."""
    vehicle = getattr(options, "vehicle", DEFAULT)
    airframe = vehicles.load(options.frame or KINDS[vehicle].default_frame)
    check_kind(options.frame, airframe, vehicle)
    airframe = equipped(airframe, getattr(options, "sensors", AS_IT_IS))
    if isinstance(params, parm_files.FileValues) and not params.is_reported:
        params.is_reported = True
        for text in parm_files.notes(KINDS[airframe.kind].firmware.table, params):
            print(f"sitl: {text}", file=sys.stderr)
    return Scenario(
        airframe,
        home=options.home,
        seed=options.seed,
        estimator=getattr(options, "estimator", ESTIMATORS[0]),
        params=params,
        world=options.world,
        start=options.start,
        physics=options.physics,
        faults=vehicle_faults(options),
        terrain=getattr(options, "terrain", None),
    )


def build_simulation(options: argparse.Namespace, overrides: Mapping[str, float] | None = None) -> Simulation:
    """The simulation that the options describe; compiles the core with a progress line when it must."""
    values = parm_files.given(overrides)
    if options.params:
        values = values | parm_files.load_all(options.params)
    scenario = scenario_of(options, values)
    with CompileProgress() as progress:
        simulation = Simulation(scenario, progress=progress)
    watch_faults(simulation)
    return simulation


def open_folder(folder: Path, option: str = "--log-dir") -> Path:
    """The folder of an option, made if need be; OptionError when that cannot be done."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OptionError(f"{option} {str(folder)!r} cannot be made: {error.strerror}") from None
    return folder
