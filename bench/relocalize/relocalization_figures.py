#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Figures 2, 4, 5 and 6 of hybrid_masson2003 on a recorded log: runs helixnav_relocalization_study and draws what it says.

usage: relocalization_figures.py STUDY PAGE.html LOG [blind seconds [runs [unseen metres [landmarks]]]]
STUDY is the program, in the bench folder of a build; the numbers are its own. docs/relocalization.png is, as a developer's step,
  relocalization_figures.py STUDY PAGE.html victoria_park_ascii.zip 30
  chromium --headless --window-size=1470,1900 --screenshot=docs/relocalization.png PAGE.html
The page carries its data and takes Plotly from reports/page/node_modules.
"""
import json
import math
import subprocess
import sys
from pathlib import Path

BLUE, ORANGE, GREEN, GREY = "#3070b0", "#d08020", "#207040", "#909090"
PUBLISHED = (2.2, 0.5)  # m: deviation before and after the first scan


def on(trace, panel):
    return {**trace, "xaxis": f"x{panel}", "yaxis": f"y{panel}", "showlegend": False}


def arrows(poses, panel, length_m, color=BLUE, opacity=0.45):
    """Poses (x, y, heading) as strokes that point where they look, with a dot at the place."""
    x, y = [], []
    for px, py, heading in poses:
        x += [px, px + length_m * math.cos(heading), None]
        y += [py, py + length_m * math.sin(heading), None]
    strokes = {"x": x, "y": y, "mode": "lines", "line": {"color": color, "width": 1}, "opacity": opacity}
    dots = {"x": [p[0] for p in poses], "y": [p[1] for p in poses], "mode": "markers",
            "marker": {"color": color, "size": 2}, "opacity": opacity}
    return [on(strokes, panel), on(dots, panel)]


def stars(points, panel):
    return on({"x": [p[0] for p in points], "y": [p[1] for p in points], "mode": "markers",
               "marker": {"color": GREEN, "size": 9, "symbol": "star"}}, panel)


def one(pose, panel, length_m):
    head = {"x": [pose[0], pose[0] + length_m * math.cos(pose[2])], "y": [pose[1], pose[1] + length_m * math.sin(pose[2])],
            "mode": "lines+markers", "line": {"color": ORANGE, "width": 3},
            "marker": {"color": ORANGE, "size": [11, 1], "symbol": "circle-open", "line": {"width": 3}}}
    return on(head, panel)


def line(points, panel, color, dash="solid"):
    return on({"x": [p[0] for p in points], "y": [p[1] for p in points], "mode": "lines",
               "line": {"color": color, "dash": dash, "width": 2}}, panel)


def series(values, panel, color, dash="solid"):
    return on({"x": list(range(len(values))), "y": values, "mode": "lines+markers", "marker": {"size": 4},
               "line": {"color": color, "dash": dash}}, panel)


class Figures:
    def __init__(self, study):
        self.study, self.shown = study, study["shown"]
        self.traces, self.titles, self.axes = [], [], {}

    def panel(self, title, x_title, y_title, centre=None, half_m=None, equal=True):
        self.titles.append(title)
        k = len(self.titles)
        x = {"title": {"text": x_title, "standoff": 3}, "zeroline": False}
        y = {"title": {"text": y_title, "standoff": 3}, "zeroline": False}
        if equal:
            y.update(scaleanchor=f"x{k}", scaleratio=1)
        if centre:
            x["range"] = [centre[0] - half_m, centre[0] + half_m]
            y["range"] = [centre[1] - half_m, centre[1] + half_m]
        self.axes[f"xaxis{k}"], self.axes[f"yaxis{k}"] = x, y
        return k

    def helix(self):
        helix = self.shown["helix"]
        centre = helix["landmark"]
        k = self.panel(f"Figure 2: one observation ({helix['range_m']:.1f} m, {helix['bearing_deg']:.0f}°) and one "
                       "landmark: poses that fit", "x [m]", "y [m]", centre, 1.6 * helix["range_m"])
        self.traces += arrows(helix["poses"][::4], k, 0.25 * helix["range_m"]) + [stars([centre], k)]
        k = self.panel("Figure 2, from the side: heading over x", "x [m]", "heading [°]", equal=False)
        poses = helix["poses"]
        self.traces.append(on({"x": [p[0] for p in poses], "y": [math.degrees(p[2]) for p in poses], "mode": "markers",
                               "marker": {"size": 3, "color": BLUE}}, k))

    def clouds(self):
        words = {0: "helices of the first scan, unweighed; ×: the EKF's estimate", 1: "after the first scan",
                 3: "after 3 scans", 6: "after 6 scans", 52: "after 52 scans"}
        for cloud in self.shown["clouds"]:
            if cloud["scans"] not in words:
                continue
            here, poses = cloud["reference"], cloud["cloud"]
            spread = sorted(max(abs(p[0] - here[0]), abs(p[1] - here[1])) for p in poses)
            half_m = max(0.6, 1.1 * spread[int(0.98 * len(spread))])
            k = self.panel(f"Figure 5: {words[cloud['scans']]}", "x [m]", "y [m]", here, half_m)
            self.traces += arrows(poses, k, 0.12 * half_m)
            self.traces += [stars(self.shown["landmarks"], k), one(here, k, 0.2 * half_m)]
            if cloud["scans"] == 0:
                x, y = self.shown["mean"][0]
                self.traces.append(on({"x": [x], "y": [y], "mode": "markers",
                                       "marker": {"color": "black", "size": 12, "symbol": "x"}}, k))

    def path(self):
        mean, reference = self.shown["mean"], self.shown["reference"]
        middle = reference[len(reference) // 2]
        half_m = 0.8 * max(max(abs(p[0] - middle[0]), abs(p[1] - middle[1])) for p in reference)
        k = self.panel(f"Figure 4: mean of {self.study['runs']} runs (blue), the navigator's path (orange)", "x [m]",
                       "y [m]", middle, half_m)
        self.traces += [stars(self.shown["landmarks"], k), line(mean, k, BLUE), line(reference, k, ORANGE, "dot")]
        self.traces.append(one(reference[1], k, 2.0))

    def history(self):
        summary = self.shown["summary"]
        k = self.panel(f"Figure 6: σ {summary['sigma_before_m']:.2f} → {summary['sigma_after_m']:.2f} m, error "
                       f"{summary['error_before_m']:.2f} → {summary['error_after_m']:.2f} m by the first scan",
                       "scans", "position [m]", equal=False)
        self.traces += [series(self.shown["sigma_m"], k, BLUE), series(self.shown["error_m"], k, ORANGE, "dot")]
        returns = self.study["returns"]
        k = self.panel(f"All {len(returns)} returns: error before and after the first scan; grey: the paper", "", "m",
                       equal=False)
        for one_return in returns:
            wrong = one_return["gate_wrong"] > 0
            self.traces.append(on({"x": ["before", "after 1 scan"], "mode": "lines+markers",
                                   "y": [one_return["error_before_m"], one_return["error_after_m"]],
                                   "line": {"color": ORANGE if wrong else BLUE, "width": 1}}, k))
        self.traces.append(on({"x": ["before", "after 1 scan"], "y": PUBLISHED, "mode": "lines+markers",
                               "line": {"color": GREY, "width": 5}}, k))

    def page(self, path):
        self.helix(), self.clouds(), self.path(), self.history()
        rows = (len(self.titles) + 1) // 2
        summary = self.shown["summary"]
        layout = {
            "width": 1450, "height": 370 * rows, "margin": {"t": 110, "l": 60, "r": 20, "b": 50},
            "title": {"text": f"{self.study['recording']}: the return at {summary['t_s']:.0f} s after "
                              f"{self.study['blind_s']:.0f} s without laser; stars: mapped landmarks, orange: the "
                              "navigator"},
            "grid": {"rows": rows, "columns": 2, "pattern": "independent", "ygap": 0.28, "xgap": 0.1},
            "annotations": [{"text": title, "xref": f"x{k} domain", "yref": f"y{k} domain", "x": 0, "y": 1.1,
                             "showarrow": False, "xanchor": "left"} for k, title in enumerate(self.titles, start=1)],
            **self.axes,
        }
        plotly = (Path(__file__).resolve().parents[2] /
                  "reports/page/node_modules/plotly.js-basic-dist-min/plotly-basic.min.js")
        Path(path).write_text(
            f'<meta charset="utf-8"><div id="f"></div><script src="{plotly.as_uri()}"></script><script>'
            f'Plotly.newPlot("f", {json.dumps(self.traces)}, {json.dumps(layout)}, {{staticPlot: true}})</script>',
            encoding="utf-8")


def main(study, page, *how):
    said = subprocess.run([study, *how], check=True, stdout=subprocess.PIPE).stdout
    Figures(json.loads(said)).page(page)


if __name__ == "__main__":
    if len(sys.argv) < 4:
        raise SystemExit(__doc__)
    main(*sys.argv[1:])
