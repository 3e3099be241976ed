# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.manoeuvres [--ardupilot PATH] [copter|rover [FLIGHT ...]]``: ours and the real one."""

from __future__ import annotations

import argparse
import datetime
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from sitl import vehicles
from sitl.errors import OptionError
from sitl.simulation import Simulation, load_core
from sitl.vehicle.kinds import KINDS

from . import copter, disturbed, executable, paths, rover, table
from .flyer import Flyer, Metrics

HOME = (-35.363262, 149.165237, 584.0, 0.0)
FRAMES = {"copter": "ardupilot_quad", "rover": "ardupilot_rover"}
FLIGHTS: dict[str, Mapping[str, Callable[[Flyer], None]]] = {
    "copter": {**copter.FLIGHTS, **disturbed.FLIGHTS, **paths.FLIGHTS},
    "rover": rover.FLIGHTS,
}
RATES_HZ = {"copter": 50.0, "rover": 25.0}
BOOT_SPEEDUP = 60
WHY = """
### Reasons for differences of manoeuvres

- *Rover, from standstill* (RTL, SMART_RTL, AUTO after its delay, the first turns, headings in AUTO with the
  steering stick out, the end of HOLD). While a rover stands, ArduPilot's estimate has an error of 0.02 to 0.05 m/s
  and 2 to 6 deg of heading: its EKF gives GPS and compass less weight, and follows the drift of the simulated gyros
  later. Our error is 0.01 m/s and 1 deg. The target moves along the leg only as fast as the vehicle does, so the
  first metre takes half a second more or less. In SMART_RTL this decides between a left and a right turn: of three
  flights of ArduPilot, two took 24 s to the middle of the path and one took 20 s.
- *Copter, sticks: half of the lean* and the altitude after a short climb. Our autopilot reads RC overrides at the
  frame rate of the receiver, 50 Hz; ArduPilot reads them at 250 Hz, 20 ms earlier.
- *3 m/s east: 95 %* and the first moments of turn rates: both curves are almost flat there, and commands reach
  ArduPilot about 10 ms late.
- *Copter, GUIDED velocities against a fence*: ArduPilot stops 1.3 m within FENCE_MARGIN with any AVOID_BEHAVE; ours
  stops at the margin, as both do in LOITER. ArduPilot's avoidance changes the stored set-point itself, until the next
  one arrives.
- *GPS lost*: the flights agree. 15 s after the loss, when aiding stops, ArduPilot no longer sends
  LOCAL_POSITION_NED; ours sends its estimate on.
- *STABILIZE and ACRO, climb and speed after 6 s*: the learnt hover throttle (MOT_THST_HOVER) differs by 0.002, which
  is 0.05 m/s.
- *ACRO, back and forth*: ArduPilot's flights vary as much, because the sticks arrive up to 20 ms late.
- *Splines, after a pause*: both stop at once. Ours goes on 2.4 s earlier, because its ramp ends at full speed, where
  ArduPilot's comes near to it ever more slowly.
"""
HEADING = "## Manoeuvres"


def chosen(kind: str, names: Sequence[str]) -> dict[str, Callable[[Flyer], None]]:
    """Flights of a kind of vehicle; all when none is named.

    Raises:
        OptionError: there is no such flight.
    """
    flights = FLIGHTS[kind]
    for name in names:
        if name not in flights:
            raise OptionError(f"a {kind} has no flight {name!r}; it has {', '.join(flights)}")
    return {name: flights[name] for name in names or flights}


def fly_ours(kind: str, names: Sequence[str] = (), seed: int = 0) -> dict[str, Metrics]:
    """The metrics of a simulation in this process."""
    core, found = load_core(KINDS[kind]), {}
    for name, flight in chosen(kind, names).items():
        flyer = Flyer(Simulation(FRAMES[kind], home=HOME, seed=seed, core=core), RATES_HZ[kind])
        flight(flyer)
        found[name] = flyer.metrics
    return found


def fly_executable(
    path: Path, kind: str, names: Sequence[str], speedup: int, instance: int = 0
) -> tuple[dict[str, Metrics], str]:
    """The metrics of an executable, and its version."""
    found, version = {}, ""
    params = vehicles.load(FRAMES[kind]).parameters
    for name, flight in chosen(kind, names).items():
        with executable.started(executable.find(path, kind), kind, HOME, BOOT_SPEEDUP, params, instance) as connection:
            flyer = Flyer(connection, RATES_HZ[kind])
            version = _version(flyer)
            flyer.wait_ready()
            flyer.params["SIM_SPEEDUP"] = speedup
            flight(flyer)
        found[name] = flyer.metrics
        print(f"{kind} {name}: {len(flyer.metrics)} metrics of {path.name}", flush=True)
    return found, version


