# SPDX-License-Identifier: BSD-3-Clause
"""AUTOTUNE: what it finds, tells, keeps and logs. Values are a real ArduPilot's."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sitl.run import runner
from sitl.simulation import Core
from tests.flights.aviator import ALT_HOLD, CIRCLE, GUIDED, LOITER, POSHOLD, STABILIZE, Aviator
from tests.logs.dataflash.conftest import read_log

AUTOTUNE, TEST_GAINS, EMERGENCY_STOP = 15, 180, 31
LOW, HIGH = 0, 2
NAMES = ("ATC_RAT_RLL_P", "ATC_RAT_RLL_I", "ATC_RAT_RLL_D", "ATC_ANG_RLL_P", "ATC_ACCEL_R_MAX", "ATC_RAT_RLL_FLTT")


def hovering(core: Core, mode: int = LOITER, axes: int = 1, **params: float) -> Aviator:
    """In a mode at 20 m with the sticks centred."""
    p = Aviator(core, "ardupilot_quad", AUTOTUNE_AXES=axes, RC_OVERRIDE_TIME=-1, **params).hover(20.0)
    p.sticks(0.5)
    assert p.set_mode(mode)
    p.sticks(2.0)
    return p


def said(p: Aviator, since: float = 0.0) -> list[str]:
    """What AUTOTUNE told, but how far it is."""
    texts = [text.removeprefix("AutoTune: ") for time, _, text in p.texts if time > since and "AutoTune: " in text]
    return [text for text in texts if "%" not in text]


def gains(p: Aviator) -> dict[str, float]:
    """Roll's."""
    return {name: float(getattr(p.ap.params, name)) for name in NAMES}


def tune(p: Aviator, seconds: float) -> float:
    """Tune to the end; how long that took [s]."""
    begin = p.now
    assert p.set_mode(AUTOTUNE), p.texts[-3:]
    assert p.fly(seconds, lambda: p.said("AutoTune: Success") or p.said("Determination Failed"))
    assert p.said("AutoTune: Success"), said(p)
    return p.now - begin


def twitching(core: Core) -> tuple[Aviator, dict[str, float]]:
    """In a twitch, and the gains from before."""
    p = hovering(core)
    before = gains(p)
    assert p.set_mode(AUTOTUNE)
    assert p.fly(20.0, lambda: p.ap.modes.autotune.twitching) and gains(p) != before
    return p, before


def land(p: Aviator) -> None:
    """Close the throttle."""
    p.hold(throttle=1100)
    assert p.fly(60.0, lambda: not p.ap.arming.armed)


def test_roll_is_tuned_as_by_a_real_one_tried_and_kept(core: Core, tmp_path: Path) -> None:
    p = hovering(core)
    runner.open_dataflash(p.simulation, tmp_path / "a.bin")
    before, begin = gains(p), p.now
    assert tune(p, 150.0) == pytest.approx(108.0, rel=0.15)  # 104, 108 and 111 s
    assert gains(p) == before
    assert abs(p.height - 20.0) < 1.0 and np.hypot(*p.pos[:2]) < 3.0
    words = said(p, begin)
    assert words[0] == "Started" and words[1] == "Roll complete" and words[4] == "Success"
    progress = [(time, text) for time, _, text in p.texts if text.endswith("%")]
    assert np.diff([time for time, _ in progress]) == pytest.approx(2.0, abs=0.03)
    assert progress[0][1] == "AutoTune: Roll Rate D Up 0%"
    assert progress[-1][1].startswith("AutoTune: Roll Angle P Up")

    assert p.set_mode(LOITER) and p.set_mode(AUTOTUNE)
    assert said(p, begin)[5:] == ["Stopped", "Pilot Testing gains for Roll "]
    found = gains(p)
    assert found["ATC_RAT_RLL_P"] == pytest.approx(0.155, rel=0.12)  # 0.155 to 0.156
    assert found["ATC_RAT_RLL_I"] == found["ATC_RAT_RLL_P"]
    assert found["ATC_RAT_RLL_D"] == pytest.approx(0.00063, abs=0.0001)  # 0.0006 to 0.00066
    assert found["ATC_ANG_RLL_P"] == pytest.approx(36.0)  # all of them
    assert found["ATC_ACCEL_R_MAX"] == pytest.approx(515_000.0, rel=0.03)  # 511150 to 518774
    assert found["ATC_RAT_RLL_FLTT"] == before["ATC_RAT_RLL_FLTT"]
    assert p.ask(218, TEST_GAINS, LOW) == 0 and gains(p) == before
    assert p.ask(218, TEST_GAINS, HIGH) == 0 and gains(p) == found
    land(p)
    assert gains(p) == pytest.approx(found, rel=1e-6)
    assert said(p, begin)[7:] == [
        "original gains restored", "Pilot Testing gains for Roll ", "Saved gains for Roll ",
    ]  # fmt: skip

    p.simulation.close()
    log = read_log(tmp_path / "a.bin")
    assert [m.Id for m in log["EV"] if 30 <= m.Id <= 37] == [30, 33, 31, 36, 36, 37]
    kept = {m.Name: m.Value for m in log["PARM"]}
    assert {name: kept[name] for name in NAMES} == pytest.approx(found, rel=1e-6), "as if a client had set them"
    rows = log["ATUN"]
    assert len(rows) == pytest.approx(107, abs=16)
    assert [m.TuneStep for m in rows] == sorted(m.TuneStep for m in rows)
    details = log["ATDE"]
    assert 0.5 < len(details) / len(rows) < 25.0
    assert 0.7 < max(m.Rate for m in details) / max(m.Max for m in rows) < 1.6, "twitches of an angle are faster"
    assert max(abs(m.Angle) for m in details) < 60.0
    assert rows[0].Targ == pytest.approx(155.86, rel=0.05)
    assert rows[0].Max == pytest.approx(145.88, rel=0.06) and pytest.approx(0.135) == rows[0].RP
    assert found["ATC_ANG_RLL_P"] - 1e-4 <= rows[-1].SP <= 40.0, "nine tenths of the greatest, 40, are kept"


