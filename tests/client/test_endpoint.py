# SPDX-License-Identifier: BSD-3-Clause
"""The client in the vehicle's process: what it refuses to send, and how it says so."""

from __future__ import annotations

import math
from typing import Any

import pytest

from sitl.bridge.dialect import FieldError, UnknownMessageError, message
from sitl.client.endpoint import Endpoint


@pytest.mark.parametrize(("name", "field", "value", "allowed"), [
    ("COMMAND_LONG", "command", 70000, "0 .. 65535"),
    ("COMMAND_LONG", "target_system", -1, "0 .. 255"),
    ("COMMAND_LONG", "command", 400.0, "whole numbers"),
    ("COMMAND_LONG", "param2", 1e40, "single precision"),
    ("COMMAND_LONG", "param2", "1", "single precision"),
    ("COMMAND_INT", "x", 2**31, "-2147483648 .. 2147483647"),
    ("PARAM_SET", "param_id", "RTL_ALT", "at most 16 bytes"),
    ("PLAY_TUNE", "tune", 5, "at most 30 bytes"),
    ("ATT_POS_MOCAP", "q", (1.0, 0.0, 0.0, 0.0, 0.0), "at most 4 numbers"),
    ("ATT_POS_MOCAP", "q", (1.0, None), "at most 4 numbers"),
    ("ATT_POS_MOCAP", "q", 1.0, "a sequence"),
])  # fmt: skip
def test_a_value_that_does_not_fit_is_named(name: str, field: str, value: Any, allowed: str) -> None:
    client = Endpoint()
    with pytest.raises(FieldError) as caught:
        client.send(name, **{field: value})
    error = caught.value
    assert (error.message, error.field, error.value) == (name, field, value)
    assert f"{name}.{field} cannot be {value!r}" in str(error) and allowed in str(error)
    assert isinstance(error, ValueError)


def test_what_fits_is_packed() -> None:
    packed = message("ATT_POS_MOCAP").payload(q=(1.0, 0.5), x=-3.0)
    assert message("ATT_POS_MOCAP").decode(packed).q == (1.0, 0.5, 0.0, 0.0)
    with pytest.raises(UnknownMessageError, match="param9"):
        Endpoint().send("COMMAND_LONG", param9=1.0)


def test_a_command_has_seven_parameters() -> None:
    client = Endpoint()
    client.command(400, *range(7))
    with pytest.raises(FieldError, match=r"COMMAND_LONG\.param8 .*param1 \.\. param7"):
        client.command(400, *range(8))


@pytest.mark.parametrize("rate", [math.nan, math.inf, -1.0])
def test_a_rate_that_is_none_is_refused(rate: float) -> None:
    with pytest.raises(FieldError, match=r"ATTITUDE\.rate_hz"):
        Endpoint().set_interval("ATTITUDE", rate)


def test_rate_0_stops_a_message() -> None:
    client = Endpoint()
    for rate, interval in ((0.0, -1.0), (4.0, 250_000.0)):
        client.set_interval("ATTITUDE", rate)
        frame = client._splitter.feed(client.link.peers[0].take())[0]
        fields: Any = frame.kind.decode(frame.payload)
        assert (fields.command, fields.param1, fields.param2) == (511, 30.0, interval)
