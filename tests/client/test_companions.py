# SPDX-License-Identifier: BSD-3-Clause
"""Companions of a client: how often they send, and what snapshots know of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from sitl import Simulation
from sitl.client import Client
from sitl.client.odometry import Odometry
from sitl.recording.entries import of_state


def with_odometry() -> tuple[Client, Odometry, list[Any]]:
    """A rover that is told where it is, and what it was told: time [s], fields."""
    client = Client(Simulation("erle_rover", params={"VISO_TYPE": 1}))
    told: list[Any] = []
    send: Callable[..., None] = client.send

    def listen(name: str, **fields: Any) -> None:
        if name == "ODOMETRY":
            told.append((client.now, fields["x"], fields["reset_counter"]))
        send(name, **fields)

    client.send = listen  # type: ignore[method-assign]
    return client, Odometry(client, position_noise=0.1, drift=(0.1, 0.0)).start(), told


@pytest.mark.parametrize("step", [0.02, 0.1, 0.25])
def test_ten_messages_a_second_whatever_the_steps(step: float) -> None:
    client, odometry, told = with_odometry()
    for _ in range(round(1.0 / step)):
        client.delay(step)
    assert [time for time, *_ in told] == pytest.approx([0.1 * k for k in range(10)])
    odometry.stop()
    client.delay(1.0)
    assert len(told) == 10


def test_another_future_is_the_same_to_the_bit() -> None:
    client, odometry, told = with_odometry()
    client.delay(2.05)
    moment = client.snapshot()
    client.delay(1.0)
    wanted, state = told[-10:], of_state(client.simulation)
    odometry.resets, odometry.offset = 3, 5.0 * odometry.offset
    odometry.stop()
    client.delay(0.3)
    del told[:]
    client.restore(moment)
    assert client.companions == [odometry]
    client.delay(1.0)
    assert told == wanted and of_state(client.simulation) == state
    with client.fork():
        odometry.stop()
    assert client.companions == [odometry]


def test_another_client_goes_on_with_one_of_its_own() -> None:
    client, odometry, told = with_odometry()
    client.delay(1.0)
    moment = client.snapshot()
    other, mine, heard = with_odometry()
    other.restore(moment)
    del told[:]
    other.delay(1.0)
    client.delay(1.0)
    assert heard == told and other.companions[0] not in (mine, odometry)
    assert of_state(client.simulation) == of_state(other.simulation)
