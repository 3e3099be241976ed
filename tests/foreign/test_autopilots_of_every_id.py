# SPDX-License-Identifier: BSD-3-Clause
"""Which environments are made with which autopilot: the table of docs/foreign-autopilots.md is made here."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import gymnasium as gym

import sitl.envs  # noqa: F401
from sitl.envs import EnvOptionError, ids

PAGE = Path(__file__).parents[2] / "docs" / "foreign-autopilots.md"
PROGRAM = "/bin/true"
"""Nothing is started before the first reset."""
ALL = (*ids.PAPER, *ids.FIRST, *ids.NEW, "sitl/Navigate-v0", "sitl/Navigate-v1")
ANSWERS = {
    "option 'autopilot' is not known": "no: a Turtlebot has no autopilot",
    "flies no rover here": "no: leave `autopilot` out, or take ArduPilot",
}


def answer(name: str, autopilot: str) -> str:
    """What an environment says to an autopilot, in a few words."""
    try:
        gym.make(name, autopilot=f"{autopilot}:{PROGRAM}").close()
    except EnvOptionError as error:
        return next(short for said, short in ANSWERS.items() if said in str(error))
    return "yes"


def table() -> str:
    """Ids by what they say; of all versions and forms of a task one name."""
    rows: dict[tuple[str, str], list[str]] = {}
    for name in ALL:
        plain = re.sub(r"(Discrete)?-v\d+$", "", name)
        names = rows.setdefault((answer(name, "ardupilot"), answer(name, "px4")), [])
        if plain not in names:
            names.append(plain)
    lines = ["| environments | ArduPilot | PX4 |", "|---|---|---|"]
    lines += [
        f"| {', '.join(f'`{name}`' for name in names)} | {one} | {other} |" for (one, other), names in rows.items()
    ]
    return "\n".join(lines)


def test_the_page_says_which_environments_each_autopilot_has():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        made = table()
    shown = re.search(r"<!-- ids -->\n\n(.*?)\n\n<!-- /ids -->", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert shown is not None and shown[1] == made, made
