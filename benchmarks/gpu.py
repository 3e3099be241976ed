# SPDX-License-Identifier: BSD-3-Clause
"""``python -m benchmarks.gpu``: whole autopilots with their physics on an NVIDIA GPU, one thread a vehicle.

First the kernel is held against the core: both advance the same vehicles, and the largest difference is printed. Then
come vehicle ticks a second. Machine code can be made on another machine, which needs no GPU: ``--compile-only --out
FOLDER`` there, ``--code FOLDER`` here, with the same version of everything.
"""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path
from typing import Any

import numpy as np

from sitl import vehicles
from sitl.errors import SitlError
from sitl.simulation import load_core
from sitl.vehicle.kinds import KINDS

from . import gpu_code
from .__main__ import begin, go_on
from .cuda_driver import Gpu, NoGpuError
from .gpu_code import MachineCode

Array = np.ndarray[Any, Any]
SIZES = (1024, 4096, 16_384, 65_536, 131_072)
TICKS = 400
"""A simulated second."""
CHECKED, CHECKED_TICKS = 64, (1, 40, TICKS)
"""Vehicles, and after how many ticks, that are held against the core."""


def compiled(kind: str, generation: tuple[int, int]) -> MachineCode:
    """The kernel of a kind of vehicle; prints what it takes."""
    begun = time.perf_counter()
    ptx = gpu_code.ptx_of(KINDS[kind].advance, KINDS[kind].record_path, generation)
    between = time.perf_counter()
    code = gpu_code.assemble(ptx)
    print(
        f"{kind}, sm_{generation[0]}{generation[1]}: {ptx.text.count(chr(10)):,} lines of PTX in "
        f"{between - begun:.0f} s, {code.instructions:,} instructions in {time.perf_counter() - between:.0f} s; "
        f"a thread has {code.registers} registers, {code.stack:,} bytes of stack, a record of "
        f"{KINDS[kind].record.dtype.itemsize:,} bytes",
        flush=True,
    )
    return code


def save(code: MachineCode, folder: Path, kind: str) -> None:
    """Write a kernel to a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{kind}.cubin").write_bytes(code.cubin)
    notes = {**code._asdict(), "layout": KINDS[kind].record.layout()}
    del notes["cubin"]
    (folder / f"{kind}.json").write_text(json.dumps(notes))


def load(folder: Path, kind: str) -> MachineCode:
    """Read it.

    Raises:
        SystemExit: it is not there, or was compiled for records of another layout.
    """
    try:
        known = json.loads((folder / f"{kind}.json").read_text())
        cubin = (folder / f"{kind}.cubin").read_bytes()
    except FileNotFoundError as error:
        raise SystemExit(
            f"{error.filename} is missing: python -m benchmarks.gpu --compile-only --out {folder}"
        ) from None
    if known.pop("layout") != KINDS[kind].record.layout():
        raise SystemExit(f"{folder / kind}.cubin is for other records than these: compile it anew")
    return MachineCode(cubin=cubin, **known)


def fleet_of(kind: str, count: int) -> Array:
    """Vehicles under way; of each ``CHECKED`` that follow one another, each has flown two seconds with noise of its
    own."""
    core = load_core(KINDS[kind])
    simulation = begin(vehicles.names(kind)[0], core).simulation
    start, flown = simulation.snapshot(), bytearray()
    for seed in range(CHECKED):
        simulation.restore(start)
        simulation.reseed(seed)
        for _ in range(2):
            go_on(core, simulation.fleet)
            simulation.advance(1.0)
        go_on(core, simulation.fleet)
        flown += simulation.fleet.view(np.uint8).tobytes()
    size = simulation.fleet.itemsize
    return np.frombuffer((flown * -(-count // CHECKED))[: count * size], simulation.fleet.dtype)


def copy_of(fleet: Array) -> Array:
    """With what lies between fields, which NumPy's own copies leave out."""
    return fleet.view(np.uint8).copy().view(fleet.dtype)


def check(gpu: Gpu, function: Any, kind: str) -> None:
    """Print the largest differences between core and GPU."""
    core, fleet = load_core(KINDS[kind]), fleet_of(kind, CHECKED)
    for ticks in CHECKED_TICKS:
        here, there = copy_of(fleet), copy_of(fleet)
        for index in range(CHECKED):
            core(here, index, ticks)
        with gpu.holding(fleet) as held:
            held.run(function, ticks, 32)
            held.read(there)
        if (there["time_us"] != here["time_us"]).any():
            raise SystemExit(
                f"{kind}: vehicles on the GPU are at {set(there['time_us'])} us, not {set(here['time_us'])}"
            )
        body, other = here["physics"]["body"], there["physics"]["body"]
        far, fast, turned = (float(np.abs(body[name] - other[name]).max()) for name in ("pos", "vel", "q"))
        same = int((here.view(np.uint8) == there.view(np.uint8)).reshape(CHECKED, -1).all(axis=1).sum())
        print(
            f"{kind} after {ticks} ticks: position differs by {far:.2g} m, velocity by {fast:.2g} m/s, attitude by "
            f"{turned:.2g}; {same} of {CHECKED} records are the same bit for bit",
            flush=True,
        )


def measure(gpu: Gpu, function: Any, kind: str, threads: int, repeats: int) -> None:
    """Print ticks a second by the number of vehicles."""
    for count in SIZES:
        fleet = fleet_of(kind, count)
        with gpu.holding(fleet) as held:
            held.run(function, 40, threads)
            times = []
            for _ in range(repeats):
                held.write(fleet)
                begun = time.perf_counter()
                held.run(function, TICKS, threads)
                times.append(time.perf_counter() - begun)
        rate = count * TICKS / min(times)
        print(f"{kind}, {count:7,d} vehicles: {rate:14,.0f} ticks/s, {rate / TICKS:12,.0f} times real time", flush=True)


def main() -> None:
    """Compile, check, measure."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.gpu")
    parser.add_argument("--vehicle", choices=tuple(KINDS), help="one kind; else all")
    parser.add_argument("--compile-only", action="store_true", help="needs no GPU")
    parser.add_argument("--for", dest="generation", default="9.0", help="with --compile-only: compute capability")
    parser.add_argument("--out", type=Path, metavar="FOLDER", help="keep machine code there")
    parser.add_argument("--code", type=Path, metavar="FOLDER", help="take machine code from there")
    parser.add_argument("--threads", type=int, default=32, metavar="N", help="of a block (default 32)")
    parser.add_argument("--repeats", type=int, default=3, metavar="N", help="of which the quickest counts")
    options = parser.parse_args()
    kinds = [options.vehicle] if options.vehicle else list(KINDS)
    try:
        gpu = None if options.compile_only else Gpu()
    except NoGpuError as error:
        raise SystemExit(f"{error}; --compile-only needs none") from None
    major, _, minor = options.generation.partition(".")
    generation = (int(major), int(minor or 0)) if gpu is None else gpu.generation
    for kind in kinds:
        try:
            code = load(options.code, kind) if options.code else compiled(kind, generation)
        except SitlError as error:
            raise SystemExit(str(error)) from None
        if options.out:
            save(code, options.out, kind)
        if gpu is not None:
            print(gpu.name)
            function = gpu.load(code.cubin, code.name)
            check(gpu, function, kind)
            measure(gpu, function, kind, options.threads, options.repeats)
    if gpu is not None:
        gpu.close()


if __name__ == "__main__":
    main()
