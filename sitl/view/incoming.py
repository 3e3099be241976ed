# SPDX-License-Identifier: BSD-3-Clause
"""What browsers send to the page's server, checked before the library acts on it: kinds of messages, types, finiteness,
ranges, choices and lengths.

The library takes any value for a widget, any attribute of it, files for widgets that take none, and requests to open
the page to the internet. A page is no more trusted than a MAVLink client.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ..errors import OptionError, SitlError

LONGEST = 1 << 16
"""Size of a message, at most [bytes]."""
LONGEST_TEXT = 200
"""Of a text that is typed [characters]."""
_FAR = 1e9
"""Greatest coordinate of a camera or of a click [m]."""
_SHOWN = 40
"""Characters of a value that a refusal repeats."""
_CAMERA = {"wxyz": 4, "position": 3, "look_at": 3, "up_direction": 3}
_CAMERA_NUMBERS = ("fov", "near", "far", "image_height", "image_width")
_AGAIN_S = 1.0
"""Wall time after which the same refusal is told to a browser again [s]."""

Find = Callable[[str], Any]
"""Gives a widget by its identifier, None where there is none."""


class RefusedMessage(SitlError, ValueError):
    """A message of a browser that the page does not take."""


def check(message: Any, widget: Find) -> None:
    """Check a message of a browser.

    Args:
        message: as it came, decoded.
        widget: finds what it is for.

    Raises:
        RefusedMessage: what is wrong with it.
        OptionError: a value that the widget does not take.
    """
    if not isinstance(message, Mapping):
        raise RefusedMessage(f"message {shown(message)}: it has no fields")
    kind = message.get("type")
    if kind == "GuiUpdateMessage":
        _check_update(message, widget)
    elif kind == "ViewerCameraMessage":
        _check_camera(message)
    elif kind == "ScenePointerMessage":
        _check_click(message)
    else:
        raise RefusedMessage(f"message {shown(kind)}: the page takes values of its widgets, cameras and clicks")


def _check_update(message: Mapping[Any, Any], find: Find) -> None:
    uuid, updates = message.get("uuid"), message.get("updates")
    widget = find(uuid) if isinstance(uuid, str) else None
    if widget is None:
        raise RefusedMessage("there is no such widget (any more)")
    if len(message) != 3 or not isinstance(updates, Mapping) or list(updates) != ["value"]:
        raise RefusedMessage(f"{widget.label}: only its value can be set")
    check_value(widget, updates["value"])


def check_value(widget: Any, value: Any) -> None:
    """Check a value for a widget, by the kind of widget, its bounds and its choices.

    Raises:
        OptionError: the value is not one that it takes.
    """
    label, kind = widget.label, type(widget).__name__
    if not widget.visible or widget.disabled:
        raise OptionError(f"{label}: it cannot be changed now")
    if kind in ("GuiNumberHandle", "GuiSliderHandle"):
        number = finite(label, value)
        if isinstance(widget.value, int) and number != int(number):
            raise OptionError(f"{label}: {shown(value)} is not a whole number")
        low, high = widget.min, widget.max
        if (low is not None and number < low) or (high is not None and number > high):
            raise OptionError(f"{label}: {shown(value)} is outside {low:g} .. {high:g}")
    elif kind == "GuiDropdownHandle":
        if not isinstance(value, str) or value not in widget.options:
            raise OptionError(f"{label}: {shown(value)} is not one of its choices")
    elif kind in ("GuiCheckboxHandle", "GuiButtonHandle"):
        if not isinstance(value, bool):
            raise OptionError(f"{label}: {shown(value)} is neither on nor off")
    elif kind == "GuiTextHandle":
        if not isinstance(value, str) or len(value) > LONGEST_TEXT or not value.isprintable():
            raise OptionError(f"{label}: {shown(value)} is not a line of at most {LONGEST_TEXT} characters")
    else:
        raise OptionError(f"{label}: it takes no value")


def finite(label: str, value: Any, largest: float = math.inf) -> float:
    """A finite number, whatever it came as.

    Raises:
        OptionError: it is none, or its magnitude is above ``largest``.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise OptionError(f"{label}: {shown(value)} is not a finite number")
    if abs(value) > largest:
        raise OptionError(f"{label}: {shown(value)} is outside {-largest:g} .. {largest:g}")
    return float(value)


