# SPDX-License-Identifier: BSD-3-Clause
"""A browser that sends what no page of ours would: it is refused, and the vehicle flies on with the same bits."""

from __future__ import annotations

import itertools
import math
import queue
import threading
from collections.abc import Iterator
from typing import Any

import gymnasium as gym
import pytest

from sitl import Fleet, Simulation
from sitl.run.pacing import StoppablePacing
from sitl.run.runner import serve
from sitl.simulation import Core
from sitl.view import page_library

pytest.importorskip("viser", reason="the page needs viser: pip install 'gym-sitl[view]'")
import msgspec.msgpack
import viser
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

import sitl.envs  # noqa: F401
from sitl.envs.page.page import EnvPage
from sitl.view.fleet_page import FleetPage
from sitl.view.flight_page import FlightPage
from sitl.view.flights import of_track
from sitl.view.incoming import LONGEST, check
from sitl.view.live_page import MOST_REQUESTS, LivePage

from .test_flights import track

VALUES: tuple[Any, ...] = (
    math.nan, math.inf, -math.inf, "12 monkeys", "", "x" * 5000, "a\x00\n", None, [], [1.0], {}, {"a": 1}, True, 1e300,
    -1e300, 5e-324, 2**63, -(2**63), 0, 7, 1.5, b"", b"\xff" * 40,
)  # fmt: skip
CAMERA = {
    "type": "ViewerCameraMessage", "wxyz": [1.0, 0.0, 0.0, 0.0], "position": [1.0, 2.0, 3.0], "fov": 1.0, "near": 0.01,
    "far": 1000.0, "image_height": 400, "image_width": 400, "look_at": [0.0, 0.0, 0.0], "up_direction": [0.0, 0.0, 1.0],
}  # fmt: skip
CLICK = {
    "type": "ScenePointerMessage", "event_type": "click", "ray_origin": [0.0, 0.0, 5.0],
    "ray_direction": [0.5, 0.0, -1.0], "screen_pos": [[0.5, 0.5]], "modifier": None,
}  # fmt: skip


Notes = queue.Queue[str]


class Browser:
    """A client of a page that sends anything."""

    def __init__(self, page: Any) -> None:
        self.page = page
        port = page.server.get_port()
        protocol = Subprotocol(f"viser-v{viser.__version__}")
        self.socket: ClientConnection = connect(f"ws://127.0.0.1:{port}", subprotocols=[protocol], max_size=None)
        known = threading.Event()
        page.server.on_client_connect(lambda client: known.set())
        self.send(CAMERA)
        known.wait(60.0)

    def send(self, message: Any) -> None:
        self.socket.send(msgspec.msgpack.encode(message))

    def set(self, uuid: str, value: Any) -> None:
        self.send({"type": "GuiUpdateMessage", "uuid": uuid, "updates": {"value": value}})

    def wait(self, notes: Notes) -> list[str]:
        """Wait until all that was sent is looked at; gives what was refused, but for the last."""
        self.send({"type": "the end"})
        said: list[str] = []
        while not (said and "'the end'" in said[-1]):
            said.append(notes.get(timeout=60.0))
        return said[:-1]


@pytest.fixture
def notes(monkeypatch: pytest.MonkeyPatch) -> Notes:
    """What browsers are told."""
    told: Notes = queue.Queue()
    monkeypatch.setattr(page_library, "note", lambda client, text, title="": told.put(text))
    return told


@pytest.fixture
def live(core: Core) -> Iterator[tuple[LivePage, Browser]]:
    page = LivePage(Simulation("erle_copter", core=core, seed=3), StoppablePacing(None))
    browser = Browser(page)
    yield page, browser
    browser.socket.close()
    page.close()


def widgets(page: Any) -> dict[str, Any]:
    return dict(getattr(page.server.gui, page_library._WIDGETS))


