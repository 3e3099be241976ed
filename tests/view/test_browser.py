# SPDX-License-Identifier: BSD-3-Clause
"""A real browser, headless: the page loads, its buttons arm and take off, a click on the ground sends the copter there.

What is asked is what the page says and where the vehicle is, never pixels. Skipped where there is no browser.
"""

from __future__ import annotations

import math
import shutil
import threading
from collections.abc import Iterator
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
from selenium.webdriver.support.ui import WebDriverWait

from sitl.view.live_page import LivePage

CHROMIUM, DRIVER = shutil.which("chromium") or shutil.which("chromium-browser"), shutil.which("chromedriver")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not (CHROMIUM and DRIVER), reason="no chromium, chromedriver (apt-get install chromium-driver)"),
]
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


def test_a_pilot_flies_from_the_page(browser: Any, served: Served) -> None:
    page = served.page
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


def test_two_browsers_see_the_same_and_one_that_leaves_changes_nothing(browser: Any, served: Served) -> None:
    browser.get(served.page.address)
    until(browser, lambda: "STABILIZE" in text(browser))
    browser.switch_to.new_window("window")
    browser.get(served.page.address)
    until(browser, lambda: "STABILIZE" in text(browser) and len(served.page.server.get_clients()) == 2)
    browser.close()
    browser.switch_to.window(browser.window_handles[0])
    until(browser, lambda: len(served.page.server.get_clients()) == 1)
    before = served.page.simulation.time_us
    until(browser, lambda: served.page.simulation.time_us > before + 1_000_000)
