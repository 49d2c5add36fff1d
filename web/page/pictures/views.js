// Pictures that a reader adds to those of a scene: one column over another, a phase plot, or the points of that where a
// third column passes a number, a section. What is asked of the engine for a section is an event of the scene.
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

export class Views {
  /** `form` asks for another view, `parent` takes the pictures; `changed` hears when there is one more or less. */
  constructor(form, parent, changed) {
    Object.assign(this, { form, parent, changed, all: [], plots: [] });
    this.asked = Object.fromEntries([...form.elements].filter(({ name }) => name).map((field) => [field.name, field]));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      const { x, y, column, value, direction } = this.asked;
      const view = { x: x.value, y: y.value };
      if (event.submitter.value === "section")
        view.through = { column: column.value, value: value.value || "0", direction: direction.value };
      if (!this.all.some((other) => title(other) === title(view))) changed([...this.all, view]);
    });
  }

  /** Offers what a run can be drawn by: the labels of its columns. */
  offer(labels) {
    if (this.labels?.join() === labels.join()) return;
    this.labels = labels;
    const { x, y, column } = this.asked;
    for (const [select, chosen, more] of [[x, 0, ["t"]], [y, 1, ["t"]], [column, 0, []]]) {
      select.replaceChildren(...[...labels, ...more].map((label) => new Option(label, label)));
      select.selectedIndex = Math.min(chosen, labels.length - 1);
    }
    this.form.hidden = labels.length === 0;
  }

  /** `runs` of one method or two: {columns, last, sections}; phase plots have the last rows, if there are many; also what the scene itself has of sections. */
  draw(all, runs) {
    const drawn = [
      ...all.filter(({ through }) => !through).map((view) => ({
        name: title(view) + (runs[0].last.t[0] > runs[0].columns.t[0] ? `, the last ${runs[0].last.t.length} rows` : ""),
        view, x: view.x, y: view.y, points: false, columns: runs.map(({ last }) => last) })),
      ...runs[0].sections.map(({ name, x, y }, i) => ({
        name, x, y, view: all.find((view) => view.through && title(view) === name), points: true,
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
    this.all = all;
    drawn.forEach(({ columns, points }, i) => this.plots[i].draw(columns, [], points));
  }

  offerRemoval(plot, view) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = "Remove";
    button.setAttribute("aria-label", `Remove ${title(view)}`);
    button.addEventListener("click", () => this.changed(this.all.filter((other) => title(other) !== title(view))));
    plot.canvas.parentElement.append(button);
  }
}
