# SPDX-License-Identifier: BSD-3-Clause
"""What ``sitl twin`` says of two flights, and its exit code, without flying any."""

from __future__ import annotations

import argparse
import json
import math
import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sitl import vehicles
from sitl.errors import OptionError
from sitl.missions.twin import cli, report
from sitl.missions.twin import twin as twins
from sitl.missions.twin.agreement import Agreement
from sitl.missions.twin.inputs import Inputs, Mode, Wind
from sitl.missions.twin.judge import NOT_JUDGED, findings
from sitl.missions.twin.limits import Verdict, judge, parse
from sitl.missions.twin.log_flight import Change
from sitl.missions.twin.streams import COPTER, ROVER, THRUST, Quantity
from sitl.missions.twin.twin import Twin, _Twins, with_mass

QUANTITIES = {one.name: one for one in (*ROVER, *COPTER, THRUST)}


@pytest.fixture(autouse=True)
def no_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    """They have tests of their own."""
    monkeypatch.setattr(report, "_pictures", lambda twin: ())


def agreement(name: str, rms: float = 0.25, worst: float = 2.0, vaf: float = 97.34, bias: float = 0.0,
              logged: Any = (1.0, 2.0, 3.0), flown: Any = (1.0, -4.0, 2.0), at: float = 7.25) -> Agreement:  # fmt: skip
    time = np.arange(float(len(logged)))
    columns = (np.reshape(np.array(values, float), (len(time), -1)) for values in (logged, flown))
    return Agreement(QUANTITIES[name], time, *columns, 1.0, rms, bias, worst, at, vaf)


def made(kind: str = "copter", *, firmware: str = "ArduCopter V4.5.7", **parts: Any) -> Twin:
    log: Any = SimpleNamespace(
        name="small.bin", path=Path("logs/small.bin"), kind=kind, number=2, flights=[0, 1, 2],
        span=SimpleNamespace(length=61.26), columns=SimpleNamespace(firmware=firmware),
    )  # fmt: skip
    flown: Any = SimpleNamespace(stands="")
    return Twin(log, "erle_copter", flown, **{"changed": None, "change": Change(), "notes": [], "went": [],
                                              "went_changed": [], **parts})  # fmt: skip


# ---------------------------------------------------------------- the verdict


