# SPDX-License-Identifier: BSD-3-Clause
"""What clients and the world do to a vehicle in an episode: drawn from a seed, plain data, kept as JSON."""

from __future__ import annotations

import random
import struct
from collections.abc import Sequence
from typing import Any, NamedTuple

from sitl.autopilot.mission.item import FENCE_COMMANDS
from sitl.autopilot.params.table import Table
from sitl.bridge import dialect
from sitl.bridge.dialect import MessageType, message
from sitl.bridge.frame import encode_v1, encode_v2
from sitl.core.mavlink import MavCmd

from .tables import FAULTS, NUMBERS, PARTS, WHOLE

SPECIAL = (246, 209, 42428)
"""Commands that have deeds of their own, or end with motors turning: reboot, motor tests."""
MARKS, SHORTEST = (b"\xfd", b"\xfe"), 8
"""How a frame begins, and its least length."""
FLOOD = 100
"""Deeds at once."""
MODES = 30
"""Numbers of modes are below this."""


class Deed(NamedTuple):
    """Something done, and how long the vehicle then goes on."""

    kind: str
    """"bytes", "link", "forget" (the client's link is closed, another opened) or "reboot"."""
    data: str
    """Bytes in hex, a space between those that can do without each other; faults of the link as words
    (``LinkFaults.of_texts``) in "name=word,..."."""
    seconds: float
    """Simulated time after it."""
    what: str = ""
    """For people."""
    frames: int = 0
    """Frames among the bytes, right or wrong."""
    is_fault: bool = False
    """From then on something is not as it should be."""


