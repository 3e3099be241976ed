# SPDX-License-Identifier: BSD-3-Clause
"""``sitl cache``: the compiled core on disk."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from ..core import code_cache
from ..core import compile as compiler
from ..core.array_kernels import KERNELS, build_kernels, missing_kernels
from .output import add_json_option, print_json

if TYPE_CHECKING:
    from ..vehicle.kind import Kind

KERNEL_MODULES = (
    "sitl.agents.tabular.compiled_loop",
    "sitl.agents.tabular.exploration",
    "sitl.agents.tabular.learn",
    "sitl.agents.ways",
    "sitl.envs.free_ways",
    "sitl.envs.mavlink.compiled",
    "sitl.envs.observations",
    "sitl.envs.pictures",
    "sitl.envs.robots.truth",
    "sitl.envs.starts",
    "sitl.envs.targets.gates",
    "sitl.envs.targets.places",
    "sitl.envs.targets.waypoints",
    "sitl.envs.tasks",
    "sitl.fleet",
    "sitl.logs.dataflash.derived",
    "sitl.physics.native.traffic",
    "sitl.physics.native.turtlebot.fleet",
    "sitl.worlds.camera",
    "sitl.worlds.contact",
    "sitl.worlds.planar",
    "sitl.worlds.raycast",
)
"""Modules that make kernels; loaded by name, because some are of packages above this one."""


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("cache")
    parser.add_argument("action", choices=("show", "clear", "build"))
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
    elif options.json:
        rows = [{"vehicle": kind, "unit": unit, "ready": ready} for kind, unit, ready in units()]
        print_json({"folder": str(code_cache.cache_folder()), "units": rows})
    else:
        print(code_cache.cache_folder())
        for kind, unit, ready in units():
            print(f"  {'ready   ' if ready else 'to build'}  {kind}: {unit}")
    return 0


def units() -> Iterator[tuple[str, str, bool]]:
    """(kind of vehicle, name, whether there is machine code) of each unit of the core, and of the kernels of fleets,
    environments, worlds and agents, which are of "every kind"."""
    from ..vehicle.kinds import KINDS

    for kind in KINDS.values():
        absent = {unit for entry in entries(kind) for unit in compiler.missing(entry, kind.record_path)}
        for unit in dict.fromkeys(unit for entry in entries(kind) for unit in compiler.reached(entry)):
            yield kind.name, unit.name, unit not in absent
    absent_kernels = {task.partition(":")[2] for task in missing_kernels(KERNEL_MODULES)}
    for name in sorted(KERNELS):
        yield "every kind", name, name not in absent_kernels


def entries(kind: Kind) -> tuple[Callable[..., None], ...]:
    """Units that a run of a kind of vehicle calls; a kind without a face on MAVLink is only advanced."""
    if "mavlink" not in kind.parts:
        return (kind.advance,)
    from ..bridge.profile import load as load_profile

    units = load_profile(kind.name).core
    return units.run, units.hear


def all_entries(kind: Kind) -> tuple[Callable[..., None], ...]:
    """Every unit of a kind of vehicle that is called from outside the core: those of a run, of fleets, of moves, of
    several vehicles in one world, and of physics engines besides the native one."""
    from ..physics.native import ranging

    found = [*entries(kind), kind.fly, kind.step, kind.move, kind.meet, ranging.list_near]
    if kind.pieces is not None:
        found += [kind.pieces.begin, kind.pieces.load, kind.pieces.sense, ranging.aim_sensor, ranging.finish_scan]
    if "mavlink" in kind.parts:
        from ..bridge.profile import load as load_profile

        units = load_profile(kind.name).core
        found += [units.tell, units.run_all]
    return tuple(dict.fromkeys(unit for unit in found if unit is not None))
