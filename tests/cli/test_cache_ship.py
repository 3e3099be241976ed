# SPDX-License-Identifier: BSD-3-Clause
"""``sitl cache ship --here``: the library of this machine alone. Making one is tested in tests/core/shipped."""

from __future__ import annotations

from pathlib import Path

import pytest

from sitl.cli import cache, main
from sitl.core.shipped.target_machines import TARGETS


@pytest.fixture
def asked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, ...]]:
    """Names of the targets that each call makes a library for."""
    calls: list[tuple[str, ...]] = []

    def build(made_of, folder, targets, progress):
        calls.append(tuple(target.name for target in targets))
        file = tmp_path / "core.so"
        file.write_bytes(b"")
        return [file]

    monkeypatch.setattr(cache, "build", build)
    monkeypatch.setattr(cache, "shipped_pieces", list)
    return calls


def test_one_for_this_machine_or_for_all(asked, monkeypatch):
    monkeypatch.setattr(cache, "usable", lambda: TARGETS[1:])
    assert main(["cache", "ship", "--here"]) == main(["cache", "ship"]) == 0
    assert asked == [("x86_64",), ("x86_64_v3", "x86_64", "aarch64")]


def test_a_machine_that_no_code_is_shipped_for(asked, monkeypatch, capsys):
    monkeypatch.setattr(cache, "usable", lambda: ())
    assert main(["cache", "ship", "--here"]) != 0
    assert "for Linux alone; sitl cache build compiles here" in capsys.readouterr().err
    assert not asked
