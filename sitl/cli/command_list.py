# SPDX-License-Identifier: BSD-3-Clause
"""The commands that come with the package: where each is, so that only the one that is given has to be loaded."""

from __future__ import annotations

from typing import NamedTuple


class Listed(NamedTuple):
    """A command."""

    module: str
    """Has ``add_parser(commands)``, which declares it, and maybe others of this table with the same module."""
    help: str


COMMANDS = {
    "run": Listed("sitl.cli.run", "run a vehicle and serve MAVLink"),
    "exec": Listed("sitl.cli.execute", "start a vehicle and run a script with it, in simulated time"),
    "demo": Listed("sitl.cli.demo", "run a MAVSDK example and draw what the vehicle did"),
    "mission": Listed("sitl.missions.cli", "fly mission files, record, replay and compare flights"),
    "view": Listed("sitl.missions.view", "show logs and recordings on a page in the browser"),
    "twin": Listed("sitl.missions.twin.cli", "fly a log's flight again beside the log, and ask what if"),
    "train": Listed("sitl.agents.cli.train", "let an agent learn in an environment"),
    "evaluate": Listed("sitl.agents.cli.evaluate", "evaluate the trained agent of a run: reward, crashes, laps"),
    "watch": Listed("sitl.agents.cli.watch", "show the trained agent of a run: browser, window, GIF or MP4"),
    "compare": Listed("sitl.agents.cli.compare", "compare runs in a report: tables, curves, statistics over seeds"),
    "rollout": Listed("sitl.agents.cli.rollout", "evaluate any policy in many episodes, in vector environments"),
    "dataset": Listed("sitl.agents.cli.dataset", "record expert flights as a Minari dataset"),
    "rehearse": Listed("sitl.agents.cli.rehearse", "test a policy's robustness to other worlds, physics and noise"),
    "export": Listed("sitl.agents.cli.export", "export the policy of a run as .npz or .onnx"),
    "deploy": Listed("sitl.agents.cli.deploy", "run a policy on a vehicle, within limits"),
    "benchmark": Listed("sitl.agents.cli.benchmark", "published results, made again"),
    "physics": Listed("sitl.cli.physics", "run physics for an autopilot in another process"),
    "arducopter": Listed("sitl.cli.drop_in", "run a copter in place of ArduPilot's arducopter"),
    "ardurover": Listed("sitl.cli.drop_in", "run a rover in place of ArduPilot's ardurover"),
    "examples": Listed("sitl.cli.examples", "list and copy the example programs"),
    "identify": Listed("sitl.identify.cli", "find a copter's or rover's properties in its logs, as an airframe"),
    "params": Listed("sitl.cli.params", "list the parameters, or look for some"),
    "frame": Listed("sitl.cli.frame", "list the airframes, or print one as a file to change and fly"),
    "world": Listed("sitl.cli.world", "list and draw worlds"),
    "envs": Listed("sitl.envs.listing", "list the environments, or describe one"),
    "cache": Listed("sitl.cli.cache", "show, clear or build the compiled core"),
    "help": Listed("sitl.cli.help", "print a page of the documentation"),
    "doctor": Listed("sitl.cli.doctor", "check the installation, and print the commands that complete it"),
    "completion": Listed("sitl.cli.completion", "print the completion script for a shell"),
}
"""Name -> the command, in the order of ``sitl --help``."""

WELCOME = """\
Autopilot-in-the-loop simulator in simulated time. Five things to begin with:

  sitl demo copter              fly a MAVSDK script and draw the flight
  sitl run copter               run a copter for any ground station or script
  sitl exec -- python FLY.py    start a copter and run your script with it, in simulated time
  sitl mission fly FILE.plan    fly a mission file; `sitl mission suite` is for regression tests
  sitl train --recipe NAME      let an agent learn, by the vehicle's real command interface

All commands: sitl --help. Options of a command: sitl COMMAND --help. Documentation: sitl help.
Is all installed? sitl doctor
"""
"""What ``sitl`` alone prints."""
