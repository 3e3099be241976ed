# SPDX-License-Identifier: BSD-3-Clause
"""Messages that every firmware writes, with ArduPilot's names, types and units (4.7).

https://ardupilot.org/copter/docs/logmessages.html
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from . import bits, board, derived
from .derived import DEG
from .formats import Field, Message, Source

E, S, A, K = "autopilot.estimate.", "sensors.", "autopilot.", "autopilot.ekf."
_ATTITUDE = bits.ATTITUDE | bits.ATTITUDE_FAST
PARAMETERS = A + "params."
NO_AIRSPEED, NO_DRAG = 1 << 4, 1 << 5
"""Timeouts of XKF4: neither is ever fused."""


def _pulses(path: str) -> tuple[Field, ...]:
    return tuple(Field(f"C{k + 1}", "H", "Y", "-", f"{path}[{k}]") for k in range(14))


def pulses_in(bit: int) -> Message:
    """RCIN: pulses of the receiver or of overrides [us]."""
    return Message("RCIN", bits.MEDIUM, bit).of(*_pulses(A + "rc.channels"))


def pulses_out(bit: int) -> Message:
    """RCOU: pulses to motors and servos [us]."""
    return Message("RCOU", bits.MEDIUM, bit).of(*_pulses("actuators.pwm"))


def magnetometer(bit: int) -> Message:
    """MAG: field in the body's frame [mgauss]."""
    offsets = [Field(f"Ofs{axis}", "h", "G", "C", f"{PARAMETERS}COMPASS.OFS.{axis}") for axis in "XYZ"]
    offsets += [Field(f"MO{axis}", "h", "G", "C") for axis in "XYZ"]
    return Message("MAG", bits.MEDIUM, bit, when=S + "mag_count").of(
        Field("I", "B", "#"),
        *(Field(f"Mag{axis}", "h", "G", "C", f"{S}mag[{k}]", 1000.0) for k, axis in enumerate("XYZ")),
        *offsets,
        Field("Health", "B", source=derived.is_seen(S + "mag_count")),
        Field("S", "I", "s", "F", S + "time_us"),
    )


def pid(name: str, loop: str, gains: str, measured: str, bit: int, scale: float = 1.0) -> Message:
    """Target, measurement, error and output parts of a PID, in the unit that ``scale`` makes."""
    parts = (
        Field("Tar", "f", source=loop + ".target", scale=scale),
        Field("Act", "f", source=measured, scale=scale),
        Field("Err", "f", source=loop + ".error", scale=scale),
        Field("P", "f", source=derived.proportional(loop, gains + "P")),
        Field("I", "f", source=loop + ".integrator"),
        Field("D", "f", source=derived.derivative(loop, gains + "D")),
        Field("FF", "f", source=derived.ahead(loop, gains + "FF")),
        Field("DFF", "f"),
        Field("Dmod", "f", source=1.0),
        Field("SRate", "f"),
        Field("Flags", "B"),
    )
    return Message(name, bits.MEDIUM, bit).of(*parts)


COMMAND = (
    *(Field(label, "H") for label in ("CTot", "CNum", "CId")),
    *(Field(f"Prm{k}", "f") for k in range(1, 5)),
    Field("Lat", "L", "D", "G"),
    Field("Lng", "L", "U", "G"),
    Field("Alt", "f", "m", "0"),
    Field("Frame", "B"),
)

