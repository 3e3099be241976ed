# SPDX-License-Identifier: BSD-3-Clause
"""An executable with the command line of ArduPilot's simulator, started for one flight."""

from __future__ import annotations

import fcntl
import os
import socket
import struct
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, nullcontext
from pathlib import Path
from tempfile import TemporaryDirectory

from sitl.client.connection import RealTime, connect
from sitl.errors import LinkLostError, OptionError

PROGRAMS = {"copter": ("arducopter", "quad"), "rover": ("ardurover", "rover")}
"""Name of the executable and its model, by kind of vehicle."""
CALIBRATION = {
    **{f"INS_ACC{k}{of}_{axis}": x for k in ("", 2) for of, x in (("OFFS", 0.001), ("SCAL", 1.001)) for axis in "XYZ"},
    **dict(zip((f"COMPASS_OFS{k}_{axis}" for k in ("", 2, 3) for axis in "XYZ"), (5, 13, -18) * 3, strict=True)),
}
"""What arming asks for: accelerometers that count as calibrated, and the offsets of the simulated compasses."""
PORT = 5760
"""Of instance 0; each next one has 10 more."""
IN_NAMESPACE = "SITL_MANOEUVRES_IN_NAMESPACE"
_NAMESPACES = (("unshare", "--net"), ("unshare", "--net", "--map-root-user"))
_SET_FLAGS, _UP_AND_RUNNING = 0x8914, 0x1 | 0x40  # SIOCSIFFLAGS, IFF_UP | IFF_RUNNING (netdevice(7))
_START_S = 20.0
"""Wall time within which the executable listens [s]."""


def find(given: Path, kind: str) -> Path:
    """The executable of a kind of vehicle: a file, or in a folder by ArduPilot's name of it.

    Raises:
        OptionError: there is none.
    """
    path = given / PROGRAMS[kind][0] if given.is_dir() else given
    if not (path.is_file() and os.access(path, os.X_OK)):
        raise OptionError(f"{path} is no executable")
    return path.resolve()


def enter_namespace() -> None:
    """Go on in a network namespace of this process's own where that is allowed: its ports are free there."""
    if os.environ.get(IN_NAMESPACE):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
            fcntl.ioctl(s, _SET_FLAGS, struct.pack("16sH14x", b"lo", _UP_AND_RUNNING))
        return
    for words in _NAMESPACES:
        try:
            if subprocess.run([*words, "true"], capture_output=True, timeout=10).returncode == 0:
                os.environ[IN_NAMESPACE] = "1"
                os.execvp(words[0], [*words, *sys.orig_argv])
        except (OSError, subprocess.TimeoutExpired):
            continue


@contextmanager
def started(
    path: Path, kind: str, home: tuple[float, ...], speedup: int, params: Mapping[str, float], instance: int = 0,
    port: int = PORT, own: Path | None = None,
) -> Iterator[RealTime]:  # fmt: skip
    """The executable, started in a folder of its own, and the connection to it; it ends with the block.

    Args:
        path: the executable.
        kind: of vehicle.
        home: latitude, longitude [deg], altitude [m], heading [deg].
        speedup: simulated seconds a second.
        params: what differs from the firmware's defaults.
        instance: its number, which adds 10 to its ports.
        port: TCP port of instance 0; its second serial line is two above.
        own: a folder that stays, in place of one that is removed.

    Raises:
        LinkLostError: it does not listen.
    """
    port += 10 * instance  # said outright: then ArduPilot's --instance does not move it
    with nullcontext(str(own)) if own is not None else TemporaryDirectory(prefix="manoeuvres-") as folder:
        defaults = Path(folder) / "defaults.parm"
        defaults.write_text(
            "".join(f"{name} {value}\n" for name, value in {**CALIBRATION, **params}.items()), encoding="ascii"
        )
        command = [
            str(path), "-w", f"-I{instance}", "--model", PROGRAMS[kind][1], "--speedup", str(speedup),
            "--home", ",".join(f"{x:.10g}" for x in home), "--defaults", str(defaults), "--base-port", str(port),
        ]  # fmt: skip
        with open(os.devnull, "wb") as nowhere:
            process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=nowhere, stderr=nowhere)
        try:
            connection = _connected(process, port)
            try:
                yield connection
            finally:
                connection.close()
        finally:
            process.kill()
            process.wait()


def _connected(process: subprocess.Popen[bytes], port: int) -> RealTime:
    stop = time.monotonic() + _START_S
    while True:
        try:
            found = connect(f"tcp:127.0.0.1:{port}", patience=_START_S, warn=lambda _: None)
        except LinkLostError:
            if process.poll() is not None or time.monotonic() > stop:
                raise
            time.sleep(0.1)
        else:
            if not isinstance(found, RealTime):
                raise OptionError("the executable holds its clock for clients: it is none of ArduPilot's kind")
            return found