def everything(page: Any) -> Iterator[Any]:
    """Messages that are wrong, or of no use: each widget and each field with each value."""
    for uuid, value in itertools.product(widgets(page), VALUES):
        if type(widgets(page)[uuid]).__name__ != "GuiButtonHandle" and not takes(widgets(page)[uuid], value):
            yield {"type": "GuiUpdateMessage", "uuid": uuid, "updates": {"value": value}}
        yield {"type": "GuiUpdateMessage", "uuid": uuid, "updates": value}
    for uuid in widgets(page):
        for name in ("removed", "update_cb", "sync_cb", "uuid", "props", "gui_api", "is_button", "_x", "value.real"):
            yield {"type": "GuiUpdateMessage", "uuid": uuid, "updates": {name: []}}
        yield {
            "type": "FileTransferStartUpload", "source_component_uuid": uuid, "transfer_uuid": uuid, "filename": "f",
            "mime_type": "", "part_count": 0, "size_bytes": 0,
        }  # fmt: skip
    for message in (CAMERA, CLICK):
        for name, value in itertools.product(message, VALUES):
            changed = {**message, name: value}
            if not passes(changed):
                yield changed
            yield {key: kept for key, kept in message.items() if key != name}
    for kind in ("ShareUrlRequest", "ShareUrlDisconnect", "GuiFormDirtyMessage", "GuiFormSubmitMessage", "Nothing", ""):
        yield {"type": kind, "uuid": "x"}
    yield from VALUES


def passes(message: Any) -> bool:
    try:
        check(message, lambda uuid: None)
    except ValueError:
        return False
    return True


def takes(widget: Any, value: Any) -> bool:
    kind = type(widget).__name__
    if kind == "GuiCheckboxHandle":
        return isinstance(value, bool)
    if kind == "GuiTextHandle":
        return value in ("", "12 monkeys")
    if kind == "GuiDropdownHandle":
        return value in widget.options
    return (
        isinstance(value, int | float)
        and not isinstance(value, bool)
        and math.isfinite(value)
        and ((widget.min is None or value >= widget.min) and (widget.max is None or value <= widget.max))
        and not (isinstance(widget.value, int) and value != int(value))
    )


def harass(page: Any, browser: Browser, notes: Notes, capfd: pytest.CaptureFixture[str]) -> None:
    """Send everything; none of it reaches a widget, and nobody prints a traceback."""
    before = {uuid: widget.value for uuid, widget in widgets(page).items()}
    asked: list[str] = []
    page.server.request_share_url = lambda verbose=True: asked.append("share")
    capfd.readouterr()
    for message in everything(page):
        browser.send(message)
    browser.socket.send("text, not bytes")
    browser.socket.send(b"\xc1\xff")
    said = browser.wait(notes)
    assert len(said) > 100 and any("not a finite number" in text for text in said)
    assert {uuid: widget.value for uuid, widget in widgets(page).items()} == before
    assert not asked
    printed = capfd.readouterr()
    assert "Traceback" not in printed.err + printed.out and "exception" not in printed.err


def fly(page: LivePage, seconds: float) -> None:
    simulation, pace = page.simulation, StoppablePacing(None)
    serve(simulation, pace, until_us=simulation.time_us + round(seconds * 1e6), on_slice=page.attend)


def test_a_vehicle_flies_on_as_if_nobody_had_sent_anything(
    live: tuple[LivePage, Browser], core: Core, notes: Notes, capfd: pytest.CaptureFixture[str]
) -> None:
    page, browser = live
    alone = Simulation("erle_copter", core=core, seed=3)
    fly(page, 5.0)
    harass(page, browser, notes, capfd)
    fly(page, 5.0)
    page.capture(1.0)
    page.wait_drawn()
    pace = StoppablePacing(None)
    serve(alone, pace, until_us=alone.time_us + 10_000_000)
    assert page.simulation.fleet.tobytes() == alone.fleet.tobytes()
    assert page.frame is not None and page.frame.time_us == 10_000_000