EVENT_MESSAGES = (
    Message("PARM").of(Field("Name", "N"), Field("Value", "f"), Field("Default", "f")),
    Message("MSG").of(Field("ID", "B"), Field("Seq", "B"), Field("Message", "Z")),
    Message("VER").of(
        Field("BT", "B"), Field("BST", "H"), Field("Maj", "B"), Field("Min", "B"), Field("Pat", "B"),
        Field("FWT", "B"), Field("GH", "I"), Field("FWS", "Z"), Field("APJ", "H"), Field("BU", "B"),
        Field("FV", "B"), Field("IMI", "I"), Field("ICI", "I"),
    ),
    Message("MODE").of(Field("Mode", "M"), Field("ModeNum", "B"), Field("Rsn", "B")),
    Message("ARM").of(*(Field(*x) for x in (("ArmState", "B"), ("ArmChecks", "I"), ("Forced", "B"), ("Method", "B")))),
    Message("EV").of(Field("Id", "B")),
    board.COMMANDS,
    Message("ERR").of(Field("Subsys", "B"), Field("ECode", "B")),
    Message("SIDD").of(
        Field("Time", "f", "s"), Field("Targ", "f"), Field("F", "f", "z"),
        *(Field(f"G{axis}", "f", "k") for axis in "xyz"),
        *(Field(f"A{axis}", "f", "o") for axis in "xyz"),
    ),
    Message("SIDS").of(
        Field("Ax", "B"), Field("Mag", "f"),
        *(Field(name, "f", "s") for name in ("FSt", "FSp", "TFin", "TC", "TR", "TFout")),
    ),
    Message("ATUN").of(
        Field("Axis", "B"), Field("TuneStep", "B"),
        *(Field(name, "f", "d", "0") for name in ("Targ", "Min", "Max")),
        *(Field(name, "f") for name in ("RP", "RD", "SP")), Field("ddt", "f", "o", "0"),
    ),
    Message("CMD", bits=bits.COMMANDS).of(*COMMAND),
    Message("MISE", bits=bits.COMMANDS).of(*COMMAND),
    Message("FNCE").of(
        Field("Tot", "B"), Field("Seq", "B"), Field("Type", "B"), Field("Lat", "L", "D", "G"),
        Field("Lng", "L", "U", "G"), Field("Count", "B"), Field("Radius", "f", "m"),
    ),
    Message("RALY").of(
        Field("Tot", "B"), Field("Seq", "B"), Field("Lat", "L", "D", "G"), Field("Lng", "L", "U", "G"),
        Field("Alt", "h", "m", "B"), Field("Flags", "B"),
    ),
    Message("OABR").of(
        Field("Type", "B"), Field("Act", "B"), *(Field(name, "H", "d") for name in ("DYaw", "Yaw", "DP")),
        Field("RChg", "B"), Field("Mar", "f", "m"),
        Field("DLt", "L", "D", "G"), Field("DLg", "L", "U", "G"), Field("DAlt", "f", "m", "0"),
        Field("OLt", "L", "D", "G"), Field("OLg", "L", "U", "G"), Field("OAlt", "f", "m", "0"),
    ),
    Message("OADJ").of(
        *(Field(name, "B") for name in ("State", "Err", "CurrPoint", "TotPoints")),
        Field("DLat", "L", "D", "G"), Field("DLng", "L", "U", "G"),
        Field("OALat", "L", "D", "G"), Field("OALng", "L", "U", "G"),
    ),
    Message("ORGN").of(
        Field("Type", "B", "#"), Field("Lat", "L", "D", "G"), Field("Lng", "L", "U", "G"),
        Field("Alt", "e", "m", "B"),
    ),
)  # fmt: skip
"""Event messages, encoded by ``events.EventEncoder``."""

POSITION = Message("POS", bits.MEDIUM, _ATTITUDE, when=E + "origin_set").of(
    Field("Lat", "L", "D", "G", derived.latitude(E + "origin_", E + "pos")),
    Field("Lng", "L", "U", "G", derived.longitude(E + "origin_", E + "pos")),
    Field("Alt", "f", "m", "0", derived.difference(E + "origin_alt", E + "pos[2]")),
    Field("RelHomeAlt", "f", "m", "0", derived.difference(A + "home.pos[2]", E + "pos[2]")),
    Field("RelOriginAlt", "f", "m", "0", E + "pos[2]", -1.0),
)


