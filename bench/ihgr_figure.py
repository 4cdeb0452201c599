#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws docs/ihgr.png from the tables of helixnav_ihgr_reproduction and helixnav_association_times --figure3.

usage: ihgr_figure.py SWEEP.csv FIGURE3.csv PAGE.html
Then, as a developer's step:
  chromium --headless --window-size=1470,1180 --screenshot=docs/ihgr.png PAGE.html
The page carries its data and takes Plotly from reports/page/node_modules.
"""
import csv
import json
import sys
from pathlib import Path

METHODS = {
    "nearest-neighbour": "#b03030",
    "nearest-neighbour-unique": "#d08020",
    "ihgr-published": "#3070b0",
    "likelihood-ratio": "#207040",
    "joint-likelihood-ratio": "#705090",
}
TIMED = {**METHODS, "jcbb": "#808080", "optimal assignment alone": "#50a080"}
del TIMED["joint-likelihood-ratio"]
PUBLISHED = {"nearest-neighbour": (0.805, 162), "ihgr-published": (0.975, 195)}


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def curve(rows, setting, method, what, panel, legend):
    mine = [r for r in rows if r["setting"] == setting and r["method"] == method]
    share = [100 * float(r[what]) for r in mine]
    return {
        "x": [float(r["sigma_range_m"]) for r in mine],
        "y": share,
        "error_y": {"type": "data", "symmetric": False, "thickness": 1, "width": 3,
                    "array": [100 * float(r[what + "_high"]) - s for r, s in zip(mine, share)],
                    "arrayminus": [s - 100 * float(r[what + "_low"]) for r, s in zip(mine, share)]},
        "mode": "lines+markers", "name": method, "legendgroup": method, "showlegend": legend,
        "line": {"color": METHODS[method]}, "xaxis": f"x{panel}", "yaxis": f"y{panel}",
    }


def times(rows, method, panel):
    mine = [r for r in rows if r["method"] == method]
    return {"x": [int(r["features"]) for r in mine], "y": [float(r["mean_us"]) for r in mine],
            "mode": "lines+markers", "name": method, "legendgroup": method, "showlegend": method not in METHODS,
            "line": {"color": TIMED[method]}, "xaxis": f"x{panel}", "yaxis": f"y{panel}"}


def main(sweep, figure3, page):
    rows = rows_of(sweep)
    panels = [("half circle", "no_wrong", "half circle ahead, 30 m: runs without a wrong association"),
              ("half circle", "consistent", "the same runs: pose consistent at the end"),
              ("full circle", "no_wrong", "full circle, 30 m: without a wrong association"),
              ("half circle to 10 m", "no_wrong", "half circle, 10 m: without a wrong association"),
              ("half circle, odometry x3", "no_wrong", "half circle, odometry noise x3: without a wrong association")]
    traces = []
    layout = {
        "width": 1450, "height": 1150, "margin": {"t": 90, "l": 70, "r": 20, "b": 60},
        "title": {"text": "Simulation of ihgr_zhang2005 with 95 % intervals; dotted: the paper's 80.5 % for NN and 97.5 % for IHGR"},
        "grid": {"rows": 3, "columns": 2, "pattern": "independent", "ygap": 0.3},
        "legend": {"orientation": "h", "y": -0.07}, "annotations": [], "shapes": [],
    }
    for k, (setting, what, title) in enumerate(panels, start=1):
        traces += [curve(rows, setting, method, what, k, k == 1) for method in METHODS]
        layout[f"xaxis{k}"] = {"title": {"text": "range noise [m]; bearing noise is 10° a metre", "standoff": 4},
                                 "type": "log", "tickvals": [0.03, 0.06, 0.1, 0.15, 0.2, 0.3]}
        layout[f"yaxis{k}"] = {"title": {"text": "runs [%]"}, "range": [0, 103]}
        layout["annotations"].append({"text": title, "xref": f"x{k} domain", "yref": f"y{k} domain", "x": 0, "y": 1.1,
                                      "showarrow": False, "xanchor": "left"})
        for method, (share, _) in PUBLISHED.items():
            layout["shapes"].append({"type": "line", "xref": f"x{k} domain", "yref": f"y{k}", "x0": 0, "x1": 1,
                                     "y0": 100 * share, "y1": 100 * share,
                                     "line": {"color": METHODS[method], "dash": "dot", "width": 1.5}})
    traces += [times(rows_of(figure3), method, 6) for method in TIMED]
    layout["xaxis6"] = {"title": {"text": "features, all seen in every scan", "standoff": 4}}
    layout["yaxis6"] = {"title": {"text": "mean time of a scan [µs]"}, "type": "log"}
    layout["annotations"].append({"text": "time against the number of features (the paper's Figure 3)",
                                  "xref": "x6 domain", "yref": "y6 domain", "x": 0, "y": 1.1, "showarrow": False,
                                  "xanchor": "left"})
    plotly = Path(__file__).resolve().parent.parent / "reports/page/node_modules/plotly.js-basic-dist-min/plotly-basic.min.js"
    Path(page).write_text(
        f'<meta charset="utf-8"><div id="f"></div><script src="{plotly.as_uri()}"></script>'
        f'<script>Plotly.newPlot("f", {json.dumps(traces)}, {json.dumps(layout)}, {{staticPlot: true}})</script>',
        encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        raise SystemExit(__doc__)
    main(*sys.argv[1:])
