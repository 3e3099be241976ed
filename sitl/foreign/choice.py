# SPDX-License-Identifier: BSD-3-Clause
"""The choice of an autopilot: ours, a foreign program, or the address of a running one."""

from __future__ import annotations

import os
import shutil
import sysconfig
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ..autopilot.params.parm_files import FileValues
from ..core.code_in_files import REACHED
from ..errors import OptionError
from ..vehicle.kinds import KINDS
from ..vehicle.sim_parameters import PREFIX
from .betaflight import program as betaflight

NATIVE, ARDUPILOT, PX4, BETAFLIGHT = "native", "ardupilot", "px4", "betaflight"
FOREIGN = (ARDUPILOT, PX4, BETAFLIGHT)
WIND = "SIM_WIND_"
"""Beginning of the parameters of an ArduPilot that mean our physics."""
FORMS = (
    '"native" (default); "ardupilot" or "px4" (program in PATH); "betaflight" (the program that the package betaflight '
    'builds); "ardupilot:PROGRAM", "px4:PROGRAM", "betaflight:PROGRAM"; or a running one by its MAVLink address: '
    '"ardupilot:tcp:HOST:PORT", "px4:udp:HOST:PORT"'
)


@dataclass(frozen=True)
class Choice:
    """A foreign autopilot."""

    kind: str
    """One of ``FOREIGN``."""
    program: Path | None = None
    """Program to start; None: it is running already."""
    connection: str | None = None
    """Address of the MAVLink of an autopilot that is running already."""

    @property
    def name(self) -> str:
        """Name for messages."""
        return f"{self.kind}:{self.program or self.connection}"

    def for_autopilot(self, values: Mapping[str, float]) -> dict[str, float]:
        """Those that the autopilot itself gets: an ArduPilot has a SIM_WIND_ of its own, a PX4 nothing like ours."""
        ours = self.for_physics(values) if self.kind == PX4 else {}
        return {name: value for name, value in values.items() if name not in ours}

    def for_physics(self, values: Mapping[str, float]) -> dict[str, float]:
        """Those of the parameters that act on our physics. An ArduPilot has sensors, a battery and failing outputs of
        its own, so only the wind does. A PX4's sensors are ours; it has SIM_ parameters, too, with other names."""
        prefix = WIND if self.kind == ARDUPILOT else PREFIX
        found = {name: value for name, value in values.items() if name.startswith(prefix)}
        if self.kind == PX4:
            tables = [kind.firmware.table for kind in KINDS.values()]
            found = {name: value for name, value in found.items() if any(name in table for table in tables)}
        return FileValues(found) if isinstance(values, FileValues) else found


def choose(text: str, vehicle: str, path: str | Path | None = None) -> Choice | None:
    """Parse the choice of an autopilot; None: our own.

    Args:
        text: one of the forms.
        vehicle: kind of vehicle ("copter", "rover" ...).
        path: path of the program, when the text does not say.

    Raises:
        OptionError: none of the forms, or no such program.
    """
    kind, _, rest = text.partition(":") if isinstance(text, str) else ("", "", "")
    if kind == NATIVE and not rest and path is None:
        return None
    if kind not in FOREIGN:
        extra = f" with a program ({path})" if kind == NATIVE else ""
        raise OptionError(f"autopilot {text!r}{extra} is none of {FORMS}")
    if rest.startswith(REACHED):
        if kind == BETAFLIGHT:
            raise OptionError(
                f"autopilot {text!r}: a Betaflight that runs already has a clock of its own; name a program"
            )
        return Choice(kind, connection=rest)
    wanted = rest or (str(path) if path is not None else "")
    if kind == BETAFLIGHT and not wanted:
        if not KINDS[vehicle].flies:
            raise OptionError(f"autopilot {text!r}: it flies copters, and this is a {vehicle}")
        return Choice(kind, betaflight.find())
    usual = KINDS[vehicle].programs.get(kind)
    if usual is None and not wanted:
        raise OptionError(f"autopilot {text!r}: no program for a {vehicle} is known; name it: {kind}:PROGRAM")
    found = shutil.which(os.path.expanduser(wanted)) if wanted else _in_path(str(usual))
    if found is None:
        if not wanted:
            raise OptionError(f"autopilot {text!r}: no program {usual!r} in PATH; say where it is: {kind}:PROGRAM")
        why = "is not a program that may be run" if Path(wanted).expanduser().exists() else "is not there"
        raise OptionError(f"autopilot {text!r}: program {wanted!r} {why}")
    return Choice(kind, Path(found).resolve())


def _in_path(name: str) -> str | None:
    """A program in PATH that is not one of our own scripts, which have the same names."""
    own = sysconfig.get_path("scripts")
    folders = [folder for folder in os.environ.get("PATH", os.defpath).split(os.pathsep) if folder != own]
    return shutil.which(name, path=os.pathsep.join(folders))
