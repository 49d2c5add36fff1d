// What happened in a run: marks on its curves, sections, and a way to the moments at which it did.

/** What happened, in the order of time: the name of each event, its time and, by their labels, its columns. */
export function happened(run) {
  if (!run.events) return [];
  const { columns, rows } = run.events;
  return rows.map(({ event, t, passing, values }) => {
    const at = { t };
    columns.forEach((label, i) => (at[label] = values[i]));
    return { event, t, passing, at };
  });
}

const points = (rows, x, y, { x_offset = 0, y_offset = 0 } = {}) =>
  rows
    .filter(({ at }) => Number.isFinite(at[x]) && Number.isFinite(at[y]))
    .map(({ at }) => ({ x: at[x] - x_offset, y: at[y] - y_offset }));

/** Where something happened on the curves of a panel, as far as their columns are known there. */
export const marksOn = (rows, panel) => panel.curves.flatMap((curve) => points(rows, panel.x, curve, panel));

/** The sections that the run draws: of an event the points at which it happened, in two columns. */
export function sections(run, rows) {
  return (run.events?.watched ?? [])
    .filter(({ plot, count }) => plot && count > 0)
    .map(({ name, plot: [x, y] }) => ({
      title: name,
      x_label: x,
      y_label: y,
      points: points(rows.filter(({ event, passing }) => event === name && passing !== "touching"), x, y),
    }));
}

/** Fills the list of what happened; choosing a line of it calls `goTo` with its time. */
export function listHappened(run, list, goTo) {
  const rows = happened(run);
  list.parentElement.hidden = rows.length === 0;
  rows.forEach(({ event, t, passing }) => list.add(new Option(`${event}, ${passing}, t = ${t.toPrecision(6)}`, t)));
  list.addEventListener("change", ({ target }) => target.value !== "" && goTo(Number(target.value)));
}
