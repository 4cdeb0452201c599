"""Looks at a report in a real browser, as a user would: page_test.py REPORT [--measure] [--pictures FOLDER].

Without --measure: nothing on the console, nothing wider than the screen, the player goes where it is told, and shows there what
the run folder says. With it: size, seconds to open and frames a second of a replay, held against what is promised.
"""

import argparse
import os
import sys
import time
import unittest

from browser import Browser

wide, phone = (1280, 900, False), (390, 844, True)

# Frames drawn in two seconds of replay at a speed that passes the whole drive in 30 s.
count_frames = """new Promise((done) => {
  const player = helixnavPlayer;
  let frames = 0, worst = 0, before = performance.now();
  const begin = before;
  const next = (now) => {
    worst = Math.max(worst, now - before);
    before = now;
    frames++;
    if (now - begin < 2000) requestAnimationFrame(next);
    else done([frames / (now - begin) * 1000, worst]);
  };
  player.speed = player.end / 30;
  if (!player.playing) document.getElementById("player-play").click();
  requestAnimationFrame(next);
})"""

picture_of_canvas = "document.getElementById('player-canvas').toDataURL()"
player_is_ready = """new Promise((done) => {
  const look = () => (window.helixnavPlayer ? requestAnimationFrame(() => done()) : setTimeout(look, 5));
  look();
})"""
two_frames = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"


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

    def test_goes_to_the_closing_that_is_clicked(self):
        page = self.open()
        step = page.run("helixnavPlayer.closings.length > 0 ? helixnavPlayer.closings[0].step : -1")
        if step < 0:
            self.skipTest("a run without a closing")
        page.run("document.querySelector('.closing').click()")
        page.run(two_frames)
        self.assertIn(f"step {step}", page.run("document.getElementById('player-state').textContent").replace("\u202f", ""))

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

    def test_makes_a_picture_to_save(self):
        page = self.open()
        kind, size = page.run("""new Promise((done) => helixnavPlayer.canvas.toBlob((blob) => done([blob.type, blob.size])))""")
        self.assertEqual(kind, "image/png")
        self.assertGreater(size, 5000)


def measure(report, pictures):
    """Prints the figures; 1 where one is not kept."""
    megabytes = os.path.getsize(report) / 1e6
    with Browser() as browser:
        opened, ready = [], []
        for _ in range(3):
            page = browser.page()
            page.look(1280, 900)
            begin = time.monotonic()
            opened.append(page.open(report))
            page.run(player_is_ready)
            ready.append(time.monotonic() - begin)
        scans = page.run("helixnavPlayer.drive.count")
        frames = {}
        page.run("document.getElementById('player').scrollIntoView()")
        for name, setup in (("whole map", "document.getElementById('player-all').click()"),
                            ("following", "helixnavPlayer.goTo(0)")):
            page.run(setup)
            page.run(two_frames)
            frames[name] = page.run(count_frames)
            page.run("document.getElementById('player-play').click()")
            if pictures:
                page.picture(os.path.join(pictures, f"measure-{name.replace(' ', '-')}.png"))
    print(f"{scans} scans: {megabytes:.2f} MB; opened in " + ", ".join(f"{s:.2f}" for s in opened) + " s, player ready after " +
          ", ".join(f"{s:.2f}" for s in ready) + " s")
    for name, (rate, worst) in frames.items():
        print(f"{name}: {rate:.1f} frames/s, longest {worst:.0f} ms")
    kept = megabytes <= 15.0 and min(ready) <= 3.0 and all(rate >= 30.0 for rate, _ in frames.values())
    return 0 if kept else 1


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
