# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle at the end of a serial line, which a pseudo-terminal stands for."""

from __future__ import annotations

import os

import pytest

from sitl.client.byte_socket import open_stream
from sitl.errors import LinkLostError, OptionError

pytest.importorskip("serial")
pytest.importorskip("termios")


def test_bytes_pass_in_both_directions_until_the_other_end_is_gone():
    vehicle, end = os.openpty()
    line = open_stream(f"serial:{os.ttyname(end)}:57600")
    os.close(end)
    assert not line.wait(0.0)
    line.send(b"\x00\r\n\xff")
    line.send(b"\x11\x13")
    assert line.flush() == b"\x00\r\n\xff\x11\x13" == os.read(vehicle, 100)
    os.write(vehicle, b"\xfd\r\n\x03")
    assert line.wait(5.0) and line.receive() == b"\xfd\r\n\x03"
    os.close(vehicle)
    with pytest.raises(LinkLostError, match="is lost"):
        line.receive()
    line.close()
    line.close()


@pytest.mark.parametrize("text", ["serial:/dev/null", "serial::57600", "serial:/dev/ttyACM0:fast", "serial:/dev/x:0"])
def test_other_forms_are_refused(text):
    with pytest.raises(OptionError, match=r"is not \"serial:DEVICE:BAUD\""):
        open_stream(text)


def test_a_device_that_is_not_there():
    with pytest.raises(LinkLostError, match="serial:/dev/nosuch:57600"):
        open_stream("serial:/dev/nosuch:57600")
