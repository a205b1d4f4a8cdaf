"""The report on screens of any width, by keyboard alone, without truth, and over a map.

Usage: screens_test.py PROGRAM SOURCE_FOLDER   (ctest calls it)
"""

import csv
import json
import os
import pathlib
import re
import shutil
import tempfile

from page_case import ActionChains, By, Keys, PageCase, main, run

SCREENS = ((1400, 900), (900, 900), (360, 800))


def without_truth(source, target):
    """Copies a drive; its drive.yaml loses the section "truth", and its fixes get a quality."""
    shutil.copytree(source, target)
    text = (target / "drive.yaml").read_text(encoding="utf-8")
    text = text[:text.index("\ntruth:")].replace("    height: h_m\n", "    height: h_m\n    quality: quality\n", 1)
    (target / "drive.yaml").write_text(text, encoding="utf-8")
    log = target / "gnss_5hz.csv"
    lines = log.read_text(encoding="utf-8").splitlines()
    told = [lines[0] + ",quality"] + [f"{line},{'RTK float' if 200 < i < 400 else 'single'}" for i, line in enumerate(lines[1:])]
    log.write_text("\n".join(told) + "\n", encoding="utf-8")


def write_map(epochs, path):
    """Roads along and across a drive, houses beside it, and some far away."""
    with epochs.open(encoding="utf-8") as file:
        places = [(float(r["fused_longitude_deg"]), float(r["fused_latitude_deg"])) for r in csv.DictReader(file)]

    def feature(kind, coordinates, **tags):
        return {"type": "Feature", "properties": tags, "geometry": {"type": kind, "coordinates": coordinates}}

    def house(x, y):
        return [[[x, y], [x + 2e-4, y], [x + 2e-4, y + 1e-4], [x, y + 1e-4], [x, y]]]

    features = [feature("LineString", places, highway="primary"), feature("LineString", [[13.0, 52.4], [13.1, 52.4]])]
    features += [feature("Polygon", house(x + 3e-4, y), building="yes") for x, y in places[::10]]
    features.append(feature("Polygon", house(14, 53), building="yes"))
    path.write_text(json.dumps({"type": "FeatureCollection", "features": features}), encoding="utf-8")


