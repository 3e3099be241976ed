# SPDX-License-Identifier: BSD-3-Clause
"""The client's end of a serial line to a vehicle: a telemetry radio, a USB cable."""

from __future__ import annotations

import select
from typing import Any

from ..errors import LinkLostError, MissingExtra, OptionError
from .outbox import Outbox

FORM = '"serial:DEVICE:BAUD" (as serial:/dev/ttyACM0:57600)'
BAUD = range(1200, 4_000_001)


class SerialPort(Outbox):
    """A serial line as ``Endpoint`` wants it; nothing blocks but ``wait`` and a full line.

    Args:
        text: the form.

    Raises:
        OptionError: it is not of that form.
        MissingExtra: pyserial is not installed.
        LinkLostError: the device cannot be opened.
    """

    def __init__(self, text: str) -> None:
        super().__init__()
        _, _, rest = text.partition(":")
        device, _, baud = rest.rpartition(":")
        if not device or not baud.isdigit() or int(baud) not in BAUD:
            raise OptionError(f"connection {text!r} is not {FORM}, with {BAUD[0]} to {BAUD[-1]} baud")
        try:
            import serial
        except ModuleNotFoundError:
            raise MissingExtra(f"connection {text!r} needs pyserial: pip install 'gym-sitl[serial]'") from None
        self.name = text
        self._lost: Any = (serial.SerialException, OSError)
        try:
            self._port = serial.Serial(device, int(baud), timeout=0, exclusive=True)
        except (*self._lost, ValueError) as error:
            raise LinkLostError(f"connection {text}: {getattr(error, 'strerror', None) or error}") from None

    def write(self, data: bytes) -> None:
        """Send bytes now.

        Raises:
            LinkLostError: the device is gone.
        """
        try:
            self._port.write(data)
        except self._lost as error:
            raise LinkLostError(f"connection {self.name} is lost: {error}") from None

    def wait(self, seconds: float) -> bool:
        """Until something can be read, at most so long [s of wall time]. True when it can."""
        return bool(select.select([self._port], [], [], seconds)[0])

    def receive(self) -> bytes:
        """All bytes that are there.

        Raises:
            LinkLostError: the device is gone.
        """
        try:
            return bytes(self._port.read(max(self._port.in_waiting, 1)))
        except self._lost as error:
            raise LinkLostError(f"connection {self.name} is lost: {error}") from None

    def limit(self, seconds: float) -> None:
        """From now on, sending takes at most so long [s of wall time]; what is not sent by then raises."""
        self._port.write_timeout = seconds

    def close(self) -> None:
        """Close the line; may be called twice."""
        self._port.close()
