"""Size, seconds to open, and a replay: frames a second and the processor time that a frame takes.

The wall clock of a machine that does other work as well says little; so each figure of time stands with the processor time of the
page's own processes (its scripts, and the process that paints).
"""

import os
import time

from browser import Browser, player_is_ready, two_frames

seconds_of_replay = 4

# Frames drawn at a speed that passes the whole drive in 30 s: [frames, milliseconds, longest frame in ms, ms in the player's own code].
count_frames = """new Promise((done) => {
  const player = helixnavPlayer;
  let frames = 0, worst = 0, before = performance.now();
  const begin = before;
  const next = (now) => {
    worst = Math.max(worst, now - before);
    before = now;
    frames++;
    if (now - begin < 1000 * SECONDS) requestAnimationFrame(next);
    else done([frames, now - begin, worst]);
  };
  player.speed = player.end / 30;
  if (!player.playing) document.getElementById("player-play").click();
  requestAnimationFrame(next);
})""".replace("SECONDS", str(seconds_of_replay))

views = {
    "whole map": "document.getElementById('player-all').click(); helixnavPlayer.goTo(0); "
                 "document.getElementById('player-all').click()",
    "following": "helixnavPlayer.goTo(0)",
    "whole map, second half": "helixnavPlayer.goTo(Math.floor(helixnavPlayer.drive.count / 2)); "
                              "document.getElementById('player-all').click()",
}


def opened(browser, report):
    """(page, seconds until loaded and painted, until the player is ready, processor seconds until then)"""
    page = browser.page()
    page.look(1280, 900)
    before = browser.processor_s()
    begin = time.monotonic()
    loaded = page.open(report)
    page.run(player_is_ready)
    return page, loaded, time.monotonic() - begin, browser.processor_s() - before


def replayed(browser, page, setup):
    """(frames/s, longest frame in ms, processor ms a frame of all processes, and of the script's thread alone)"""
    page.run("document.getElementById('player').scrollIntoView()")
    page.run(setup)
    page.run(two_frames)
    before, thread_before = browser.processor_s(), page.thread_s()
    frames, passed_ms, worst_ms = page.run(count_frames)
    all_ms, thread_ms = (1000 * (browser.processor_s() - before), 1000 * (page.thread_s() - thread_before))
    page.run("if (helixnavPlayer.playing) document.getElementById('player-play').click()")
    return 1000 * frames / passed_ms, worst_ms, all_ms / frames, thread_ms / frames


def measure(report, pictures):
    """Prints the figures; 1 where one is not kept."""
    megabytes = os.path.getsize(report) / 1e6
    with Browser() as browser:
        openings = []
        for _ in range(3):
            page, *times = opened(browser, report)
            openings.append(times)
        scans, landmarks = page.run("[helixnavPlayer.drive.count, helixnavPlayer.drive.landmarks.id.length]")
        print(f"{scans} scans, {landmarks} landmarks: {megabytes:.2f} MB")
        for name, column in (("opened", 0), ("player ready", 1), ("processor time until then", 2)):
            print(f"{name}: " + ", ".join(f"{times[column]:.2f}" for times in openings) + " s")
        rates = []
        for name, setup in views.items():
            rate, worst_ms, all_ms, thread_ms = replayed(browser, page, setup)
            rates.append(rate)
            print(f"{name}: {rate:.1f} frames/s, longest {worst_ms:.0f} ms; processor {all_ms:.1f} ms a frame, "
                  f"{thread_ms:.1f} ms of it the script's thread")
            if pictures:
                page.picture(os.path.join(pictures, f"measure-{name.replace(' ', '-').replace(',', '')}.png"))
        print("console:", page.errors or "nothing")
    kept = megabytes <= 15.0 and min(times[1] for times in openings) <= 3.0 and min(rates) >= 30.0 and not page.errors
    return 0 if kept else 1
