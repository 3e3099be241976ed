# SPDX-License-Identifier: BSD-3-Clause
"""The page about MAVLink says what the code does."""

from __future__ import annotations

import re
from pathlib import Path

from sitl.bridge import docs
from sitl.bridge.dialect import message_by_id
from tests.bridge.fakes import Bench

DOCS = Path(__file__).parents[2] / "docs"


def test_the_page_is_up_to_date() -> None:
    template = (DOCS / "templates" / "mavlink.md").read_text(encoding="utf-8")
    assert (DOCS / "mavlink.md").read_text(encoding="utf-8") == docs.page(template), "run: python docs/make_pages.py"


def test_every_message_in_and_out_is_on_the_page(bench: Bench) -> None:
    page = (DOCS / "mavlink.md").read_text(encoding="utf-8")
    assert set(docs.handled()) == {message_by_id(number).name for number in bench.bridge._handlers}
    for name in docs.handled():
        assert f"{name} (" in page
    for kind, _ in bench.bridge.telemetry.values():
        assert f"| {kind.id} | {kind.name} |" in page
    assert not re.search(r"\{\w+\}", page), "a table is missing"


def test_every_command_says_what_it_does() -> None:
    for line in docs.commands().splitlines()[2:]:
        assert len(line.split("|")[5].strip()) > 10, line
