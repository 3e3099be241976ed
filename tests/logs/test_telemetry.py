# SPDX-License-Identifier: BSD-3-Clause
"""Telemetry logs as columns: times of reboots, parameters that came as a file."""

from __future__ import annotations

import struct
from types import SimpleNamespace

import numpy as np
import pytest

from sitl.autopilot.params.parameter import FLOAT, INT32
from sitl.bridge.dialect import message
from sitl.bridge.frame import encode_v2
from sitl.bridge.services.parameter_protocol import pack_parameters
from sitl.logs.telemetry_parameters import by_ftp
from sitl.logs.tlog_columns import Telemetry

from .log_files import telemetry

_ACK, _OPEN, _BURST = 128, 4, 15
PARAMETERS = {"ATC_RAT_RLL_P": 0.135, "ATC_RAT_RLL_D": 0.0036, "FRAME_CLASS": 1.0, "LOG_BITMASK": 180222.0}


def packets(data: bytes, size: int = 30) -> list[bytes]:
    """Payloads with which a vehicle answers the opening of a file, and a burst."""

    def payload(asked: int, content: bytes, offset: int) -> bytes:
        return struct.pack("<HBBBBBBI", 0, 1, _ACK, len(content), asked, 0, 0, offset) + content.ljust(239, b"\0")

    pieces = [payload(_BURST, data[at : at + size], at) for at in range(0, len(data), size)]
    return [payload(_OPEN, struct.pack("<I", len(data)), 0), *pieces]


@pytest.mark.parametrize("with_defaults", [False, True])
def test_parameters_that_came_as_a_file_are_put_together(with_defaults: bool) -> None:
    kinds = [SimpleNamespace(name=name, kind=FLOAT if value % 1 else INT32) for name, value in PARAMETERS.items()]
    data = pack_parameters([(kind, PARAMETERS[kind.name], 1.0) for kind in kinds], with_defaults)
    found = by_ftp(packets(data))
    assert found == pytest.approx(PARAMETERS, rel=1e-6)
    shuffled = packets(data)
    shuffled[1:] = shuffled[:0:-1]
    assert by_ftp([*shuffled, *packets(b"another file")]) == found
    assert by_ftp([piece for k, piece in enumerate(packets(data)) if k != 2]) == {}, "a piece is missing"
    assert by_ftp(packets(data[:-3])) == {}
    assert by_ftp(packets(b"no file with parameters")) == {}


def test_times_are_those_of_the_vehicle_and_go_on_after_a_reboot(tmp_path) -> None:
    path = tmp_path / "boots.tlog"
    frames = []
    for k in range(30):
        boot = 1000 + 100 * k if k < 20 else 200 + 100 * (k - 20)
        body = message("ATTITUDE").payload(time_boot_ms=boot, roll=0.01 * k)
        frames.append((1_700_000_000_000_000 + 100_000 * k, encode_v2(message("ATTITUDE"), body, k, 1, 1)))
    path.write_bytes(telemetry(boot_ms=[]) + b"".join(t.to_bytes(8, "big") + f for t, f in frames))
    table = Telemetry(path)["ATT"]
    np.testing.assert_allclose(np.diff(table.time), 0.1, atol=1e-6)
    np.testing.assert_allclose(table["Roll"], np.degrees(0.01 * np.arange(30)), atol=1e-5)