@pytest.mark.parametrize(
    ("kind", "said", "verdict"),
    [
        ("copter", [], "The twin flies as the log's vehicle did, as far as these metrics tell"),
        ("rover", [], "The twin drives as the log's vehicle did, as far as these metrics tell"),
        ("copter", ["model: x"], "The twin flies otherwise than the log's vehicle did: 1 difference"),
        ("rover", ["model: x", "y"], "The twin drives otherwise than the log's vehicle did: 2 differences"),
        ("copter", [f"{NOT_JUDGED}: x"], "The twin flies as the log's vehicle did, as far as these metrics tell"),
    ],
)
def test_differences_are_counted_but_not_what_could_not_be_judged(
    kind: str, said: list[str], verdict: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(twins, "findings", lambda *parts: said)
    assert report.verdict_of(made(kind)) == verdict


def test_a_twin_that_stood_is_judged_by_its_open_segments_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    parts: list[Any] = []
    monkeypatch.setattr(twins, "findings", lambda *given: parts.append(given) or ["more"])
    one, two, three, four = (agreement(name) for name in ("height", "speed", "roll", "pitch"))
    found = made(whole=[one], segments=[two], model=[three], legs=[four])
    assert found.findings == ["more"] and parts == [([one], [two], [three], [four])]
    parts.clear()
    found.flown.stands = "never left the ground"
    stands, *others = found.findings
    assert stands.startswith("the twin never left the ground") and others == ["more"]
    assert parts == [((), [two], [three])]


def test_all_metrics_have_the_name_of_their_part() -> None:
    found = made(
        whole=[agreement("height", 0.1, 0.2, 90.0, -0.3)], legs=[agreement("height", 1.0)],
        segments=[agreement("roll", 2.0)], model=[agreement("thrust", 3.0)], difference=[agreement("speed", 4.0)],
    ).metrics()  # fmt: skip
    assert (found["height.rms"], found["height.max"], found["height.bias"], found["height.vaf"]) == (
        0.1, 0.2, -0.3, 90.0,
    )  # fmt: skip
    assert [found[f"{name}.rms"] for name in ("legs.height", "segments.roll", "model.thrust", "changed.speed")] == [
        1.0, 2.0, 3.0, 4.0,
    ]  # fmt: skip
    assert len(found) == 20


def test_what_is_written_as_json() -> None:
    found = made(whole=[agreement("height")], notes=["n"], went=["w"], went_changed=["c"]).to_json()
    assert {name: found[name] for name in found if name != "metrics"} == {
        "log": "logs/small.bin", "firmware": "ArduCopter V4.5.7", "flight": 2, "frame": "erle_copter",
        "seconds": 61.26, "aligned": "arming", "changed": [], "notes": ["n"], "twin": ["w"], "changed_twin": ["c"],
        "findings": [],
    }  # fmt: skip
    assert set(found["metrics"]) == {"height.rms", "height.max", "height.bias", "height.vaf"}


# ---------------------------------------------------------------- lines for a terminal


def test_lines_begin_with_the_verdict_and_hold_a_row_for_each_quantity() -> None:
    found = made(
        whole=[agreement("height", 0.1234, vaf=100.0), agreement("speed", 12.345, vaf=-3.0),
               agreement("roll", 0.5, vaf=math.nan), agreement("position", 1.0, vaf=99.949)],
        legs=[agreement("height", 0.05, vaf=99.96)], notes=["a note"], went=["it was late"],
    )  # fmt: skip
    lines = report.lines(found, [Verdict("height.rms", 0.5, 1.0), Verdict("roll.vaf", 50.0, 80.0)])
    assert lines[0] == "small.bin: ArduCopter V4.5.7, flight of 61.3 s; twin on frame erle_copter"
    assert lines[1] == (
        "  The twin flies as the log's vehicle did, as far as these metrics tell. They differ (RMS) in height by "
        "0.12 m, position by 1 m, speed by 12 m/s over the whole flight; height by 0.05 m in step by mission items."
    )
    assert lines[2:4] == ["  note: a note", "  twin: it was late"]
    assert lines[4].split("  ")[-1] == "in step by items" and "whole flight" in lines[4]
    assert lines[5].split() == ["RMS", "VAF", "[%]"] * 2
    rows = [line.rsplit("]", 1)[1].split() for line in lines[6:10]]
    assert rows == [["0.123", "100", "0.05", "100"], ["12.3", "below", "0"], ["0.5", "-"], ["1", "99.9"]]
    assert len({line.index("[") for line in lines[6:10]}) == 1, "units stand in a column"
    assert {len(line) for line in lines[4:7]} == {len(lines[4])} and lines[6].startswith("height above the position")
    assert lines[10:] == ["ok: height.rms is 0.5, at most 1 is asked for",
                          "LIMIT: roll.vaf is 50, at least 80 is asked for"]  # fmt: skip


@pytest.mark.parametrize(("vaf", "text"), [(99.94, "99.9"), (99.96, "100"), (0.0, "0.0"), (-0.01, "below 0")])
def test_a_variance_accounted_for_is_between_0_and_100(vaf: float, text: str) -> None:
    (line,) = (line for line in report.lines(made(whole=[agreement("roll", vaf=vaf)]), []) if line.startswith("roll"))
    assert line.endswith(text.rjust(10))


def test_of_a_log_without_a_version_the_kind_is_told() -> None:
    assert report.lines(made("rover", firmware=""), [])[0].startswith("small.bin: rover, flight of")
    assert report.lines(made(), [])[1] == "  The twin flies as the log's vehicle did, as far as these metrics tell."


def test_what_a_change_does_is_told_with_before_and_after() -> None:
    pairs = {"height": ((1.0, 5.0, 2.0), (1.0, 7.0, 2.0)), "roll": ((1.0, -5.0, 2.0), (1.0, 3.0, -2.0)),
             "pitch": ((0.0, 0.0, 1.0), (0.0, 0.0, -9.0)), "voltage": ((12.0, 11.0, 11.5), (12.0, 9.0, 11.5)),
             "throttle": ((10.0, 20.0, 30.0), (20.0, 30.0, 40.0)), "consumed": ((0.0, 5.0, 9.0), (0.0, 6.0, 12.0)),
             "speed": ((0.0, 3.0, 1.0), (0.0, 2.0, 1.0)), "current": ((1.0, 2.0, 3.0), (2.0, 2.0, 2.0))}  # fmt: skip
    found = made(
        difference=[agreement(name, logged=then, flown=now) for name, (then, now) in pairs.items()],
        changed=SimpleNamespace(), change=Change({"RTL_ALT": 900.0}), went_changed=["it was high"],
    )  # fmt: skip
    effects = {what: (unit, before, after) for what, unit, before, after in report.effects(found)}
    assert effects == {
        "greatest height": ("m", 5.0, 7.0), "greatest speed": ("m/s", 3.0, 2.0), "largest roll": ("deg", 5.0, 3.0),
        "largest pitch": ("deg", 1.0, 9.0), "mean throttle output": ("%", 20.0, 30.0),
        "mean battery current": ("A", 2.0, 2.0), "lowest battery voltage": ("V", 11.0, 9.0),
        "charge drawn": ("mAh", 9.0, 12.0),
    }  # fmt: skip
    lines = report.lines(found, [])
    where = lines.index("changed: RTL_ALT = 900")
    assert lines[where + 1] == "  changed twin: it was high"
    assert re.fullmatch(r"  greatest height +\[m\] +5 -> 7", lines[where + 2])
    page = report.html(found, [])
    assert "<b>Changed:</b> RTL_ALT = 900</p></header>" in page and "<li>it was high</li>" in page
    assert "<tr><td>greatest height</td><td>m</td><td class=n>5</td><td class=n>7</td></tr>" in page


# ---------------------------------------------------------------- the page


def page(found: Twin, *verdicts: Verdict) -> str:
    return report.html(found, verdicts)


def test_the_head_of_the_page_says_what_was_flown_and_is_bad_when_a_limit_is_not_kept(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    good, bad = Verdict("height.rms", 0.5, 1.0), Verdict("roll.rms", 2.0, 1.0)
    text = page(made(), good)
    assert '<header class="">' in text and "<p>1 of 1 limits are kept</p>" in text
    assert "flight 2 of 3, 61.3 s from arming" in text and "twin on airframe <b>erle_copter</b>" in text
    assert "Limits that are not kept" not in text and "limits are kept" not in page(made())
    text = page(made(), good, bad)
    assert '<header class="bad">' in text and "<p>1 of 2 limits are kept</p>" in text
    assert "<li>roll.rms is 2, at most 1 is asked for</li>" in text
    monkeypatch.setattr(twins, "findings", lambda *parts: ["model: a < b"])
    assert '<header class="unsure">' in page(made(), good) and "<li>model: a &lt; b</li>" in page(made())
    assert '<header class="bad">' in page(made(), bad)


def test_a_column_of_three_for_each_part_that_was_flown() -> None:
    parts = {"whole": [agreement("height", 0.1, 0.3, 90.0), agreement("roll", 1.0, 2.0, -5.0)],
             "legs": [agreement("height", 0.2, 0.4, 91.0)], "segments": [agreement("roll", 0.3, 0.6, 92.0)],
             "model": [agreement("roll", 0.4, 0.8, 93.0)]}  # fmt: skip
    assert page(made(whole=parts["whole"])).count("colspan=3") == 1
    text = page(made(**parts))
    assert re.findall('colspan=3 title="([^"]*)"', text) == [
        "Whole flight", "In step by mission items", "Open segments of 2 s",
        "Model alone, 0.5 s, by the log&#x27;s motor outputs",
    ]  # fmt: skip
    rows = {row.split("</td>")[0]: row for row in text.split("<tr><td>")}
    cell = '<td class=n>{}</td><td class=n title="7.2 s after arming">{}</td><td class=n>{}</td>'.format
    nothing = "<td></td>" * 3
    assert rows["height above the position of arming"].split("<td>m</td>")[1] == (
        cell("0.1", "0.3", "90.0") + cell("0.2", "0.4", "91.0") + 2 * nothing + "</tr>"
    )
    assert cell("1", "2", "below 0") + nothing + cell("0.3", "0.6", "92.0") + cell("0.4", "0.8", "93.0") in rows["roll"]


def test_lists_of_nothing_are_left_out() -> None:
    text = page(made())
    assert "What the twin did otherwise" not in text and "What the change does" not in text
    assert "Nowhere, as far as these metrics tell." in text
    text = page(made(went=["w & w"], notes=["n"]))
    assert "<h2>What the twin did otherwise</h2><section><ul><li>w &amp; w</li></ul></section>" in text
    assert "<li>n</li>" in text


def test_a_page_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    with pytest.raises(OptionError, match=r"report '.*nowhere/page\.html'"):
        report.write(made(), [], tmp_path / "nowhere" / "page.html")


# ---------------------------------------------------------------- notes


def notes(kind: str = "copter", *, inputs: Inputs | None = None, wind: Any = None, values: Any = None,
          flights: int = 1, whole: bool = True, skipped: int = 0, truncated: bool = False, rotors: int = 4,
          motors: Any = (), monkeypatch: pytest.MonkeyPatch | None = None) -> list[str]:  # fmt: skip
    if monkeypatch is not None:
        monkeypatch.setattr(twins, "motor_channels", lambda columns: motors)
    given: Any = SimpleNamespace(
        log=SimpleNamespace(
            kind=kind, number=1, flights=[0] * flights, span=SimpleNamespace(is_whole=whole, length=12.6),
            columns=SimpleNamespace(skipped=skipped, truncated=truncated),
        ),
        taken=SimpleNamespace(notes=lambda: ["a parameter"], values=values or {}),
        kind=twins.KINDS[kind], inputs=inputs or Inputs(), wind=wind,
        airframe=SimpleNamespace(name="erle_copter", rotors=[0] * rotors),
    )  # fmt: skip
    given._wind_note = lambda: _Twins._wind_note(given)
    return _Twins._notes(given)


CALM = "the log has no estimate of the wind: the twin flies in calm air (--logged-wind)"
LAST = "both flights are aligned by the moment of arming"


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({}, CALM),
        ({"wind": (8.0, 270.0)}, "wind of the log's flight: 8 m/s from 270 deg, as given"),
        ({"inputs": Inputs(wind=[Wind(0.0, 3.0, 10.0), Wind(1.0, 4.26, 20.0), Wind(2.0, 2.0, 0.0)])},
         "wind as the log's estimator knew it, up to 4.3 m/s"),
        ({"values": {"SIM_WIND_SPD": 3.0}}, "wind as the log's SIM_WIND_ parameters say"),
        ({"values": {"SIM_WIND_SPD": 0.0, "SIM_WIND_DIR": 90.0}}, CALM),
    ],
)  # fmt: skip
def test_where_the_wind_is_from(given: Any, said: str, monkeypatch: pytest.MonkeyPatch) -> None:
    found = notes(**given, monkeypatch=monkeypatch)
    assert found == ["a parameter", said, LAST]
    assert notes("rover", **given, monkeypatch=monkeypatch) == ["a parameter", LAST], "no wind moves it"


