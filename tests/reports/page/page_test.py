"""Looks at a report in a real browser, as a user would: page_test.py REPORT [--measure] [--pictures FOLDER].

Without --measure: nothing on the console, nothing wider than the screen, the player goes where it is told, and shows there what
the run folder says. With it: size, seconds to open and frames a second of a replay, held against what is promised.
"""

import argparse
import os
import sys
import tempfile
import time
import unittest

from browser import Browser, player_is_ready, two_frames
from measure import measure

wide, phone = (1280, 900, False), (390, 844, True)

picture_of_canvas = "document.getElementById('player-canvas').toDataURL()"


class ReportPage(unittest.TestCase):
    report = ""

    @classmethod
    def setUpClass(cls):
        cls.browser = Browser().__enter__()

    @classmethod
    def tearDownClass(cls):
        cls.browser.__exit__()

    def open(self, look=wide, dark=False):
        page = self.browser.page()
        width, height, mobile = look
        page.look(width, height, dark=dark, mobile=mobile, scale=2.0 if mobile else 1.0)
        page.open(self.report)
        page.run(player_is_ready)
        page.run(two_frames)
        return page

    def steps(self):
        folder = os.path.dirname(self.report)
        with open(os.path.join(folder, "trajectory.tum")) as file:
            return [[float(word) for word in line.split()] for line in file if not line.startswith("#")]

    def state(self, page):
        """The text under the picture."""
        return page.run("document.getElementById('player-state').textContent").replace("\u202f", "")

    def set_slider(self, page, time_s):
        page.run(f"""(() => {{
          const slider = document.getElementById('player-time');
          slider.value = {round(1000 * time_s)};
          slider.dispatchEvent(new Event('input'));
        }})()""")
        page.run(two_frames)

    def go_to(self, page, k):
        page.run(f"helixnavPlayer.goTo({k})")
        page.run(two_frames)

    def test_says_nothing_on_the_console_and_is_no_wider_than_the_screen(self):
        for look in (wide, phone):
            for dark in (False, True):
                page = self.open(look, dark)
                page.run("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
                for _ in range(30):
                    page.run("window.scrollBy(0, 600)")
                    page.run(two_frames)
                self.assertEqual(page.errors, [])
                self.assertLessEqual(page.run("document.documentElement.scrollWidth"), look[0])

    def test_keeps_the_legend_above_the_chart_when_the_screen_is_turned(self):
        page = self.open(phone)
        page.run("document.getElementById('map').scrollIntoView()")
        for width, height, mobile in ((390, 844, True), (844, 390, True), (1280, 900, False), (390, 844, True)):
            page.look(width, height, mobile=mobile)
            page.run("new Promise((done) => setTimeout(done, 1500))")
            legend, chart = page.run("""['.legend .bg', '.nsewdrag'].map((part) =>
              document.querySelector(`#map ${part}`).getBoundingClientRect()).map(({ top, bottom }) => [top, bottom])""")
            self.assertLessEqual(legend[1], chart[0] + 1, f"{width} pixels wide")

    def test_can_be_opened_where_nothing_of_it_is_shown(self):
        page = self.browser.page()
        page.look(*wide[:2])
        page.open(self.report)
        page.run(player_is_ready)
        address = page.run("location.href")
        for style in ("display: none", "width: 0; height: 0; border: 0", "width: 1px; height: 1px; border: 0"):
            page.run(f"""new Promise((done) => {{
              const frame = document.createElement('iframe');
              frame.style.cssText = {style!r};
              frame.onload = () => setTimeout(done, 1000);
              frame.src = {address!r};
              document.body.append(frame);
            }})""")
            self.assertEqual(page.errors, [], style)
        page.look(1, 1)
        page.run("helixnavPlayer.goTo(5)")
        page.run("new Promise((done) => setTimeout(done, 300))")
        self.assertEqual(page.errors, [])

    def test_breaks_a_long_name_of_a_log_where_the_screen_ends(self):
        page = self.open(phone)
        page.run("document.getElementById('title').textContent = '2026-05-12_field_north_robot_one_run_three_long'")
        page.run(two_frames)
        self.assertLessEqual(page.run("document.documentElement.scrollWidth"), phone[0])

    def test_asks_the_network_for_nothing(self):
        page = self.open()
        self.assertEqual(page.run("performance.getEntriesByType('resource').length"), 0)

    def test_shows_every_pose_of_the_run_folder(self):
        page = self.open()
        steps = self.steps()
        x, y = page.run("[Array.from(helixnavPlayer.drive.x), Array.from(helixnavPlayer.drive.y)]")
        self.assertEqual(len(x), len(steps))
        for k, step in enumerate(steps):
            self.assertLess(abs(x[k] - step[1]) + abs(y[k] - step[2]), 0.011)

    def test_shows_the_same_picture_for_the_same_scan_and_another_for_another(self):
        page = self.open()
        middle = len(self.steps()) // 2
        self.go_to(page, middle)
        there = page.run(picture_of_canvas)
        self.go_to(page, middle + 40)
        elsewhere = page.run(picture_of_canvas)
        self.go_to(page, middle)
        self.assertEqual(page.run(picture_of_canvas), there)
        self.assertNotEqual(elsewhere, there)

    def test_shows_the_same_picture_after_playing_as_after_a_leap(self):
        page = self.open()
        page.run("helixnavPlayer.speed = helixnavPlayer.end / 4; document.getElementById('player-play').click()")
        page.run("new Promise((done) => setTimeout(done, 1500))")
        page.run("document.getElementById('player-play').click(); document.getElementById('player-on').click()")
        page.run(two_frames)
        played, time_s = page.run(f"[{picture_of_canvas}, helixnavPlayer.t]")
        self.assertGreater(page.run("helixnavPlayer.k"), 100)
        self.set_slider(page, 0.0)
        self.assertNotEqual(page.run(picture_of_canvas), played)
        self.set_slider(page, time_s)
        self.assertEqual(page.run(picture_of_canvas), played)

    def test_knows_the_landmarks_of_a_scan_whichever_way_it_came_there(self):
        page = self.open()
        scans = len(self.steps())
        for k in (scans // 3, scans // 3 + 7, scans - 1, scans // 5, 0, scans // 2):
            self.go_to(page, k)
            wrong = page.run("""(() => {
              const { present: { place }, drive: { landmarks: l }, k } = helixnavPlayer;
              return Array.from(place).filter((shown, i) => {
                let expected = -1;
                for (let p = l.offsets[i]; p < l.offsets[i + 1]; p++) if (l.step[p] <= k) expected = p;
                return shown !== (l.until[i] >= 0 && l.until[i] <= k ? -1 : expected);
              }).length;
            })()""")
            self.assertEqual(wrong, 0, f"landmarks at scan {k}")

    def test_goes_to_the_closing_that_is_clicked(self):
        page = self.open()
        step = page.run("helixnavPlayer.closings.length > 0 ? helixnavPlayer.closings[0].step : -1")
        if step < 0:
            self.skipTest("a run without a closing")
        page.run("document.querySelector('.closing').click()")
        page.run(two_frames)
        self.assertIn(f"step {step},", self.state(page))
        top, bottom = page.run("""(({ top, bottom }) => [top, bottom])(
          document.getElementById('player-canvas').getBoundingClientRect())""")
        self.assertGreaterEqual(top, 0)
        self.assertLessEqual(bottom, wide[1])

    def test_plays_and_obeys_the_keys(self):
        page = self.open()
        time_s = "helixnavPlayer.t"
        page.press(" ", "Space")
        page.run("new Promise((done) => setTimeout(done, 600))")
        page.press(" ", "Space")
        played = page.run(time_s)
        self.assertGreater(played, 0.0)
        page.run(two_frames)
        self.assertEqual(page.run(time_s), played)
        self.assertIn(f"step {page.run('helixnavPlayer.k')},", self.state(page), "the text of the picture, though it changes seldom")
        page.run("document.getElementById('player-canvas').focus()")
        page.press("Home")
        page.press("ArrowRight")
        page.press("ArrowRight")
        self.assertAlmostEqual(page.run(time_s), page.run("helixnavPlayer.drive.t[2]"), places=6)
        page.press("ArrowLeft")
        self.assertAlmostEqual(page.run(time_s), page.run("helixnavPlayer.drive.t[1]"), places=6)
        speed = page.run("helixnavPlayer.speed")
        page.press("+")
        self.assertGreater(page.run("helixnavPlayer.speed"), speed)
        page.press("-")
        self.assertEqual(page.run("helixnavPlayer.speed"), speed)
        self.assertEqual(page.errors, [])

    def test_leaves_the_keys_that_scroll_to_the_page_until_the_player_has_the_focus(self):
        page = self.open()
        page.run("document.getElementById('player-canvas').scrollIntoView()")
        page.press("ArrowRight")
        self.assertEqual(page.run("helixnavPlayer.t"), page.run("helixnavPlayer.drive.t[1]"))
        page.press("f")
        self.assertTrue(page.run("document.getElementById('player-follow').checked"))
        page.press("End")
        self.assertEqual(page.run("helixnavPlayer.t"), page.run("helixnavPlayer.drive.t[1]"))
        page.run("window.scrollTo(0, document.documentElement.scrollHeight)")
        page.run(two_frames)
        page.press("f")
        page.press(" ", "Space")
        self.assertTrue(page.run("document.getElementById('player-follow').checked"), "out of view")
        self.assertFalse(page.run("helixnavPlayer.playing"), "out of view")
        page.run("document.getElementById('player-canvas').focus()")
        page.press("End")
        self.assertEqual(page.run("helixnavPlayer.t"), page.run("helixnavPlayer.end"))

    def test_zooms_by_the_wheel_about_the_pointer_and_returns_to_the_whole_map(self):
        page = self.open()
        whole = page.run(picture_of_canvas)
        page.run("""document.getElementById('player-canvas').dispatchEvent(
          new WheelEvent('wheel', { deltaY: -400, bubbles: true, cancelable: true }))""")
        page.run(two_frames)
        self.assertNotEqual(page.run(picture_of_canvas), whole)
        page.run("document.getElementById('player-all').click()")
        page.run(two_frames)
        self.assertEqual(page.run(picture_of_canvas), whole)

    def test_follows_the_screen_from_light_to_dark(self):
        page = self.open()
        light = page.run(picture_of_canvas)
        page.look(*wide[:2], dark=True)
        page.run(two_frames)
        self.assertNotEqual(page.run(picture_of_canvas), light)
        page.look(*wide[:2], dark=False)
        page.run(two_frames)
        self.assertEqual(page.run(picture_of_canvas), light)
        self.assertEqual(page.errors, [])

    def test_is_moved_by_one_finger_and_zoomed_by_two(self):
        page = self.open(phone)
        page.run("document.getElementById('player-canvas').scrollIntoView({ block: 'center' })")
        left, top = page.run("""(({ left, top }) => [left, top])(
          document.getElementById('player-canvas').getBoundingClientRect())""")
        camera = "[helixnavPlayer.camera.x, helixnavPlayer.camera.y, helixnavPlayer.camera.scale]"
        x, y, scale = page.run(camera)
        page.touch([[(left + 100, top + 200)], [(left + 140, top + 170)]])
        page.run(two_frames)
        self.assertAlmostEqual(page.run(camera)[0], x - 40 / scale, delta=0.01 * 40 / scale)
        self.assertAlmostEqual(page.run(camera)[1], y - 30 / scale, delta=0.01 * 30 / scale)
        page.touch([[(left + 150, top + 200), (left + 200, top + 200)], [(left + 125, top + 200), (left + 225, top + 200)]])
        page.run(two_frames)
        self.assertAlmostEqual(page.run(camera)[2] / scale, 2.0, delta=0.01)

    def test_saves_a_picture(self):
        page = self.open()
        with tempfile.TemporaryDirectory() as folder:
            page.download_into(folder)
            page.run("document.getElementById('player-save').click()")
            saved = os.path.join(folder, "helixnav-step-0.png")
            for _ in range(200):
                if os.path.exists(saved):
                    break
                time.sleep(0.05)
            with open(saved, "rb") as file:
                picture = file.read()
        self.assertEqual(picture[:8], b"\x89PNG\r\n\x1a\n")
        self.assertGreater(len(picture), 5000)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("report")
    parser.add_argument("--measure", action="store_true")
    parser.add_argument("--pictures", help="folder for pictures")
    words = parser.parse_args()
    if words.measure:
        sys.exit(measure(words.report, words.pictures))
    ReportPage.report = os.path.abspath(words.report)
    unittest.main(argv=sys.argv[:1], verbosity=2)
