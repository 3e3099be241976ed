# SPDX-License-Identifier: BSD-3-Clause
"""Stands in for ArduPilot's simulator program: its command line, its wire, its boot; our firmware inside.

As the real one: listens for MAVLink on the base port and boots when the first client connects; sends servos to the
simulator port and stands still until it is answered; hears commands only while its time passes; a reboot is a new
program in the same process; ends when whoever has started it has gone.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from dataclasses import replace
from pathlib import Path

from sitl import vehicles
from sitl.autopilot.params import parm_files
from sitl.bridge.links.tcp import TcpServerLink
from sitl.plants.plant import PhysicsLostError
from sitl.run.pacing import Pacing
from sitl.simulation import Simulation

FRAMES = {"arducopter": "erle_copter", "ardurover": "erle_rover"}


def options(words: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    parser.add_argument("--base-port", type=int, default=5760)
    parser.add_argument("--instance", "-I", type=int, default=0)
    parser.add_argument("--model", "-M", required=True)
    parser.add_argument("--sim-port-out", type=int, default=9002)
    parser.add_argument("--rc-in-port", type=int, default=5501)
    parser.add_argument("--home", "-O", required=True)
    parser.add_argument("--start-time", type=int)
    parser.add_argument("--speedup", "-s", type=float, default=1.0)
    parser.add_argument("--defaults", default="")
    parser.add_argument("--wipe", "-w", action="store_true")
    at = words.index("--home")  # argparse takes a latitude in the south for an option
    return parser.parse_args([*words[:at], f"--home={words[at + 1]}", *words[at + 2 :]])


def main(name: str, words: list[str]) -> None:
    given, parent = options(words), os.getppid()
    model, _, host = given.model.partition(":")
    assert model == "JSON"
    print(f"Starting {name}: JSON at {host}:{given.sim_port_out}", flush=True)
    values = parm_files.load_all([path for path in given.defaults.split(",") if path])
    lat, lon, alt, heading = (float(number) for number in given.home.split(","))
    bare = replace(vehicles.load(FRAMES[name]), parameters={})  # it knows no airframe but by its parameters
    simulation = Simulation(
        bare, home=(lat, lon, alt, heading), params=values, physics=f"json:{host}:{given.sim_port_out}"
    )
    clients = TcpServerLink(given.base_port)
    simulation.bridge.add_link(clients)
    print("Waiting for connection ....", flush=True)
    while not clients.peers:
        simulation.bridge.wait(0.5)
        simulation.bridge.receive()
        if os.getppid() != parent:
            return
    print("ArduPilot Ready", flush=True)
    pacing = Pacing(None if given.speedup >= 1000 else given.speedup)
    while os.getppid() == parent:
        with contextlib.suppress(PhysicsLostError):
            simulation.advance_to(simulation.time_us + pacing.slice_us)
            pacing.after_slice(simulation)
        if simulation.before_boot_us:
            simulation.close()
            os.execv(sys.executable, [sys.executable, __file__, name, *words])


def install(folder: Path, name: str = "arducopter") -> Path:
    """A program in a folder that starts this file, as ``name``."""
    program = folder / name
    root = Path(__file__).resolve().parents[2]
    program.write_text(f'#!/bin/sh\nPYTHONPATH="{root}" exec "{sys.executable}" "{__file__}" {name} "$@"\n')
    program.chmod(0o755)
    return program


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