def test_yaw_is_tuned_by_its_filter_as_by_a_real_one(core: Core) -> None:
    p = hovering(core, axes=4)
    assert tune(p, 320.0) > 170.0  # 221 s
    land(p)
    assert said(p)[-1] == "Saved gains for Yaw(E)"
    params = p.ap.params
    assert pytest.approx(0.75, rel=0.12) == params.ATC_RAT_YAW_P  # 0.734, 0.771, 0.771
    assert pytest.approx(0.1 * params.ATC_RAT_YAW_P) == params.ATC_RAT_YAW_I
    assert pytest.approx(1.0) == params.ATC_RAT_YAW_FLTE  # all of them
    assert pytest.approx(3.126, rel=0.1) == params.ATC_ANG_YAW_P  # all of them
    assert pytest.approx(11_000.0, rel=0.12) == params.ATC_ACCEL_Y_MAX  # 10707 to 11130
    assert params.ATC_RAT_YAW_D == 0.0


def lag(p: Aviator) -> float:
    """RMS of the roll that is missed while it rolls from side to side [deg]."""
    missed = []
    for k in range(16):
        p.hold(roll=1700 if k % 2 else 1300)
        for _ in range(100):
            p.fly(0.01)
            missed.append(p.ap.control.attitude.target_euler.roll - p.ap.estimate.euler.roll)
    p.hold()
    return math.degrees(float(np.sqrt(np.mean(np.square(missed)))))


def test_a_detuned_vehicle_follows_better_afterwards_and_keeps_what_it_did_not_try(core: Core) -> None:
    p = hovering(core, ALT_HOLD, ATC_RAT_RLL_P=0.05, ATC_RAT_RLL_I=0.05, ATC_RAT_RLL_D=0.001, AUTOTUNE_MIN_D=0.0002)
    before = lag(p)
    p.sticks(3.0)
    assert p.set_mode(AUTOTUNE)
    p.set_parameter("AUTOTUNE_AXES", 0)  # after it has begun with roll
    assert p.fly(200.0, lambda: p.said("AutoTune: Success")), said(p)
    land(p)
    assert said(p)[-1] == "Saved gains for Roll "
    assert pytest.approx(0.152, rel=0.15) == p.ap.params.ATC_RAT_RLL_P  # 0.151, 0.153
    assert pytest.approx(0.0006, abs=0.0003) == p.ap.params.ATC_RAT_RLL_D  # 0.0005, 0.0007
    p.sticks(2.0, throttle=1000)
    assert p.set_mode(GUIDED)
    p.arm()
    p.take_off(20.0)
    p.sticks(0.5)
    assert p.set_mode(ALT_HOLD)
    p.sticks(2.0)
    after = lag(p)
    assert after < 0.5 * before, (before, after)


def test_left_before_its_end_nothing_stays_and_it_goes_on_when_entered_again(core: Core) -> None:
    p = hovering(core, STABILIZE, ATC_RAT_RLL_P=0.12)
    before = gains(p)
    assert p.set_mode(AUTOTUNE)
    p.fly(12.0)
    t: Any = p.ap.modes.autotune
    assert gains(p) != before, "less I between twitches"
    done, tuned = (t.step, t.roll.rate_p, t.roll.rate_d), said(p)
    assert done != (0, 0.12, 0.0036) and tuned == ["Started"]
    assert p.set_mode(ALT_HOLD)
    assert gains(p) == before and said(p)[-1] == "Stopped"
    assert p.ask(218, TEST_GAINS, HIGH) == 0
    assert said(p)[-1] == "must be complete to test gains" and gains(p) == before
    p.fly(2.0)
    assert p.set_mode(AUTOTUNE)
    assert (t.step, t.roll.rate_p, t.roll.rate_d) == done
    p.fly(3.0)
    land(p)
    assert gains(p) == before and "Saved" not in said(p)[-1]


