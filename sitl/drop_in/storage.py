# SPDX-License-Identifier: BSD-3-Clause
"""What the autopilot keeps when it is switched off, as a file: parameters, lists of locations, signing key."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ..autopilot.fence import items as fence
from ..autopilot.fence.state import FenceState
from ..autopilot.mission.item import FENCE_COMMANDS, MissionItem
from ..bridge.signing import KEY_BYTES, LAST, OFF, SigningState
from ..core import documents
from ..core.mavlink import MavCmd
from ..core.whole_file import write_whole
from ..errors import SitlError

MOST_BYTES = 1 << 24
"""Of the file."""
MOST_ITEMS = 65535
"""Of a list: its numbers have 16 bits."""
_INT32 = range(-(1 << 31), 1 << 31)
_RANGES = {
    "command": range(1 << 16), "frame": range(1 << 8), "x": _INT32, "y": _INT32, "autocontinue": range(1 << 8),
    "current": range(1 << 8),
}  # fmt: skip
"""Fields of an item that are whole."""
_LARGEST, _HIGHEST = 3.4e38, 32767.0
"""Of float32; of a rally point [m]."""


class StorageError(SitlError):
    """The file cannot be read or written, or is something else."""


class Storage:
    """Parameters by name and mission items, read from ``path`` if it is there.

    Raises:
        StorageError: the file is there and cannot be read.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.parameters: dict[str, float] = {}
        self.mission: tuple[MissionItem, ...] = ()
        self.fence: tuple[MissionItem, ...] = ()
        self.rally: tuple[MissionItem, ...] = ()
        self.signing = OFF
        self._is_changed = False
        try:
            with path.open("rb") as file:
                content = file.read(MOST_BYTES + 1)
        except FileNotFoundError:
            return
        except OSError as error:
            raise StorageError(f"storage {str(path)!r} cannot be read: {error.strerror or error}") from None
        try:
            if len(content) > MOST_BYTES:
                raise ValueError(f"more than {MOST_BYTES} bytes")
            self._take(documents.of_json(content))
        except (ValueError, KeyError, TypeError, AttributeError, OverflowError, SitlError) as error:
            raise StorageError(f"storage {str(path)!r} is damaged ({error!r}); -w begins anew") from None

    def _take(self, kept: Any) -> None:
        """What is in the file, checked: a vehicle starts with it.

        Raises:
            ValueError, KeyError, TypeError, AttributeError, OverflowError, SitlError: it makes no sense.
        """
        self.parameters = {name: _number(value) for name, value in kept["parameters"].items()}
        self.mission = _items(kept["mission"])
        self.fence, self.rally = _items(kept.get("fence", [])), _items(kept.get("rally", []))
        for items, commands in ((self.fence, FENCE_COMMANDS), (self.rally, (MavCmd.NAV_RALLY_POINT,))):
            for item in items:
                if item.command not in commands or not abs(item.z) <= _HIGHEST:
                    raise ValueError(f"{item} is no such location")
        fence.load(FenceState(), list(fence.shapes(self.fence)))
        key, timestamp = kept.get("signing", ("", 0))
        if type(timestamp) is not int or not 0 <= timestamp <= LAST:
            raise ValueError(f"a time stamp {timestamp!r}")
        self.signing = SigningState(bytes.fromhex(key), timestamp)
        if len(self.signing.key) not in (0, KEY_BYTES):
            raise ValueError(f"a signing key of {len(self.signing.key)} bytes")

    @classmethod
    def wiped(cls, path: Path) -> Storage:
        """Without anything of before.

        Raises:
            StorageError: the file of before cannot be removed.
        """
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            raise StorageError(f"storage {str(path)!r} cannot be wiped: {error.strerror or error}") from None
        return cls(path)

    def keep(self, name: str, value: float) -> None:
        """Keep a parameter."""
        self.parameters[name] = value
        self._is_changed = True

    def keep_mission(self, items: tuple[MissionItem, ...]) -> None:
        """Keep a mission, home first."""
        self.mission = items
        self._is_changed = True

    def keep_lists(self, fences: tuple[MissionItem, ...], rally: tuple[MissionItem, ...]) -> None:
        """Keep fences and rally points."""
        self.fence, self.rally = fences, rally
        self._is_changed = True

    def keep_signing(self, state: SigningState) -> None:
        """Keep the key and the time stamp."""
        self.signing = SigningState(state.key, state.timestamp)
        self._is_changed = True

    def write(self) -> None:
        """Write the file if something has changed: whole, or not at all.

        Raises:
            StorageError: it cannot be written.
        """
        if not self._is_changed:
            return
        self._is_changed = False
        kept: dict[str, object] = {"parameters": self.parameters, "mission": self.mission}
        kept |= {"fence": self.fence, "rally": self.rally}
        if self.signing.key:
            kept["signing"] = (self.signing.key.hex(), self.signing.timestamp)
        try:
            write_whole(self.path, json.dumps(kept, indent=0), StorageError, f"storage {str(self.path)!r}")
        except StorageError:
            self._is_changed = True
            raise


def _number(value: Any) -> float:
    if type(value) not in (int, float):
        raise ValueError(f"{value!r} is no number")
    return float(value)


def _items(rows: Any) -> tuple[MissionItem, ...]:
    if not isinstance(rows, list) or len(rows) > MOST_ITEMS:
        raise ValueError(f"no list of at most {MOST_ITEMS} items")
    return tuple(_item(row) for row in rows)


def _item(row: Any) -> MissionItem:
    item = MissionItem(*row)
    for name, value in item._asdict().items():
        if name in _RANGES:
            if type(value) is not int or value not in _RANGES[name]:
                raise ValueError(f"{name} {value!r} of an item")
        elif abs(_number(value)) > _LARGEST:
            raise ValueError(f"{name} {value!r} of an item")
    return item
