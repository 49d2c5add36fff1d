// Curves on a canvas: one panel of a run, with those of a second run dashed over them, or points of both; in a panel with
// logarithms, points that were measured. What can be moved by hand is drawn over them as handles.

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

/** Of what is drawn of the lists, and of places that are drawn as they are, with a margin. */
function range(lists, drawn, places) {
  let [least, most] = [Math.min(...places), Math.max(...places)];
  for (const list of lists)
    for (let row = 0; row < list.length; ++row) {
      const value = drawn(list[row]);
      if (!Number.isFinite(value)) continue;
      if (value < least) least = value;
      if (value > most) most = value;
    }
  if (least > most) return [0, 1];
  // What is the same but for rounding is drawn as a line.
  const size = Math.max(Math.abs(least), Math.abs(most));
  const margin = most - least > size * 1e-12 ? (most - least) * 0.05 : Math.max(1e-12, size * 0.1);
  return [least - margin, most + margin];
}

const reach = 14; // px, within which a handle is taken
const fine = 0.4; // px, below which nobody sees that a curve moves
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
    this.canvas.setAttribute("aria-label", `${panel.title}; ${panel.y_label} over ${panel.x_label}: ${panel.curves.join(", ")}`);
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

  /** `runs`: columns by label, of one run or two; `handles`: {x, y, moved(x, y), released()}; `points` alone, no curves. */
  draw(runs, handles = [], points = false) {
    const { panel, canvas } = this;
    // The one in hand stays the same object while others come.
    this.handles = handles.map((handle) => (this.held?.name === handle.name ? Object.assign(this.held, handle) : handle));
    canvas.classList.toggle("movable", handles.length > 0);
    const scale = window.devicePixelRatio || 1;
    const { clientWidth: width, clientHeight: height } = canvas;
    const paint = canvas.getContext("2d");
    // A canvas of another size is a new one, which costs more than what is drawn in it.
    const size = [width, height].map((length) => Math.round(length * scale));
    if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
    paint.setTransform(scale, 0, 0, scale, 0, 0);
    paint.clearRect(0, 0, width, height);
    const style = getComputedStyle(canvas);
    const [ink, faint] = ["--ink", "--line"].map((name) => style.getPropertyValue(name));
    const drawn = (offset = 0) => (panel.log ? (value) => Math.log10(value - offset) : (value) => value - offset);
    const [x_drawn, y_drawn] = [drawn(panel.x_offset), drawn(panel.y_offset)];
    const curves = runs.flatMap((columns, which) =>
      panel.curves.map((name, i) => ({
        which,
        colour: palette[(i + which * panel.curves.length) % palette.length],
        x: columns[panel.x_of ? panel.x_of(name) : panel.x] ?? [],
        y: columns[name] ?? [],
      })));
    let [left, right] = range([...new Set(curves.map(({ x }) => x))], x_drawn, handles.map(({ x }) => x));
    let [low, high] = range(curves.map(({ y }) => y), y_drawn, handles.map(({ y }) => y));
    const box = { left: 62, top: 6, width: width - 72, height: height - 40 };
    if (panel.equal_axes) {
      const unit = Math.max((right - left) / box.width, (high - low) / box.height);
      const middle = [(left + right) / 2, (low + high) / 2];
      [left, right] = [middle[0] - (unit * box.width) / 2, middle[0] + (unit * box.width) / 2];
      [low, high] = [middle[1] - (unit * box.height) / 2, middle[1] + (unit * box.height) / 2];
    }
    if (this.held) [left, right, low, high] = this.shown;
    this.shown = [left, right, low, high];
    const [x_unit, y_unit, bottom] = [box.width / (right - left), box.height / (high - low), box.top + box.height];
    const at = (x, y) => [box.left + (x - left) * x_unit, bottom - (y - low) * y_unit];
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
      if (points) {
        paint.fillStyle = colour;
        for (let row = 0; row < x.length; ++row) {
          const [px, py] = at(x_drawn(x[row]), y_drawn(y[row]));
          if (Number.isFinite(px) && Number.isFinite(py)) paint.fillRect(px - 1, py - 1, 2, 2);
        }
        continue;
      }
      paint.strokeStyle = colour;
      paint.setLineDash(which === 0 ? [] : [6, 4]);
      paint.beginPath();
      let [px, py] = [NaN, NaN]; // where the pen is
      for (let row = 0; row < x.length; ++row) {
        const qx = box.left + (x_drawn(x[row]) - left) * x_unit;
        const qy = bottom - (y_drawn(y[row]) - low) * y_unit;
        if (!Number.isFinite(qx) || !Number.isFinite(qy)) {
          px = NaN;
          continue;
        }
        if (row + 1 < x.length && Math.abs(qx - px) < fine && Math.abs(qy - py) < fine) continue;
        if (Number.isNaN(px)) paint.moveTo(qx, qy);
        else paint.lineTo(qx, qy);
        px = qx;
        py = qy;
      }
      paint.stroke();
      if (!panel.log) continue;
      paint.fillStyle = colour;
      x.forEach((value, row) => {
        paint.beginPath();
        paint.arc(...at(x_drawn(value), y_drawn(y[row])), 2.5, 0, 2 * Math.PI);
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
