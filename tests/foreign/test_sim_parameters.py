# SPDX-License-Identifier: BSD-3-Clause
"""Our SIM_ parameters beside an autopilot that has none like them."""

from __future__ import annotations

import pytest

from sitl.bridge.dialect import message
from sitl.bridge.frame import Splitter, encode_v1, encode_v2
from sitl.bridge.links.inprocess import InProcessLink
from sitl.foreign.sim_parameters import SimParameterPort

SET, READ, VALUE, HEARTBEAT = (
    message(name) for name in ("PARAM_SET", "PARAM_REQUEST_READ", "PARAM_VALUE", "HEARTBEAT")
)


def asked(kind, encode=encode_v2, **fields) -> bytes:
    return encode(kind, kind.payload(target_system=2, target_component=1, **fields), 0, 255, 190)


def answered(data: bytes):
    (frame,) = Splitter().feed(data)
    assert frame.kind is VALUE and (frame.system, frame.component) == (2, 1)
    return frame.kind.decode(frame.payload)


@pytest.mark.parametrize("encode", [encode_v1, encode_v2])
def test_they_are_set_between_two_ticks_and_read(copter_plant, encode):
    port, sim = SimParameterPort(copter_plant), copter_plant.vehicle.v.autopilot.params.SIM
    copter_plant.tick()
    value = answered(port.answer(asked(SET, encode, param_id=b"SIM_WIND_SPD", param_value=7.0, param_type=9)))
    assert (value.param_id, value.param_value) == (b"SIM_WIND_SPD", 7.0)
    assert sim.WIND_SPD == 0.0
    port.act()
    assert sim.WIND_SPD == 7.0
    assert answered(port.answer(asked(READ, encode, param_id=b"SIM_WIND_SPD", param_index=-1))).param_value == 7.0


def test_what_cannot_be_set_is_answered_with_what_there_is(copter_plant):
    port = SimParameterPort(copter_plant)
    value = answered(port.answer(asked(SET, param_id=b"SIM_WIND_SPD", param_value=float("nan"), param_type=9)))
    assert value.param_value == 0.0
    port.act()
    assert copter_plant.vehicle.v.autopilot.params.SIM.WIND_SPD == 0.0


@pytest.mark.parametrize("name", [b"MPC_XY_CRUISE", b"SIM_BAT_DRAIN", b"SIM_NONE"])
def test_others_are_the_autopilots(copter_plant, name):
    port = SimParameterPort(copter_plant)
    assert port.answer(asked(SET, param_id=name, param_value=1.0, param_type=9)) == b""
    assert port.answer(encode_v2(HEARTBEAT, HEARTBEAT.payload(), 0, 255, 190)) == b""


def test_a_client_of_a_stream_gets_the_answers_beside_what_the_autopilot_says(copter_plant):
    class Stream(InProcessLink):
        name, sent = "stream", []

        def send(self, data):
            self.sent.append(data)

        def receive(self):
            return b"its own"

        flush = write = wait = limit = close = None

    stream = SimParameterPort(copter_plant).over(Stream())
    for name in (b"SIM_WIND_SPD", b"MPC_XY_CRUISE"):
        stream.send(asked(READ, param_id=name, param_index=-1))
    assert Stream.sent == [asked(READ, param_id=b"MPC_XY_CRUISE", param_index=-1)]
    answer = stream.receive()
    assert answer.endswith(b"its own") and answered(answer.removesuffix(b"its own")).param_id == b"SIM_WIND_SPD"
    assert stream.receive() == b"its own"
