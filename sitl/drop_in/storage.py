# SPDX-License-Identifier: BSD-3-Clause
"""What the autopilot keeps when it is switched off, as a file: parameters, lists of places, signing key."""

from __future__ import annotations

import json
import os
from pathlib import Path

from ..autopilot.fence import items as fence
from ..autopilot.fence.state import FenceState
from ..autopilot.mission.item import MissionItem
from ..bridge.signing import KEY_BYTES, OFF, SigningState
from ..core import documents
from ..errors import SitlError


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
            kept = documents.of_json(path.read_text(encoding="utf-8"))
            self.parameters = {str(name): float(value) for name, value in kept["parameters"].items()}
            self.mission = tuple(MissionItem(*item) for item in kept["mission"])
            self.fence = tuple(MissionItem(*item) for item in kept.get("fence", ()))
            self.rally = tuple(MissionItem(*item) for item in kept.get("rally", ()))
            fence.load(FenceState(), list(fence.shapes(self.fence)))
            key, timestamp = kept.get("signing", ("", 0))
            self.signing = SigningState(bytes.fromhex(key), int(timestamp))
            if len(self.signing.key) not in (0, KEY_BYTES):
                raise ValueError(f"a signing key of {len(self.signing.key)} bytes")
        except FileNotFoundError:
            return
        except OSError as error:
            raise StorageError(f"storage {str(path)!r} cannot be read: {error.strerror or error}") from None
        except (ValueError, KeyError, TypeError, AttributeError) as error:
            raise StorageError(f"storage {str(path)!r} is damaged ({error!r}); -w begins anew") from None

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

    def keep_places(self, fences: tuple[MissionItem, ...], rally: tuple[MissionItem, ...]) -> None:
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
        text = json.dumps(kept, indent=0)
        beside = self.path.with_name(self.path.name + ".new")
        try:
            beside.write_text(text, encoding="utf-8")
            os.replace(beside, self.path)
        except OSError as error:
            raise StorageError(f"storage {str(self.path)!r} cannot be written: {error.strerror or error}") from None