def barometer(number: int, pressure: str, count: str, when: Source) -> Message:
    """BARO of a barometer; ``pressure``, ``count``: paths of what it shows [hPa] and of its samples."""
    return Message("BARO", bits.MEDIUM, bits.IMU, when=when).of(
        Field("I", "B", "#", source=number),
        Field("Alt", "f", "m", "0", derived.baro_altitude(pressure)),
        Field("AltAMSL", "f", "m", "0", derived.pressure_altitude(pressure)),
        Field("Press", "f", "P", "0", pressure, 100.0),
        Field("Temp", "c", "O", "B", S + "temperature"),
        Field("CRt", "f", "n", "0", E + "vel[2]", -1.0),
        Field("SMS", "I", "s", "C", S + "time_us", 1e-3),
        Field("Offset", "f", "m", "?"),
        Field("GndTemp", "f", "O", "0", S + "temperature"),
        Field("H", "B", source=derived.is_seen(count)),
        Field("CPress", "f", "P", "0", pressure, 100.0),
    )


SENSORS = (
    Message("IMU", bits.IMU_RATE, bits.IMU, ring=True).of(
        Field("I", "B", "#"),
        *(Field(f"Gyr{axis}", "f", "E", "0", f"@gyro[{k}]") for k, axis in enumerate("XYZ")),
        *(Field(f"Acc{axis}", "f", "o", "0", f"@acc[{k}]") for k, axis in enumerate("XYZ")),
        Field("EG", "I"),
        Field("EA", "I"),
        Field("T", "f", "O", source=S + "temperature"),
        Field("GH", "B", source=1),
        Field("AH", "B", source=1),
        Field("GHz", "H", "z", "0", 400),
        Field("AHz", "H", "z", "0", 400),
    ),
    barometer(0, S + "abs_pressure", S + "baro_count", S + "baro_count"),
    barometer(1, S + "abs_pressure2", S + "baro2_count", derived.baros_differ),
    Message("VIBE", bits.MEDIUM, bits.IMU).of(
        Field("IMU", "B", "#"),
        *(Field(f"Vibe{axis}", "f", "o", "0", derived.root(f"{A}vibration.squares[{k}]"))
          for k, axis in enumerate("XYZ")),
        Field("Clip", "I", source=A + "vibration.clips"),
    ),
)  # fmt: skip


FLOW = Message("OF", bits.MEDIUM, bits.FLOW, change=A + "flow.count", time=A + "flow.time_us").of(
    Field("Qual", "B", source=A + "flow.quality"),
    *(Field(f"flow{axis}", "f", "E", "0", f"{A}flow.rate[{k}]") for k, axis in enumerate("XY")),
    *(Field(f"body{axis}", "f", "E", "0", f"{A}flow.body[{k}]") for k, axis in enumerate("XY")),
)
"""OF: optical flow, body rates included, and body rates of the same time [rad/s]."""


def battery(resting: Source, resistance: Source = 0.0) -> Message:
    """BAT: as measured; ``resting`` [V] and ``resistance`` [ohm] as far as the firmware knows them."""
    return Message("BAT", bits.MEDIUM, bits.BATTERY).of(
        Field("Inst", "B", "#"),
        Field("Volt", "f", "v", "0", A + "battery.voltage"),
        Field("VoltR", "f", "v", "0", resting),
        Field("Curr", "f", "A", "0", A + "battery.current"),
        Field("CurrTot", "f", "a", "C", A + "battery.consumed_mah"),
        Field("EnrgTot", "f", "X", "0", A + "battery.consumed_wh"),
        Field("Temp", "c", "O", "?"),
        Field("Res", "f", "w", "0", resistance),
        Field("RemPct", "B", "%", "0", A + "battery.remaining_pct"),
        Field("H", "B", "-", "0", 1),
        Field("SH", "B", "%", "0"),
    )


def position_control(axis: str, k: int, path: Callable[[str], str], target: str, when: Any) -> Message:
    """PSCN, PSCE, PSCD: desired, target and actual position, velocity and acceleration along an axis.

    Args:
        axis: "N", "E" or "D".
        k: its index.
        path: of a field of the position controller along it, by the field's name.
        target: name of the field that has the target position [m].
        when: see ``Message``.
    """
    rows = (
        ("P", "m", target, target, "pos"),
        ("V", "n", "vel_desired", "vel_target", "vel"),
        ("A", "o", "accel_desired", "accel_target", "acc_ned"),
    )
    fields = tuple(
        Field(name + axis, "f", unit, "0", source)
        for kind, unit, desired, followed, actual in rows
        for name, source in (("D" + kind, path(desired)), ("T" + kind, path(followed)), (kind, f"{E}{actual}[{k}]"))
    )
    return Message(f"PSC{axis}", bits.MEDIUM, bits.NAVIGATION, when=when).of(*fields)


