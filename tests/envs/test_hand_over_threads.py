# SPDX-License-Identifier: BSD-3-Clause
"""A vehicle that may be real is commanded from a thread in which no signal can be caught: that is said, once."""

from __future__ import annotations

import threading

import pytest

from tests.envs.test_guarded_vehicles import STILL
from tests.envs.test_hand_over import flying, signals  # noqa: F401 (a fixture)
from tests.envs.test_reset_of_real_vehicles import RealVehicle, hovering

pytestmark = pytest.mark.filterwarnings("ignore:.*clock cannot be held")
WARNING = "is commanded from a thread that is not the main one, where no signal can be caught: SIGTERM, SIGHUP and"


def test_a_thread_in_which_no_signal_can_be_caught_is_told_once(capsys: pytest.CaptureFixture[str]) -> None:
    raised: list[BaseException] = []

    def fly() -> None:
        try:
            with RealVehicle(hovering()) as vehicle, flying(vehicle) as env:
                env.step(STILL)
                env.reset()
                env.step(STILL)
        except BaseException as error:  # a thread's errors are nobody's else
            raised.append(error)

    thread = threading.Thread(target=fly)
    thread.start()
    thread.join()
    assert raised == []
    assert capsys.readouterr().err.count(WARNING) == 1
