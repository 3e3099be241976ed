# SPDX-License-Identifier: BSD-3-Clause
"""``sitl deploy``: a learnt policy on a vehicle at a connection, with limits and a hand-over."""

from __future__ import annotations

import argparse
from dataclasses import fields

from sitl.envs.mavlink.guard import NOT_HANDED_OVER, Guard
from sitl.foreign.choice import ARDUPILOT, PX4

from .. import baselines, learnt
from ..deploy import REPLACED, Deployed, deploy, options_of
from ..errors import check_names
from .agent_options import add_option, assignment, assignments, positive

RESETS = ("none", "return", "reboot", "force")


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "deploy",
        description="Runs a policy on a vehicle that stands or hovers in GUIDED. A guard limits speed, height and "
        "distance. At the end, on Ctrl-C and other signals and on every error the vehicle goes into a safe mode.",
    )
    parser.add_argument(
        "policy",
        type=baselines.find,
        metavar="POLICY",
        help="run folder, policy file of `sitl export` (.npz), or name of a baseline (sitl help baselines)",
    )
    parser.add_argument(
        "--connection", required=True, metavar="URL",
        help="address of the vehicle: udp:HOST:PORT, udpout:HOST:PORT, tcp:HOST:PORT, serial:DEVICE:BAUD",
    )  # fmt: skip
    parser.add_argument(
        "--autopilot", choices=(ARDUPILOT, PX4), default=ARDUPILOT,
        help="autopilot of the vehicle (default ardupilot, as of gym-sitl itself). A PX4 is taken over in Hold, into "
        "OFFBOARD",
    )  # fmt: skip
    parser.add_argument("--episodes", type=positive, default=1, metavar="N", help="number of episodes (default 1)")
    parser.add_argument(
        "--max-steps", type=positive, metavar="N", help="time limit of an episode in steps (default: as in training)"
    )
    parser.add_argument(
        "--reset", choices=RESETS, default=RESETS[0],
        help="before each episode: none: wait for the vehicle (default); return: fly back in GUIDED; reboot: reboot a "
        "simulator; force: reboot any vehicle",
    )  # fmt: skip
    parser.add_argument(
        "--wait",
        type=float,
        default=60.0,
        metavar="S",
        help="time to wait for a vehicle that is ready [s] (default 60)",
    )
    parser.add_argument(
        "--guard", type=assignment, action="append", metavar="NAME=VALUE",
        help=f"limit of the guard: {', '.join(field.name for field in fields(Guard))}",
    )  # fmt: skip
    add_option(parser)
    parser.set_defaults(function=run)


def run(options: argparse.Namespace) -> int:
    """Run the command."""
    guard = assignments(options.guard)
    check_names(guard, [field.name for field in fields(Guard)], "guard {!r}")
    given = {**assignments(options.option), "autopilot": options.autopilot}
    policy = learnt.load(options.policy, (*REPLACED, *given))
    left_out = options_of(policy, given)[1]
    if left_out:
        print(f"left out, since a simulator alone has them: {', '.join(left_out)}")
    done = Deployed()
    try:
        deploy(
            policy, options.connection, episodes=options.episodes, max_steps=options.max_steps, reset=options.reset,
            guard=guard, wait=options.wait, options=given, out=done,
        )  # fmt: skip
    finally:
        for deed in done.deeds:
            print(f"{deed.time:.3f} s: {deed.what}{': ' if deed.why else ''}{deed.why}")
        for sentence in done.sentences(policy.step_time):
            print(sentence, flush=True)
    return 1 if done.handed_over or any(deed.what == NOT_HANDED_OVER for deed in done.deeds) else 0
