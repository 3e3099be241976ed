# SPDX-License-Identifier: BSD-3-Clause
"""``sitl cache``: the compiled core on disk."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from ..core import code_cache
from ..core import compile as compiler
from ..core.array_kernels import KERNELS, build_kernels, is_shipped, missing_kernels
from ..core.numba_tuning import summary
from ..core.shipped.build import Piece, build, pieces
from ..core.shipped.library import library
from ..core.shipped.target_machines import TARGETS, usable
from ..errors import OptionError
from .output import add_json_option, print_json

if TYPE_CHECKING:
    from ..vehicle.kind import Kind

KERNEL_MODULES = (
    "sitl.agents.deep.layers",
    "sitl.agents.deep.narrow",
    "sitl.agents.tabular.compiled_loop",
    "sitl.agents.tabular.exploration",
    "sitl.agents.tabular.learn",
    "sitl.agents.grid_a_star",
    "sitl.core.elementary_kernels",
    "sitl.foreign.exchange",
    "sitl.foreign.hil_exchange",
    "sitl.envs.actions",
    "sitl.envs.costs",
    "sitl.envs.shortest_paths",
    "sitl.envs.gathering",
    "sitl.envs.judge",
    "sitl.envs.mavlink.compiled",
    "sitl.envs.observations",
    "sitl.envs.parts",
    "sitl.envs.pictures",
    "sitl.envs.robots.true_state",
    "sitl.envs.session",
    "sitl.envs.starts",
    "sitl.envs.targets.gates",
    "sitl.envs.targets.hold",
    "sitl.envs.targets.landing",
    "sitl.envs.targets.moving",
    "sitl.envs.targets.parking",
    "sitl.envs.targets.target_task",
    "sitl.envs.targets.waypoints",
    "sitl.envs.tasks",
    "sitl.fleet",
    "sitl.identify.rover.courses",
    "sitl.logs.dataflash.derived",
    "sitl.physics.native.traffic",
    "sitl.physics.native.turtlebot.compiled_fleet",
    "sitl.worlds.camera",
    "sitl.worlds.contact",
    "sitl.worlds.planar",
    "sitl.worlds.raycast",
)
"""Modules that make kernels; loaded by name, because some are of packages above this one."""
SHIPPED, READY, TO_BUILD = "shipped", "ready", "to build"
"""Where the machine code of a unit is: it came with the package, was compiled here, or is not there yet."""


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("cache")
    parser.add_argument("action", choices=("show", "clear", "build", "ship"))
    parser.add_argument("--folder", type=Path, default=Path("build/shipped"), help="with ship, where libraries go")
    parser.add_argument("--here", action="store_true", help="with ship, for this machine alone")
    add_json_option(parser, "with show, the folder and its units")
    parser.set_defaults(function=cache)


def cache(options: argparse.Namespace) -> int:
    """Show where the compiled core is, delete it, or build what is missing."""
    from ..vehicle.kinds import KINDS
    from .progress import CompileProgress

    if options.action == "clear":
        print(f"deleted {code_cache.clear_cache()} compiled units from {code_cache.cache_folder()}")
    elif options.action == "build":
        with CompileProgress() as progress:
            took = sum(compiler.build(all_entries(kind), kind.record_path, progress) for kind in KINDS.values())
            took += build_kernels(KERNEL_MODULES, progress)
        print(f"built in {took:.1f} s")
    elif options.action == "ship":
        targets = usable()[:1] if options.here else TARGETS
        if not targets:
            raise OptionError("sitl cache ship --here: code is shipped for Linux alone; sitl cache build compiles here")
        with CompileProgress(f"gym-sitl compiles its core for {', '.join(t.name for t in targets)}") as progress:
            for file in build(shipped_pieces(), options.folder, targets, progress):
                print(f"{file}: {file.stat().st_size / 1e6:.1f} MB")
    elif options.json:
        rows = [
            {"vehicle": kind, "unit": unit, "ready": state != TO_BUILD, "shipped": state == SHIPPED}
            for kind, unit, state in units()
        ]
        shipped = library()
        from_package = None if shipped is None else str(shipped.file)
        folder = str(code_cache.cache_folder())
        print_json({"folder": folder, "library": from_package, "compiler": summary(), "units": rows})
    else:
        print(code_cache.cache_folder())
        print(shipped_library())
        print(summary())
        for kind, unit, state in units():
            print(f"  {state:8}  {kind}: {unit}")
    return 0


def shipped_pieces() -> list[Piece]:
    """All units of the kinds of vehicle that come with the simulator, and all kernels."""
    from ..vehicle.kinds import BUILT_IN, KINDS

    return pieces({KINDS[name].record_path: all_entries(KINDS[name]) for name in BUILT_IN}, KERNEL_MODULES)


def shipped_library() -> str:
    """The library of machine code that came with the package, in words."""
    shipped = library()
    if shipped is not None:
        return f"{shipped.file} ({shipped.target.name}, made with {shipped.made_with})"
    return "no machine code came with this installation for this machine: all is compiled here"


def units() -> Iterator[tuple[str, str, str]]:
    """(Kind of vehicle, name, ``SHIPPED``, ``READY`` or ``TO_BUILD``) of each unit of the core, and of the kernels of
    fleets, environments, worlds and agents, which are of "every kind"."""
    from ..vehicle.kinds import KINDS

    for kind in KINDS.values():
        absent = {unit for entry in entries(kind) for unit in compiler.missing(entry, kind.record_path)}
        for unit in dict.fromkeys(unit for entry in entries(kind) for unit in compiler.reached(entry)):
            from_package = compiler.is_shipped(unit, kind.record_path)
            yield kind.name, unit.name, SHIPPED if from_package else TO_BUILD if unit in absent else READY
    absent_kernels = {task.partition(":")[2] for task in missing_kernels(KERNEL_MODULES)}
    for name in sorted(KERNELS):
        state = SHIPPED if is_shipped(KERNELS[name]) else TO_BUILD if name in absent_kernels else READY
        yield "every kind", name, state


def entries(kind: Kind) -> tuple[Callable[..., None], ...]:
    """Units that a run of a kind of vehicle calls; a kind without a face on MAVLink is only advanced."""
    if "mavlink" not in kind.parts:
        return (kind.advance,)
    from ..bridge.firmware_profile import load as load_profile

    units = load_profile(kind.name).core
    return units.run, units.receive


def all_entries(kind: Kind) -> tuple[Callable[..., None], ...]:
    """Every unit of a kind of vehicle that is called from outside the core: those of a run, of fleets, of moves, of
    several vehicles in one world, and of physics engines besides the native one."""
    from ..physics.native import ranging

    found = [*entries(kind), kind.fly, kind.step, kind.move, kind.meet, ranging.list_near]
    if kind.pieces is not None:
        found += [kind.pieces.begin, kind.pieces.load, kind.pieces.sense, ranging.aim_sensor, ranging.finish_scan]
    if "mavlink" in kind.parts:
        from ..bridge.firmware_profile import load as load_profile

        units = load_profile(kind.name).core
        found += [units.transmit, units.run_all]
    return tuple(dict.fromkeys(unit for unit in found if unit is not None))
