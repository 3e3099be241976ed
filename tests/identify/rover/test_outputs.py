# SPDX-License-Identifier: BSD-3-Clause
"""Outputs between two samples: straight lines, and steps at their onsets."""

from __future__ import annotations

import numpy as np
import pytest

from sitl.identify.rover.outputs import Output

TIME = np.arange(0.0, 2.0, 0.1)


def test_a_ramp_is_a_straight_line_that_is_held_for_a_while() -> None:
    output = Output(TIME, 0.4 * TIME, hold=0.02)
    assert len(output.indices) == 0, "0.04 a sample is no step"
    assert output.at(np.array([0.55]), 0.01) == pytest.approx([0.4 * 0.54]), "half of what is held late"


def test_a_step_happens_at_its_onset() -> None:
    value = np.where(TIME < 0.95, 0.0, 0.8)
    output = Output(TIME, value, hold=0.0)
    assert output.steps.begin == pytest.approx([0.9])
    early, late = (output.with_onset(np.array([onset])) for onset in (0.2, 0.8))
    times = np.array([0.905, 0.95, 0.995])
    assert early.at(times, 0.01) == pytest.approx([0.0, 0.8, 0.8])
    assert late.at(times, 0.01) == pytest.approx([0.0, 0.0, 0.8])
    assert early.at(np.array([0.92]), 0.01) == pytest.approx([0.4]), "the mean over the width"


def test_what_changes_before_and_after_too_is_no_step() -> None:
    assert len(Output(TIME, np.clip(3.0 * (TIME - 0.5), 0.0, 1.0), hold=0.0).indices) == 0
