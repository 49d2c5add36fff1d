// The compiled laboratory, as a page and node see it.

/** Runs of scenes, by number. `module` is what emscripten's factory made. */
export class Engine {
  constructor(module) {
    this.module = module;
    this.about = this.ask("lagroid_begin", [], []);
  }
  /** Calls a function that returns JSON; throws where it says that something is wrong. */
  ask(name, types, values) {
    const answer = JSON.parse(this.module.ccall(name, "string", types, values));
    if (answer.status === "invalid_scene" || answer.status === "failed") throw new Error(answer.message);
    return answer;
  }
  open({ scene, settings = [], method = "" }) {
    return this.ask("lagroid_open", ["string"], [JSON.stringify({ scene, settings, method })]);
  }
  /** At most so many steps more; whether there is more to do. */
  advance(run, steps) {
    return this.ask("lagroid_advance", ["number", "number"], [run, steps]).goes_on;
  }
  /** What scenes of a system may hold, as a JSON Schema; of bodies where none is named. */
  schema(system) {
    return this.ask("lagroid_schema", ["string"], [system]);
  }
  /** Begins to measure what accuracy costs, which takes some seconds. */
  study({ scene, settings = [] }) {
    return this.ask("lagroid_study", ["string"], [JSON.stringify({ scene, settings })]);
  }
  /** The study's next run, {method, step, error, seconds}; {done} where there is none. */
  nextOfStudy() {
    return this.ask("lagroid_study_next", [], []);
  }
  /** What `lagroid run` would write as summary.json. A run that failed says so in it, and is no error here. */
  summary(run) {
    return JSON.parse(this.module.ccall("lagroid_summary", "string", ["number"], [run]));
  }
  /** Numbers of a series, of time where it is negative: a view of the memory, to be copied before the next step. */
  values(run, series) {
    return this.numbers("lagroid_values", "lagroid_count", run, series);
  }
  /** Points x, y of a section one after another; a view in the same way. */
  section(run, event) {
    return this.numbers("lagroid_section", "lagroid_section_count", run, event);
  }
  numbers(place, counted, run, which) {
    const types = ["number", "number"];
    const count = this.module.ccall(counted, "number", types, [run, which]);
    const at = this.module.ccall(place, "number", types, [run, which]) / 8;
    return this.module.HEAPF64.subarray(at, at + count);
  }
  close(run) {
    this.module.ccall("lagroid_close", null, ["number"], [run]);
  }
}

/** Columns by label, of at most so many rows, evenly spaced, and the last. */
export function columnsOf(engine, run, series, most) {
  const count = engine.values(run, -1).length;
  const stride = Math.max(1, Math.ceil(count / most));
  const rows = [];
  for (let row = 0; row < count; row += stride) rows.push(row);
  if (rows.length && rows[rows.length - 1] !== count - 1) rows.push(count - 1);
  return columnsAt(engine, run, series, rows);
}

/** All of the last rows, so many, of the columns with these labels and of time. */
export function lastOf(engine, run, series, most, wanted) {
  const count = engine.values(run, -1).length;
  const first = Math.max(0, count - most);
  const rows = Array.from({ length: count - first }, (_, i) => first + i);
  return columnsAt(engine, run, series, rows, wanted);
}

/** On arrows there is nothing at the first node. */
function columnsAt(engine, run, series, rows, wanted) {
  const time = engine.values(run, -1);
  const columns = { t: Float64Array.from(rows, (row) => time[row]) };
  series.forEach(({ labels, on_arrows }, i) => {
    const values = engine.values(run, i);
    const first = on_arrows ? 1 : 0;
    labels.forEach((label, component) => {
      if (wanted && !wanted.includes(label)) return;
      columns[label] = Float64Array.from(rows, (row) =>
        row < first ? NaN : values[(row - first) * labels.length + component]);
    });
  });
  return columns;
}

/** The last points of all sections of a run: {name, x, y}, labels, and the columns by these. */
export function sectionsOf(engine, run, sections) {
  return sections.map(({ event, name, x, y }) => {
    const points = engine.section(run, event);
    const of = (which) => Float64Array.from({ length: points.length / 2 }, (_, i) => points[2 * i + which]);
    return { name, x, y, columns: { [x]: of(0), [y]: of(1) } };
  });
}
