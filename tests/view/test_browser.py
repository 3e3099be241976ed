# SPDX-License-Identifier: BSD-3-Clause
"""A real browser, headless: the page loads, its buttons arm and take off, a click on the ground sends the copter there;
kept flights are gone through, and files with a scene open from disk.

What is asked is what the page says and where the vehicle is, never pixels. Skipped where there is no browser.
"""

from __future__ import annotations

import math
import re
import shutil
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from sitl import Simulation
from sitl.run.pacing import StoppablePacing
from sitl.run.runner import serve
from sitl.run.watched import Watched
from sitl.simulation import Core

pytest.importorskip("viser", reason="the page needs viser: pip install 'gym-sitl[view]'")
pytest.importorskip("selenium", reason="browsers are driven by selenium: pip install 'gym-sitl[test]'")
from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

from sitl.missions.comparison import flight
from sitl.missions.view import together
from sitl.view import page_library
from sitl.view.axes import to_scene
from sitl.view.flight_page import FlightPage
from sitl.view.live_page import LivePage

CHROMIUM, DRIVER = shutil.which("chromium") or shutil.which("chromium-browser"), shutil.which("chromedriver")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not (CHROMIUM and DRIVER), reason="no chromium, chromedriver (apt-get install chromium-driver)"),
]
GOLDEN = Path(__file__).parents[1] / "golden" / "golden"
PATIENCE_S = 120.0
"""A busy machine draws slowly without a graphics card."""


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    options = Options()
    options.binary_location = str(CHROMIUM)
    for word in ("headless=new", "no-sandbox", "disable-dev-shm-usage", "window-size=900,600"):
        options.add_argument(f"--{word}")
    for word in ("use-angle=swiftshader", "enable-unsafe-swiftshader"):  # no graphics card is needed
        options.add_argument(f"--{word}")
    driver = webdriver.Chrome(options=options, service=Service(DRIVER))
    yield driver
    driver.quit()


class Served:
    """A run with a page, in a thread of its own."""

    def __init__(self, simulation: Simulation) -> None:
        self.pace = StoppablePacing(4.0)
        self.page = LivePage(simulation, self.pace)
        watched = Watched(self.page, lambda: simulation.time_us)
        self._stops = threading.Event()
        run = {"pace": self.pace, "running": lambda: not self._stops.is_set(), "on_slice": watched}
        self._thread = threading.Thread(target=serve, args=(simulation,), kwargs=run)
        self._thread.start()

    def close(self) -> None:
        self._stops.set()
        self._thread.join()
        self.page.close()


@pytest.fixture
def served(core: Core) -> Iterator[Served]:
    simulation = Simulation("erle_copter", core=core, seed=3)
    simulation.advance(60.0)
    served = Served(simulation)
    yield served
    served.close()


def text(browser: Any) -> str:
    return str(browser.find_element(By.TAG_NAME, "body").text)


def until(browser: Any, holds: Any) -> None:
    WebDriverWait(browser, PATIENCE_S).until(lambda _: holds())


def choose_tab(browser: Any, name: str) -> None:
    browser.find_element(By.XPATH, f"//*[@role='tab'][contains(., '{name}')]").click()


def click(browser: Any, label: str) -> None:
    WebDriverWait(browser, PATIENCE_S).until(
        lambda _: browser.find_element(By.XPATH, f"//button[contains(., '{label}')]").is_displayed()
    )
    browser.find_element(By.XPATH, f"//button[contains(., '{label}')]").click()