def test_a_log_that_ends_early_or_is_damaged_or_has_more_flights_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    found = notes(flights=3, whole=False, skipped=17, truncated=True, monkeypatch=monkeypatch)
    assert found == [
        "a parameter",
        "flight 1 of 3 in the log (--flight)",
        "the log ends 13 s after arming, while armed: it is compared up to there",
        "the log is damaged: 17 bytes of it are no messages",
        "the log is cut off within a message",
        CALM,
        LAST,
    ]


@pytest.mark.parametrize(("motors", "told"), [((1, 2, 3, 4), False), ((1, 2, 3, 4, 5, 6), True), ((), False)])
def test_another_number_of_motors_is_told_first(motors: Any, told: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    found = notes(motors=motors, monkeypatch=monkeypatch)
    said = "the log is of a vehicle with 6 motors, frame erle_copter has 4"
    assert (found[0] == said) == told and (said in found) == told


def test_modes_that_this_autopilot_lacks_are_named_once_and_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    lacking = Inputs(modes=[Mode(0.0, 5, True), Mode(1.0, 99, True), Mode(2.0, 5, True), Mode(3.0, 99, False)])
    first = notes(inputs=lacking, monkeypatch=monkeypatch)[0]
    assert re.fullmatch(r"modes of the log not in this autopilot: .*99.* \(2 changes\)", first)


# ---------------------------------------------------------------- mass, limits, options


@pytest.mark.parametrize(("text", "by"), [("+0.5", 0.5), ("-0.2", -0.2), (" +0.25", 0.25)])
def test_a_payload_is_added(text: str, by: float) -> None:
    airframe = vehicles.load("erle_copter")
    assert with_mass(airframe, text).value("mass") == pytest.approx(float(airframe.value("mass")) + by)
    assert with_mass(airframe, "2.1").value("mass") == 2.1


@pytest.mark.parametrize("text", ["heavy", "0", "0.001", "-99", "nan", "inf", ""])
def test_what_is_no_mass_is_named_with_what_would_be(text: str) -> None:
    with pytest.raises(OptionError, match=f"mass '{re.escape(text)}': a mass .kg. is needed, or what is added to the"):
        with_mass(vehicles.load("erle_copter"), text)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("height=0.5", ("height.rms", 0.5)),
        (" height =0.5", ("height.rms", 0.5)),
        ("roll.vaf=80", ("roll.vaf", 80.0)),
        ("segments.roll_rate.vaf=80", ("segments.roll_rate.vaf", 80.0)),
        ("segments.roll_rate=3", ("segments.roll_rate.rms", 3.0)),
    ],
)
def test_a_quantity_alone_means_its_root_mean_square(text: str, found: tuple[str, float]) -> None:
    assert parse(text) == found
    name, limit = found
    assert judge({name: limit}, {text.partition("=")[0].strip(): limit}) == [Verdict(name, limit, limit)]


