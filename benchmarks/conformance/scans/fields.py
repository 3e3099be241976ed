# SPDX-License-Identifier: BSD-3-Clause
"""Messages, field by field: in streams and on request, on the ground, at rest in GUIDED, and on a leg of a mission.

"request SIM_STATE" has what a request gets, where it is not FAILED; "group 1" the messages of a stream group; and
"auto: ATTITUDE.roll" the median of a number and how far ours may be from it, or another value.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from contextlib import contextmanager
from fnmatch import fnmatchcase
from statistics import median
from typing import Any

from sitl.bridge.dialect import find_message, message

from .program import HEIGHT_M, RATES_HZ, Program, Programs

REQUEST, STREAMS = "REQUEST_MESSAGE", (1, 2, 3, 4, 6, 10, 11, 12)
RESULTS = ("ACCEPTED", "TEMPORARILY_REJECTED", "DENIED", "UNSUPPORTED", "FAILED")
NUMBERS = range(13_000)
NOT_ASKED = ("HEARTBEAT", "AVAILABLE_MODES", "STATUSTEXT", "COMMAND_ACK")
"""They come without being asked for, or say as much as the vehicle has of them."""
RATE_HZ, SECONDS = 5, 3.0
TIMES = re.compile(
    r"time.*|ts1|tc1|.*_(us|usec|utc)|count|uid.*|flight_custom_version|.*_sw_version|file_crc|.*_delay_us"
)
"""Fields that say when, or who: nothing to compare."""
TOLERANCES = {
    r"lat|lon|lng|lat_int|lon_int|latitude|longitude": 100.0,  # [degE7] a metre
    r"alt|altitude|alt_ellipsoid|relative_alt|target_altitude|current_height|press_abs|abs_pressure": 1.0,
    r"roll|pitch|yaw|q\d?|nav_roll|nav_pitch|omegaI.": 0.06,
    r"hdg": 400.0,  # [cdeg]
    r"heading|nav_bearing|target_bearing|target_heading": 4.0,
    r"rollspeed|pitchspeed|yawspeed|.gyro|body_.*_rate|angular_velocity_z|feed_forward.*": 0.05,
    r"x|y|z|wp_dist|alt_error|xtrack_error|alt_m": 0.7,  # [m]
    r"v[xyznedu]|climb|groundspeed|airspeed|vel|aspd_error|af.": 0.3,
    r".*variance|error_rp|error_yaw|vibration_.|fom": 0.05,
    r".acc": 0.4,
    r".mag": 12.0,
    r"servo\d+_raw|chan\d+_raw": 15.0,
    r"throttle|thrust|battery|battery_remaining|load": 3.0,
    r"current_consumed|energy_consumed|totalcurrent": 60.0,
    r"chan\d+_scaled": 60.0,
    r"rpm|current|current_battery|voltage.*": 0.0,
}
"""How far a number may be from the real one's, besides 3 % of it."""
EXACT = re.compile(
    r"onboard_.*|.*flags|.*mask.*|.*mode.*|fields_updated|capabilities|.*state|type|autopilot|seq|total|fix_type|.*status|"
    r"satellites.*|eph|epv|.*_acc|custom\d|.*_type|.*_function|id|chancount|rssi|present|on|errors_.*|spacing|pending|loaded"
)
"""Fields of bits and kinds: equal, or not."""
OF_MESSAGES = {
    "GLOBAL_POSITION_INT": {r"relative_alt|alt": 700.0, r"v.": 20.0},
    "GPS_RAW_INT": {r"vel": 15.0, r"cog": math.inf, r"alt.*": 700.0},
    "RAW_IMU": {r".acc|.gyro": 40.0},
    "SCALED_IMU": {r".acc|.gyro": 40.0},
    "SCALED_IMU2": {r".acc|.gyro": 40.0},
    "HIGH_LATENCY2": {r".*speed.*": 2.0},
    "LOCAL_POSITION_NED": {r"z": 1.0},
    "ATTITUDE_TARGET": {r"thrust": 0.05, r"body.*": 0.2},
    "HOME_POSITION": {r"altitude": 700.0},
    "GPS_GLOBAL_ORIGIN": {r"altitude": 700.0},
    "NAV_CONTROLLER_OUTPUT": {r"nav_roll|nav_pitch": 3.0, r".*bearing": 4.0},
    "TERRAIN_REQUEST": {r".*": math.inf},
    "SERVO_OUTPUT_RAW": {r".*": 40.0},
}
"""Tolerances of some messages, before the others."""
AT_REST = re.compile(r"guided: (NAV_CONTROLLER_OUTPUT.target_bearing|HIGH_LATENCY2.target_heading)")
"""Directions to where it is already."""
PLACES = re.compile(r"lat|lon|lng|lat_int|lon_int|latitude|longitude|x|y|wp_dist|target_distance|.mag|press.*|rpm")
"""Fields that change all the time on a leg."""
LEG_M = 2000.0


def scan(programs: Programs) -> dict[str, Any]:
    """All rows."""
    rows: dict[str, Any] = {}
    with programs.started({"FS_OPTIONS": 0.0, "FS_GCS_ENABLE": 0.0}) as program:
        program.be_ready()
        asked = _requests(program)
        rows |= {f"request {name}": result for name, result in asked.items() if result != "FAILED"}
        sent = [name for name, result in asked.items() if result == "ACCEPTED, sent"]
        rows |= _state(program, "ground", sent)
        program.be_flying()
        program.goto(20.0, 10.0, **({"altitude": HEIGHT_M} if program.of == "copter" else {}))
        program.delay(15.0)
        for group in STREAMS:
            rows[f"group {group}"] = _group(program, group)
        rows |= _state(program, "guided", sent)
        altitude = 15.0 if program.of == "copter" else 0.0
        program.upload([program.item("NAV_WAYPOINT"), program.item("NAV_WAYPOINT", LEG_M, 300.0, altitude)])
        program.set_mode("AUTO")
        program.delay(20.0)
        found = _state(program, "auto", sent)
        rows |= {name: x for name, x in found.items() if not PLACES.fullmatch(name.rpartition(".")[2])}
    wanted = (name for name in rows if fnmatchcase(name, programs.rows) and not AT_REST.fullmatch(name))
    return {name: rows[name] for name in wanted}


