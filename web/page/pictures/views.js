// Pictures that a reader adds to those of a scene: one column over another, a phase plot, or the points of that where a
// third column passes a number, a section. What is asked of the engine for a section is an event of the scene.
import { mostViews } from "../link.js";
import { Plot } from "./plot.js";

const title = ({ x, y, through }) => {
  if (!through) return `${y} over ${x}`;
  const { column, value, direction } = through;
  return `${y} over ${x} where ${column} ${{ rising: "rises", falling: "falls", both: "passes" }[direction]} through ${value}`;
};

/** What sections add to a scene; they bear the names of their pictures. */
export const asEvents = (views) =>
  views.filter(({ through }) => through).map((view) => {
    const { column, value, direction } = view.through;
    const when = Number(value) === 0 ? column : `${column} - (${value})`;
    return ["\n[[event]]", `name = ${JSON.stringify(title(view))}`, `when = ${JSON.stringify(when)}`,
      `direction = ${JSON.stringify(direction)}`, `plot = ${JSON.stringify([view.x, view.y])}\n`].join("\n");
  }).join("");

/** The labels of what phase plots draw. */
export const drawnBy = (views) => views.filter(({ through }) => !through).flatMap(({ x, y }) => [x, y]);

const mostPoints = 5000; // of a section (web/live_run.hpp)

/** Without the sections that a message speaks of: by their names, or by their places behind the scene's own events. */
export function withoutRefused(views, message, own) {
  const sections = views.filter(({ through }) => through);
  const place = Number(/event\.(\d+)/.exec(message)?.[1] ?? NaN) - own;
  const refused = sections.filter((view, i) => i === place || message.includes(`"${title(view)}"`));
  return views.filter((view) => !(refused.length > 0 ? refused : sections).includes(view));
}

export class Views {
  /** `form` asks for another of `state.views`, `parent` takes the pictures; `changed` hears of all, one more or less. */
  constructor(form, parent, state, changed) {
    Object.assign(this, { form, parent, state, changed, plots: [] });
    this.asked = Object.fromEntries([...form.elements].filter(({ name }) => name).map((field) => [field.name, field]));
    this.asked.phase.addEventListener("click", () => this.add({}));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const { column, value, direction } = this.asked;
      this.add({ through: { column: column.value, value: value.value, direction: direction.value } });
    });
  }

  add(more) {
    const view = { x: this.asked.x.value, y: this.asked.y.value, ...more };
    const { views } = this.state;
    if (views.length < mostViews && !views.some((other) => title(other) === title(view))) this.changed([...views, view]);
  }

  /** Offers what a run can be drawn by, the labels of its columns; sections by those that are known `within` steps. */
  offer(labels, within = []) {
    const offered = JSON.stringify([labels, within]);
    if (this.offered === offered) return;
    this.offered = offered;
    const { x, y, column } = this.asked;
    for (const [select, all, chosen] of [[x, [...labels, "t"], 0], [y, [...labels, "t"], 1], [column, within, 0]]) {
      select.replaceChildren(...all.map((label) => new Option(label, label)));
      select.selectedIndex = Math.min(chosen, all.length - 1);
    }
    this.form.hidden = labels.length === 0;
    this.form.querySelector("#through").hidden = within.length === 0;
  }

  /**
   * `runs` of one method or two: {columns, last, sections}; phase plots have the last rows, if there are many; also what
   * the scene itself has of sections.
   */
  draw(runs) {
    const all = this.state.views;
    const drawn = [
      ...all.filter(({ through }) => !through).map((view) => ({
        name: title(view) + (runs[0].last.t[0] > runs[0].columns.t[0] ? `, the last ${runs[0].last.t.length} rows` : ""),
        view, x: view.x, y: view.y, points: false, columns: runs.map(({ last }) => last) })),
      ...runs[0].sections.map(({ name, x, y, columns }, i) => ({
        name: columns[x].length < mostPoints ? name : `${name}, the last ${mostPoints} points`,
        x, y, view: all.find((view) => view.through && title(view) === name), points: true,
        columns: runs.map(({ sections }) => sections[i]?.columns ?? {}) })),
    ];
    if (drawn.map(({ name }) => name).join("\n") !== this.shown) {
      this.shown = drawn.map(({ name }) => name).join("\n");
      this.parent.replaceChildren();
      this.plots = drawn.map(({ name, view, x, y }) => {
        const plot = new Plot(this.parent, { title: name, x_label: x, y_label: y, x, curves: [y] });
        if (view) this.offerRemoval(plot, view);
        return plot;
      });
    }
    drawn.forEach(({ columns, points }, i) => this.plots[i].draw(columns, [], points));
  }

  offerRemoval(plot, view) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = "Remove";
    button.setAttribute("aria-label", `Remove ${title(view)}`);
    button.addEventListener("click", () => {
      this.asked.y.focus();
      this.changed(this.state.views.filter((other) => title(other) !== title(view)));
    });
    plot.canvas.parentElement.append(button);
  }
}