def _vector(label: str, value: Any, count: int) -> None:
    if not isinstance(value, Sequence) or isinstance(value, str | bytes) or len(value) != count:
        raise RefusedMessage(f"{label}: {shown(value)} is not {count} numbers")
    for each in value:
        finite(label, each, _FAR)


def _check_camera(message: Mapping[Any, Any]) -> None:
    if set(message) != {"type", *_CAMERA, *_CAMERA_NUMBERS}:
        raise RefusedMessage(f"camera: its fields are {', '.join((*_CAMERA, *_CAMERA_NUMBERS))}")
    for name, count in _CAMERA.items():
        _vector(f"camera's {name}", message[name], count)
    for name in _CAMERA_NUMBERS:
        if finite(f"camera's {name}", message[name], _FAR) < 0.0:
            raise RefusedMessage(f"camera's {name}: {shown(message[name])} is negative")
    for name in ("wxyz", "up_direction"):
        if not any(message[name]):
            raise RefusedMessage(f"camera's {name}: all of it is 0")


def _check_click(message: Mapping[Any, Any]) -> None:
    wanted = {"type", "event_type", "ray_origin", "ray_direction", "screen_pos", "modifier"}
    if set(message) != wanted or message["event_type"] != "click":
        raise RefusedMessage("click: only clicks on the scene mean something here")
    for name in ("ray_origin", "ray_direction"):
        _vector(f"click's {name}", message[name], 3)
    positions, modifier = message["screen_pos"], message["modifier"]
    if not isinstance(positions, Sequence) or isinstance(positions, str | bytes) or len(positions) > 2:
        raise RefusedMessage(f"click's screen_pos: {shown(positions)} is not a position on the screen")
    for each in positions:
        _vector("click's screen_pos", each, 2)
    if modifier is not None and not (isinstance(modifier, str) and len(modifier) < _SHOWN):
        raise RefusedMessage(f"click's modifier: {shown(modifier)} is not the name of one")


def shown(value: Any) -> str:
    """A value as a refusal repeats it: not all of a long one."""
    text = repr(value[:_SHOWN] if isinstance(value, str | bytes | list) else value)
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."


class Visit:
    """A browser's connection, of whose messages the server gets those that pass.

    Args:
        connection: of websockets.
        decode: bytes to a message; ValueError or what is derived from it when they are none.
        widget: finds widgets.
        report: is given this and what was refused.
    """

    def __init__(
        self, connection: Any, decode: Callable[[bytes], Any], widget: Find, report: Callable[[Any, str], None]
    ) -> None:
        self._connection, self._decode, self._widget, self._report = connection, decode, widget, report
        self._last_text, self._last_time = "", -math.inf

    def __getattr__(self, name: str) -> Any:
        return getattr(self._connection, name)

    async def recv(self) -> bytes:
        """The next message that passes."""
        while True:
            raw = await self._connection.recv()
            try:
                check(self._read(raw), self._widget)
            except SitlError as error:
                self._say(str(error))
            else:
                return bytes(raw)

    def _read(self, raw: Any) -> Any:
        try:
            return self._decode(raw if isinstance(raw, bytes) else b"")
        except (ValueError, TypeError, RecursionError):
            raise RefusedMessage("a message that cannot be read") from None

    def _say(self, text: str) -> None:
        now = time.monotonic()
        if text != self._last_text or now - self._last_time > _AGAIN_S:  # a browser that repeats itself hears it once
            self._last_text, self._last_time = text, now
            self._report(self, text)