def test_a_boot_in_a_twitch_gives_the_gains_back(core: Core) -> None:
    p, before = twitching(core)
    assert p.ask(246, 1, 0, 0, 0, 0, 20190226) == 0
    p.fly(1.0)
    assert not p.ap.arming.armed and gains(p) == before


def test_gains_that_a_client_sets_after_it_was_left_stay(core: Core) -> None:
    p, before = twitching(core)
    assert p.set_mode(LOITER) and gains(p) == before
    p.set_parameter("ATC_RAT_RLL_P", 0.11)
    changed = gains(p)
    assert p.set_mode(AUTOTUNE)
    p.fly(3.0)
    assert p.set_mode(LOITER) and gains(p) == changed, "entered again"
    p.set_parameter("ATC_RAT_RLL_P", 0.12)
    changed = gains(p)
    land(p)
    assert gains(p) == changed, "disarmed"


def test_disarmed_in_the_air_it_keeps_nothing(core: Core) -> None:
    p = hovering(core)
    before = gains(p)
    tune(p, 150.0)
    assert p.set_mode(LOITER) and p.set_mode(AUTOTUNE) and gains(p) != before
    assert p.ask(400, 0, 21196) == 0
    p.fly(0.2)
    assert not p.ap.arming.armed and gains(p) == before and "Saved" not in said(p)[-1]


def test_motors_that_stop_end_a_twitch(core: Core) -> None:
    p, before = twitching(core)
    assert p.ask(218, EMERGENCY_STOP, HIGH) == 0
    p.fly(0.1)
    assert gains(p) == before and not p.said("AutoTune: pilot overrides active")
    assert p.ask(218, EMERGENCY_STOP, LOW) == 0
    p.fly(0.3)
    assert gains(p) == before
    assert p.fly(20.0, lambda: gains(p) != before and p.ap.modes.autotune.twitching), "it goes on"


@pytest.mark.parametrize("stick", ["roll", "yaw", "throttle"])
def test_sticks_interrupt_it(core: Core, stick: str) -> None:
    p = hovering(core)
    before = gains(p)
    assert p.set_mode(AUTOTUNE)
    p.fly(5.0)
    begin, place, yaw, height = p.now, p.pos, p.euler[2], p.height
    p.sticks(3.0, **{stick: 1700})
    assert gains(p) == before
    warned = [time - begin for time, _, text in p.texts if time > begin and "overrides" in text]
    assert warned == pytest.approx([0.05, 1.05, 2.05], abs=0.06)
    moved = {"roll": np.hypot(*(p.pos - place)[:2]) > 2.0, "yaw": abs(p.euler[2] - yaw) > 30.0}
    assert {**moved, "throttle": p.height > height + 0.7}[stick]
    t: Any = p.ap.modes.autotune
    last = t.begun_us
    p.sticks(0.45)
    assert gains(p) == before and t.begun_us == last, "half a second's rest"
    there = p.pos
    p.sticks(6.0)
    assert t.begun_us > last + 4_000_000
    assert np.hypot(*(p.pos - there)[:2]) < 7.0, "it stays where the sticks have brought it"


def test_wind_carries_it_off_until_its_lean_holds_it_and_it_turns_along(core: Core) -> None:
    p = hovering(core, SIM_WIND_SPD=7.0, SIM_WIND_DIR=90)  # at 60 m; 4 m/s at 20 m
    east = p.pos[1]
    assert p.set_mode(AUTOTUNE)
    p.fly(40.0)
    assert east - p.pos[1] == pytest.approx(17.7, abs=1.0)
    assert abs(abs(p.euler[2]) - 90.0) < 6.0
    assert abs(p.euler[1]) == pytest.approx(8.9, abs=1.0)


def test_refusals(core: Core) -> None:
    failed = "Mode change to AUTOTUNE failed: init failed"
    p = Aviator(core, "ardupilot_quad", RC_OVERRIDE_TIME=-1).ready()
    assert not p.set_mode(AUTOTUNE) and p.said(failed)
    p.sticks(0.5, throttle=1000)
    p.arm()
    for mode in (GUIDED, ALT_HOLD, LOITER):
        assert p.set_mode(mode) and not p.set_mode(AUTOTUNE)
    assert p.set_mode(GUIDED)
    p.take_off(20.0)
    p.sticks(0.5)
    for mode in (GUIDED, CIRCLE):
        assert p.set_mode(mode) and not p.set_mode(AUTOTUNE)
    assert p.set_mode(LOITER)
    p.sticks(0.6, throttle=1000)
    assert not p.set_mode(AUTOTUNE)
    p.set_parameter("AUTOTUNE_AXES", 0)
    p.sticks(0.5)
    assert not p.set_mode(AUTOTUNE)
    p.set_parameter("AUTOTUNE_AXES", 2)
    for mode in (STABILIZE, ALT_HOLD, POSHOLD, LOITER):
        assert p.set_mode(mode) and p.set_mode(AUTOTUNE)
    assert p.said("AutoTune: Pitch Rate D Up 0%") and [t[2] for t in p.texts].count(failed) == 8
