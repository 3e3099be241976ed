# SPDX-License-Identifier: BSD-3-Clause
"""The description of messages: that readers can take it, and that every message of ours fits it."""

from __future__ import annotations

from pathlib import Path

import pytest
from pymavlink import DFReader

from sitl.logs.dataflash import formats
from sitl.logs.dataflash.common import EVENT_MESSAGES
from sitl.logs.dataflash.encoder import EVERY_BIT
from sitl.logs.dataflash.formats import Field, Message
from sitl.logs.kind import logs_of


@pytest.mark.parametrize("kind", ["copter", "rover"])
def test_every_message_fits_what_fmt_can_say(kind: str) -> None:
    messages = (*EVENT_MESSAGES, *logs_of(kind).messages(EVERY_BIT, 0, True))
    for m in messages:
        formats.check(m)
    names = [m.name for m in messages]
    assert len(set(names)) == len(names)
    assert len(set(formats.number_all(messages).values())) == len(names)


@pytest.mark.parametrize(
    "message",
    [
        Message("TOOLONG", ()),
        Message("MANY", tuple(Field(f"F{k}", "B") for k in range(16))),
        Message("LAB", tuple(Field(f"AVeryLongLabel{k}", "B") for k in range(5))),
        Message("UNIT", (Field("A", "f", "!"),)),
        Message("TYPE", (Field("A", "x"),)),
    ],
)
def test_check_refuses_what_does_not_fit(message: Message) -> None:
    with pytest.raises(ValueError, match=message.name):
        formats.check(message)


def test_head_describes_types_units_and_multipliers(tmp_path: Path) -> None:
    message = Message("ABC", (Field("I", "B", "#"), Field("Ang", "c", "d", "B"), Field("Txt", "N")))
    numbers = formats.number_all([message])
    body = message.packer.pack(*formats.HEAD, numbers["ABC"], 5_000_000, 2, -1234, b"words")
    path = tmp_path / "one.bin"
    path.write_bytes(formats.head([message], numbers, 0) + body)
    log = DFReader.DFReader_binary(str(path))
    read = log.recv_match(type="ABC")
    assert (read.TimeUS, read.I, read.Ang, read.Txt) == (5_000_000, 2, -12.34, "words")
    described = read.fmt
    assert (described.get_unit("TimeUS"), described.get_unit("Ang")) == ("\u00b5s", "deg")
    assert described.instance_field == "I"
    log.close()
