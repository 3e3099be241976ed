# SPDX-License-Identifier: BSD-3-Clause
"""The acknowledgements and texts of a real ArduCopter and ArduRover (4.7-dev, July 2025), in the order in which they
came.

``data/acknowledgements*.json`` have one row a command: what was sent, when (``at``: vehicle time [s]; ``wait``:
seconds after the row before), the result, and mode, arming and status texts afterwards. They were recorded from
unmodified SITLs; the commands' unrecorded parameters are those that the rows' results imply. ``ours`` is where this
firmware answers otherwise: its calibrations measure nothing and do not hold the GPS up, so that it can be armed, and
its motors tested, right after them.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from sitl.client.endpoint import Endpoint, Received
from sitl.simulation import Simulation

DATA = Path(__file__).parent / "data"
ROWS: dict[str, list[dict[str, Any]]] = {
    "ardupilot_quad": json.loads((DATA / "acknowledgements.json").read_text()),
    "ardupilot_rover": json.loads((DATA / "acknowledgements_rover.json").read_text()),
}
RESULTS = ("ACCEPTED", "TEMPORARILY_REJECTED", "DENIED", "UNSUPPORTED", "FAILED", "IN_PROGRESS")
TARGET = {"target_system": 1, "target_component": 1}
ANSWER_S = 0.3
"""The vehicle has so long to answer [simulated s]; ours answers at once."""
UNASKED = ("PreArm: ", "EKF3 ", "AHRS: ", "Field Elevation", "ArduPilot Ready", "Barometer 1 calibration")
"""Beginnings of texts that come by the clock, not by the command."""


def send(client: Endpoint, row: dict[str, Any]) -> None:
    """Send a row's command or parameter message."""
    if "long" in row:
        client.command(*row["long"])
    elif "int" in row:
        command, frame, p1, p2, p3, p4, x, y, z = row["int"]
        client.send(
            "COMMAND_INT", **TARGET, command=command, frame=frame,
            param1=p1, param2=p2, param3=p3, param4=p4, x=x, y=y, z=z,
        )  # fmt: skip
    elif "param_set" in row:
        name, value = row["param_set"]
        client.send("PARAM_SET", **TARGET, param_id=name.encode(), param_value=value, param_type=9)
    else:
        client.send("PARAM_REQUEST_READ", **TARGET, param_id=row["param_read"].encode(), param_index=-1)


def seen(simulation: Simulation, row: dict[str, Any], received: list[Received]) -> dict[str, Any]:
    """What the vehicle answered and did, in the shape of a row."""
    if "answer" in row:
        values = [m.fields for m in received if m.name == "PARAM_VALUE"]
        answers = [[m.param_id.decode(), m.param_value, m.param_index] for m in values]
        return {"answer": answers[0] if answers else None}
    acks = [m.fields for m in received if m.name == "COMMAND_ACK"]
    number = (row.get("long") or row["int"])[0]
    assert [(a.command, a.target_system, a.target_component) for a in acks] == [(number, 255, 190)], row["label"]
    texts = [m.fields.text.decode() for m in received if m.name == "STATUSTEXT"]
    ap = simulation.v.autopilot
    return {
        "result": RESULTS[acks[0].result],
        "mode": int(ap.modes.number),
        "armed": int(ap.arming.armed),
        "texts": [measured(text) for text in texts if not text.startswith(UNASKED)],
    }


def label(value: str | dict[str, Any]) -> str:
    """Name of a case."""
    return value if isinstance(value, str) else str(value["label"])


def measured(text: str) -> str:
    """A text without the centimetres of an altitude: noise decides on them."""
    return re.sub(r"(at \d+)\.\d+m$", r"\1m", text)


def replayed(frame: str) -> dict[str, dict[str, Any]]:
    """Every row sent to one simulated vehicle, in order: label -> what it answered."""
    simulation = Simulation(frame)
    client = Endpoint()
    simulation.bridge.add_link(client.link)
    answers = {}
    for row in ROWS[frame]:
        if "at" in row:
            simulation.advance_to(round(row["at"] * 1e6))
        simulation.advance(row.get("wait", 0.2))
        client.receive()
        send(client, row)
        simulation.advance(ANSWER_S)
        answers[row["label"]] = seen(simulation, row, client.receive())
    return answers


@pytest.fixture(scope="module")
def replay() -> Callable[[str], dict[str, dict[str, Any]]]:
    """As ``replayed``, once for each airframe."""
    return cache(replayed)


@pytest.mark.parametrize(("frame", "row"), [(frame, row) for frame, rows in ROWS.items() for row in rows], ids=label)
def test_as_the_real_one(replay: Callable[[str], dict[str, dict[str, Any]]], frame: str, row: dict[str, Any]) -> None:
    answer = replay(frame)[row["label"]]
    expected = {key: row[key] for key in answer} | row.get("ours", {})
    if "texts" in expected:
        expected["texts"] = [measured(text) for text in expected["texts"]]
    assert answer == expected
