# SPDX-License-Identifier: BSD-3-Clause
"""Small logs of the versions of ArduPilot, written here: DataFlash as bytes and as text, and .tlog."""

from __future__ import annotations

import struct
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from sitl.bridge.dialect import message
from sitl.bridge.frame import encode_v2
from sitl.logs.dataflash.formats import TYPES

Message = tuple[Any, ...]
"""Name and values, the time first, in the units of the file's own numbers."""
V36 = {
    "MSG": ("QZ", "TimeUS,Message"),
    "MODE": ("QMBB", "TimeUS,Mode,ModeNum,Rsn"),
    "POS": ("QLLfff", "TimeUS,Lat,Lng,Alt,RelHomeAlt,RelOriginAlt"),
    "ATT": ("QccccCCCCB", "TimeUS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw,ErrRP,ErrYaw,AEKF"),
    "NKF1": ("QccCfffffffccce", "TimeUS,Roll,Pitch,Yaw,VN,VE,VD,dPD,PN,PE,PD,GX,GY,GZ,OH"),
    "BAT": ("Qfff", "TimeUS,Volt,Curr,CurrTot"),
    "EV": ("QB", "TimeUS,Id"),
}
"""ArduPilot 3.6: no ARM, a BAT of which EnrgTot is missing."""
V32 = {
    "MSG": ("Z", "Message"),
    "MODE": ("IMh", "TimeMS,Mode,ThrCrs"),
    "GPS": ("BIHBcLLeeEefI", "Status,TimeMS,Week,NSats,HDop,Lat,Lng,RelAlt,Alt,Spd,GCrs,VZ,T"),
    "AHR2": ("IccCfLL", "TimeMS,Roll,Pitch,Yaw,Alt,Lat,Lng"),
    "ATT": ("IccccCC", "TimeMS,DesRoll,Roll,DesPitch,Pitch,DesYaw,Yaw"),
    "CURR": ("Ihhhhf", "TimeMS,ThrOut,Volt,Curr,Vcc,CurrTot"),
    "EV": ("B", "Id"),
}
"""ArduPilot 3.2: milliseconds, no POS, voltage and current in hundredths."""
LAT, LON = -353632620, 1491652370


def flight(version: str = "ArduCopter V3.6.12", step_us: int = 100_000, count: int = 50) -> list[Message]:
    """Five seconds of ``V36``: north at 2 m/s, 5 A at 12 V."""
    found: list[Message] = [("MSG", 1_000_000, version.encode()), ("MODE", 1_000_000, 4, 4, 1), ("EV", 1_000_000, 10)]
    for k in range(count):
        t = 1_000_000 + k * step_us
        north = round(0.2 * k / 0.011131884502145034)
        found += [
            ("POS", t, LAT + north, LON, 594.0, 10.0, 10.0),
            ("ATT", t, 0, 100, 0, -200, 9000, 9000, 0, 0, 2),
            ("NKF1", t, 0, 0, 0, 2.0, 0.0, 0.0, *[0.0] * 4, 0, 0, 0, 0),
            ("BAT", t, 12.0, 5.0, 10.0),
        ]
    return found


def old_flight() -> list[Message]:
    """Five seconds of ``V32``."""
    found: list[Message] = [("MSG", b"ArduCopter V3.2.1 (36b405fb)")]
    for k in range(50):
        t = 1_000 + k * 100
        north = round(0.2 * k / 0.011131884502145034)
        found += [
            ("GPS", 3, 400_000_000 + t, 1800, 9, 100, LAT + north, LON, 1000, 59400, 200, 0, 0.0, t),
            ("AHR2", t, 0, 0, 9000, 594.0, LAT + north, LON),
            ("ATT", t, 0, 100, 0, -200, 9000, 9000),
            ("CURR", t, 500, 1200, 500, 5000, 10.0),
        ]
    found.insert(10, ("MODE", 1_000, 5, 500))
    found.insert(11, ("EV", 10))
    return found


def binary(messages: Iterable[Message], formats: dict[str, tuple[str, str]]) -> bytes:
    """A .bin."""
    numbers = {name: 1 + k for k, name in enumerate(formats)}
    codes = {name: struct.Struct("<" + "".join(TYPES[c][1] for c in letters)) for name, (letters, _) in formats.items()}
    out = bytearray()
    for number, length, name, letters, labels in [
        (128, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns"),
        *((numbers[n], 3 + codes[n].size, n, *formats[n]) for n in formats),
    ]:
        out += b"\xa3\x95\x80" + struct.pack(
            "<BB4s16s64s", number, length, name.encode(), letters.encode(), labels.encode()
        )
    for name, *values in messages:
        out += b"\xa3\x95" + bytes([numbers[name]]) + codes[name].pack(*values)
    return bytes(out)


def text(messages: Iterable[Message], formats: dict[str, tuple[str, str]]) -> bytes:
    """The same as a .log, as tools write it."""
    lines = ["FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format"]
    lines += [f"FMT, {1 + k}, 0, {n}, {letters}, {labels}" for k, (n, (letters, labels)) in enumerate(formats.items())]
    for name, *values in messages:
        shown = []
        for letter, value in zip(formats[name][0], values, strict=True):
            scale = {"c": 100.0, "C": 100.0, "e": 100.0, "E": 100.0, "L": 1e7}.get(letter)
            shown.append(
                value.decode() if isinstance(value, bytes) else f"{value / scale:.7f}" if scale else str(value)
            )
        lines.append(", ".join([name, *shown]))
    return "\n".join([*lines, ""]).encode()


def telemetry(
    mav_type: int = 2, boot_ms: Iterable[int] = range(1000, 6000, 100), epoch_us: int = 1_700_000_000_000_000
) -> bytes:
    """A .tlog: a HEARTBEAT, then places north at 2 m/s."""
    out = bytearray()
    beat = message("HEARTBEAT").payload(
        type=mav_type, autopilot=3, base_mode=129, custom_mode=4, system_status=4, mavlink_version=3
    )
    frames = [(0, encode_v2(message("HEARTBEAT"), beat, 0, 1, 1))]
    for k, ms in enumerate(boot_ms):
        payload = message("GLOBAL_POSITION_INT").payload(
            time_boot_ms=ms, lat=LAT + 18 * k, lon=LON, alt=594_000, relative_alt=10_000, vx=200, vy=0, vz=0, hdg=0
        )
        frames.append((k * 100_000, encode_v2(message("GLOBAL_POSITION_INT"), payload, (k + 1) & 255, 1, 1)))
    for at, frame in frames:
        out += (epoch_us + at).to_bytes(8, "big") + frame
    return bytes(out)


def written(path: Path, data: bytes) -> Path:
    """The file's path."""
    path.write_bytes(data)
    return path


def without_messages(path: Path, to: Path, name: bytes) -> Path:
    """A log without the messages of a name."""
    data, at, out = path.read_bytes(), 0, bytearray()
    lengths: dict[int, int] = {128: 89}
    names: dict[int, bytes] = {}
    while at + 3 <= len(data):
        kind = data[at + 2]
        if kind == 128:
            number, length, label = struct.unpack_from("<BB4s", data, at + 3)
            lengths[number], names[number] = length, label.rstrip(b"\0")
        if names.get(kind) != name:
            out += data[at : at + lengths[kind]]
        at += lengths[kind]
    to.write_bytes(bytes(out))
    return to