def test_a_pilot_flies_from_the_page(browser: Any, served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    page = served.page
    refused: list[str] = []
    monkeypatch.setattr(page_library, "note", lambda client, text, title="": refused.append(text))
    browser.get(page.address)
    until(browser, lambda: "erle_copter" in text(browser) and "STABILIZE" in text(browser))
    assert page.is_seen and "disarmed" in text(browser)

    choose_tab(browser, "Control")
    click(browser, "Take off")
    until(browser, lambda: page.frame is not None and -page.frame.pos.z > 8.0)
    choose_tab(browser, "Flight")
    until(browser, lambda: "GUIDED" in text(browser) and "ARMED" in text(browser))
    frame = page.frame
    assert frame is not None

    canvas = browser.find_element(By.TAG_NAME, "canvas")
    ActionChains(browser).move_to_element_with_offset(canvas, 60, 90).click().perform()
    until(browser, lambda: page.frame is not None and math.dist(page.frame.pos, frame.pos) > 3.0)

    choose_tab(browser, "Control")
    click(browser, "Stop time")
    until(browser, lambda: served.pace.is_stopped)
    stopped = page.simulation.time_us
    click(browser, "One step")
    until(browser, lambda: page.simulation.time_us != stopped)
    assert page.simulation.time_us == stopped + 100_000

    choose_tab(browser, "Flight")
    until(browser, lambda: shown_place(browser) is not None)
    until(browser, lambda: math.dist(shown_place(browser), page.simulation.v.physics.body.pos[:2]) < 0.15)
    told = page.simulation.v.autopilot.estimate.pos
    assert math.dist(shown_place(browser), told[:2]) < 4.0, "as LOCAL_POSITION_NED has it, but for a receiver's error"
    served.pace.go_on()
    assert refused == [], "what the library's own page sends passes"


def shown_place(browser: Any) -> Any:
    found = re.findall(r"(-?[\d.]+) N, (-?[\d.]+) E", text(browser))  # the vehicle's, then the true one
    return None if len(found) != 2 else tuple(map(float, found[1]))


def test_two_browsers_see_the_same_and_one_that_leaves_changes_nothing(browser: Any, served: Served) -> None:
    browser.get(served.page.address)
    until(browser, lambda: "STABILIZE" in text(browser))
    browser.switch_to.new_window("window")
    browser.get(served.page.address)
    until(browser, lambda: "STABILIZE" in text(browser) and len(served.page.server.get_clients()) == 2)
    first, second = browser.window_handles
    browser.switch_to.window(first)
    served.page.ask(lambda: served.page.pilot.set_mode("ALT_HOLD"))
    for window in (first, second):
        browser.switch_to.window(window)
        until(browser, lambda: "ALT_HOLD" in text(browser))
    browser.close()
    browser.switch_to.window(browser.window_handles[0])
    until(browser, lambda: len(served.page.server.get_clients()) == 1)
    before = served.page.simulation.time_us
    until(browser, lambda: served.page.simulation.time_us > before + 1_000_000)


@pytest.fixture(scope="module")
def flights() -> Iterator[FlightPage]:
    found = [flight.read(GOLDEN / f"copter-circles{name}.rec") for name in ("", "-wind")]
    page = FlightPage(*together(found))
    yield page
    page.close()


def test_going_through_flights_shows_the_state_of_that_time(browser: Any, flights: FlightPage) -> None:
    browser.get(flights.address)
    until(browser, lambda: "apart at 0.0 s" in text(browser))
    number = next(each for each in browser.find_elements(By.TAG_NAME, "input") if each.is_displayed())
    number.click()
    number.send_keys(Keys.CONTROL, "a")
    number.send_keys("60", Keys.TAB)
    until(browser, lambda: "apart at 60.0 s" in text(browser))
    one, two = (each.frame(60.0) for each in flights.flights)
    assert f"{math.dist(one.pos, two.pos):.2f} m apart at 60.0 s" in text(browser)
    for frame, nodes in zip((one, two), flights.scene.vehicles, strict=True):
        assert f"{-frame.pos.z:.1f} m" in text(browser)
        assert tuple(nodes.body.position) == pytest.approx(to_scene(frame.pos))
    click(browser, "Play")
    until(browser, lambda: flights.player.time > 61.0)
    click(browser, "Stop")
    until(browser, lambda: not flights.player.is_playing)


def test_a_comparison_opens_from_disk_and_plays(browser: Any, flights: FlightPage, tmp_path: Path) -> None:
    file = tmp_path / "flights.html"
    flights.save(file, 60)
    browser.get(file.as_uri())
    until(browser, lambda: browser.find_elements(By.TAG_NAME, "canvas"))

    def clock() -> float:
        values = [each.get_attribute("value") or "" for each in browser.find_elements(By.TAG_NAME, "input")]
        return max((float(value) for value in values if re.fullmatch(r"[\d.]+", value)), default=0.0)

    until(browser, lambda: clock() > 0.0)
    before = clock()
    until(browser, lambda: clock() > before)
    loaded = browser.execute_script("return performance.getEntriesByType('resource').map(each => each.name)")
    assert not [name for name in loaded if name.startswith(("http", "ws"))], "all of it is in the file"
