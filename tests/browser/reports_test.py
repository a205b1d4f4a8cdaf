"""The program's pages in a real browser (headless Chromium): no errors, and what moves, moves rightly.

Usage: reports_test.py PROGRAM SOURCE_FOLDER   (ctest calls it)
"""

import csv
import itertools
import json
import math
import os
import pathlib
import re
import sys
import tempfile

from page_case import ActionChains, By, Keys, PageCase, main, run

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import raw_gnss_receivers

POSES_OF_LONG_DRIVE = 104949


class Pages(PageCase):
    """What the program writes, opened once for all cases."""

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="waymark_pages_"))
        bundled = cls.source / "examples/berlin_potsdamer_platz/drive.yaml"
        run("run", bundled, "-o", cls.folder / "gated", "-m", "g2")
        run("run", bundled, "-o", cls.folder / "all", "-m", "g1,correlated")
        run("simulate", "--preset", "paper-8", "-o", cls.folder / "simulated")
        run("run", cls.folder / "simulated/drive.yaml", "-o", cls.folder / "long", "-m", "g1")
        run("evaluate", cls.folder / "gated/g2.fused.graph", cls.folder / "all/g1.fused.graph", "--truth", bundled,
            "-o", cls.folder / "evaluated")
        run("compare", cls.folder / "gated", cls.folder / "all", cls.folder / "long", "-o", cls.folder / "compared")
        run("bench", cls.folder / "gated/g2.graph", cls.folder / "all/g1.graph", "-a", "all", "--repeat", "2",
            "-o", cls.folder / "bench")
        raw_gnss_receivers.make_drive(cls.program, "open", 1, 60, cls.folder / "receiver")
        run("run", cls.folder / "receiver/raw.yaml", "-o", cls.folder / "satellites")
        run("reproduce", bundled, "-o", cls.folder / "reproduced")
        run("reproduce", bundled, "--ablation", "-o", cls.folder / "ablation")
        cls.pages = sorted(cls.folder.rglob("*.html"))

    # The cases.

    def test_every_page_loads_alone_and_silently(self):
        names = {str(page.relative_to(self.folder)) for page in self.pages}
        self.assertEqual(names, {"gated/report.html", "all/report.html", "all/g1.html", "all/correlated.html",
                                 "long/report.html", "satellites/report.html", "evaluated/report.html",
                                 "evaluated/g1.fused.html", "evaluated/g2.fused.html", "compared/comparison.html", "bench/bench.html",
                                 "reproduced/reproduction.html", "ablation/ablation.html"})
        for page in self.pages:
            with self.subTest(page=page.relative_to(self.folder)):
                self.browser.get(page.as_uri())
                self.assertEqual(self.browser.get_log("browser"), [])
                self.assertEqual(
                    self.browser.execute_script("return performance.getEntriesByType('resource').length"), 0)
                text = page.read_text(encoding="utf-8")
                # The second is followed only by a click on the link beside a map.
                self.assertEqual(set(re.findall(r"https?://[^\s\"'?]+", text)),
                                 {"http://www.w3.org/2000/svg", "https://www.openstreetmap.org/"})

    def test_every_figure_has_a_title_a_description_and_files(self):
        for page in self.pages:
            self.browser.get(page.as_uri())
            ids, figures = self.browser.execute_script("""
                const tell = (svg, part) => svg.querySelector(part).textContent;
                return [[...document.querySelectorAll("[id]")].map(e => e.id),
                        [...document.querySelectorAll("figure.figure")].map(figure => {
                            const svg = figure.querySelector("svg");
                            return [figure.id, svg.getAttribute("role"), tell(svg, "title"), tell(svg, "desc")];
                        })];""")
            self.assertEqual(len(ids), len(set(ids)), page)
            for name, role, title, description in figures:
                self.assertIn(role, ("group", "img"))  # with or without a legend of buttons
                self.assertGreaterEqual(len(title), 3, name)
                self.assertGreaterEqual(len(description), 3, name)
                stem = page.parent / "figures" / f"{page.stem}-{name}"
                for ending in (".svg", ".csv"):
                    self.assertTrue(stem.with_name(stem.name + ending).is_file(), stem)

    def test_pointing_at_a_rejected_fix_tells_why(self):
        self.open("gated/report.html")
        self.wake("trajectory")
        fix = next(r for r in self.rows("gated/report.html", "trajectory") if "rejected, angle" in r["note"])
        self.move_to("trajectory", *self.place("trajectory", float(fix["east [m]"]), float(fix["north [m]"]))).perform()
        self.assertIn("rejected, angle", self.tip("trajectory"))
        self.assertIn("deg", self.tip("trajectory"))

    def test_the_cursor_tells_its_place_and_time_and_links_to_an_online_map(self):
        self.open("gated/report.html")
        self.wake("trajectory")
        with (self.folder / "gated/g2.epochs.csv").open(encoding="utf-8") as file:
            epoch = list(csv.DictReader(file))[60]
        fused = [r for r in self.rows("gated/report.html", "trajectory") if r["series"] == "fused"]
        pose = min(fused, key=lambda r: abs(float(r["time [s]"]) - float(epoch["time_s"])))
        self.move_to("trajectory", *self.place("trajectory", float(pose["east [m]"]), float(pose["north [m]"]))).perform()
        told = self.tip("trajectory")
        latitude, longitude = map(float, re.search(r"(\d+\.\d{7}), (\d+\.\d{7})", told).groups())
        # The pointer is a whole pixel, which is a metre or two here.
        self.assertAlmostEqual(latitude, float(epoch["fused_latitude_deg"]), delta=4e-5)
        self.assertAlmostEqual(longitude, float(epoch["fused_longitude_deg"]), delta=6e-5)
        self.assertRegex(told, r"2016-06-06 11:1\d:\d\d\.\d UTC")  # GPS week 1900
        link = self.browser.find_element(By.CSS_SELECTOR, "#trajectory a.online")
        linked = re.search(r"mlat=([\d.]+)&mlon=([\d.]+)#map=", link.get_attribute("href")).groups()
        self.assertAlmostEqual(float(linked[0]), latitude, delta=1e-6)  # six decimals of seven
        self.assertAlmostEqual(float(linked[1]), longitude, delta=1e-6)

    def test_the_trajectory_takes_the_colour_of_a_quantity(self):
        self.open("gated/report.html")
        self.wake("trajectory")
        select = self.browser.find_element(By.CSS_SELECTOR, "#trajectory select.colour-by")
        offered = [option.text for option in select.find_elements(By.TAG_NAME, "option")]
        for name in ("one colour", "colour: error", "colour: sigma", "colour: speed"):
            self.assertIn(name, offered)
        self.assertEqual(self.browser.find_elements(By.CSS_SELECTOR, "#trajectory path.colour"), [])
        select.send_keys("colour: error")
        self.settle()
        paths = self.browser.find_elements(By.CSS_SELECTOR, "#trajectory path.colour")
        self.assertEqual(len(paths), 8)
        self.assertGreater(sum(1 for path in paths if path.get_attribute("d")), 3)

    def test_ellipses_appear_when_the_map_is_zoomed_in(self):
        self.open("gated/report.html")
        self.wake("trajectory")
        ellipses = self.part("trajectory", "path.ellipses")
        fused = [r for r in self.rows("gated/report.html", "trajectory") if r["series"] == "fused"]
        for _ in range(12):
            middle = fused[len(fused) // 2]
            self.figure("trajectory").click()
            self.wheel("trajectory", *self.place("trajectory", float(middle["east [m]"]), float(middle["north [m]"])), -400)
            if ellipses.get_attribute("d"):
                break
        radii = [float(r) for r in re.findall(r"a([\d.]+) ", ellipses.get_attribute("d"))]
        low, high = self.view("trajectory")[:2]
        per_metre = self.box("trajectory")[2] / (high - low)
        with (self.folder / "gated/g2.epochs.csv").open(encoding="utf-8") as file:
            sigmas = [math.sqrt(float(r["covariance_xx_m2"]) + float(r["covariance_yy_m2"])) for r in csv.DictReader(file)]
        self.assertGreater(len(radii), 0)
        self.assertLessEqual(max(radii), math.sqrt(5.991) * max(sigmas) * per_metre + 0.1)

    def test_a_tip_stays_inside_the_window(self):
        self.open("gated/report.html")
        self.wake("trajectory")
        svg = self.figure("trajectory")
        self.browser.execute_script("scrollBy(0, arguments[0].getBoundingClientRect().bottom - innerHeight)", svg)
        left, top, width, height = self.box("trajectory")
        for x, y in ((left + 4, top + height - 4), (left + width - 4, top + height - 4), (left + width / 2, top + height - 2)):
            box = self.browser.execute_script(
                "const [x, y] = [arguments[1], arguments[2]]; const s = arguments[0];"
                "const b = s.getBoundingClientRect(); const k = b.width / s.viewBox.baseVal.width;"
                "s.dispatchEvent(new PointerEvent('pointermove', {clientX: b.left + x * k, clientY: b.top + y * k}));"
                "const t = document.querySelector('#trajectory .tip').getBoundingClientRect();"
                "return [t.left, t.top, t.right, t.bottom, innerWidth, innerHeight]", svg, x, y)
            self.assertGreaterEqual(min(box[0], box[1]), 0)
            self.assertLessEqual(box[2], box[4])
            self.assertLessEqual(box[3], box[5])

    def test_the_page_reads_verdict_trajectory_errors_and_then_the_inputs(self):
        self.open("gated/report.html")
        headings = [h.text for h in self.browser.find_elements(By.TAG_NAME, "h2") if h.text != "Warnings"]
        self.assertEqual(headings[:3], ["Trajectory", "Errors", "What went in"])
        for folded in self.browser.find_elements(By.TAG_NAME, "details"):
            self.assertIsNone(folded.get_attribute("open"))
        word = self.browser.find_element(By.CSS_SELECTOR, ".verdict abbr")
        self.assertGreater(len(word.get_attribute("title")), 10)
        self.assertNotIn("EDGE_", self.browser.find_element(By.CSS_SELECTOR, "#residuals-by-type table").text)

    def test_the_cursor_is_linked_by_time(self):
        self.open("gated/report.html")
        self.wake("error-position")
        self.wake("trajectory")
        fused = [r for r in self.rows("gated/report.html", "trajectory") if r["series"] == "fused"]
        x, y = self.middle("error-position")
        self.move_to("error-position", x, y).perform()
        low, high = self.view("error-position")[:2]
        left, _, width, _ = self.box("error-position")
        time = low + (high - low) * (x - left) / width
        nearest = min(fused, key=lambda r: abs(float(r["time [s]"]) - time))
        expected = self.place("trajectory", float(nearest["east [m]"]), float(nearest["north [m]"]))
        ring = self.part("trajectory", ".cursor circle.look-fused")
        self.assertAlmostEqual(float(ring.get_attribute("cx")), expected[0], delta=1.5)
        self.assertAlmostEqual(float(ring.get_attribute("cy")), expected[1], delta=1.5)
        for other in ("error-along", "speed"):
            line = self.part(other, ".cursor path").get_attribute("d")
            other_left, _, other_width, _ = self.box(other)
            at = low + (high - low) * (float(re.match(r"M([\d.]+)", line)[1]) - other_left) / other_width
            self.assertAlmostEqual(at, time, delta=1.5 * (high - low) / width)

    def test_the_wheel_zooms_about_the_pointer_once_the_figure_was_clicked(self):
        self.open("gated/report.html")
        before = self.wake("trajectory")
        x, y = self.middle("trajectory")
        drawn = self.part("trajectory", ".marks .line.look-fused")
        path = drawn.get_attribute("d")
        self.move_to("trajectory", x + 100, y).click().perform()
        self.wheel("trajectory", x + 100, y, -400)
        after = self.view("trajectory")
        ratio = (after[1] - after[0]) / (before[1] - before[0])
        self.assertLess(ratio, 1.0015 ** -390)
        self.assertAlmostEqual((after[3] - after[2]) / (before[3] - before[2]), ratio, places=6)
        self.assertNotEqual(drawn.get_attribute("d"), path)

    def test_a_page_scrolls_over_a_figure_that_was_not_clicked(self):
        self.open("gated/report.html")
        before = self.wake("trajectory")
        self.browser.execute_script("document.activeElement.blur()")
        self.wheel("trajectory", *self.middle("trajectory"), -400)
        self.assertEqual(self.view("trajectory"), before)

    def test_the_script_has_the_ticks_that_the_figure_was_drawn_with(self):
        """Both choose them by the same rule, in two languages (tools/drawing/README.md)."""
        ticks = ("return [...document.getElementById(arguments[0]).querySelectorAll('.tick-x, .tick-y')]"
                 ".map((tick) => [tick.textContent, tick.getAttribute('x'), tick.getAttribute('y')])")
        for width, page in itertools.product((1100, 400, 1400), ("gated/report.html", "compared/comparison.html")):
            self.screen(width, 900, mobile=width < 600)
            self.open(page)
            text = self.browser.execute_script("return document.getElementById('page-data').textContent")
            for name, figure in json.loads(text)["figures"].items():
                if figure["motion"] == "still":
                    continue
                drawn = self.browser.execute_script(ticks, name)
                self.wake(name)
                again = self.browser.execute_script(ticks, name)
                self.assertEqual([tick[0] for tick in again], [tick[0] for tick in drawn], name)
                for old, new in zip(drawn, again):
                    self.assertAlmostEqual(float(new[1]), float(old[1]), delta=0.11)
                    self.assertAlmostEqual(float(new[2]), float(old[2]), delta=0.11)

    def test_the_scale_bar_is_as_long_as_it_says(self):
        self.open("gated/report.html")
        self.wake("trajectory")
        for keys in ("", "++++", "---------"):
            self.figure("trajectory").send_keys(keys)
            low, high = self.view("trajectory")[:2]
            bar = self.part("trajectory", ".scale-bar").get_attribute("d")
            text = self.part("trajectory", ".scale-text").text
            metres = float(text.split()[0]) * (1000 if text.endswith("km") else 1)
            pixels = float(re.search(r"h([\d.]+)", bar)[1])
            width = self.box("trajectory")[2]
            self.assertAlmostEqual(metres, pixels * (high - low) / width, delta=0.01 * metres)

    def test_dragging_moves_by_what_was_dragged_and_takes_linked_figures_along(self):
        self.open("gated/report.html")
        low, high = self.wake("error-position")[:2]
        x, y = self.middle("error-position")
        self.move_to("error-position", x, y).click_and_hold().move_by_offset(-120, 0).release().perform()
        moved = self.view("error-position")[0] - low
        width = self.box("error-position")[2]
        self.assertAlmostEqual(moved, 120 / self.scale("error-position") * (high - low) / width,
                               delta=2 * (high - low) / width)
        for other in ("error-along", "error-across", "speed"):
            self.assertAlmostEqual(self.view(other)[0] - low, moved, places=5)
        x, y = self.middle("speed")
        self.move_to("speed", x, y).double_click().perform()
        self.assertAlmostEqual(self.view("error-position")[0], low, places=6)

    def test_the_legend_switches_series_by_mouse_and_by_key(self):
        self.open("gated/report.html")
        entry = self.figure("error-position").find_element(By.CSS_SELECTOR, ".entry[data-series]")
        index = entry.get_attribute("data-series")
        mark = self.part("error-position", f".marks [data-series='{index}']")
        entry.click()
        self.settle()
        self.assertFalse(mark.is_displayed())
        self.assertEqual(entry.get_attribute("aria-pressed"), "false")
        entry.send_keys(Keys.ENTER)
        self.settle()
        self.assertNotIn("off", mark.get_attribute("class").split())
        self.assertEqual(entry.get_attribute("aria-pressed"), "true")

    def test_arrow_keys_move_the_cursor_epoch_by_epoch(self):
        self.open("gated/report.html")
        svg = self.figure("error-position")
        svg.send_keys(Keys.ARROW_RIGHT, Keys.ARROW_RIGHT, Keys.ARROW_RIGHT)
        times = [float(r["time [s]"]) for r in self.rows("gated/report.html", "error-position")
                 if r["series"] == "fused"]
        told = float(self.tip("error-position").split()[0])
        self.assertTrue(any(abs(told - t) < 0.05 for t in times[1:5]), (told, times[:5]))

    def test_of_a_long_drive_nothing_is_lost_in_a_small_file(self):
        page = self.folder / "long/report.html"
        self.assertLess(page.stat().st_size, 5_000_000)
        fused = [r for r in self.rows("long/report.html", "trajectory") if r["series"] == "fused"]
        self.assertGreaterEqual(len(fused), POSES_OF_LONG_DRIVE)  # and nodes for the fixes between
        self.open("long/report.html")
        self.wake("trajectory")
        self.figure("trajectory").click()
        # Somewhere where the vehicle moves, the whole of five seconds must be drawn pose by pose.
        drive = [(float(r["east [m]"]), float(r["north [m]"])) for r in fused]
        start = next(i for i in range(50000, len(drive) - 125)
                     if math.hypot(drive[i + 125][0] - drive[i][0], drive[i + 125][1] - drive[i][1]) > 50)
        piece = drive[start:start + 125]
        for _ in range(40):
            low_x, high_x, low_y, high_y = self.view("trajectory")
            if high_x - low_x < 60:
                break
            x, y = self.place("trajectory", *piece[62])
            self.wheel("trajectory", x, y, -500)
        path = self.part("trajectory", ".marks .line.look-fused").get_attribute("d")
        drawn = [tuple(map(float, pair.split())) for pair in re.findall(r"[ML]([-\d. ]+)", path)]
        view = self.view("trajectory")
        inside = [p for p in piece if view[0] < p[0] < view[1] and view[2] < p[1] < view[3]]
        self.assertGreater(len(inside), 20)
        for point, (x, y) in zip(inside, self.places("trajectory", inside)):
            self.assertTrue(any(abs(x - dx) < 0.5 and abs(y - dy) < 0.5 for dx, dy in drawn), point)

    def test_each_satellite_stands_in_the_table_and_in_the_sky(self):
        with (self.folder / "receiver/raw.csv").open(encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        elevations = {f"G{int(r['satellite']):02d}": math.degrees(float(r["elevation"])) for r in rows}
        self.open("satellites/report.html")
        cells = [[cell.text for cell in row.find_elements(By.TAG_NAME, "td")]
                 for row in self.browser.find_elements(By.XPATH, "//section[h2[contains(., 'by satellite')]]//tbody/tr")]
        table = {row[0]: row for row in cells if len(row) > 8}
        self.assertEqual(set(table), set(elevations))
        for name, row in table.items():
            self.assertEqual(int(row[2]), sum(f"G{int(r['satellite']):02d}" == name for r in rows))
        self.wake("sky-pseudorange")
        points = [r for r in self.rows("satellites/report.html", "sky-pseudorange") if "weight" in r["note"]]
        self.assertEqual({r["note"].split(",")[0] for r in points}, set(elevations))
        for point in points:
            name = point["note"].split(",")[0]
            east, north = (float(value) for key, value in point.items() if "[deg]" in key)
            self.assertAlmostEqual(90 - math.hypot(east, north), elevations[name], delta=2)  # within a minute
        self.move_to("sky-pseudorange", *self.place("sky-pseudorange", east, north)).perform()
        self.assertIn(name, self.tip("sky-pseudorange"))

    def test_print_leaves_out_what_paper_cannot_do(self):
        self.open("gated/report.html")
        self.assertTrue(self.browser.find_element(By.CLASS_NAME, "tools").is_displayed())
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
        try:
            self.assertFalse(self.browser.find_element(By.CLASS_NAME, "tools").is_displayed())
            self.assertFalse(self.browser.find_element(By.TAG_NAME, "nav").is_displayed())
        finally:
            self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})

    def test_without_script_the_page_is_complete(self):
        self.browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
        try:
            self.browser.get((self.folder / "gated/report.html").as_uri())
            for figure in self.browser.find_elements(By.CSS_SELECTOR, "figure.figure"):
                drawn = figure.find_elements(By.CSS_SELECTOR, ".marks path")
                self.assertTrue(any(path.get_attribute("d") for path in drawn), figure.get_attribute("id"))
        finally:
            self.browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": False})

    def test_a_narrow_screen_shows_the_rmse_first_and_letters_that_can_be_read(self):
        self.narrow()
        self.open("gated/report.html")
        verdict = self.browser.find_element(By.CLASS_NAME, "verdict")
        self.assertIn("RMSE", verdict.text)
        self.assertLess(verdict.rect["y"] + verdict.rect["height"], 800)
        self.assertEqual(self.browser.execute_script("return document.documentElement.scrollWidth"), 400)
        for name in ("trajectory", "error-position"):
            self.assertGreaterEqual(12 * self.scale(name), 10)  # px of the letters of a drawing

    def test_two_fingers_zoom_a_map(self):
        self.narrow()
        self.browser.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 2})
        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.setTouchEmulationEnabled", {"enabled": False})
        self.open("gated/report.html")
        before = self.wake("trajectory")
        box = self.browser.execute_script(
            "const b = arguments[0].getBoundingClientRect(); return [b.left, b.top + b.height / 2]",
            self.figure("trajectory"))

        def touch(kind, spread):
            points = [] if spread is None else [{"x": 200 - spread, "y": box[1], "id": 1},
                                                {"x": 200 + spread, "y": box[1], "id": 2}]
            self.browser.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

        touch("touchStart", 40)
        for spread in (50, 60, 70, 80):
            touch("touchMove", spread)
        touch("touchEnd", None)
        after = self.view("trajectory")
        self.assertAlmostEqual((after[1] - after[0]) / (before[1] - before[0]), 40 / 80, delta=0.1)

    def test_axe_finds_no_violation_by_day_and_by_night(self):
        """axe-core of npm, if WAYMARK_AXE names its minified script (tests/README.md)."""
        if not os.environ.get("WAYMARK_AXE"):
            self.skipTest("WAYMARK_AXE names no axe.min.js")
        script = pathlib.Path(os.environ["WAYMARK_AXE"]).read_text(encoding="utf-8")
        for scheme in ("light", "dark"):
            self.scheme(scheme)
            for page in ("gated/report.html", "all/report.html", "all/correlated.html", "compared/comparison.html"):
                self.open(page)
                self.browser.execute_script(script)
                found = self.browser.execute_async_script(
                    "const done = arguments[0]; axe.run().then((result) => done(result.violations.map("
                    "(v) => v.id + ': ' + v.nodes.slice(0, 3).map((n) => n.html.slice(0, 160)).join(' | '))))")
                self.assertEqual(found, [], f"{page}, {scheme}")

    def test_words_are_apart_from_their_ground(self):
        """Contrast of text on white: at least 4.5 to 1 (WCAG 2.1, 1.4.3)."""
        self.open("gated/report.html")
        for selector in ("figcaption", ".tick-x", "footer", "td", ".note", "nav a"):
            element = self.browser.find_element(By.CSS_SELECTOR, selector)
            colour = self.browser.execute_script(
                "const s = getComputedStyle(arguments[0]);"
                "return arguments[0] instanceof SVGElement ? s.fill : s.color", element)
            parts = [int(v) / 255 for v in re.findall(r"\d+", colour)[:3]]
            linear = [v / 12.92 if v <= 0.03928 else ((v + 0.055) / 1.055) ** 2.4 for v in parts]
            luminance = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
            self.assertGreaterEqual(1.05 / (luminance + 0.05), 4.5, selector)


if __name__ == "__main__":
    main()