def gps_accuracy(receiver: int, r: str) -> Message:
    """GPA of a receiver, whose numbers begin with ``r``."""
    return Message("GPA", bits.MEDIUM, bits.GPS, change=r + "gps_count", time=r + "gps_time_us").of(
        Field("I", "B", "#", source=receiver),
        Field("VDop", "C", "-", "B", r + "gps_epv", 0.01),
        Field("HAcc", "C", "m", "B", r + "gps_eph", 0.3 / 121.0),
        Field("VAcc", "C", "m", "B", r + "gps_epv", 0.3 / 200.0),
        Field("SAcc", "C", "n", "B"),
        Field("YAcc", "f", "d", "0"),
        Field("VV", "B", source=1),
        Field("SMS", "I", "s", "C", r + "gps_time_us", 1e-3),
        Field("Delta", "H", "s", "C", 200),
        Field("AEl", "e", "m", "B", r + "gps_alt", 1e-3),
        Field("RTCMFU", "H"),
        Field("RTCMFD", "H"),
    )


def estimator(e: str, k: str, when: Source) -> tuple[Message, ...]:
    """XKF1 to XKF5, XKFS and XKQ of a filter, whose number C is that of its IMU.

    XKF3 has ArduPilot's sign, expected minus measured; of the magnetometer only the yaw is fused.

    Args:
        e: path of what it says.
        k: of its own record.
        when: see ``Message``.
    """
    euler = tuple(derived.euler(e + "q", n) for n in range(3))

    def of(name: str, *fields: Field) -> Message:
        return Message(name, bits.MEDIUM, _ATTITUDE, when=when).of(Field("C", "B", "#", source=k + "imu"), *fields)

    return (
        of(
            "XKF1",
            Field("Roll", "c", "d", "B", euler[0], DEG),
            Field("Pitch", "c", "d", "B", euler[1], DEG),
            Field("Yaw", "C", "h", "B", derived.wrapped(euler[2])),
            *(Field(f"V{axis}", "f", "n", "0", f"{e}vel[{n}]") for n, axis in enumerate("NED")),
            Field("dPD", "f", "n", "0", e + "vel[2]"),
            *(Field(f"P{axis}", "f", "m", "0", f"{e}pos[{n}]") for n, axis in enumerate("NED")),
            *(Field(f"G{axis}", "c", "k", "B", f"{k}gyro_bias[{n}]", DEG) for n, axis in enumerate("XYZ")),
            Field("OH", "e", "m", "B", e + "origin_alt"),
        ),
        of(
            "XKF2",
            *(Field(f"A{axis}", "c", source=f"{k}acc_bias[{n}]") for n, axis in enumerate("XYZ")),
            Field("VWN", "c", "n", "B"),
            Field("VWE", "c", "n", "B"),
            *(Field(f"M{axis}", "h", "G", "C", f"{k}earth_field[{n}]", 1000.0) for n, axis in enumerate("NED")),
            *(Field(f"M{axis}", "h", "G", "C", f"{k}mag_bias[{n}]", 1000.0) for n, axis in enumerate("XYZ")),
            Field("IDX", "f", "o", "0"),
            Field("IDY", "f", "o", "0"),
            Field("IS", "f", "r", "0"),
        ),
        of(
            "XKF3",
            *(Field(f"IV{axis}", "c", "n", "B", f"{k}innovation_vel[{n}]", -1.0) for n, axis in enumerate("NED")),
            *(Field(f"IP{axis}", "c", "m", "B", f"{k}innovation_pos[{n}]", -1.0) for n, axis in enumerate("NED")),
            *(Field(f"IM{axis}", "h", "G", "C") for axis in "XYZ"),
            Field("IYAW", "c", "d", "B", k + "innovation_yaw", -DEG),
            Field("IVT", "c", "?", "B"),
            Field("RErr", "f", "-", "0"),
            Field("ErSc", "f", "-", "0"),
        ),
        of(
            "XKF4",
            *(Field(f"S{x}", "c", source=f"{e}variance_{y}")
                  for x, y in (("V", "vel"), ("P", "pos"), ("H", "hgt"), ("M", "mag"))),
            Field("SVT", "c"),
            Field("errRP", "f", "-", "-", derived.angle_error(k + "P"), 1.0 / DEG),
            Field("OFN", "f", "m", "?", e + "reset_pos[0]"),
            Field("OFE", "f", "m", "?", e + "reset_pos[1]"),
            Field("FS", "H"),
            Field("TS", "B", source=NO_AIRSPEED | NO_DRAG),
            Field("SS", "I", source=derived.solution(e, k)),
            Field("GPS", "H"),
            Field("PI", "b", source=K + "imu"),
        ),
        of(
            "XKF5",
            Field("NI", "B"),
            *(Field(f"FI{x}", "h", source=f"{k}innovation_flow[{n}]", scale=1000.0) for n, x in enumerate("XY")),
            Field("AFI", "h"),
            Field("HAGL", "c", "m", "B", derived.difference(k + "ground_d", e + "pos[2]")),
            Field("offset", "c", "?", "B", k + "ground_d"),
            Field("RI", "c", "?", "B"),
            Field("rng", "C", "?", "B"),
            Field("Herr", "C", "m", "B"),
            Field("eAng", "f", "r", "0", derived.angle_error(k + "P"), 1.0 / DEG),
            Field("eVel", "f", "n", "0", derived.length(*(f"{k}lag_vel[{n}]" for n in range(3)))),
            Field("ePos", "f", "m", "0", derived.length(*(f"{k}lag_pos[{n}]" for n in range(3)))),
        ),
        of(
            "XKFS",
            Field("MI", "B", source=k + "compass"),
            *(Field(label, "B") for label in ("BI", "GI", "AI", "SS")),
            Field("GPS_GTA", "B", source=derived.is_seen(k + "gps_good_us")),
            Field("GPS_CHK_WAIT", "B"),
            Field("MAG_FUSION", "B", source=1),
        ),
        of(
            "XKQ",
            *(Field(f"Q{n + 1}", "f", "?", "?", f"{e}q[{n}]") for n in range(4)),
        ),
    )  # fmt: skip


