// What every part of the page uses: its data, and text. Frames: map frame, metres; times: seconds of the log.
"use strict";
const parse = (id) => JSON.parse(document.getElementById(id).textContent);
const data = parse("run-data");
const clock = parse("wall-clock");
const summary = data.summary;
const byId = (id) => document.getElementById(id);

const element = (name, text, className) => {
  const node = document.createElement(name);
  if (text !== undefined) node.textContent = text;
  if (className) node.className = className;
  return node;
};
const known = (value) => value !== null && value !== undefined;
const fixed = (value, digits) => (known(value) ? value.toFixed(digits) : "–");
const metres = (value) => (known(value) ? `${value.toFixed(Math.abs(value) < 10 ? 3 : 2)} m` : "–");
const degrees = (radians) => (known(radians) ? `${(radians * 180 / Math.PI).toFixed(3)}°` : "–");
const percent = (value) => (known(value) ? `${(100 * value).toFixed(1)} %` : "–");
const thousands = new Intl.NumberFormat("en");
const count = (value) => (known(value) ? thousands.format(value).replace(/,/g, "\u202f") : "–");
const microseconds = (value) => {
  if (!known(value)) return "–";
  return value < 1000 ? `${value.toFixed(0)} µs` : `${(value / 1000).toFixed(1)} ms`;
};
const duration = (seconds) => {
  const minutes = Math.floor(seconds / 60);
  if (minutes >= 120) return `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
  return minutes > 0 ? `${minutes} min ${Math.round(seconds - 60 * minutes)} s` : `${seconds.toFixed(1)} s`;
};

const table = (title, rows) => {
  const box = element("div");
  if (title) box.append(element("h3", title));
  const body = element("table");
  for (const [name, value] of rows) {
    const row = element("tr");
    row.append(element("td", name), element("td", value, "number"));
    body.append(row);
  }
  box.append(body);
  return box;
};

const last = (list) => list[list.length - 1];

// A smoother's run without a filter: no steps that were estimated one after the other, so nothing of them to show.
const smoothing = data.smoothing;
const filtered = !(smoothing && smoothing.alone);
const empty = summary.steps === 0;