@pytest.mark.parametrize("text", ["height=", "=1", "height=nan", "height=inf", "height", ""])
def test_what_is_no_limit_is_named(text: str) -> None:
    with pytest.raises(OptionError, match=f"limit '{text}' is not NAME=VALUE, as in height.rms=0.5"):
        parse(text)


@pytest.mark.parametrize(
    ("name", "value", "ok"),
    [
        ("x.rms", 1.0, True), ("x.rms", 1.01, False), ("x.bias", -1.0, True), ("x.bias", -1.01, False),
        ("x.vaf", 1.0, True), ("x.vaf", 0.99, False), ("x.vaf", 100.0, True), ("x.max", math.inf, False),
        ("x.vaf", math.nan, False),
    ],
)  # fmt: skip
def test_a_limit_itself_is_kept(name: str, value: float, ok: bool) -> None:
    assert Verdict(name, value, 1.0).ok == ok


@pytest.mark.parametrize(
    ("text", "found"),
    [("8@270", (8.0, 270.0)), ("8", (8.0, 180.0)), ("0@0", (0.0, 0.0)), ("50@360", (50.0, 360.0))],
)
def test_wind_has_a_speed_and_where_it_comes_from(text: str, found: tuple[float, float]) -> None:
    assert cli.wind(text) == found


