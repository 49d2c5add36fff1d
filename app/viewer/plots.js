// The curves of a run, with a mark that moves in time.
import { Chart, LinearScale, LineElement, PointElement, ScatterController } from "chart.js";

import { happened, marksOn, sections } from "./events.js";
import { reader, stepReader } from "./frames.js";

Chart.register(LinearScale, LineElement, PointElement, ScatterController);

const ink = "#1c2330";
const grey = "#6b7586";
const sand = "#f6ead0";
const palette = ["#2f6fde", "#e4572e", "#2a9d6f", "#8e5bd0", "#b07d00", "#2089a0"];
/** Six colours are not enough for twelve costates: the next six curves are dashed, the next dotted. */
const dashes = [[], [7, 3], [2, 2]];

const colourOf = (curve) => palette[curve % palette.length];
const dashOf = (curve) => dashes[Math.floor(curve / palette.length) % dashes.length];

/** The same colour with much white. */
function light(colour) {
  const parts = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
  return `rgb(${parts.map((part) => Math.round(0.22 * part + 0.78 * 255)).join(", ")})`;
}

/** A tick in as few digits as tell it from the next: limits that are no round numbers are not written out. */
export function tickLabel(value, _, ticks) {
  const values = ticks.map((tick) => tick.value);
  const apart = (values.at(-1) - values[0]) / Math.max(1, values.length - 1);
  const size = Math.max(...values.map(Math.abs));
  const digits = apart > 0 ? Math.ceil(Math.log10(size / apart)) + 1 : 3;
  return Number(value.toPrecision(Math.min(Math.max(digits, 3), 15))).toString();
}

/** What is shown of an axis: the column less an offset, near which all of its numbers lie, or 0. */
const less = (label, offset) => (offset === 0 ? label : `${label} ${offset > 0 ? "-" : "+"} ${Math.abs(offset)}`);

/** The inequalities that act somewhere, by their names: the page has them in its notes alone. */
const actingNames = (run) =>
  run.notes.map((note) => /^bands: (.*) acts$/.exec(note)?.[1]).filter((name) => name !== undefined);

/** In fewer words where both bounds of something act. */
function inShort(names) {
  const isBoth = (of) => ["upper", "lower"].every((side) => names.includes(`${side} bound of ${of}`));
  const short = names.map((name) => {
    const of = /^(?:upper|lower) bound of (.*)$/.exec(name)?.[1];
    return of !== undefined && isBoth(of) ? `bounds of ${of}` : name;
  });
  return [...new Set(short)].join(", ");
}

/** Whose bounds the levels are, as a curve's number: known where all curves have a lower and an upper one; or null. */
function ownersOf(levels, curves) {
  return levels.map((level) => {
    const phase = levels.filter(({ from, to }) => from === level.from && to === level.to);
    return phase.length === 2 * curves || curves === 1 ? phase.indexOf(level) % curves : null;
  });
}

/** The levels that may be this curve's: those that are, and any of which that is not known while its bound acts. */
function levelsOf(run, panel, curve) {
  const { curves, levels } = panel;
  const owners = ownersOf(levels, curves.length);
  const ofBounds = actingNames(run).filter((name) => curves.some((each) => name.endsWith(`bound of ${each}`)));
  const named = ofBounds.length === 0 || ofBounds.some((name) => name.endsWith(`bound of ${curves[curve]}`));
  return levels.filter((_, i) => (owners[i] === null ? named : owners[i] === curve));
}

/** To a millionth of its size, as the program decides it (app/control/results/acting.hpp). */
const isAt = (value, bound) => value !== null && Math.abs(value - bound) <= 1e-6 * Math.abs(bound);

/** The bands of a panel: from, to, and at: [curve, level] for each that is at its bound there, none elsewhere. */
export function bandsOf(run, panel) {
  const { bands = [], levels = [], curves } = panel;
  if (levels.length === 0) return bands.map(([from, to]) => ({ from, to, at: [] }));
  const reachable = curves.map((_, curve) => levelsOf(run, panel, curve));
  const reached = (row, t) =>
    curves.flatMap((name, curve) =>
      reachable[curve]
        .filter(({ value, from, to }) => from <= t && t <= to && isAt(run.columns[name][row], value))
        .slice(0, 1)
        .map(({ value }) => [curve, value]));
  const out = [];
  for (const [begin, end] of bands)
    for (let row = 1; row < run.time.length; ++row) {
      const [from, to] = [Math.max(begin, run.time[row - 1]), Math.min(end, run.time[row])];
      if (from >= to) continue;
      const at = reached(row, (from + to) / 2);
      const last = out.at(-1);
      if (last && last.to === from && String(last.at) === String(at)) last.to = to;
      else out.push({ from, to, at });
    }
  return out;
}