FILTER = (
    *estimator(E, K, derived.estimates),
    *estimator(A + "second_lane.estimate.", A + "second_lane.ekf.", derived.second_lane_estimates),
)
"""The filter that is flown by, and the second one while there is one."""

AHR2 = Message("AHR2", bits.MEDIUM, _ATTITUDE).of(
    Field("Roll", "c", "d", "B", derived.euler(E + "q", 0), DEG),
    Field("Pitch", "c", "d", "B", derived.euler(E + "q", 1), DEG),
    Field("Yaw", "C", "h", "B", derived.wrapped(derived.euler(E + "q", 2))),
    Field("Alt", "f", "m", "0", derived.difference(E + "origin_alt", E + "pos[2]")),
    Field("Lat", "L", "D", "G", derived.latitude(E + "origin_", E + "pos")),
    Field("Lng", "L", "U", "G", derived.longitude(E + "origin_", E + "pos")),
    *(Field(f"Q{n + 1}", "f", source=f"{E}q[{n}]") for n in range(4)),
)
"""AHR2: the second attitude source; this firmware has one estimator and logs it again, as AHRS2 reports it."""
_BODY, _GROUND = "physics.body.", "physics.origin."


def gps(boot_unix_us: int) -> tuple[Message, ...]:
    """GPS and GPA of two receivers; ``boot_unix_us``: Unix time of boot [us]."""
    return tuple(m for k, r in enumerate((S, S + "gps2.")) for m in (gps_fix(boot_unix_us, k, r), gps_accuracy(k, r)))