def agrees(ours: Any, theirs: Any) -> bool:
    """Whether a value is within the tolerance of another one."""
    if isinstance(ours, dict) and isinstance(theirs, dict) and "of" in ours and "of" in theirs:
        return len(ours["of"]) == len(theirs["of"]) and all(map(_is_near, ours["of"], theirs["of"]))
    numbers = [x for pair in (ours, theirs) if isinstance(pair, list) for x in pair if isinstance(x, int | float)]
    if len(numbers) == 4:
        return bool(abs(ours[0] - theirs[0]) <= theirs[1])
    return bool(ours == theirs)


def _is_near(a: Any, b: Any) -> bool:
    """Of numbers of an array."""
    numbers = isinstance(a, int | float) and isinstance(b, int | float)
    return abs(a - b) <= max(0.06, 0.03 * abs(b)) if numbers else bool(a == b)


def _requests(program: Program) -> dict[str, str]:
    """What a request of each message gets."""
    found: dict[str, str] = {}
    for number in NUMBERS:
        kind = find_message(number)
        if kind is not None and kind.name not in NOT_ASKED:
            found[kind.name] = _request(program, number, kind.name)
    return found


def _request(program: Program, number: int, name: str) -> str:
    with program.messages(name) as seen, program.messages("COMMAND_ACK") as answers:
        program.send_command(REQUEST, number)
        program.passes(lambda: answers, 2.0)
        program.delay(0.05)
    word = RESULTS[answers[0].result] if answers and answers[0].result < len(RESULTS) else "no answer"
    return f"{word}, sent" if seen and word == "ACCEPTED" else word


@contextmanager
def _all(program: Program) -> Iterator[list[tuple[str, Any]]]:
    """Everything that is sent while the block lasts."""
    seen: list[tuple[str, Any]] = []
    take = program._take

    def taken(name: str, fields: Any) -> None:
        seen.append((name, fields))
        take(name, fields)

    program._take = taken  # type: ignore[method-assign]
    try:
        yield seen
    finally:
        del program._take


def _stream(program: Program, group: int, rate: int) -> None:
    program.send("REQUEST_DATA_STREAM", req_stream_id=group, req_message_rate=rate, start_stop=rate > 0)
    names = RATES_HZ if group == 0 and rate == 0 else ("SYSTEM_TIME",)  # what the client goes by
    for name in names:
        program.send_command("SET_MESSAGE_INTERVAL", message(name).id, 1e6 / RATES_HZ[name])


def _group(program: Program, group: int) -> list[str]:
    """Names of what comes with a group."""
    with _all(program) as seen:
        program.delay(2.0)
    always = {name for name, _ in seen}
    _stream(program, group, RATE_HZ)
    with _all(program) as seen:
        program.delay(2.0)
    _stream(program, 0, 0)
    program.delay(1.0)
    return sorted({name for name, _ in seen} - always - {"TIMESYNC"})


def _state(program: Program, state: str, asked: list[str]) -> dict[str, Any]:
    """Rows of every field of every message, now."""
    _stream(program, 0, RATE_HZ)
    program.delay(1.0)
    with _all(program) as seen:
        program.delay(SECONDS)
    _stream(program, 0, 0)
    told: dict[str, list[Any]] = {}
    for name, fields in seen:
        if name in asked:
            told.setdefault(name, []).append(fields)
    for name in asked:
        if name not in told:
            with program.messages(name) as answers:
                for _ in range(3):
                    program.send_command(REQUEST, message(name).id)
                    program.delay(0.3)
                told[name] = answers
    rows: dict[str, Any] = {}
    for name in sorted(told):
        for field in told[name][0]._fields if told[name] else ():
            if not TIMES.fullmatch(field):
                rows[f"{state}: {name}.{field}"] = value([getattr(fields, field) for fields in told[name]], name, field)
    return rows


def value(samples: list[Any], name: str, field: str) -> Any:
    """What a row has of a field's values."""
    if all(isinstance(x, int | float) for x in samples):
        degrees = {"hdg": 18000.0, "heading": 180.0, "target_bearing": 180.0, "nav_bearing": 180.0}.get(field)
        if degrees is not None:
            samples = [x - 2.0 * degrees if x > degrees else x for x in samples]
        x = median(samples)
        if not math.isfinite(x):
            return str(x)
        spread = max(samples) - min(samples)
        if EXACT.fullmatch(field):
            return int(x) if x == int(x) else x
        return [_short(x), _short(max(_tolerance(name, field), 0.03 * abs(x), spread))]
    last = samples[-1]
    if isinstance(last, bytes):
        return last.decode("ascii", "replace")
    if isinstance(last, tuple | list):
        return {"of": [_short(x) if math.isfinite(x) else str(x) for x in last]}
    return last


def _tolerance(name: str, field: str) -> float:
    for pattern, tolerance in {**OF_MESSAGES.get(name, {}), **TOLERANCES}.items():
        if re.fullmatch(pattern, field):
            return min(tolerance, 1e9)
    return 0.0


def _short(x: float) -> float | int:
    return int(x) if x == int(x) and abs(x) < 1e12 else float(f"{x:.5g}") if abs(x) < 1e5 else round(x)