@pytest.mark.parametrize("text", ["-1", "50.1", "8@361", "8@-1", "fast", "8@west", "nan", "8@nan", ""])
def test_wind_beyond_what_blows_is_named(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match=r"is not SPEED\[@FROM\]: 0 to 50 m/s, 0 to 360 degrees"):
        cli.wind(text)


def run(monkeypatch: pytest.MonkeyPatch, found: Twin, *words: str) -> tuple[int, dict[str, Any]]:
    """Exit code of the command, and what it asked for."""
    asked: dict[str, Any] = {}
    monkeypatch.setattr(twins, "fly", lambda log, frame, **given: asked.update(log=log, frame=frame, **given) or found)
    parser = argparse.ArgumentParser()
    cli.add_parser(parser.add_subparsers())
    options = parser.parse_args(["twin", "a.bin", "--frame", "erle_copter", *words])
    return options.function(options), asked


def test_what_is_given_is_flown(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    code, asked = run(monkeypatch, made())
    del asked["progress"]
    assert code == 0 and asked == {
        "log": Path("a.bin"), "frame": "erle_copter", "flight": None, "seed": 0, "physics": "native",
        "change": Change(), "wind": None, "segments": True, "keep": None,
    }  # fmt: skip
    words = ["--flight", "2", "--seed", "3", "--logged-wind", "2@90", "--no-segments", "--set", "rtl_alt = 900",
             "--wind", "5", "--mass", "+1", "--log-dir", str(tmp_path / "kept")]  # fmt: skip
    _, asked = run(monkeypatch, made(), *words)
    assert (asked["flight"], asked["seed"], asked["wind"], asked["segments"]) == (2, 3, (2.0, 90.0), False)
    assert asked["change"] == Change({"RTL_ALT": 900.0}, (5.0, 180.0), (), "+1")
    assert asked["keep"] == tmp_path / "kept" and asked["keep"].is_dir()


@pytest.mark.parametrize(("limit", "code"), [("0.25", 0), ("0.24", 1)])
def test_the_exit_code_is_1_when_a_limit_is_not_kept(
    limit: str, code: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = made(whole=[agreement("height", 0.25)])
    file = tmp_path / "page.HTM"
    assert run(monkeypatch, found, "--limit", f"height={limit}", "--report", str(file))[0] == code
    out = capsys.readouterr().out
    assert ("LIMIT: " if code else "ok: ") + f"height.rms is 0.25, at most {limit} is asked for" in out
    assert out.endswith(f"report: {file}\n") and file.read_text().startswith("<!doctype html>")
    assert run(monkeypatch, found, "--limit", f"height={limit}", "--json")[0] == code
    told = json.loads(capsys.readouterr().out)
    assert told["ok"] == (code == 0) and len(told["beyond_limits"]) == code


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (("--set", "RTL_ALT"), "--set 'RTL_ALT' is not NAME=VALUE, as in ATC_RAT_RLL_P=0.2"),
        (("--set", "RTL_ALT=high"), "--set 'RTL_ALT=high' is not NAME=VALUE"),
        (("--report", "page.pdf"), "--report 'page.pdf' does not end in .html"),
        (("--limit", "nothing=1"), "limit 'nothing.rms' is of no metric of this flight"),
    ],
)
def test_what_is_not_taken_is_named(words: tuple[str, ...], error: str, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(OptionError, match=re.escape(error)):
        run(monkeypatch, made(whole=[agreement("height")]), *words)


# ---------------------------------------------------------------- findings


def bad(name: str, vaf: float = 40.0, rms: float = 50.0, **given: Any) -> Agreement:
    return agreement(name, rms, vaf=vaf, **given)


@pytest.mark.parametrize(("logged", "flown", "said"), [(50.0, 52.4, ""), (50.0, 52.6, "less"), (50.0, 47.4, "more"),
                                                        (0.9, 40.0, "")])  # fmt: skip
def test_mean_throttle_tells_of_thrust_over_weight(logged: float, flown: float, said: str) -> None:
    throttle = agreement("throttle", logged=[logged] * 3, flown=[flown] * 3)
    found = findings([throttle, agreement("motors")], [agreement("roll")], [])
    told = f"model: mean throttle output of the log is {logged:.1f} %, of the twin {flown:.1f} %: the thrust over "
    assert found == ([f"{told}weight of the airframe is {said} than the vehicle's"] if said else [])
    assert findings([throttle], [agreement("roll")], []) == [], "a rover's throttle is none of motors"


@pytest.mark.parametrize(("bias", "said"), [(0.3, ""), (0.31, "0.31 m/s^2 more up"), (-0.31, "0.31 m/s^2 more down")])
def test_thrust_of_the_model_alone(bias: float, said: str) -> None:
    for name in ("thrust", "acceleration"):
        found = findings([], [agreement("roll")], [agreement(name, bias=bias)])
        told = f"model: at the log's motor outputs the model accelerates {said} than the vehicle did"
        assert found == ([told] if said else [])
    both = [agreement("acceleration", bias=9.0), agreement("thrust", bias=0.0)]
    assert findings([], [agreement("roll")], both) == [], "thrust does not fall when the model leans"


@pytest.mark.parametrize(
    ("alone", "closed", "begins"),
    [
        (40.0, 40.0, "model: roll rate at the log's motor outputs accounts for 40 % of its variance"),
        (40.0, None, "model: roll rate at the log's motor outputs accounts for 40 % of its variance"),
        (-40.0, None, "model: roll rate at the log's motor outputs accounts for 0 % of its variance"),
        (40.0, 90.0, ""),
        (90.0, 40.0, "roll rate in open segments accounts for 40 % of its variance: model or rate controller differ"),
        (None, -7.0, "roll rate in open segments accounts for 0 % of its variance: model or rate controller differ"),
        (80.0, 80.0, ""),
        (math.nan, math.nan, ""),
    ],
)
def test_rates_of_the_model_alone_and_of_open_segments(alone: float | None, closed: float | None, begins: str) -> None:
    segments = [agreement("pitch")] + ([bad("roll_rate", closed)] if closed is not None else [])
    found = findings([], segments, [bad("roll_rate", alone)] if alone is not None else [])
    assert [text.startswith(begins) for text in found] == ([True] if begins else [])


def test_what_moves_less_than_noise_is_not_bad() -> None:
    quantity: Quantity = QUANTITIES["roll_rate"]
    for rms, count in ((quantity.moves, 0), (1.01 * quantity.moves, 1)):
        assert len(findings([], [bad("roll_rate", rms=rms)], [])) == count


@pytest.mark.parametrize(("volts", "rms", "told"), [(12.0, 0.24, False), (12.0, 0.25, True), (0.9, 5.0, False)])
def test_voltages_may_differ_by_two_per_cent(volts: float, rms: float, told: bool) -> None:
    voltage = replace(agreement("voltage", rms, logged=[volts] * 3), vaf=math.nan)
    said = [f"model: battery voltage differs by {rms:.2f} V (RMS): resistance or capacity differ"]
    assert findings([voltage], [agreement("roll")], []) == (said if told else [])