def _version(flyer: Flyer) -> str:
    m = flyer.message("AUTOPILOT_VERSION")
    number = ".".join(str(m.flight_sw_version >> shift & 0xFF) for shift in (24, 16, 8))
    kind = {0: "-dev", 255: ""}.get(m.flight_sw_version & 0xFF, "")
    return f"{number}{kind} ({bytes(m.flight_custom_version).decode('ascii', 'replace')})"


def section(found: Mapping[str, list[table.Row]], described: Mapping[str, str]) -> str:
    """The part of the page."""
    every = [row for part in found.values() for row in part]
    parts = [
        f"{HEADING} by commands and sticks\n",
        "Scripts of this project fly a real ArduPilot and ours by MAVLink, with the same parameters (the defaults",
        "of the firmware and those of our airframe), in simulated time. ArduPilot's flights vary a little, because",
        "its clock continues while a client writes. Its values are medians of three flights, in",
        "`benchmarks/reference/`; they are from `python -m benchmarks.manoeuvres --ardupilot PATH --times 3",
        "--keep`, where PATH is the folder of `arducopter` and `ardurover`. Without `--ardupilot` the command",
        "compares with these metrics.",
        f"\n{table.RULE}\n",
        f"**{table.summary(every)}**; by {table.PERCENT:g} % or {table.CLOSE['m']:g} m alone "
        f"{sum(map(table.within, every))} do. Most of the others are times below {table.SHORT_S:g} s.",
    ]
    for kind, part in found.items():
        parts.append(f"\n### {kind.title()}: {table.summary(part)}, compared with {described[kind]}\n")
        for flight in dict.fromkeys(row.flight for row in part):
            own = [row for row in part if row.flight == flight]
            parts.append(f"{FLIGHTS[kind][flight].__doc__}\n\n{table.markdown(own)}\n")
    return "\n".join(parts) + WHY


def kept_beside_ours() -> str:
    """The same with the kept metrics of both kinds of vehicles."""
    found, described = {}, {}
    for kind in sorted(FLIGHTS):
        kept = table.kept(kind)
        found[kind] = table.rows(fly_ours(kind), kept["metrics"])
        described[kind] = f"ArduPilot {kept['version']} of {kept['date']}"
    return section(found, described)


def parser() -> argparse.ArgumentParser:
    """The command line."""
    top = argparse.ArgumentParser(prog="python -m benchmarks.manoeuvres", description=__doc__)
    top.add_argument("kind", nargs="?", choices=sorted(FLIGHTS), help="of vehicle (default: all)")
    top.add_argument("flights", nargs="*", metavar="FLIGHT", help="names of flights (default: all)")
    top.add_argument(
        "--ardupilot", type=Path, metavar="PATH", help="executable, or folder with both; else kept metrics"
    )
    top.add_argument(
        "--ours", type=Path, metavar="PATH", help="executable of ours instead of a vehicle in this process"
    )
    top.add_argument("--speedup", type=int, default=2, metavar="K", help="of executables (default 2)")
    top.add_argument("--times", type=int, default=1, metavar="N", help="fly --ardupilot N times, take each median")
    top.add_argument("--keep", action="store_true", help="keep the metrics of --ardupilot, in the package")
    top.add_argument("--page", type=Path, metavar="FILE", help="replace the page's section of these tables")
    return top


def main() -> None:
    """Fly, and print the tables."""
    options = parser().parse_args()
    if options.ardupilot or options.ours:
        executable.enter_namespace()
    found, described = {}, {}
    for kind in [options.kind] if options.kind else sorted(FLIGHTS):
        if options.ardupilot:
            date = datetime.date.today().isoformat()
            flown = [
                fly_executable(options.ardupilot, kind, options.flights, options.speedup) for _ in range(options.times)
            ]
            theirs, version = table.medians([metrics for metrics, _ in flown]), flown[0][1]
            if options.keep:
                path = Path(__file__).parents[1] / "reference" / table.file_name(kind)
                others = table.kept(kind)["metrics"] if options.flights and path.exists() else {}
                path.write_text(table.as_json(version, date, {**others, **theirs}), encoding="utf-8")
        else:
            kept = table.kept(kind)
            theirs, version, date = kept["metrics"], kept["version"], kept["date"]
        if options.ours:
            ours, _ = fly_executable(options.ours, kind, options.flights, options.speedup)
        else:
            ours = fly_ours(kind, options.flights)
        found[kind], described[kind] = table.rows(ours, theirs), f"ArduPilot {version} of {date}"
    text = section(found, described)
    print(text)
    if options.page:
        before = options.page.read_text(encoding="utf-8").split(f"\n{HEADING}")[0].rstrip()
        options.page.write_text(f"{before}\n\n{text}", encoding="utf-8")


if __name__ == "__main__":
    main()
