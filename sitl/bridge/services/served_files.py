# SPDX-License-Identifier: BSD-3-Clause
"""The files that MAVLink FTP serves: parameters, missions (which it takes, too), logs, links, what parameters mean, and
what clients have made (``client_files.py``).

As ArduPilot's: ``@SYS/`` reports the running system, ``@MISSION/`` has mission, fence and rally points as items of
MISSION_ITEM_INT behind a header of five numbers, ``logs/`` the on-board logs.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Mapping
from typing import Any

from ...core.mavlink import MavMissionType
from .. import metadata
from ..host import Host
from .client_files import ClientFiles
from .mission_protocol import MissionService
from .mission_upload import ITEM_INT, to_int
from .parameter_protocol import ParameterService

PARAMETERS = "@PARAM/param.pck"
LOGS = "logs"
MISSIONS = {
    "@MISSION/mission.dat": MavMissionType.MISSION,
    "@MISSION/fence.dat": MavMissionType.FENCE,
    "@MISSION/rally.dat": MavMissionType.RALLY,
}
MISSION_MAGIC = 0x763D
MISSION_HEADER = struct.Struct("<HHHHH")
"""magic, MAV_MISSION_TYPE, options (0), first item (0), number of items"""
_ITEM_BYTES = 38
_PIECE_BYTES = 1 << 20
Reader = Callable[[], bytes]


class Log:
    """An on-board log of the length that it had when it was opened, read piece by piece: it may be long.

    Args:
        logs: the vehicle's.
        entry: of the log, in the list.
    """

    def __init__(self, logs: Any, entry: Any) -> None:
        self._logs, self._number, self._size = logs, entry.number, entry.size
        self.key = (entry.number, entry.time_utc, entry.size)
        """Equal for equal contents."""

    def __len__(self) -> int:
        return self._size

    def __getitem__(self, piece: slice) -> bytes:
        begin, end, _ = piece.indices(self._size)
        return bytes(self._logs.read(self._number, begin, max(end - begin, 0)))

    def crc(self) -> int:
        """Its CRC-32."""
        found = 0xFFFFFFFF
        for begin in range(0, self._size, _PIECE_BYTES):
            found = zlib.crc32(self[begin : begin + _PIECE_BYTES], found)
        return found ^ 0xFFFFFFFF


def read(bridge: Host, clients: ClientFiles, path: str, queries: list[str]) -> bytes | Log | None:
    """What is in a file now; None: there is none.

    Args:
        clients: what clients have made.
        path: without a slash before it.
        queries: what stands behind its "?".
    """
    values = bridge.vehicle.parameters
    if path == PARAMETERS:
        return bridge.get(ParameterService).packed("withdefaults=1" in queries)
    if path in MISSIONS:
        return pack_mission(bridge, MISSIONS[path])
    if path in _system(bridge):
        return _system(bridge)[path]()
    if path in (logs := _logs(bridge)):
        return Log(bridge.logs, logs[path])
    return metadata.files(values.table).get(path, clients.read(path))


def listing(bridge: Host, clients: ClientFiles, path: str) -> list[str] | None:
    """Entries of a folder, as FTP reports them: "DNAME" or "FNAME<tab>SIZE"; None: there is none that can be listed."""
    sizes = {f"@SYS/{name}": UNKNOWN_SIZE for name in SYSTEM} | {"@SYS/storage.bin": STORAGE_SIZE}
    sizes |= {name: len(file()) for name, file in _system(bridge).items()}
    sizes |= {name: entry.size for name, entry in _logs(bridge).items()}
    folder = path.strip("/")
    folder = "" if folder == "." else folder
    if folder:
        found = [f"F{name[len(folder) + 1 :]}\t{size}" for name, size in sizes.items() if name.startswith(folder + "/")]
        made = clients.listing(folder)
        return found or (None if made is None else ["D.", "D..", *made])
    folders = {name.split("/")[0] for name in sizes}
    return ["D.", "D..", *(f"D{name}" for name in sorted(folders)), *(clients.listing("") or ())]


def pack_mission(bridge: Host, kind: int) -> bytes:
    """Mission, fence or rally points as a file."""
    service = bridge.get(MissionService)
    items = service.items(kind) or service.home_alone(kind)
    parts = [to_int(item, k, False, (0, 0), kind)[1].ljust(_ITEM_BYTES, b"\0") for k, item in enumerate(items)]
    return MISSION_HEADER.pack(MISSION_MAGIC, kind, 0, 0, len(items)) + b"".join(parts)


def write(bridge: Host, path: str, data: bytes) -> bool:
    """Take a file of ``MISSIONS`` in place of what it holds; False, and that stays, when it is none or not valid."""
    if len(data) < MISSION_HEADER.size:
        return False
    *head, count = MISSION_HEADER.unpack_from(data)
    if head != [MISSION_MAGIC, MISSIONS[path], 0, 0] or len(data) != MISSION_HEADER.size + count * _ITEM_BYTES:
        return False
    starts = range(MISSION_HEADER.size, len(data), _ITEM_BYTES)
    rows = [ITEM_INT.decode(data[at : at + _ITEM_BYTES]) for at in starts]
    return bridge.get(MissionService).take(MISSIONS[path], rows)


SYSTEM = (
    "threads.txt", "tasks.txt", "dma.txt", "memory.txt", "uarts.txt", "timers.txt", "can_log.txt", "can0_stats.txt",
    "can1_stats.txt", "crash_dump.bin", "storage.bin",
)  # fmt: skip
"""What ArduPilot lists in @SYS. It cannot read those of the board and its memory either, but storage.bin, which has
parameters under numbers of its own tables."""
UNKNOWN_SIZE = 100_000
"""As ArduPilot lists a file whose size is known only when it is read."""
STORAGE_SIZE = 16384
"""Of ArduPilot's storage."""


def _system(bridge: Host) -> Mapping[str, Reader]:
    return {"@SYS/uarts.txt": lambda: _links(bridge), "@SYS/tasks.txt": lambda: b"TasksV2\n"}


def _links(bridge: Host) -> bytes:
    lines = [
        f"SERIAL{channel.number} TX={channel.port.sent:8d} RX={channel.port.received:8d} messages ({channel.name})"
        for channel in bridge.channels
    ]
    return "\n".join(["UARTV1", *lines, ""]).encode("ascii", "replace")


def _logs(bridge: Host) -> dict[str, Any]:
    """Name of each log -> its entry in the list."""
    entries = bridge.logs.entries() if bridge.logs is not None else ()
    return {f"{LOGS}/{entry.number:08d}.BIN": entry for entry in entries}