/** Bands behind the curves, in their colours: where several are at bounds at once, one above the other. */
const shading = (bands, offset) => ({
  id: "bands",
  beforeDraw({ ctx, chartArea: { top, bottom }, scales }) {
    ctx.save();
    for (const { from, to, at } of bands) {
      const [left, right] = [from, to].map((t) => Math.round(scales.x.getPixelForValue(t - offset)));
      const colours = at.length > 0 ? at.map(([curve]) => light(colourOf(curve))) : [sand];
      const height = (bottom - top) / colours.length;
      colours.forEach((colour, i) => {
        ctx.fillStyle = colour;
        ctx.fillRect(left, top + i * height, right - left, height);
      });
    }
    ctx.restore();
  },
});

/** What the bands say, in the legend: whose bound it is and which, and else the names of what acts. */
function legendOfBands(run, panel, bands) {
  const items = panel.curves.flatMap((name, curve) => {
    const values = bands.flatMap(({ at }) => at.filter(([which]) => which === curve).map(([, value]) => value));
    if (values.length === 0) return [];
    const ordered = [...new Set(values)].sort((a, b) => a - b);
    const written = ordered.map((value) => Number(value.toPrecision(4))).join(" or ");
    return [{ kind: "band", colour: light(colourOf(curve)), text: `${name} at its bound, ${written}` }];
  });
  if (!bands.some(({ at }) => at.length === 0)) return items;
  const names = actingNames(run);
  const which = names.length > 0 ? `: ${inShort(names)}` : "";
  return [...items, { kind: "band", colour: sand, text: `an inequality acts${which}` }];
}

/** The unit of a panel whose curves share one: its title ends with it. */
const unitOf = ({ title, y_label }) => (y_label !== "" && title.endsWith(`, ${y_label}`) ? y_label : "");

/** Every curve by its name, one alone too; and what else there is to be seen. */
function legendOf(run, panel, bands, marks) {
  const { curves, levels = [] } = panel;
  const unit = curves.length === 1 && unitOf(panel) !== "" ? `, ${unitOf(panel)}` : "";
  const items = curves.map((name, curve) => ({
    kind: ["line", "line dashed", "line dotted"][dashes.indexOf(dashOf(curve))],
    colour: colourOf(curve),
    text: name + unit,
  }));
  if (levels.length > 0) items.push({ kind: "line bound", colour: grey, text: "bounds" });
  items.push(...legendOfBands(run, panel, bands));
  if (marks.length > 0) items.push({ kind: "point", colour: ink, text: "events" });
  return items;
}

/** Words, no part of the picture: they break into lines where a window is narrow, and can be read aloud. */
function writeLegend(items, parent) {
  const list = document.createElement("ul");
  list.className = "legend";
  for (const { kind, colour, text } of items) {
    const item = document.createElement("li");
    const sample = document.createElement("span");
    sample.className = `sample ${kind}`;
    sample.style.color = colour;
    item.append(sample, text);
    list.append(item);
  }
  parent.append(list);
}

/** A figure: the title, a frame for a chart with its canvas, and the legend. */
function framed(parent, { title, x_label, y_label }, items) {
  const figure = document.createElement("figure");
  const caption = document.createElement("figcaption");
  caption.textContent = title;
  const frame = document.createElement("div");
  frame.className = "plot";
  const canvas = document.createElement("canvas");
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", `${title}: ${y_label || "curves"} over ${x_label}`);
  frame.append(canvas);
  figure.append(caption, frame);
  writeLegend(items, figure);
  parent.append(figure);
  return { frame, canvas };
}

function scatter(canvas, datasets, { x_label, y_label, x_offset = 0, y_offset = 0 }, bands = []) {
  const axis = (label, offset) => ({
    type: "linear",
    title: { display: true, text: less(label === "1" ? "no unit" : label, offset), color: grey },
    ticks: { maxTicksLimit: 6, callback: tickLabel, includeBounds: false, color: grey },
  });
  return new Chart(canvas, {
    type: "scatter",
    data: { datasets },
    plugins: [shading(bands, x_offset)],
    options: {
      animation: false,
      maintainAspectRatio: false,
      events: [],
      scales: { x: axis(x_label, x_offset), y: axis(y_label, y_offset) },
    },
  });
}

/** A bound as a line, in the colour of its curve where that is known and nobody else's is the same. */
function boundLines({ curves, levels = [], x_offset = 0, y_offset = 0 }) {
  const owners = ownersOf(levels, curves.length);
  return levels.map(({ value, from, to }, i) => {
    const isShared = levels.some((other, j) => j !== i && other.value === value && owners[j] !== owners[i]);
    return {
      label: "bound",
      data: [{ x: from - x_offset, y: value - y_offset }, { x: to - x_offset, y: value - y_offset }],
      showLine: true,
      pointRadius: 0,
      borderWidth: 1,
      borderDash: [4, 4],
      borderColor: owners[i] === null || isShared ? grey : colourOf(owners[i]),
    };
  });
}

