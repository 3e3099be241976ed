# SPDX-License-Identifier: BSD-3-Clause
"""ArduPilot SITL's command line. Source: the program's --help, https://ardupilot.org/dev/docs/sitl-parameters.html."""

from __future__ import annotations

import getopt
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ..bridge.links import LinkFaults
from ..bridge.links.faults import OPTIONS as LINK_OPTIONS
from ..errors import OptionError
from ..physics.native.power_on import Home
from ..scenario import checked_home

BASE_PORT, STICKS_PORT, PHYSICS_PORT = 5760, 5501, 9002
PORTS_AN_INSTANCE = 10
SERIAL_PORTS = 10
DEVICES = {0: "tcp:0:wait", 1: "tcp:2", 2: "tcp:3"}
"""What the serial ports are by default; others are not connected."""
_SHORT = {
    "w": "wipe", "h": "help", "u": "unhide-groups", "s": "speedup", "r": "rate", "C": "console", "I": "instance",
    "S": "synthetic-clock", "O": "home", "M": "model", "F": "fg",
}  # fmt: skip
_SILENT = ("unhide-groups", "synthetic-clock")
_NO_EFFECT = ("console", "gimbal", "rtscts", "enable-fgview", "disable-fgview")
"""Flags."""
_NO_EFFECT_WITH_VALUE = (
    "rate", "config", "fg", "autotest-dir", "sim-port-in", "irlock-port", "start-time", "slave",
)  # fmt: skip
_UARTS = {"A": 0, "B": 3, "C": 1, "D": 2, "E": 4, "F": 5, "G": 6, "H": 7}
"""Older names of serial ports."""
_FLAGS = ("wipe", "help", *_SILENT, *_NO_EFFECT)
_WITH_VALUE = (
    "speedup", "instance", "home", "model", "defaults", "base-port", "rc-in-port", "sim-address", "sim-port-out",
    "sysid", "listen", *(f"link-{name}" for name in LINK_OPTIONS), *_NO_EFFECT_WITH_VALUE,
    *(f"serial{k}" for k in range(SERIAL_PORTS)), *(f"uart{letter}" for letter in _UARTS),
)  # fmt: skip

HELP = """options (those of ArduPilot's simulator):
  -w, --wipe             forget parameters and mission of earlier runs
  -M, --model MODEL      +, x, hexa, octa, rover, ..., or JSON:HOST: physics at HOST
  -O, --home LAT,LON,ALT,HEADING
                         start (degrees, degrees, metres, degrees)
  -s, --speedup K        simulated seconds a second (0: as fast as it goes)
  -I, --instance N       adds 10 N to all ports that no option gives
  --defaults FILE,...    parameters that stand unless a client has set others
  --serial0 DEVICE ... --serial9 DEVICE
                         tcp:PORT[:wait], tcpclient:HOST:PORT, udpclient:HOST:PORT, udp:HOST:PORT or none; a PORT
                         below 1000 is added to the base port
  --uartA DEVICE         the same as --serial0
  --sysid N              MAV_SYSID
  --base-port PORT       first TCP port (5760)
  --rc-in-port PORT      UDP port of the sticks (5501)
  --sim-address HOST     of physics elsewhere
  --sim-port-out PORT    of physics elsewhere (9002)
  -S, -u, -C, -r RATE, --config, -F, --enable-fgview, --gimbal, --autotest-dir, --rtscts, --sim-port-in, --irlock-port,
  --start-time, --slave  are taken, and have no effect
and of this program:
  --listen ADDRESS       where ports are opened (127.0.0.1; 0.0.0.0: on all addresses)
"""
HELP += "".join(f"  --link-{name} {metavar}\n{'':25}{text}\n" for name, (metavar, text) in LINK_OPTIONS.items())


