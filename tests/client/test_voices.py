# SPDX-License-Identifier: BSD-3-Clause
"""Two vehicles under the same ids are told from one on a link that loses, repeats or reorders frames."""

from __future__ import annotations

import random
from typing import Any

import pytest

from sitl.bridge.dialect import message
from sitl.client.voices import Voices

Said = tuple[int, str, dict[str, Any]]
QUAD, ROVER, ARMED = 2, 10, 128


def heard(said: list[Said], is_held: bool = False) -> Voices:
    voices = Voices(is_held)
    for number, name, fields in said:
        kind = message(name)
        payload = kind.payload(**fields)
        if not voices.is_repeated(kind, payload, number & 0xFF):
            voices.take(kind, number & 0xFF, kind.decode(payload))
    return voices


def telemetry(first: int, count: int = 300, start_ms: int = 5000) -> list[Said]:
    return [(first + k, "ATTITUDE", {"time_boot_ms": start_ms + 10 * k, "roll": 1e-3 * k}) for k in range(count)]


def heartbeat(number: int, mode: int = 4, armed: int = ARMED, type: int = QUAD) -> Said:
    return number, "HEARTBEAT", {"type": type, "autopilot": 3, "base_mode": armed, "custom_mode": mode}


def merged(one: list[Said], other: list[Said]) -> list[Said]:
    return [each for pair in zip(one, other, strict=True) for each in pair]


def lossy(said: list[Said]) -> list[Said]:
    chance = random.Random(1)
    return [each for each in said if chance.random() > 0.4]


def reordered(said: list[Said]) -> list[Said]:
    return [each for at in range(0, len(said), 20) for each in reversed(said[at : at + 20])]


@pytest.mark.parametrize("link", [
    lambda said: said,
    lossy,
    reordered,
    lambda said: [each for each in said for _ in range(2)],
    lambda said: reordered(lossy(said)),
    lambda said: said[:90] + said[250:],  # a burst of losses
])  # fmt: skip
def test_one_vehicle_is_one_whatever_the_link_does(link: Any) -> None:
    assert heard(link(telemetry(200))).doubt == ""


@pytest.mark.parametrize("apart", [1, 5, 40, 90, 128, 170, 220, 255])
def test_two_series_of_numbers_are_two_vehicles(apart: int) -> None:
    """Also when both have the same clock."""
    one, other = telemetry(7), telemetry(7 + apart)
    other = [(number, name, fields | {"roll": 9.0}) for number, name, fields in other]
    assert "two series of numbers" in heard(merged(one, other)).doubt


def test_two_clocks_are_two_vehicles() -> None:
    one, late = telemetry(0, 50), (50, "ATTITUDE", {"time_boot_ms": 90_000})
    assert heard([*one, late]).doubt == ""
    assert "clock goes back from 90000" in heard([*one, late, *telemetry(51, 1, 5600)]).doubt
    assert heard([*one, *telemetry(50, 5, 5000)]).doubt == ""  # of old messages


def test_telemetry_of_a_vehicle_whose_time_stands_is_anothers() -> None:
    assert "ATTITUDE comes while its time stands" in heard(telemetry(0, 1), is_held=True).doubt
    answers: list[Said] = [heartbeat(0), (1, "SIMSTATE", {}), (2, "STATUSTEXT", {}), heartbeat(3)]
    assert heard(answers, is_held=True).doubt == ""


def test_states_by_turns_are_two_vehicles_and_a_change_is_none() -> None:
    for other in (heartbeat(1, mode=5), heartbeat(1, armed=0)):
        changed = heard([heartbeat(0), other, (2, *other[1:])])
        assert changed.has_changed and changed.doubt == ""
        assert "HEARTBEATs say by turns" in heard([heartbeat(0), other, heartbeat(2)]).doubt
    assert "HEARTBEATs say by turns" in heard([heartbeat(0), heartbeat(1, type=ROVER)]).doubt
    assert not heard([heartbeat(0), heartbeat(1)]).has_changed
