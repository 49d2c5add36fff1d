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
    const types = ["number", "number"];
    const count = this.module.ccall("lagroid_count", "number", types, [run, series]);
    const at = this.module.ccall("lagroid_values", "number", types, [run, series]) / 8;
    return this.module.HEAPF64.subarray(at, at + count);
  }
  close(run) {
    this.module.ccall("lagroid_close", null, ["number"], [run]);
  }
}

/** Columns by label, of at most so many rows, evenly spaced, and the last. On arrows there is none at the first node. */
export function columnsOf(engine, run, series, most) {
  const time = engine.values(run, -1);
  const stride = Math.max(1, Math.ceil(time.length / most));
  const rows = [];
  for (let row = 0; row < time.length; row += stride) rows.push(row);
  if (rows.length && rows[rows.length - 1] !== time.length - 1) rows.push(time.length - 1);
  const columns = { t: Float64Array.from(rows, (row) => time[row]) };
  series.forEach(({ labels, on_arrows }, i) => {
    const values = engine.values(run, i);
    const first = on_arrows ? 1 : 0;
    labels.forEach((label, component) => {
      columns[label] = Float64Array.from(rows, (row) =>
        row < first ? NaN : values[(row - first) * labels.length + component]);
    });
  });
  return columns;
}
