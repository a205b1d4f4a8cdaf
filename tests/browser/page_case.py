"""What the cases about pages in a browser are made of."""

import csv
import json
import pathlib
import subprocess
import sys
import unittest

try:
    from selenium import webdriver
    from selenium.common.exceptions import WebDriverException
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
    from selenium.webdriver.chrome.service import Service
except ImportError:
    print("SKIPPED: python3-selenium is not installed")
    sys.exit(0)

CHROMIUM = pathlib.Path("/usr/bin/chromium")
CHROMEDRIVER = pathlib.Path("/usr/bin/chromedriver")


def start_browser():
    options = webdriver.ChromeOptions()
    options.binary_location = str(CHROMIUM)
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                     "--window-size=1100,1000"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service(str(CHROMEDRIVER)), options=options)


def run(*arguments):
    done = subprocess.run([PageCase.program, *map(str, arguments), "--quiet"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"waymark {arguments}: {done.returncode}: {done.stderr}")


class PageCase(unittest.TestCase):
    """A folder of pages, opened in one browser for all cases. `main` sets the program and its source folder."""

    program = ""
    source = pathlib.Path()
    browser = None
    figures = None

    def setUp(self):
        self.screen(1100, 1000, mobile=False)

    def open(self, page):
        self.browser.get((self.folder / page).as_uri())
        self.figures = None
        self.assertEqual(self.browser.get_log("browser"), [])

    def part(self, name, selector):
        """An element of the drawing that is shown. The page is not scrolled: the pointer would leave its figure."""
        return self.shown(name).find_element(By.CSS_SELECTOR, selector)

    def shown(self, name):
        """The drawing of a figure that this screen shows."""
        drawings = self.browser.find_elements(By.CSS_SELECTOR, f"#{name} > svg")
        return next(svg for svg in drawings if svg.is_displayed())

    def figure(self, name):
        """The same, in sight."""
        element = self.shown(name)
        self.browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", element)
        return element

    def settle(self):
        """Two pictures later all drawing is done."""
        self.browser.execute_async_script(
            "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(done));")

    def view(self, name):
        """Low and high of x and y."""
        self.settle()
        return [float(v) for v in self.browser.find_element(By.ID, name).get_attribute("data-view").split()]

    def data(self, name):
        if self.figures is None:  # of the page that is open
            text = self.browser.execute_script("return document.getElementById('page-data').textContent")
            self.figures = json.loads(text)["figures"]
        return self.figures[name]

    def box(self, name):
        """The plot in the drawing that is shown, px of the drawing."""
        classes = self.shown(name).get_attribute("class").split()
        return next(drawn["box"] for screen, drawn in self.data(name)["drawings"].items() if screen in classes)

    def scale(self, name):
        """CSS px per px of the drawing."""
        return self.browser.execute_script(
            "const s = arguments[0]; return s.getBoundingClientRect().width / s.viewBox.baseVal.width", self.figure(name))

    def move_to(self, name, x, y):
        """The pointer to a place of the drawing, px."""
        svg = self.figure(name)
        size, scale = svg.size, self.scale(name)
        return ActionChains(self.browser, duration=0).move_to_element_with_offset(
            svg, round(x * scale - size["width"] / 2), round(y * scale - size["height"] / 2))

    def wheel(self, name, x, y, turn):
        svg = self.figure(name)
        size, scale = svg.size, self.scale(name)
        origin = ScrollOrigin.from_element(svg, round(x * scale - size["width"] / 2),
                                           round(y * scale - size["height"] / 2))
        ActionChains(self.browser).scroll_from_origin(origin, 0, turn).perform()
        self.settle()

    def middle(self, name):
        left, top, width, height = self.box(name)
        return left + width / 2, top + height / 2

    def place(self, name, x, y):
        """Of a point of the data in the drawing, for linear axes."""
        return self.places(name, [(x, y)])[0]

    def places(self, name, points):
        left, top, width, height = self.box(name)
        low_x, high_x, low_y, high_y = self.view(name)
        return [(left + width * (x - low_x) / (high_x - low_x), top + height * (1 - (y - low_y) / (high_y - low_y)))
                for x, y in points]

    def rows(self, page, figure):
        path = (self.folder / page).parent / "figures" / f"{pathlib.Path(page).stem}-{figure}.csv"
        with path.open(encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def tip(self, name):
        return self.browser.find_element(By.ID, name).find_element(By.CLASS_NAME, "tip").text

    def wake(self, name):
        """Draws once by the script, so that data-view tells the view at rest."""
        self.figure(name).send_keys("0")
        return self.view(name)

    def screen(self, width, height, mobile):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                     {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": mobile})

    def narrow(self, width=400, height=800):
        self.screen(width, height, mobile=True)

    def scheme(self, name):
        """"light" or "dark"."""
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                     {"features": [{"name": "prefers-color-scheme", "value": name}]})
        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.setEmulatedMedia", {"features": []})


def main():
    """Runs the cases of the calling script: SCRIPT PROGRAM SOURCE_FOLDER [CLASS.CASE ...]."""
    if not CHROMIUM.exists() or not CHROMEDRIVER.exists():
        print("SKIPPED: chromium and chromium-driver are not installed")
        sys.exit(0)
    PageCase.program, PageCase.source = sys.argv[1], pathlib.Path(sys.argv[2])
    try:
        PageCase.browser = start_browser()
    except WebDriverException as error:  # a container may forbid what a browser needs
        print("SKIPPED: Chromium does not start here:", error.msg.splitlines()[0])
        sys.exit(0)
    PageCase.browser.set_script_timeout(60)
    with PageCase.browser:
        unittest.main(module="__main__", argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
