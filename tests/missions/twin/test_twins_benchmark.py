# SPDX-License-Identifier: BSD-3-Clause
"""The tables of docs/twin.md: a row for each log and twin, with what the twin's metrics say."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks import twins
from sitl.missions.twin.twin import Twin
from tests.missions.twin.conftest import FRAME, SEED


def test_a_row_has_the_metrics_of_its_twin(own_twin: Twin) -> None:
    head, rule, row = twins.table("copter", [(twins.Row("square", FRAME, FRAME, SEED), own_twin)])
    cells = [cell.strip() for cell in row.strip("|").split("|")]
    assert head.count("|") == rule.count("|") == row.count("|")
    assert cells[:3] == [
        f"square, {own_twin.log.span.length:.0f} s", "`ardupilot_quad`, seed 3", f"`{FRAME}`, seed {SEED}",
    ]  # fmt: skip
    metrics = own_twin.metrics()
    assert cells[3] == f"{metrics['height.rms']:.2g}"
    assert cells[6] == ", ".join(f"{metrics[f'{axis}_rate.vaf']:.0f}" for axis in ("roll", "pitch", "yaw"))


@pytest.mark.slow
def test_a_flight_of_ours_is_flown_and_compared(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert twins.main(["--only", "square", "--keep", str(tmp_path)]) == 0
    out = capsys.readouterr().out
    rows = [line for line in out.splitlines() if line.startswith("| square")]
    assert len(rows) == sum(row.flight == "square" and bool(row.logged) for row in twins.ROWS)
    assert {path.name for path in tmp_path.glob("*.bin")} == {"square-erle_copter.bin", "square-ardupilot_quad.bin"}
    assert "more down than the vehicle did" in out, "the wrong airframe is told"
