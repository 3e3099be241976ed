# SPDX-License-Identifier: BSD-3-Clause
"""Clients that push the vehicle's clock (MAV_CMD_USER_1) and reseed its sensors (MAV_CMD_USER_2)."""

from __future__ import annotations

from typing import Any

import pytest
from pymavlink.dialects.v20 import ardupilotmega as mavlink

from sitl.bridge.services.command_protocol import Grants
from tests.bridge.fakes import Bench, Client

GRANT, RESEED = 31010, 31011
ACCEPTED, DENIED, UNSUPPORTED = 0, 2, 3


@pytest.fixture
def granted(bench: Bench) -> Bench:
    bench.bridge.grants = Grants()
    return bench


def say(bench: Bench, number: int, x: int, client: Client | None = None) -> None:
    (client or bench.client).send(mavlink.MAVLink_command_int_message(1, 1, 0, number, 0, 0, 0, 0, 0, 0, x, 0, 0))
    bench.bridge.receive()


def answers(bench: Bench, client: Client | None = None) -> list[Any]:
    grants = bench.bridge.grants
    assert grants is not None
    grants.answer(bench.bridge)
    found = (client or bench.client).receive("COMMAND_ACK")
    return [(m.command, m.result, m.result_param2, m.target_system, m.target_component) for m in found]


def test_a_grant_is_answered_when_its_time_has_come(granted: Bench) -> None:
    say(granted, GRANT, 50)
    assert granted.bridge.grants is not None and granted.bridge.grants.until_us == 50_000
    assert answers(granted) == []
    granted.run(0.0475)
    assert answers(granted) == []
    granted.run(0.0025)
    assert answers(granted) == [(GRANT, ACCEPTED, 50, 255, 190)]
    assert answers(granted) == [], "once"


def test_an_older_grant_gets_its_answer_and_moves_nothing(granted: Bench) -> None:
    granted.run(0.1)
    for x in (100, 20, 0):
        say(granted, GRANT, x)
    assert answers(granted) == [(GRANT, ACCEPTED, 100, 255, 190)] * 3
    assert granted.bridge.grants is not None and granted.bridge.grants.until_us == 100_000


def test_a_grant_before_the_start_is_denied_at_once(granted: Bench) -> None:
    say(granted, GRANT, -1)
    assert [(m.command, m.result, m.result_param2) for m in granted.client.receive("COMMAND_ACK")] == [
        (GRANT, DENIED, 0)
    ]
    assert answers(granted) == [] and granted.bridge.grants is not None and granted.bridge.grants.until_us == 0


def test_each_client_gets_its_own_answer(granted: Bench) -> None:
    other = granted.connect(system=9, component=8)
    say(granted, GRANT, 10)
    say(granted, GRANT, 20, other)
    granted.run(0.01)
    assert answers(granted) == [(GRANT, ACCEPTED, 10, 255, 190)] and other.receive("COMMAND_ACK") == []
    granted.run(0.01)
    assert answers(granted, other) == [(GRANT, ACCEPTED, 20, 9, 8)] and granted.client.receive("COMMAND_ACK") == []


def test_a_seed_is_taken_as_32_bits(granted: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    seeds: list[int] = []
    monkeypatch.setattr(granted.vehicle, "reseed", seeds.append)
    for x in (7, -1):
        say(granted, RESEED, x)
    assert seeds == [7, 0xFFFFFFFF]
    found = [(m.command, m.result, m.result_param2) for m in granted.client.receive("COMMAND_ACK")]
    assert found == [(RESEED, ACCEPTED, 0)] * 2


def test_others_are_commands_as_usual(granted: Bench) -> None:
    say(granted, 400, 0)
    assert [m.command for m in granted.client.receive("COMMAND_ACK")] == [400]


def test_where_nobody_pushes_the_clock_it_is_no_command(bench: Bench) -> None:
    for number in (GRANT, RESEED):
        say(bench, number, 5)
        assert [(m.command, m.result) for m in bench.client.receive("COMMAND_ACK")] == [(number, UNSUPPORTED)]