def test_values_that_got_into_widgets_are_refused_before_the_vehicle(live: tuple[LivePage, Browser]) -> None:
    """As if a browser's message had passed: what acts on a value looks at it, too."""
    page, _ = live
    assert page.controls is not None and page.weather is not None
    said: list[str] = []
    page.notify = lambda text, client=None, title="": said.append(text)  # type: ignore[method-assign]
    pilot, controls = page.pilot, page.controls
    fly(page, 1.0)

    class Click:
        client = None

    for widget, button in ((controls.step_s, controls.step), (controls.height, controls.take_off)):
        for value in (math.nan, math.inf, 1e300, "text", None):
            widget._impl.value = value
            button._impl.update_cb[0](Click())
            page.attend()
            assert (len(said) == 1 and "finite" in said[0]) or "outside" in said[0]
            said.clear()
    controls.speed._impl.value = "as fast as can be"
    controls.speed._impl.update_cb[0](Click())
    for north in (math.inf, math.nan, 1e7):
        page.ask(lambda north=north: pilot.go_to(north, 0.0))  # type: ignore[misc]
    page.ask(lambda: pilot.set_parameter("SIM_WIND_SPD", math.nan))
    page.ask(lambda: pilot.set_parameter("SIM_WIND_SPD", 1e39))
    page.ask(lambda: [][0])  # an error of ours
    page.attend()
    assert len(said) == 7 and "speed-up 'as fast as can be'" in said[0] and "IndexError" in said[-1]
    for slider in controls.sticks.sliders.values():
        slider._impl.value = math.nan
    controls.sticks.held.value = True
    page.attend()
    assert "not a finite number" in said[-1]
    fly(page, 1.0)
    assert page.simulation.time_us == 2_000_000


def test_requests_that_nobody_has_time_for_are_refused(live: tuple[LivePage, Browser]) -> None:
    page, _ = live
    said: list[str] = []
    page.notify = lambda text, client=None, title="": said.append(text)  # type: ignore[method-assign]
    done: list[int] = []
    for k in range(MOST_REQUESTS + 5):
        page.ask(lambda k=k: done.append(k))  # type: ignore[misc]
    assert said == [f"{MOST_REQUESTS} requests wait for the vehicle already"] * 5
    page.attend()
    assert done == list(range(MOST_REQUESTS))


def test_a_message_that_is_too_long_closes_the_connection(live: tuple[LivePage, Browser]) -> None:
    _, browser = live
    browser.socket.send(b"\x00" * (LONGEST + 1))
    with pytest.raises(Exception, match="1009"):
        while True:
            browser.socket.recv(timeout=60.0)


def test_what_a_browser_may_do_passes(live: tuple[LivePage, Browser], notes: Notes) -> None:
    page, browser = live
    assert page.controls is not None
    seen = threading.Event()
    page.controls.height.on_update(lambda event: seen.set())
    browser.send(CLICK)
    browser.set(page.plots._search._impl.uuid, "ATTITUDE")
    browser.set(page.controls.arm._impl.uuid, True)
    browser.set(page.controls.height._impl.uuid, 7)
    assert browser.wait(notes) == [] and seen.wait(60.0)
    assert page.controls.height.value == 7.0 and page.plots._search.value == "ATTITUDE"


@pytest.mark.parametrize("kind", ["flights", "fleet", "environment"])
def test_other_pages_refuse_it_too(kind: str, notes: Notes, capfd: pytest.CaptureFixture[str]) -> None:
    page: Any
    if kind == "flights":
        page = FlightPage([of_track("one", track())])
    elif kind == "fleet":
        page = FleetPage(Fleet("erle_copter", 3, seed=5))
    else:
        env = gym.make("GazeboCircuit2TurtlebotLIDAR-v0")
        page = EnvPage(env.unwrapped.session, "circuit")  # type: ignore[attr-defined]
    try:
        browser = Browser(page)
        harass(page, browser, notes, capfd)
        browser.socket.close()
    finally:
        page.close()