class Screens(PageCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="waymark_screens_"))
        bundled = cls.source / "examples/berlin_potsdamer_platz"
        run("run", bundled / "drive.yaml", "-o", cls.folder / "true", "-m", "g2")
        write_map(cls.folder / "true/g2.epochs.csv", cls.folder / "town.geojson")
        without_truth(bundled, cls.folder / "drive")
        for modeling in ("g1", "correlated"):
            run("run", cls.folder / "drive/drive.yaml", "-o", cls.folder / modeling, "-m", modeling,
                "--map", cls.folder / "town.geojson", "--no-gate")
        run("compare", cls.folder / "true", cls.folder / "g1", "-o", cls.folder / "compared")
        cls.all_pages = ("true/report.html", "g1/report.html", "correlated/report.html", "compared/comparison.html")

    # Any screen.

    def test_nothing_but_wide_tables_is_pushed_sideways(self):
        for width, height in SCREENS:
            self.screen(width, height, mobile=width < 600)
            for page in self.all_pages:
                with self.subTest(page=page, width=width):
                    self.open(page)
                    self.assertLessEqual(self.browser.execute_script("return document.documentElement.scrollWidth"), width)
                    pushed = self.browser.execute_script(
                        "return [...document.querySelectorAll('body *')].filter((e) => e.scrollWidth > e.clientWidth + 1 &&"
                        " ['auto', 'scroll'].includes(getComputedStyle(e).overflowX) && !e.querySelector('table'))"
                        ".map((e) => e.outerHTML.slice(0, 80))")
                    self.assertEqual(pushed, [])
                    outside = self.browser.execute_script(
                        "return [...document.querySelectorAll('figure > svg')].map((s) => s.getBoundingClientRect())"
                        ".filter((b) => b.width > 0 && b.right > innerWidth).length")
                    self.assertEqual(outside, 0)

    def test_letters_of_drawings_have_the_size_of_letters_on_every_screen(self):
        for width, height in SCREENS:
            self.screen(width, height, mobile=width < 600)
            for page in self.all_pages:
                self.open(page)
                sizes = self.browser.execute_script(
                    "return [...document.querySelectorAll('figure > svg')].filter((s) => s.getBoundingClientRect().width > 0)"
                    ".map((s) => [s.getBoundingClientRect().width / s.viewBox.baseVal.width * 12, s.closest('figure').id])")
                self.assertGreater(len(sizes), 3)
                for size, name in sizes:
                    self.assertGreater(size, 9, (page, width, name))
                    self.assertLess(size, 17, (page, width, name))

    def test_a_large_screen_is_used_and_shows_the_whole_map(self):
        self.screen(1400, 900, mobile=False)
        self.open("true/report.html")
        box = self.browser.execute_script(
            "const b = arguments[0].getBoundingClientRect(); return [b.width, b.height]", self.figure("trajectory"))
        self.assertGreater(box[0], 1300)
        self.assertLess(box[1], 800)

    def test_a_screen_that_is_turned_keeps_what_was_looked_at(self):
        self.open("true/report.html")
        self.wake("trajectory")
        self.figure("trajectory").send_keys(Keys.HOME, *"++++++")
        before = self.view("trajectory")
        self.narrow()
        self.settle()
        after = self.view("trajectory")
        self.assertAlmostEqual(after[0], before[0], places=3)
        self.assertAlmostEqual(after[1], before[1], places=3)
        self.assertAlmostEqual(after[2] + after[3], before[2] + before[3], places=3)
        left, top, width, height = self.box("trajectory")
        self.assertAlmostEqual((after[1] - after[0]) / width, (after[3] - after[2]) / height, places=6)

    def test_one_finger_moves_a_map(self):
        self.narrow()
        self.browser.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 1})
        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.setTouchEmulationEnabled", {"enabled": False})
        self.open("true/report.html")
        before = self.wake("trajectory")
        y = self.browser.execute_script(
            "const b = arguments[0].getBoundingClientRect(); return b.top + b.height / 2", self.figure("trajectory"))

        def touch(kind, *points):
            self.browser.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": list(points)})

        touch("touchStart", {"x": 150, "y": y})
        for x in (170, 190, 210):
            touch("touchMove", {"x": x, "y": y + x - 150})
        touch("touchEnd")
        after = self.view("trajectory")
        per_px = (before[1] - before[0]) / self.box("trajectory")[2] / self.scale("trajectory")
        self.assertAlmostEqual(after[0] - before[0], -60 * per_px, delta=3 * per_px)
        self.assertAlmostEqual(after[2] - before[2], 60 * per_px, delta=3 * per_px)

    # The keyboard alone.

    def focused(self):
        return self.browser.execute_script(
            "const e = document.activeElement; return e === document.body ? '' : (e.tagName + '.' + "
            "(e.getAttribute('class') || '') + (e.closest('figure') ? ' in ' + e.closest('figure').id : ''))")

    def press(self, *keys):
        ActionChains(self.browser, duration=0).send_keys(*keys).perform()

    def tab_to(self, wanted):
        """Tabs on until the focus is on what is wanted; every stop must be in sight and have an outline."""
        for _ in range(400):
            self.press(Keys.TAB)
            if re.search(wanted, self.focused()):
                return
        self.fail(f"no tab leads to {wanted}")

    def test_every_control_is_reached_by_tabs(self):
        self.open("g1/report.html")
        wanted = self.browser.execute_script(
            "return [...document.querySelectorAll('a[href], button, select, summary, abbr, figure > svg[role=group], .entry, .scroll')]"
            ".filter((e) => e.getBoundingClientRect().width > 0 && e.closest('details:not([open]) > :not(summary)') === null)"
            ".map((e, i) => { e.dataset.wanted = i; return i; })")
        reached = set()
        for _ in range(len(wanted) + 50):
            self.press(Keys.TAB)
            reached.add(self.browser.execute_script("return document.activeElement.dataset.wanted || ''"))
        missed = [i for i in wanted if str(i) not in reached]
        names = [self.browser.execute_script(f"return document.querySelector('[data-wanted=\"{i}\"]').outerHTML.slice(0, 90)")
                 for i in missed]
        self.assertEqual(names, [])

    def test_a_map_is_read_moved_and_coloured_without_a_pointer(self):
        self.open("true/report.html")
        self.tab_to(r"svg\.plot .* in trajectory")
        self.press(Keys.END)
        self.settle()
        told = self.tip("trajectory")
        self.assertRegex(told, r"\d+\.\d{7}, \d+\.\d{7}")
        self.assertIn("UTC", told)
        end = float(told.split()[0])
        self.press(Keys.ARROW_LEFT)
        self.assertLess(float(self.tip("trajectory").split()[0]), end)
        before = self.wake_view("trajectory")
        self.press("+", "+")
        zoomed = self.view("trajectory")
        self.assertAlmostEqual((zoomed[1] - zoomed[0]) / (before[1] - before[0]), 0.49, places=3)
        self.press("d", "w")
        moved = self.view("trajectory")
        self.assertAlmostEqual(moved[0] - zoomed[0], 0.2 * (zoomed[1] - zoomed[0]), delta=0.01)
        self.assertAlmostEqual(moved[2] - zoomed[2], 0.2 * (zoomed[3] - zoomed[2]), delta=0.01)
        # A cursor that leaves what is seen takes the view along.
        self.press(Keys.HOME)
        self.settle()
        x = float(self.part("trajectory", ".cursor circle.look-fused").get_attribute("cx"))
        left, _, width, _ = self.box("trajectory")
        self.assertTrue(left <= x <= left + width)
        self.press("0")
        self.assertEqual(self.view("trajectory"), before)
        self.tab_to(r"g\.entry in trajectory")
        self.press(Keys.ENTER)
        self.assertEqual(self.browser.switch_to.active_element.get_attribute("aria-pressed"), "false")
        self.tab_to(r"SELECT.*in trajectory")
        self.press("colour: error")
        self.settle()
        self.assertGreater(len(self.figure("trajectory").find_elements(By.CSS_SELECTOR, "path.colour")), 0)
        self.tab_to(r"SUMMARY")
        self.press(Keys.ENTER)
        self.assertIsNotNone(self.browser.find_element(By.CSS_SELECTOR, "details[open]"))

    def wake_view(self, name):
        self.press("0")
        return self.view(name)

    def test_a_word_is_explained_to_the_keyboard(self):
        self.open("true/report.html")
        self.tab_to(r"ABBR")
        shown = self.browser.execute_script("return getComputedStyle(document.activeElement, '::after').content")
        self.assertGreater(len(shown), 10)

    # Without truth.

    def test_without_truth_the_verdict_predicts_fixes_and_judges_sigmas(self):
        for modeling in ("g1", "correlated"):
            self.open(f"{modeling}/report.html")
            verdict = self.browser.find_element(By.CLASS_NAME, "verdict").text
            self.assertRegex(verdict, r"A second fusion predicts \d+ fixes")
            self.assertIn("stated sigma of the positions", verdict)
            titles = [h.text for h in self.browser.find_elements(By.TAG_NAME, "h2")]
            self.assertIn("Stated errors", titles)
            for figure in ("sigma", "sigma-heading", "fix-residuals", "speed"):
                self.assertTrue(self.figure(figure).is_displayed())
            held = [r for r in self.rows(f"{modeling}/report.html", "fix-residuals") if r["series"] == "kept out"]
            self.assertGreaterEqual(len(held), 10)
        self.open("g1/report.html")
        self.assertRegex(self.browser.find_element(By.CLASS_NAME, "verdict").text, r"The mean NIS is [\d.]+, and 2 is right")
        self.assertTrue(self.figure("nis").is_displayed())
        self.open("correlated/report.html")
        self.assertIn("68 % between", self.browser.find_element(By.ID, "noise").text)

    def test_without_truth_the_first_telephone_screen_has_the_verdict(self):
        self.narrow(360, 800)
        self.open("correlated/report.html")
        verdict = self.browser.find_element(By.CLASS_NAME, "verdict")
        self.assertIn("RMSE", verdict.text)
        self.assertLess(verdict.rect["y"] + verdict.rect["height"], 800)

    def test_axe_finds_no_violation_without_truth_and_over_a_map(self):
        """axe-core of npm, if WAYMARK_AXE names its minified script (tests/README.md)."""
        if not os.environ.get("WAYMARK_AXE"):
            self.skipTest("WAYMARK_AXE names no axe.min.js")
        script = pathlib.Path(os.environ["WAYMARK_AXE"]).read_text(encoding="utf-8")
        for scheme in ("light", "dark"):
            self.scheme(scheme)
            for width, height in SCREENS:
                self.screen(width, height, mobile=width < 600)
                for page in self.all_pages:
                    self.open(page)
                    self.browser.execute_script(script)
                    found = self.browser.execute_async_script(
                        "const done = arguments[0]; axe.run().then((result) => done(result.violations.map("
                        "(v) => v.id + ': ' + v.nodes.slice(0, 3).map((n) => n.html.slice(0, 160)).join(' | '))))")
                    self.assertEqual(found, [], f"{page}, {scheme}, {width} px")

    # The map.

    def test_a_map_lies_beneath_the_trajectory_and_moves_with_it(self):
        self.open("g1/report.html")
        self.assertEqual(self.browser.execute_script("return performance.getEntriesByType('resource').length"), 0)
        names = [series["name"] for series in self.data("trajectory")["series"]]
        self.assertEqual(names[:2], ["buildings", "roads"])
        self.assertLess(names.index("roads"), names.index("raw GNSS"))
        self.assertGreater(names.index("fused"), names.index("raw GNSS"))
        road = [r for r in self.rows("g1/report.html", "trajectory") if r["series"] == "roads"]
        self.assertGreater(len(road), 50)
        self.wake("trajectory")
        for _ in range(2):
            drawn = self.part("trajectory", ".marks .line.look-road").get_attribute("d")
            points = [tuple(map(float, pair.split())) for pair in re.findall(r"[ML]([-\d. ]+)", drawn)]
            left, top, width, height = self.box("trajectory")
            expected = self.places("trajectory", [(float(r["east [m]"]), float(r["north [m]"])) for r in road if r["east [m]"]])
            inside = [(x, y) for x, y in expected if left < x < left + width and top < y < top + height]
            self.assertGreater(len(inside), 3)
            for x, y in inside:
                self.assertTrue(any(abs(x - a) < 1 and abs(y - b) < 1 for a, b in points), (x, y))
            self.figure("trajectory").send_keys("+++")
            self.settle()
        houses = self.part("trajectory", ".marks .areas.look-building").get_attribute("d")
        self.assertGreater(houses.count("Z"), 0)
        # The map has no time and no place in the tip: the cursor stays with the drive.
        self.figure("trajectory").send_keys("0")
        self.move_to("trajectory", *self.middle("trajectory")).perform()
        self.assertNotIn("roads", self.tip("trajectory"))

    def test_dead_reckoning_is_a_track_that_does_not_widen_the_map(self):
        self.open("true/report.html")
        series = {s["name"]: s for s in self.data("trajectory")["series"]}
        self.assertIn("dead reckoning", series)
        rows = self.rows("true/report.html", "trajectory")
        alone = [r for r in rows if r["series"] == "dead reckoning"]
        fused = [r for r in rows if r["series"] == "fused"]
        # It begins at the first fix of the fused trajectory, and drifts away from it.
        begin = min(fused, key=lambda r: abs(float(r["time [s]"]) - float(alone[0]["time [s]"])))
        end = min(fused, key=lambda r: abs(float(r["time [s]"]) - float(alone[-1]["time [s]"])))
        apart = [max(abs(float(a[key]) - float(b[key])) for key in ("east [m]", "north [m]"))
                 for a, b in ((alone[0], begin), (alone[-1], end))]
        self.assertLess(apart[0], 0.01)
        self.assertGreater(apart[1], 5)
        self.assertIsNotNone(self.part("trajectory", ".marks .line.look-third").get_attribute("d"))

    def test_the_trajectory_is_coloured_by_the_quality_of_the_fixes(self):
        self.open("g1/report.html")
        self.wake("trajectory")
        select = self.browser.find_element(By.CSS_SELECTOR, "#trajectory select.colour-by")
        select.send_keys("colour: fix quality")
        self.settle()
        paths = self.figure("trajectory").find_elements(By.CSS_SELECTOR, "path.colour")
        self.assertEqual(len([path for path in paths if path.get_attribute("d")]), 2)
        scale = self.browser.find_element(By.CSS_SELECTOR, "#trajectory .colour-scale").text
        self.assertIn("single", scale)
        self.assertIn("float", scale)


if __name__ == "__main__":
    main()
