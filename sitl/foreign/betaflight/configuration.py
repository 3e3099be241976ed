# SPDX-License-Identifier: BSD-3-Clause
"""Betaflight's configuration: lines of its command line, typed into the program before it flies.

What a vehicle of ours needs comes first, then a user's lines, last the switches that ``sticks`` sets. A program that
was configured once in this process is started with what it saved then.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from ...autopilot.params.parm_files import Given
from ...errors import OptionError
from ...vehicle.sim_parameters import PREFIX
from ...warp.held_clock import ProgramGone
from .program import Program

BEGINNING = tuple(
    f"set {axis}_{name}" for axis in ("roll", "pitch", "yaw") for name in ("rc_rate = 67", "srate = 67", "expo = 0")
)
"""Rates that are straight lines, 670 deg/s at the whole deflection, so that a rate becomes a stick without a curve."""
ENDING = ("serial UART2 1 115200 57600 0 115200", "aux 0 0 0 1700 2100 0 0", "aux 1 1 1 1700 2100 0 0",
          "aux 2 2 1 1300 1700 0 0")  # fmt: skip
"""MSP on the second serial port, for configurators; ARM on AUX1; ANGLE and HORIZON on AUX2."""
_PROMPT = b"\r\n# "
_ERROR = re.compile(r"###ERROR[^:]*: (.*?)###")
_STEP_US, _PATIENCE_US, _BOOT_US, _WALL_S = 10_000, 3_000_000, 1_000_000, 20.0
_NOT_TYPED = ("save", "exit")
"""Words that would end the session: it is saved at its end."""
_known: dict[tuple[Path, int, bytes | None, tuple[str, ...]], bytes] = {}


def lines(text: str) -> list[str]:
    """The lines of a text that mean something, as a ``diff`` or ``dump`` of Betaflight has them."""
    kept = (line.partition("#")[0].strip() for line in text.splitlines())
    return [line for line in kept if line and line.split()[0].lower() not in _NOT_TYPED]


def read(paths: Sequence[str | Path]) -> tuple[list[str], dict[str, float]]:
    """The lines of files, one after the other, but those that mean our physics; and these, "SIM_WIND_SPD 5", by name.

    Raises:
        OptionError: a file that cannot be read, or such a line without a number.
    """
    found: list[str] = []
    acting: dict[str, float] = {}
    for path in paths:
        try:
            text = Path(path).read_text()
        except (OSError, UnicodeDecodeError) as error:
            why = getattr(error, "strerror", None) or "it is no text"
            raise OptionError(f"--params {path}: cannot be read: {why}") from None
        for line in lines(text):
            if not line.startswith(PREFIX):
                found.append(line)
                continue
            words = line.replace(",", " ").split()
            try:
                name, value = words
                acting[name] = float(value)
            except ValueError:
                raise OptionError(f"--params {path}: {line!r} is not a name and a number") from None
    return found, acting


def settings(values: Mapping[str, object]) -> list[str]:
    """The lines that set these."""
    return [f"set {name} = {value:g}" if isinstance(value, float) else f"set {name} = {value}"
            for name, value in values.items()]  # fmt: skip


def given(params: Given | None) -> tuple[list[str], dict[str, float]]:
    """The same of what is given in Python: a file, or values by name.

    Raises:
        OptionError: see ``read``.
    """
    if isinstance(params, str | Path):
        return read([params])
    values = dict(params or {})
    acting = {name: float(value) for name, value in values.items() if name.startswith(PREFIX)}
    return settings({name: value for name, value in values.items() if name not in acting}), acting


class CommandLine:
    """The command line of a program at the end of its boot."""

    def __init__(self, program: Program) -> None:
        self._program, self._us = program, 0
        self._wait()
        while self._us < _BOOT_US:
            self._step()
        self._say(b"#")  # alone: what comes within 0.1 s after it would end the wish

    def _wait(self) -> None:
        if self._program.clock.answer(_WALL_S) is None:
            raise OptionError(f"autopilot betaflight: it does not answer within {_WALL_S:g} s")

    def _step(self) -> None:
        self._us += _STEP_US
        self._program.clock.grant(self._us)
        self._wait()

    def type(self, line: str) -> str:
        """Type a line; returns what comes back before the next prompt.

        Raises:
            OptionError: no prompt comes.
        """
        return self._say(line.encode("ascii", "replace") + b"\n")

    def _say(self, line: bytes) -> str:
        self._program.say(line)
        said, until = b"", self._us + _PATIENCE_US
        while not said.endswith(_PROMPT):
            if self._us > until:
                raise OptionError(f"autopilot betaflight: its command line does not answer {line!r}: {said[-200:]!r}")
            self._step()
            said += self._program.receive()
        return said.decode("ascii", "replace")

    def save(self) -> None:
        """Write the configuration; the program ends after it."""
        self._program.say(b"save\n")
        until = self._us + _PATIENCE_US
        try:
            while self._us < until:
                self._step()
        except ProgramGone:
            return
        raise OptionError("autopilot betaflight: it does not end after 'save'")


def configure(path: Path, wanted: Sequence[str], eeprom: bytes | None = None) -> bytes:
    """The program's configuration after these lines were typed, over ``eeprom`` or its defaults.

    Raises:
        OptionError: lines that it does not take, all of them, each with what it says.
    """
    key = (path, path.stat().st_mtime_ns, eeprom, tuple(wanted))
    if key not in _known:
        _known[key] = _typed(path, wanted, eeprom)
    return _known[key]


def _typed(path: Path, wanted: Iterable[str], eeprom: bytes | None) -> bytes:
    program = Program(path, eeprom)
    try:
        line = CommandLine(program)
        refused = [f"{each!r}: {why}" for each in wanted for why in _ERROR.findall(line.type(each))]
        if refused:
            raise OptionError(f"configuration of {path.name}: it refuses {'; '.join(refused)}")
        line.save()
        kept = program.configuration()
        if kept is None:
            raise OptionError(f"autopilot betaflight: {path} has not saved its configuration")
        return kept
    except ProgramGone:
        program.process.ended(_WALL_S)
        program.process.check()
        raise
    finally:
        program.close()