/** One panel: curves over a column, drawn once; the mark is on a canvas above, drawn at every frame. */
class Plot {
  constructor(run, rows, panel, parent) {
    const { x_offset = 0, y_offset = 0, steps = false, equal_axes = false } = panel;
    const marks = marksOn(rows, panel);
    const bands = bandsOf(run, panel);
    const { frame, canvas } = framed(parent, panel, legendOf(run, panel, bands, marks));
    this.cursor = document.createElement("canvas");
    this.cursor.className = "cursor";
    this.cursor.setAttribute("aria-hidden", "true");
    frame.append(this.cursor);
    const x = run.columns[panel.x];
    const readX = reader(run, panel.x);
    this.x = (row) => readX(row) - x_offset;
    this.curves = panel.curves.map((curve) => {
      const readY = (steps ? stepReader : reader)(run, curve);
      return (row) => readY(row) - y_offset;
    });
    const shown = (xs, y) => (xs === null || y === null ? [] : [{ x: xs - x_offset, y: y - y_offset }]);
    const datasets = panel.curves.map((curve, i) => ({
      label: curve,
      data: run.columns[curve].flatMap((y, row, all) => shown(x[row], steps ? y ?? all[row + 1] ?? null : y)),
      showLine: true,
      stepped: steps ? "after" : false,
      pointRadius: 0,
      borderWidth: 1.5,
      borderDash: dashOf(i),
      borderColor: colourOf(i),
      backgroundColor: colourOf(i),
    }));
    datasets.push(...boundLines(panel));
    if (marks.length > 0)
      datasets.push({ label: "events", data: marks, pointRadius: 3, borderColor: ink, backgroundColor: "transparent" });
    this.chart = scatter(canvas, datasets, panel, bands);
    this.hasEqualAxes = equal_axes;
  }

  /** Widens the shorter axis until both have as many pixels a unit: a circle is round. */
  equalise() {
    const { left, right, top, bottom } = this.chart.chartArea;
    const pixels = { x: right - left, y: bottom - top };
    const all = this.chart.data.datasets.flatMap(({ data }) => data);
    const range = (axis) => {
      const values = all.map((point) => point[axis]);
      return [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))];
    };
    const ranges = { x: range("x"), y: range("y") };
    const unit = 1.1 * Math.max(...["x", "y"].map((axis) => (ranges[axis][1] - ranges[axis][0]) / pixels[axis]));
    if (!(unit > 0)) return;
    for (const axis of ["x", "y"]) {
      const middle = (ranges[axis][0] + ranges[axis][1]) / 2;
      this.chart.options.scales[axis].min = middle - (unit * pixels[axis]) / 2;
      this.chart.options.scales[axis].max = middle + (unit * pixels[axis]) / 2;
    }
    this.chart.update("none");
  }

  points() {
    return this.chart.data.datasets.reduce((sum, { data }) => sum + data.length, 0);
  }

  /** The canvas of the mark has the shape of the chart, which follows the window. */
  takeShape() {
    const { width, height } = this.chart;
    const scale = window.devicePixelRatio || 1;
    const shape = [width, height, scale].join();
    if (shape !== this.shape) {
      this.shape = shape;
      this.cursor.width = Math.round(width * scale);
      this.cursor.height = Math.round(height * scale);
      this.cursor.style.width = `${width}px`;
      this.cursor.style.height = `${height}px`;
      if (this.hasEqualAxes) this.equalise();
    }
    return { width, height, scale };
  }

  mark(row) {
    const { width, height, scale } = this.takeShape();
    const paint = this.cursor.getContext("2d");
    paint.setTransform(scale, 0, 0, scale, 0, 0);
    paint.clearRect(0, 0, width, height);
    const left = this.chart.scales.x.getPixelForValue(this.x(row));
    this.curves.forEach((curve, i) => {
      paint.fillStyle = colourOf(i);
      paint.beginPath();
      paint.arc(left, this.chart.scales.y.getPixelForValue(curve(row)), 4, 0, 2 * Math.PI);
      paint.fill();
    });
  }
}

/** The points at which an event happened, in two columns. */
class Section {
  constructor(section, parent) {
    const colours = { borderColor: palette[0], backgroundColor: palette[0] };
    const data = [{ label: section.title, data: section.points, pointRadius: 1.5, ...colours }];
    const items = [{ kind: "point", colour: palette[0], text: `where ${section.title} happened` }];
    this.chart = scatter(framed(parent, section, items).canvas, data, section);
  }
}

export class Plots {
  constructor(parent, run) {
    const rows = happened(run);
    this.plots = run.panels.map((panel) => new Plot(run, rows, panel, parent));
    this.sections = sections(run, rows).map((section) => new Section(section, parent));
  }
  mark(row) {
    for (const plot of this.plots) plot.mark(row);
  }
  points() {
    return this.plots.map((plot) => plot.points());
  }
}