def gps_fix(boot_unix_us: int, receiver: int, r: str) -> Message:
    """GPS: fixes with GPS week and time of week, of a receiver whose numbers begin with ``r``.

    GPS time began in 1980 and has been 18 s ahead of UTC since 2017.
    """
    boot = (boot_unix_us - 315_964_800_000_000) * 1e-6 + 18.0
    week, seconds = 7 * 86400.0, derived.gps_seconds(r)
    return Message("GPS", bits.MEDIUM, bits.GPS, change=r + "gps_count", time=r + "gps_time_us").of(
        Field("I", "B", "#", source=receiver),
        Field("Status", "B", source=r + "gps_fix"),
        Field("GMS", "I", "s", "C", lambda s: (boot + seconds(s)) % week, 1000.0),
        Field("GWk", "H", source=lambda s: (boot + seconds(s)) // week),
        Field("NSats", "B", "S", "0", r + "gps_satellites"),
        Field("HDop", "c", "-", "B", r + "gps_eph", 0.01),
        Field("Lat", "L", "D", "G", r + "gps_lat"),
        Field("Lng", "L", "U", "G", r + "gps_lon"),
        Field("Alt", "e", "m", "B", r + "gps_alt", 1e-3),
        Field("Spd", "f", "n", "0", derived.length(r + "gps_vel[0]", r + "gps_vel[1]"), 0.01),
        Field("GCrs", "f", "h", "0", derived.course(r)),
        Field("VZ", "f", "n", "0", r + "gps_vel[2]", 0.01),
        Field("Yaw", "f", "h"),
        Field("U", "B", source=derived.is_used(receiver)),
    )


_TARGET = A + "landing_target."


def _acquired(path: str) -> Any:
    return lambda s: s(_TARGET + path) * s(_TARGET + "acquired")


LANDING_TARGET = Message("PL", bits.MEDIUM, bits.CONTROL | bits.NAVIGATION, when=A + "params.PLND.ENABLED").of(
    Field("Heal", "B", source=_TARGET + "sees"),
    Field("TAcq", "B", source=_TARGET + "acquired"),
    *(Field(f"p{axis}", "f", "m", "0", _acquired(f"away[{k}]")) for k, axis in enumerate("XY")),
    *(Field(f"v{axis}", "f", "n", "0", _acquired(f"closing[{k}]")) for k, axis in enumerate("XY")),
    *(Field(f"m{axis}", "f", "m", "0", f"{_TARGET}measured_pos[{k}]") for k, axis in enumerate("XYZ")),
    Field("LastMeasMS", "I", "s", "C", _TARGET + "used_us", 1e-3),
    Field("EKFOutl", "I", source=_TARGET + "outliers"),
    Field("Est", "B", source=A + "params.PLND.EST_TYPE"),
)
TRUTH = Message("SIM", bits.MEDIUM, _ATTITUDE).of(
    Field("Roll", "c", "d", "B", derived.roll(_BODY + "q")),
    Field("Pitch", "c", "d", "B", derived.pitch(_BODY + "q")),
    Field("Yaw", "C", "h", "B", derived.yaw(_BODY + "q")),
    Field("Alt", "f", "m", "0", derived.difference(_GROUND + "alt", _BODY + "pos[2]")),
    Field("Lat", "L", "D", "G", derived.latitude(_GROUND, _BODY + "pos")),
    Field("Lng", "L", "U", "G", derived.longitude(_GROUND, _BODY + "pos")),
    *(Field(f"Q{k + 1}", "f", "-", "0", f"{_BODY}q[{k}]") for k in range(4)),
)
"""SIM: true position and attitude of the simulated vehicle."""
TRUE_MOTION = Message("SIM2", bits.IMU_RATE, _ATTITUDE).of(
    *(Field(f"P{axis}", "d", "?", "?", f"{_BODY}pos[{k}]") for k, axis in enumerate("NED")),
    *(Field(f"V{axis}", "f", "?", "?", f"{_BODY}vel[{k}]") for k, axis in enumerate("NED")),
    Field("As", "f", "?", "?"),
    Field("ASpdU", "f", "?", "?"),
    Field("UFC", "I", "?", "?"),
)
"""SIM2: its true position from the start [m] and velocity [m/s]."""