@dataclass(frozen=True)
class CommandLine:
    """What the arguments say."""

    help: bool
    wipe: bool
    model: str
    """"" when none is given."""
    home: Home | None
    speedup: float | None
    defaults: tuple[Path, ...]
    devices: dict[int, str]
    """Number of a serial port -> what it is connected to."""
    base_port: int
    """With what the instance adds."""
    sticks_port: int
    physics: tuple[str, int]
    """Host and port of physics elsewhere."""
    sysid: int | None
    address: str
    """Where ports are opened."""
    link_faults: LinkFaults | None
    """Of the links to all clients."""
    without_effect: tuple[str, ...]
    """Options that were given, and have no effect."""


def parse(words: Sequence[str]) -> CommandLine:
    """Understand the arguments. A value may begin with a minus, and be joined to its option ("-I0", "--home=-35,...").

    Raises:
        OptionError: an option that ArduPilot's simulator does not have either, or a value that cannot be taken.
    """
    short = "".join(letter + (":" if name in _WITH_VALUE else "") for letter, name in _SHORT.items())
    try:
        pairs, rest = getopt.gnu_getopt(list(words), short, [*_FLAGS, *(f"{name}=" for name in _WITH_VALUE)])
    except getopt.GetoptError as error:
        raise OptionError(f"{error.msg}\n\n{HELP}") from None
    if rest:
        raise OptionError(f"{rest[0]!r} belongs to no option\n\n{HELP}")
    given: dict[str, str] = {}
    devices = dict(DEVICES)
    defaults: list[Path] = []
    link: dict[str, list[str]] = {}
    for option, value in pairs:
        name = option[2:] if option.startswith("--") else _SHORT[option[1]]
        given[name] = value
        if name == "defaults":
            defaults += [Path(path) for path in value.split(",") if path]
        elif name.startswith("link-"):
            link.setdefault(name.removeprefix("link-"), []).append(value)
        elif name.startswith("serial"):
            devices[int(name[6:])] = value
        elif name.startswith("uart"):
            devices[_UARTS[name[4:]]] = value
    without = [f"--{name}" for name in given if name in (*_NO_EFFECT, *_NO_EFFECT_WITH_VALUE)]
    return CommandLine(
        help="help" in given,
        wipe="wipe" in given,
        model=given.get("model", ""),
        home=home(given["home"]) if "home" in given else None,
        speedup=number(given, "speedup") if "speedup" in given else None,
        defaults=tuple(defaults),
        devices=devices,
        base_port=_port(given, "base-port", BASE_PORT),
        sticks_port=_port(given, "rc-in-port", STICKS_PORT),
        physics=(given.get("sim-address", "127.0.0.1"), _port(given, "sim-port-out", PHYSICS_PORT)),
        sysid=whole(given, "sysid", 1, 255) if "sysid" in given else None,
        address=given.get("listen", "127.0.0.1"),
        link_faults=LinkFaults.of_texts(link),
        without_effect=tuple(without),
    )


def _port(given: dict[str, str], name: str, usual: int) -> int:
    """A port; ``--instance`` moves only one that still has its usual number when it is read, as ArduPilot's does."""
    step = PORTS_AN_INSTANCE * whole(given, "instance", 0, 5000)
    port, names = whole(given, name, usual), list(given)
    is_own = name in given and (port != usual or "instance" not in given or names.index(name) > names.index("instance"))
    return port if is_own else port + step


def home(text: str) -> Home:
    """``LAT,LON,ALT,HEADING``; OptionError when it is something else."""
    try:
        lat, lon, alt, heading = (float(word) for word in text.split(","))
    except ValueError:
        raise OptionError(f"--home {text!r} is not LAT,LON,ALT,HEADING (degrees, degrees, metres, degrees)") from None
    return checked_home((lat, lon, alt, heading))


def number(given: dict[str, str], name: str) -> float:
    """Value of an option; OptionError when it is no number."""
    try:
        return float(given[name])
    except ValueError:
        raise OptionError(f"--{name} {given[name]!r} is not a number") from None


def whole(given: dict[str, str], name: str, default: int, most: int = 65535) -> int:
    """Value of an option, 0 .. ``most``; OptionError when it is something else."""
    text = given.get(name, str(default))
    if not (text.isascii() and text.isdigit() and int(text) <= most):
        raise OptionError(f"--{name} {text!r} is not a whole number from 0 to {most}")
    return int(text)
