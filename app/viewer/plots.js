// The curves of a run, with a mark that moves in time.
import { Chart, Legend, LinearScale, LineElement, PointElement, ScatterController, Title } from "chart.js";

import { happened, marksOn, sections } from "./events.js";
import { reader, stepReader } from "./frames.js";

Chart.register(Legend, LinearScale, LineElement, PointElement, ScatterController, Title);

const palette = ["#2f6fde", "#e4572e", "#2a9d6f", "#8e5bd0", "#d9a514", "#3aa6b9"];

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

/** Bands behind the curves: the stretches of the x axis where an inequality acts. */
const shading = (bands) => ({
  id: "bands",
  beforeDatasetsDraw({ ctx, chartArea, scales }) {
    ctx.save();
    ctx.fillStyle = "#f6ead0";
    for (const [from, to] of bands) {
      const left = scales.x.getPixelForValue(from);
      ctx.fillRect(left, chartArea.top, scales.x.getPixelForValue(to) - left, chartArea.bottom - chartArea.top);
    }
    ctx.restore();
  },
});

/** A frame for a chart, with its canvas. */
function framed(parent) {
  const frame = document.createElement("div");
  frame.className = "plot";
  const canvas = document.createElement("canvas");
  frame.append(canvas);
  parent.append(frame);
  return { frame, canvas };
}

function scatter(canvas, datasets, { title, x_label, y_label, x_offset = 0, y_offset = 0, bands = [] }, legend) {
  const axis = (label, offset) => ({
    type: "linear",
    title: { display: true, text: less(label, offset) },
    ticks: { maxTicksLimit: 6, callback: tickLabel },
  });
  return new Chart(canvas, {
    type: "scatter",
    data: { datasets },
    plugins: [shading(bands)],
    options: {
      animation: false,
      maintainAspectRatio: false,
      events: [],
      scales: { x: axis(x_label, x_offset), y: axis(y_label, y_offset) },
      plugins: { title: { display: true, text: title }, legend },
    },
  });
}

/** One panel: curves over a column, drawn once; the mark is on a canvas above, drawn at every frame. */
class Plot {
  constructor(run, rows, panel, parent) {
    const { frame, canvas } = framed(parent);
    this.cursor = document.createElement("canvas");
    this.cursor.className = "cursor";
    frame.append(this.cursor);
    const { x_offset = 0, y_offset = 0, steps = false, levels = [] } = panel;
    const x = run.columns[panel.x];
    const readX = reader(run, panel.x);
    this.x = (row) => readX(row) - x_offset;
    this.curves = panel.curves.map((curve) => {
      const readY = (steps ? stepReader : reader)(run, curve);
      return (row) => readY(row) - y_offset;
    });
    const shown = (xs, y) => (xs === null || y === null ? [] : [{ x: xs - x_offset, y: y - y_offset }]);
    const curves = panel.curves.map((curve, i) => ({
      label: curve,
      data: run.columns[curve].flatMap((y, row, all) => shown(x[row], steps ? y ?? all[row + 1] ?? null : y)),
      showLine: true,
      stepped: steps ? "after" : false,
      pointRadius: 0,
      borderWidth: 1.5,
      borderColor: palette[i % palette.length],
      backgroundColor: palette[i % palette.length],
    }));
    const count = curves.length;
    for (const { value, from, to } of levels)
      curves.push({
        label: "bound",
        data: [{ x: from - x_offset, y: value - y_offset }, { x: to - x_offset, y: value - y_offset }],
        showLine: true,
        pointRadius: 0,
        borderWidth: 1,
        borderDash: [4, 4],
        borderColor: "#8a94a6",
      });
    const marks = marksOn(rows, panel);
    if (marks.length > 0)
      curves.push({ label: "events", data: marks, pointRadius: 3, borderColor: "#1c2330", backgroundColor: "transparent" });
    this.chart = scatter(canvas, curves, panel, {
      display: count > 1 || marks.length > 0,
      position: "bottom",
      labels: { boxWidth: 12, filter: ({ text }) => text !== "bound" },
    });
    if (panel.equal_axes) this.equalise();
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

  mark(row) {
    const { width, height } = this.chart;
    const scale = window.devicePixelRatio || 1;
    if (this.cursor.width !== width * scale || this.cursor.height !== height * scale) {
      this.cursor.width = width * scale;
      this.cursor.height = height * scale;
      this.cursor.style.width = `${width}px`;
      this.cursor.style.height = `${height}px`;
    }
    const paint = this.cursor.getContext("2d");
    paint.setTransform(scale, 0, 0, scale, 0, 0);
    paint.clearRect(0, 0, width, height);
    const left = this.chart.scales.x.getPixelForValue(this.x(row));
    this.curves.forEach((curve, i) => {
      paint.fillStyle = palette[i % palette.length];
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
    this.chart = scatter(framed(parent).canvas, data, section, { display: false });
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