class Dice:
    """Draws the deeds of an episode.

    Args:
        seed: of the episode.
        table: the vehicle's parameters.
        commands: MAV_CMD numbers that the vehicle knows.
        items: those that its missions may hold.
    """

    def __init__(self, seed: int, table: Table, commands: Sequence[int], items: Sequence[int]) -> None:
        self._dice = random.Random(seed)
        self._table = table
        self._commands = [number for number in commands if number not in SPECIAL]
        self._items = list(items)
        self._parameters = [p for p in table if p.has_effect or p.doc]
        self._kinds = [kind for kind in map(dialect.find_message, range(512)) if kind is not None]
        self._sequence = 0

    def deeds(self, count: int) -> list[Deed]:
        """So many deeds; some of them belong together."""
        found: list[Deed] = []
        makers = (
            self._garbage, self._any_message, self._any_message, self._command, self._command, self._command_int,
            self._mission, self._set_parameter, self._set_parameter, self._fault, self._link, self._mode, self._arm,
            self._target, self._sticks, self._reboot, self._forget, self._download, self._flood, self._equip,
        )  # fmt: skip
        while len(found) < count:
            found += self._dice.choice(makers)()
        return found[:count]

    # ------------------------------------------------------------------ bytes

    def _deed(self, what: str, *frames: bytes, seconds: float | None = None) -> list[Deed]:
        wait = self._dice.choice((0.0, 0.0025, 0.02, 0.1, 0.5, 2.0)) if seconds is None else seconds
        count = sum(frame[:1] in MARKS and len(frame) >= SHORTEST for frame in frames)
        return [Deed("bytes", " ".join(frame.hex() for frame in frames), wait, what, count)]

    def _frame(self, kind: MessageType, payload: bytes) -> bytes:
        self._sequence = (self._sequence + 1) & 0xFF
        system = 255 if self._dice.random() < 0.9 else self._dice.randint(0, 255)
        encode = encode_v1 if self._dice.random() < 0.05 else encode_v2
        return encode(kind, payload, self._sequence, system, 190)

    def _message(self, name: str, **fields: Any) -> bytes:
        kind = message(name)
        if "target_system" in kind.fields:
            fields.setdefault("target_system", 1)
        return self._frame(kind, kind.payload(**fields))

    def _garbage(self) -> list[Deed]:
        d = self._dice
        frame = bytearray(self._message("HEARTBEAT", type=6))
        frame[d.randrange(len(frame))] ^= 1 << d.randrange(8)
        return self._deed(
            "garbage", d.randbytes(d.randint(0, 300)), bytes(frame), d.choice((b"", b"\xfd", b"\xfd\xff\x00"))
        )

    def _any_message(self) -> list[Deed]:
        """Any message of the dialect, of random bytes, now and then for this vehicle."""
        d, kind = self._dice, self._dice.choice(self._kinds)
        payload = bytearray(d.randbytes(kind.size) if d.random() < 0.7 else bytes(kind.size))
        for name in ("target_system", "target_component", "target"):
            if name in kind.fields:
                payload[kind.offset_of(name)] = 1
        if kind.name in ("COMMAND_LONG", "COMMAND_INT") or kind.name == "SETUP_SIGNING":
            return self._command()  # a command has deeds of its own, and a key would lock us out
        return self._deed(kind.name, self._frame(kind, bytes(payload)))

    def _flood(self) -> list[Deed]:
        """Many frames at once; none is garbage, which may swallow the next ones."""
        makers = (self._any_message, self._command, self._command_int, self._target, self._sticks)
        deeds = [deed for _ in range(FLOOD) for deed in self._dice.choice(makers)()]
        return [
            deeds[-1]._replace(
                data=" ".join(deed.data for deed in deeds), what="flood", frames=sum(deed.frames for deed in deeds)
            )
        ]

    def _number(self) -> float:
        d = self._dice
        return d.choice(NUMBERS) if d.random() < 0.5 else struct.unpack("<f", struct.pack("<f", d.uniform(-60, 60)))[0]

    def _whole(self) -> int:
        return self._dice.choice(WHOLE) if self._dice.random() < 0.7 else self._dice.randint(-(2**31), 2**31 - 1)

    # ------------------------------------------------------------------ what clients say

    def _command(self) -> list[Deed]:
        d = self._dice
        number = d.choice(self._commands) if d.random() < 0.9 else d.randint(0, 65535)
        if number in SPECIAL:
            return self._reboot()
        fields = {f"param{k}": self._number() for k in range(1, 8)}
        return self._deed(f"command {number}", self._message("COMMAND_LONG", command=number, **fields))

    def _command_int(self) -> list[Deed]:
        d, number = self._dice, self._dice.choice(self._commands)
        fields = {f"param{k}": self._number() for k in range(1, 5)}
        place = {
            "x": self._whole(),
            "y": self._whole(),
            "z": self._number(),
            "frame": d.choice((0, 1, 2, 3, 6, 10, 255)),
        }
        return self._deed(f"command {number} (INT)", self._message("COMMAND_INT", command=number, **fields, **place))

    def _mode(self) -> list[Deed]:
        number = self._dice.randrange(MODES)
        return self._deed(f"mode {number}", self._message("COMMAND_LONG", command=176, param1=1, param2=number))

    def _arm(self) -> list[Deed]:
        d = self._dice
        on, force = d.choice((0, 1, 1)), d.choice((0, 0, 21196))
        arm = self._message("COMMAND_LONG", command=400, param1=on, param2=force)
        up = self._message("COMMAND_LONG", command=22, param7=d.uniform(1, 20))
        return self._deed(f"arm {on} {force}", arm, seconds=0.5) + self._deed("take-off", up, seconds=d.uniform(0, 8))

    def _target(self) -> list[Deed]:
        d = self._dice
        motion = {
            name: self._number() for name in ("x", "y", "z", "vx", "vy", "vz", "afx", "afy", "afz", "yaw", "yaw_rate")
        }
        frame, mask = d.choice((0, 1, 7, 8, 9, 255)), d.choice((0xDF8, 0xDC7, 0xC3F, 0x9C7, 0x5C7, d.randint(0, 65535)))
        send = self._message("SET_POSITION_TARGET_LOCAL_NED", coordinate_frame=frame, type_mask=mask, **motion)
        return self._deed("set-point", send)

    def _sticks(self) -> list[Deed]:
        d = self._dice
        pulses = {f"chan{k}_raw": d.choice((0, 1000, 1500, 2000, 65535, d.randint(900, 2100))) for k in range(1, 9)}
        return self._deed("sticks", self._message("RC_CHANNELS_OVERRIDE", **pulses))

    def _mission(self) -> list[Deed]:
        """An upload, right or with a mistake, and perhaps AUTO."""
        d = self._dice
        count, kind = d.randint(0, 6), d.choice((0, 0, 0, 1, 1, 2, 7))
        commands = {1: FENCE_COMMANDS, 2: (MavCmd.NAV_RALLY_POINT,)}.get(kind, self._items)
        corners = float(d.randint(3, 6))
        found = self._deed(
            f"mission of {count}", self._message("MISSION_COUNT", count=count, mission_type=kind), seconds=0.0
        )
        for seq in range(count):
            wild = d.random() < 0.1
            place = {"x": self._whole(), "y": self._whole(), "z": self._number()} if wild else {
                "x": -353632621 + d.randint(-5000, 5000), "y": 1491652371 + d.randint(-5000, 5000),
                "z": d.uniform(1, 30),
            }  # fmt: skip
            fields = {f"param{k}": self._number() if wild else float(d.randint(0, 5)) for k in range(1, 5)}
            if kind == 1 and not wild:
                fields["param1"] = corners  # or the radius of a circle
            item = self._message(
                "MISSION_ITEM_INT", seq=seq if d.random() < 0.97 else d.randint(0, 9), frame=d.choice((0, 3, 3, 6, 10)),
                command=d.choice(commands) if d.random() < 0.95 else d.randint(0, 65535), mission_type=kind,
                autocontinue=1, **fields, **place,
            )  # fmt: skip
            found += self._deed(f"item {seq}", item, seconds=0.0)
        if d.random() < 0.5:
            auto = self._message("COMMAND_LONG", command=176, param1=1, param2=d.choice((3, 10)))
            start = self._message("COMMAND_LONG", command=300)
            found += self._deed("start", auto, start, seconds=d.uniform(0, 10))
        return found

    def _download(self) -> list[Deed]:
        d = self._dice
        ask = d.choice((
            self._message("PARAM_REQUEST_LIST"),
            self._message("MISSION_REQUEST_LIST", mission_type=d.choice((0, 1, 2, 9))),
            self._message("MISSION_REQUEST_INT", seq=d.randint(0, 9)), self._message("LOG_REQUEST_LIST", end=65535),
            self._message("REQUEST_DATA_STREAM", req_stream_id=d.randint(0, 13), req_message_rate=50, start_stop=1),
            self._message("FILE_TRANSFER_PROTOCOL", payload=tuple(d.randbytes(251))),
        ))  # fmt: skip
        return self._deed("request", ask)

    # ------------------------------------------------------------------ the world

    def _set(self, name: str, value: float) -> list[Deed]:
        frame = self._message("PARAM_SET", param_id=name.encode(), param_value=value, param_type=9)
        return self._deed(f"{name} = {value:g}", frame)

    def _set_parameter(self) -> list[Deed]:
        d = self._dice
        parameter = d.choice(self._parameters)
        value = (
            self._number() if d.random() < 0.3 else parameter.used(d.choice((0, 1, 2, 5, 100, d.uniform(-10, 2000))))
        )
        return self._set(parameter.name, value)

    def _fault(self) -> list[Deed]:
        name = self._dice.choice([name for name in FAULTS if name in self._table])
        (deed,) = self._set(name, round(self._dice.uniform(*FAULTS[name]), 3))
        return [deed._replace(is_fault=True)]

    def _equip(self) -> list[Deed]:
        """Parts, and the boot that looks for them."""
        parts = {name: value for name, value in self._dice.choice(PARTS).items() if name in self._table}
        return [deed for name, value in parts.items() for deed in self._set(name, value)] + self._reboot()

    def _link(self) -> list[Deed]:
        d = self._dice
        words = {
            "loss": d.choice((0, 0.1, 0.5)), "delay": d.choice(("0", "0.2", "0.1..0.4")),
            "duplicates": d.choice((0, 0.2)), "reordering": d.choice((0, 0.2)), "corruption": d.choice((0, 1e-4)),
            "seed": d.randrange(1000),
        }  # fmt: skip
        text = "" if d.random() < 0.4 else ",".join(f"{name}={word}" for name, word in words.items())
        return [Deed("link", text, 0.1, text or "good link", is_fault=bool(text))]

    def _reboot(self) -> list[Deed]:
        return [Deed("reboot", "", self._dice.choice((0.0, 1.0, 45.0)), "reboot")]

    def _forget(self) -> list[Deed]:
        return [Deed("forget", "", 0.1, "another client")]
