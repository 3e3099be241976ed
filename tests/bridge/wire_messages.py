# SPDX-License-Identifier: BSD-3-Clause
"""Hypothesis strategies of well-formed messages with awkward contents."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from hypothesis import strategies as st

numbers = st.one_of(
    st.sampled_from((0.0, 1.0, -1.0, 2.0, math.nan, math.inf, -math.inf, 1e9, -1e9, 3.4e38, 1e-30, 21196.0, 2989.0)),
    st.floats(-50.0, 50.0, width=32),
)
whole = st.one_of(
    st.sampled_from((0, 1, -1, -(2**31), 2**31 - 1, 900_000_000, -1_800_000_000, -353632620, 1491652370)),
    st.integers(-(2**31), 2**31 - 1),
)
byte = st.one_of(st.sampled_from((0, 1, 2, 3, 5, 6, 8, 11, 255)), st.integers(0, 255))
word = st.one_of(st.sampled_from((0, 1500, 0x9C7, 0x9F8, 0xDC7, 0xDF8, 65535)), st.integers(0, 65535))
axis = st.integers(-1000, 1000)
places = st.fixed_dictionaries({"x": whole, "y": whole, "z": numbers})
parameters = st.fixed_dictionaries({f"param{k}": numbers for k in range(1, 5)})
vectors = st.fixed_dictionaries(dict.fromkeys(("vx", "vy", "vz", "afx", "afy", "afz", "yaw", "yaw_rate"), numbers))
targets = st.fixed_dictionaries({"coordinate_frame": byte, "type_mask": word})


def merged(*parts: dict[str, Any]) -> dict[str, Any]:
    return {k: v for part in parts for k, v in part.items()}


def message(name: str, *parts: st.SearchStrategy[dict[str, Any]], **fields: st.SearchStrategy[Any]) -> Any:
    """Strategy of (message name, its fields)."""
    return st.builds(lambda *found: (name, merged(*found)), *parts, st.fixed_dictionaries(fields))


def messages(commands: Iterable[int], items: Iterable[int]) -> Any:
    """Strategy of messages with one of these commands, or mission items."""
    number, item = st.sampled_from(sorted(commands)), st.sampled_from((*items, 0, 65535))
    return st.one_of(
        message("COMMAND_LONG", parameters, command=number, param5=numbers, param6=numbers, param7=numbers),
        message("COMMAND_INT", parameters, places, command=number, frame=byte),
        message("SET_POSITION_TARGET_LOCAL_NED", targets, vectors, x=numbers, y=numbers, z=numbers),
        message("SET_POSITION_TARGET_GLOBAL_INT", targets, vectors, lat_int=whole, lon_int=whole, alt=numbers),
        message(
            "SET_ATTITUDE_TARGET", type_mask=byte, q=st.tuples(*[numbers] * 4), thrust=numbers,
            body_roll_rate=numbers, body_pitch_rate=numbers, body_yaw_rate=numbers,
        ),
        message("RC_CHANNELS_OVERRIDE", **{f"chan{k}_raw": word for k in range(1, 9)}),
        message("MANUAL_CONTROL", target=st.just(1), x=axis, y=axis, z=axis, r=axis),
        message("MISSION_COUNT", count=st.integers(0, 3), mission_type=st.sampled_from((0, 0, 1, 2, 255))),
        message("MISSION_ITEM_INT", parameters, places, command=item, frame=byte, seq=st.integers(0, 3), current=byte),
        message("MISSION_SET_CURRENT", seq=st.integers(0, 6)),
        message("MISSION_CLEAR_ALL", mission_type=byte),
        message("SET_MODE", base_mode=byte, custom_mode=st.integers(0, 30)),
        message("SET_HOME_POSITION", latitude=whole, longitude=whole, altitude=whole),
        message("SET_GPS_GLOBAL_ORIGIN", latitude=whole, longitude=whole, altitude=whole),
    )  # fmt: skip
