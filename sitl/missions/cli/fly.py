# SPDX-License-Identifier: BSD-3-Clause
"""``sitl mission fly``: fly a mission file from power-on to its end."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

from sitl.bridge.links import open_link
from sitl.cli import recordings
from sitl.cli.execute import terminable
from sitl.cli.fault_options import say_faults
from sitl.cli.options import add_vehicle_options, build_simulation, open_folder, seconds
from sitl.cli.view_options import DEFAULT_TEXT, add_view_options, check_view, default_speedup, shown
from sitl.core.mavlink import MavCmd, MavType
from sitl.errors import OptionError
from sitl.logs.dataflash.log import DataFlash
from sitl.run import runner
from sitl.run.pacing import StoppablePacing, parse_speedup
from sitl.vehicle.kinds import DEFAULT, KINDS
from sitl.vehicles import load as load_airframe

from .. import library
from ..files import MissionFile, for_vehicle
from ..files.document import kind_of_type
from ..files.store import READ_TEXT
from ..fly import LIMIT_S, Outcome, checked, fly
from .mission_options import add_file_options, load_all, say_notes


def add_parser(actions: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = actions.add_parser("fly", help="fly a mission file from power-on to its end")
    parser.add_argument(
        "mission",
        metavar="FILE|NAME",
        help=f"a file: {READ_TEXT}; or a mission of the library (sitl mission library)",
    )
    parser.add_argument("--vehicle", choices=sorted(KINDS), help="default: the vehicle type of the file, or a copter")
    parser.add_argument("--speedup", metavar="K|max", help=f"simulated seconds a second (default {DEFAULT_TEXT})")
    parser.add_argument(
        "--time-limit",
        type=seconds,
        default=LIMIT_S,
        metavar="SIM_SECONDS",
        help=f"simulated seconds since arming (default {LIMIT_S:g})",
    )
    add_file_options(parser)
    recordings.add_recording_option(parser)
    parser.add_argument(
        "--out", action="append", default=[], metavar="udp:HOST:PORT", help="also send telemetry to this address"
    )
    parser.add_argument("--quiet", action="store_true", help="print only the summary")
    add_vehicle_options(parser)
    add_view_options(parser)
    parser.set_defaults(function=run)


def run(options: argparse.Namespace) -> int:
    """Fly it; 0 when the mission was completed, 1 when it was not."""
    check_view(options)
    with terminable():
        return _fly(options, parse_speedup(options.speedup or default_speedup(options)))


def _fly(options: argparse.Namespace, speedup: float | None) -> int:
    name = options.mission
    entry = library.find(name) if name in library.entries() else None
    if entry is None and not Path(name).exists() and not Path(name).suffix:
        library.find(name)  # says what there is
    file = load_all(str(entry.path) if entry else name, options)
    if not file.mission.items:
        raise OptionError(
            f"{file.name}: no mission, but a geofence or rally points: they are given beside a mission "
            f"(sitl mission fly MISSION --{'fence' if file.fence_items else 'rally'} {name})"
        )
    params = prepare(options, file, entry)
    taken = KINDS[options.vehicle].firmware.commands.taken
    has_curves = any(item.command == MavCmd.NAV_SPLINE_WAYPOINT for item in file.mission.items)
    file = for_vehicle(file, taken)
    say_notes(file)
    folder = open_folder(options.log_dir)
    links = [open_link(text) for text in options.out]
    simulation = build_simulation(options, params)
    try:
        checked(file.mission, simulation)
        recordings.record(simulation, options)
        for link in links:
            simulation.bridge.add_link(link)
        stem = entry.name.replace("/", "-") if entry else Path(name).stem
        log = runner.open_log(simulation, folder, stem)
        if not options.quiet:
            print(f"{file.name}: {len(file.mission) - 1} items, {simulation.airframe.name}")
            if has_curves and MavCmd.NAV_SPLINE_WAYPOINT not in taken:
                print("  spline waypoints are flown as waypoints along the curve: the firmware has none")
            if file.has_fence_or_rally:
                print_fence_and_rally(file, simulation.parameters["FENCE_ENABLE"] != 0.0)
        pace = StoppablePacing(speedup)
        with shown(simulation, options, pace) as on_slice:
            outcome = fly(
                simulation,
                file.mission,
                fence=file.fence_items,
                rally=file.rally_items,
                limit_s=options.time_limit,
                advance=lambda until_us: runner.serve(simulation, pace, until_us=until_us, on_slice=on_slice),
                on_step=quiet if options.quiet else print_step,
            )
        recordings.say_why(simulation, "mission completed" if outcome.completed else outcome.reason)
    finally:
        simulation.close()
    print(summary(outcome))
    say_faults(simulation)
    for path in (log, *(simulation.logger.paths if isinstance(simulation.logger, DataFlash) else ())):
        print(f"log: {path}")
    if options.rec:
        print(f"recording: {options.rec}")
    return 0 if outcome.completed else 1


def print_fence_and_rally(file: MissionFile, enabled: bool) -> None:
    """Say what is uploaded besides the mission; ``enabled``: the vehicle heeds fences."""
    areas, points = len(file.circles) + len(file.polygons), len(file.rally)
    unheeded = "" if enabled or not areas else " (without effect: FENCE_ENABLE is 0)"
    print(f"  geofence of {areas} areas{unheeded}, {points} rally points")


def print_step(time: float, text: str) -> None:
    """Progress at a time [simulated s], at once also where the output is a pipe."""
    print(f"{time:8.1f} s  {text}", flush=True)


def quiet(time: float, text: str) -> None:
    """No progress at a time [simulated s]."""


def prepare(options: argparse.Namespace, file: MissionFile, entry: library.Entry | None) -> dict[str, float]:
    """Fill in options that were not given by what the file and the library say; gives parameters that it needs.

    Raises:
        OptionError: the file is for another kind of vehicle.
    """
    kind = entry.kind if entry else file.kind
    if (
        options.vehicle is None
        and file.vehicle_type not in (None, MavType.GENERIC)
        and kind_of_type(file.vehicle_type) is None
    ):
        raise OptionError(
            f"{file.name}: vehicleType {file.vehicle_type} (MAV_TYPE) is none of {', '.join(KINDS)}; "
            "--vehicle says what flies it"
        )
    if options.vehicle is None:
        options.vehicle = load_airframe(options.frame).kind if options.frame else kind or DEFAULT
    if file.vehicle_type is not None and file.kind is not None and file.kind != options.vehicle:
        raise OptionError(f"{file.name}: vehicleType {file.vehicle_type} is a {file.kind}, not a {options.vehicle}")
    if entry is not None:
        if options.frame is None:
            options.frame = entry.frame
        if options.world is None and entry.world is not None:
            options.world, options.start = entry.world, options.start or entry.start
    if options.home is None and file.home is not None and ":" not in options.physics:
        options.home = (*file.home, 0.0)
    return dict(entry.params) if entry else {}


def summary(outcome: Outcome) -> str:
    """Summary of a flight, in a few lines."""
    result = ("completed" if outcome.completed else "NOT COMPLETED") + (f": {outcome.reason}" if outcome.reason else "")
    if math.isnan(outcome.started):
        return f"mission {result}"
    at = outcome.deviation
    lines = [
        f"mission {result}",
        f"  time {outcome.duration:.1f} s, distance {outcome.distance:.1f} m, energy {outcome.energy:.2f} Wh, "
        f"items reached {len(outcome.items)}",
        f"  top speed {outcome.top_speed:.2f} m/s, top height {outcome.top_height:.2f} m",
        f"  farthest from the lines of the mission {at.distance:.2f} m (item {at.seq}, at {at.time:.1f} s)",
    ]
    if outcome.hits:
        lines.append(f"  hit solids {outcome.hits} times")
    return "\n".join(lines)
