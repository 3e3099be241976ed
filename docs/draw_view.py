# SPDX-License-Identifier: BSD-3-Clause
"""``python docs/draw_view.py``: flies what images/view.gif shows, a mission in wind, and films the page in a browser
(chromium, chromedriver, selenium), picture by picture in simulated time."""

from __future__ import annotations

import shutil
from io import BytesIO
from pathlib import Path
from typing import Any

from PIL import Image
from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

from sitl import Simulation
from sitl.client import Client
from sitl.run.pacing import StoppablePacing
from sitl.view import page as pages
from sitl.view.cameras import FREE
from sitl.view.live_page import LivePage

IMAGES = Path(__file__).parent / "images"
WIDTH, HEIGHT = 860, 480
"""Of the window [pixels]."""
STEP, LONGEST_S = 0.06, 12.0
"""From one picture to the next, and all of them at most [s]: of simulated time and of the film."""
COLOURS = 200
COURSE = ((1.6, 0.0, 1.6), (1.6, 3.0, 2.4), (-1.4, 3.0, 1.6), (-1.4, 0.0, 2.4))
"""North, east, height of the mission's waypoints [m]; they are flown again and again."""
FIELD = 1.0
"""Vertical field of view of the film [rad]."""
PATIENCE_S = 120.0


def browser() -> Any:
    """A headless one that needs no graphics card."""
    options = Options()
    options.binary_location = shutil.which("chromium") or ""
    for word in (
        "headless=new", "no-sandbox", "disable-dev-shm-usage", "use-angle=swiftshader", "enable-unsafe-swiftshader",
    ):  # fmt: skip
        options.add_argument(f"--{word}")
    driver = webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))
    size = {"width": WIDTH, "height": HEIGHT, "deviceScaleFactor": 1, "mobile": False}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    return driver


class Stage:
    """A copter on a page that a browser shows."""

    def __init__(self) -> None:
        pages.SHARE = 1.0  # nothing else has to go on meanwhile
        params = {"SIM_WIND_SPD": 4.0, "SIM_WIND_DIR": 200.0, "WPNAV_SPEED": 160.0, "WPNAV_RADIUS": 40.0}
        self.simulation = Simulation("erle_copter", seed=4, params=params)
        self.vehicle = vehicle = Client(self.simulation)
        vehicle.wait_ready()
        items = [vehicle.item("NAV_WAYPOINT"), vehicle.item("NAV_TAKEOFF", altitude=COURSE[0][2])]  # home comes first
        items += [vehicle.item("NAV_WAYPOINT", *place) for place in COURSE]
        vehicle.upload([*items, vehicle.item("DO_JUMP", param1=2, param2=9)])
        self.page = LivePage(self.simulation, StoppablePacing(1.0))
        self._mark = self.page.server.gui.add_html("")
        self._shown = 0
        self.driver = browser()
        self.driver.get(self.page.address)
        self.wait(lambda: self.page.is_seen)
        for each in self.driver.find_elements(By.XPATH, "//*[contains(@class, 'Notification')]//button"):
            each.click()

    def wait(self, holds: Any) -> None:
        """Until something holds."""
        WebDriverWait(self.driver, PATIENCE_S, 0.02).until(lambda _: holds())

    def look(self, eye: tuple[float, float, float], at: tuple[float, float, float]) -> None:
        """From a place to another, of the scene, from now on."""
        self.page.view.value = FREE
        for client in self.page.server.get_clients().values():
            client.camera.position, client.camera.look_at, client.camera.fov = eye, at, FIELD

    def picture(self) -> Image.Image:
        """The page with the vehicle as it is now."""
        self._shown += 1
        self.page.capture(1.0)
        self.page.wait_drawn()
        self._mark.content = f'<i id="shown{self._shown}"></i>'
        self.wait(lambda: self.driver.find_elements(By.ID, f"shown{self._shown}"))
        return Image.open(BytesIO(self.driver.get_screenshot_as_png())).convert("RGB")

    def close(self) -> None:
        """End it."""
        self.driver.quit()
        self.page.close()


def film(stage: Stage) -> None:
    """A lap of the mission as a GIF."""
    vehicle = stage.vehicle
    vehicle.arm()
    vehicle.start_mission()
    vehicle.wait(lambda _: vehicle.reached.count(2) == 1, 120.0, "the first waypoint")
    stage.look((-4.6, 1.2, 3.4), (0.1, -1.3, 1.5))
    stage.picture()
    pictures = []
    while vehicle.reached.count(2) == 1 and len(pictures) * STEP < LONGEST_S:
        vehicle.delay(STEP)
        pictures.append(stage.picture())
    path = IMAGES / "view.gif"
    write(pictures, path)
    print(f"{path}: {len(pictures)} pictures, {path.stat().st_size} bytes")


def write(pictures: list[Image.Image], path: Path) -> None:
    """As a GIF: all have the colours of four of them, and of each only what has changed is kept."""
    few = Image.new("RGB", (WIDTH, 4 * HEIGHT))
    for k in range(4):
        few.paste(pictures[k * (len(pictures) - 1) // 3], (0, k * HEIGHT))
    palette = few.quantize(COLOURS, Image.Quantize.MEDIANCUT)
    first, *others = [each.quantize(palette=palette, dither=Image.Dither.NONE) for each in pictures]
    first.save(path, save_all=True, append_images=others, duration=round(1000.0 * STEP), loop=0, optimize=True)


def main() -> None:
    """Film it."""
    stage = Stage()
    try:
        film(stage)
    finally:
        stage.close()


if __name__ == "__main__":
    main()
