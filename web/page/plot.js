// Curves on a canvas: one panel of a run, with those of a second run dashed over them; in a panel with logarithms, points
// that were measured. What can be moved by hand is drawn over them as handles.

const palette = ["#2f6fde", "#e4572e", "#2a9d6f", "#8e5bd0", "#d9a514", "#3aa6b9"];

/** Round numbers between two, about so many, and not nearer to each other than that. */
export function ticks(least, most, about, nearest = 0) {
  const raw = Math.max((most - least) / about, nearest);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((digit) => digit * power).find((size) => size >= raw);
  const all = [];
  for (let k = Math.ceil(least / step); k * step <= most; ++k) all.push(k * step);
  return all;
}

function range(lists) {
  let [least, most] = [Infinity, -Infinity];
  for (const list of lists)
    for (const value of list)
      if (Number.isFinite(value)) [least, most] = [Math.min(least, value), Math.max(most, value)];
  if (least > most) return [0, 1];
  const margin = (most - least) * 0.05 || Math.max(1e-12, Math.abs(most) * 0.1);
  return [least - margin, most + margin];
}

const reach = 14; // px, within which a handle is taken
const power = (value) => `1e${Math.round(value)}`;
const label = (value, step) => {
  const small = Math.abs(value) < step / 1e6 ? 0 : value;
  return String(Number(small.toPrecision(6)));
};

export class Plot {
  constructor(parent, panel) {
    this.panel = panel;
    const figure = document.createElement("figure");
    const caption = document.createElement("figcaption");
    caption.textContent = panel.title;
    if (panel.curves.length > 1)
      panel.curves.forEach((name, i) => {
        const curve = document.createElement("span");
        curve.textContent = name;
        curve.style.color = palette[i % palette.length];
        caption.append(" ", curve);
      });
    this.canvas = document.createElement("canvas");
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", `${panel.y_label} over ${panel.x_label}: ${panel.curves.join(", ")}`);
    figure.append(caption, this.canvas);
    parent.append(figure);
    this.handles = [];
    this.held = null;
    this.canvas.addEventListener("pointerdown", (event) => this.take(event));
    this.canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const end of ["pointerup", "pointercancel"]) this.canvas.addEventListener(end, () => this.release());
  }

  take(event) {
    const near = ({ x, y }) => Math.hypot(...this.at(x, y).map((px, i) => px - [event.offsetX, event.offsetY][i]));
    this.held = this.handles.find((handle) => near(handle) < reach) ?? null;
    if (!this.held) return;
    event.preventDefault();
    this.canvas.setPointerCapture(event.pointerId);
  }
  /** What is moved answers with its next runs, in axes that stay as they are. */
  move(event) {
    if (this.held) this.held.moved(...this.back(event.offsetX, event.offsetY));
  }
  release() {
    const { held } = this;
    this.held = null;
    held?.released();
  }

  /** `runs`: columns by label, of one run or two; `handles`: {x, y, moved(x, y), released()}. */
  draw(runs, handles = []) {
    const { panel, canvas } = this;
    // The one in hand stays the same object while others come.
    this.handles = handles.map((handle) => (this.held?.name === handle.name ? Object.assign(this.held, handle) : handle));
    canvas.classList.toggle("movable", handles.length > 0);
    const scale = window.devicePixelRatio || 1;
    const { clientWidth: width, clientHeight: height } = canvas;
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
    const paint = canvas.getContext("2d");
    paint.setTransform(scale, 0, 0, scale, 0, 0);
    const [ink, faint] = ["--ink", "--line"].map((name) => getComputedStyle(canvas).getPropertyValue(name));
    const scaled = panel.log ? Math.log10 : (value) => value;
    const less = (values, offset) => (values ? Array.from(values, (value) => scaled(value - (offset || 0))) : []);
    const curves = runs.flatMap((columns, which) =>
      panel.curves.map((name, i) => ({
        which,
        colour: palette[(i + which * panel.curves.length) % palette.length],
        x: less(columns[panel.x_of ? panel.x_of(name) : panel.x], panel.x_offset),
        y: less(columns[name], panel.y_offset),
      })));
    let [left, right] = range([...curves.map(({ x }) => x), handles.map(({ x }) => x)]);
    let [low, high] = range([...curves.map(({ y }) => y), handles.map(({ y }) => y)]);
    const box = { left: 62, top: 6, width: width - 72, height: height - 40 };
    if (panel.equal_axes) {
      const unit = Math.max((right - left) / box.width, (high - low) / box.height);
      const middle = [(left + right) / 2, (low + high) / 2];
      [left, right] = [middle[0] - (unit * box.width) / 2, middle[0] + (unit * box.width) / 2];
      [low, high] = [middle[1] - (unit * box.height) / 2, middle[1] + (unit * box.height) / 2];
    }
    if (this.held) [left, right, low, high] = this.shown;
    this.shown = [left, right, low, high];
    const at = (x, y) => [
      box.left + ((x - left) / (right - left)) * box.width,
      box.top + box.height - ((y - low) / (high - low)) * box.height,
    ];
    this.at = at;
    this.back = (px, py) => [
      left + ((px - box.left) / box.width) * (right - left),
      low + ((box.top + box.height - py) / box.height) * (high - low),
    ];
    const [nearest, words] = panel.log ? [1, power] : [0, label];
    paint.font = "11px system-ui, sans-serif";
    paint.fillStyle = ink;
    paint.strokeStyle = faint;
    paint.lineWidth = 1;
    paint.textAlign = "center";
    for (const x of ticks(left, right, box.width / 80, nearest)) {
      const [px] = at(x, low);
      paint.strokeRect(px, box.top, 0, box.height);
      paint.fillText(words(x, right - left), px, box.top + box.height + 14);
    }
    paint.textAlign = "right";
    for (const y of ticks(low, high, box.height / 34, nearest)) {
      const [, py] = at(left, y);
      paint.strokeRect(box.left, py, box.width, 0);
      paint.fillText(words(y, high - low), box.left - 5, py + 4);
    }
    paint.textAlign = "center";
    paint.fillText(panel.x_label, box.left + box.width / 2, height - 6);
    paint.save();
    paint.beginPath();
    paint.rect(box.left, box.top, box.width, box.height);
    paint.clip();
    paint.lineWidth = 1.5;
    for (const { which, colour, x, y } of curves) {
      paint.strokeStyle = colour;
      paint.setLineDash(which === 0 ? [] : [6, 4]);
      paint.beginPath();
      let drawn = false;
      x.forEach((value, row) => {
        if (!Number.isFinite(y[row])) return void (drawn = false);
        paint[drawn ? "lineTo" : "moveTo"](...at(value, y[row]));
        drawn = true;
      });
      paint.stroke();
      if (!panel.log) continue;
      paint.fillStyle = colour;
      x.forEach((value, row) => {
        paint.beginPath();
        paint.arc(...at(value, y[row]), 2.5, 0, 2 * Math.PI);
        paint.fill();
      });
    }
    paint.setLineDash([]);
    paint.strokeStyle = paint.fillStyle = ink;
    for (const { x, y } of handles) {
      paint.beginPath();
      paint.arc(...at(x, y), 6, 0, 2 * Math.PI);
      paint.stroke();
    }
    paint.restore();
  }
}
