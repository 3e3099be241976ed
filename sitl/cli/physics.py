# SPDX-License-Identifier: BSD-3-Clause
"""``sitl physics``: the physics of a vehicle whose autopilot is another process."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from importlib import import_module

from ..errors import OptionError
from ..physics.engines import BACKENDS, NATIVE
from ..physics.native.power_on import DEFAULT_HOME
from ..plants.local import LocalPlant, stand_alone
from ..run.stop_signals import StopSignals
from ..vehicle.kinds import KINDS
from . import options as shared
from .progress import CompileProgress
from .view_options import add_view_options, check_view, shown

Serve = Callable[[LocalPlant, str, int, Callable[[str], None], Callable[[], bool]], None]
"""``serve(plant, address, instance, say, running)``: listens at the address until ``running()`` is false."""

LISTENERS = {"tcp": "sitl.plants.physics_server", "json": "sitl.foreign.json_host"}
"""Kind of ``--listen`` -> module that has ``serve``."""


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("physics")
    parser.add_argument("vehicle", choices=sorted(KINDS))
    parser.add_argument(
        "--backend", dest="physics", choices=BACKENDS, default=NATIVE, help=f"physics engine (default {NATIVE})"
    )
    parser.add_argument(
        "--listen",
        default="tcp",
        metavar="tcp[:[HOST:]PORT]|json[:[HOST:]PORT]",
        help="MAVLink HIL on a TCP port (default 127.0.0.1:4560), or ArduPilot's JSON on a UDP port (9002)",
    )
    parser.add_argument(
        "--instance",
        type=shared.instance,
        default=0,
        metavar="N",
        help="add N to the default TCP port, or 10 N to the UDP port",
    )
    parser.add_argument("--frame", metavar="NAME", help="airframe, or a .toml or .py file of one (sitl help vehicles)")
    parser.add_argument(
        "--home",
        type=shared.home,
        default=DEFAULT_HOME,
        metavar="LAT,LON,ALT,HEADING",
        help="home [deg, deg, m above mean sea level, deg]",
    )
    parser.add_argument(
        "--world", metavar="NAME|FILE", help="world with walls and obstacles; its origin is home (sitl world list)"
    )
    parser.add_argument("--start", type=shared.start, metavar="NAME|X,Y,Z,YAW", help="start pose in the world [m, deg]")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="seed of sensor noise and turbulence")
    add_view_options(parser)
    parser.set_defaults(function=physics)


def physics(options: argparse.Namespace) -> int:
    """Serve autopilots until Ctrl-C or SIGTERM.

    Raises:
        OptionError: an option that cannot be taken.
    """
    check_view(options)
    kind, _, address = options.listen.partition(":")
    if kind not in LISTENERS:
        raise OptionError(f"--listen {options.listen!r}: {kind!r} is not known; it is one of {', '.join(LISTENERS)}")
    serve: Serve = import_module(LISTENERS[kind]).serve
    scenario = shared.scenario_of(options)
    with CompileProgress() as progress:
        plant = stand_alone(scenario, progress=progress)
        plant.load_tick()
    with StopSignals() as signals:
        signals.catch()
        print(f"{scenario.airframe.name}, {scenario.physics} physics, seed {options.seed}", flush=True)
        try:
            with shown(plant, options) as on_turn:

                def running() -> bool:
                    on_turn()
                    return signals.go_on()

                serve(plant, address, options.instance, lambda text: print(text, flush=True), running)
        finally:
            plant.close()
    return 0
