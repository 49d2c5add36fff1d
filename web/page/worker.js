// Computes away from the page: a run that would not end can be stopped, for the page ends the worker.
import { Engine, columnsOf, lastOf, sectionsOf } from "./engine.mjs";

const mostRows = 1500;
const lastRows = 5000; // where every row counts: a curve of some of them is another one
const share = 12; // ms of computing, then messages are looked at
const pause = 80; // ms from one look at the rows to the next

let engine;
const runs = new Map(); // place on the page -> {run, series, goes_on, chunk}
let going = false;
let shown = 0;
let seconds = 0;
let made = 0;

let phases = []; // labels of columns of which all the last rows are told, too

function show(place) {
  const { run, series, goes_on, number, opened, isGivenUp } = runs.get(place);
  const columns = columnsOf(engine, run, series, mostRows);
  const sections = sectionsOf(engine, run, opened.sections);
  const last = phases.length > 0 ? lastOf(engine, run, series, lastRows, phases) : { t: [] };
  const rate = seconds > 0 ? made / seconds : 0;
  const summary = engine.summary(run);
  if (isGivenUp) summary.status = "given up";
  postMessage({ kind: "rows", place, number, columns, last, sections, summary, goes_on, rate });
}

function advance(place, steps) {
  const held = runs.get(place);
  try {
    held.goes_on = engine.advance(held.run, steps);
  } catch (error) {
    Object.assign(held, { goes_on: false, isGivenUp: true });
    postMessage({ kind: "refused", of: "advance", number: held.number, message: String(error.message) });
  }
}

/** ms that a step takes, told by a run of its own; none where that is over too soon. */
function costOf(asked) {
  const { run } = engine.open(asked);
  engine.advance(run, 20); // the first steps take longer
  const [begun, enough, some] = [performance.now(), 20, 50];
  let steps = 0;
  while (performance.now() - begun < enough && engine.advance(run, some)) steps += some;
  const took = performance.now() - begun;
  engine.close(run);
  return steps > 0 ? took / steps : NaN;
}

/** {settings, pace}: what is added to a scene so that it takes as long as the first run, and its steps for one of that. */
function atTheCostOf(first, asked) {
  const dearer = costOf(asked) / costOf(first.asked);
  if (!(dearer > 0)) return { settings: [], pace: 1 };
  const time = first.opened.whole.split(/^\[/m).find((table) => table.startsWith("time]")) ?? "";
  const has = (key) => new RegExp(`^\\s*${key}\\s*=`, "m").test(time);
  const number = (value) => (Number.isInteger(value) ? `${value}.0` : String(value));
  const steps = Math.max(1, Math.round(first.opened.steps / dearer));
  const settings = [];
  if (has("steps")) settings.push(`time.steps=${steps}`);
  if (has("step")) settings.push(`time.step=${number((first.opened.step * first.opened.steps) / steps)}`);
  return { settings, pace: steps / first.opened.steps };
}

/** All runs go as many steps of the first, so that they are compared at the same place. */
function work() {
  if (!going) return;
  const begin = performance.now();
  for (const [place, held] of runs) {
    if (!held.goes_on) continue;
    const from = performance.now();
    const chunk = Math.max(1, Math.floor(held.chunk * held.pace));
    advance(place, chunk);
    const took = performance.now() - from;
    seconds += took / 1000;
    made += chunk;
    held.chunk *= Math.min(2, Math.max(0.25, share / runs.size / Math.max(took, 0.1)));
  }
  const fewest = Math.min(...[...runs.values()].map(({ chunk }) => chunk));
  for (const held of runs.values()) held.chunk = fewest;
  going = [...runs.values()].some(({ goes_on }) => goes_on);
  if (!going || begin - shown > pause) {
    shown = begin;
    for (const place of runs.keys()) show(place);
  }
  if (going) setTimeout(work, 0);
}

/**
 * `fair`: beside a run that is there, with as many steps as take the same time. All that is told of the run has the
 * `number` with which it was asked for.
 */
function open({ place, number, scene, settings, method, fair, phases: drawn }) {
  phases = drawn;
  ++studied;
  if (runs.has(place)) engine.close(runs.get(place).run);
  runs.delete(place);
  const asked = { scene, settings, method };
  const first = fair ? runs.get(0) : null;
  const { settings: more, pace } = first ? atTheCostOf(first, asked) : { settings: [], pace: 1 };
  const opened = engine.open({ ...asked, settings: [...settings, ...more] });
  runs.set(place, {
    run: opened.run, series: opened.columns, goes_on: opened.goes_on, chunk: 10, pace, asked, opened, number });
  [seconds, made] = [0, 0];
  postMessage({ kind: "opened", place, number, opened, pace });
  show(place);
}

let studied = 0; // which study is under way

/** Measures as long as nobody asks for something else. */
function measure(number) {
  if (number !== studied) return;
  try {
    const point = engine.nextOfStudy();
    postMessage({ kind: "measured", point });
    if (!point.done) setTimeout(() => measure(number), 0);
  } catch (error) {
    postMessage({ kind: "refused", of: "study", message: String(error.message) });
  }
}

const actions = {
  async begin({ wasm }) {
    engine = new Engine(await lagroidModule({ wasmBinary: wasm }));
    postMessage({ kind: "ready", about: engine.about });
  },
  open,
  schema: ({ system }) => postMessage({ kind: "schema", system, schema: engine.schema(system) }),
  study({ scene, settings }) {
    ++studied;
    going = false;
    postMessage({ kind: "studied", begun: engine.study({ scene, settings }) });
    measure(studied);
  },
  close({ place }) {
    if (!runs.has(place)) return;
    engine.close(runs.get(place).run);
    runs.delete(place);
  },
  draw({ phases: drawn }) {
    phases = drawn;
    for (const place of runs.keys()) show(place);
  },
  go({ on }) {
    if (on && runs.size === 0) throw new Error("there is no run that could go on");
    const begins = on && !going;
    going = on;
    if (begins) work();
    if (!on) for (const place of runs.keys()) show(place);
  },
  step({ steps }) {
    for (const place of runs.keys()) {
      const { goes_on, pace } = runs.get(place);
      if (goes_on) advance(place, Math.max(1, Math.round(steps * pace)));
      show(place);
    }
  },
  export({ place }) {
    if (!runs.has(place)) throw new Error("there are no rows yet");
    const { run, series } = runs.get(place);
    postMessage({ kind: "exported", columns: columnsOf(engine, run, series, Infinity) });
  },
};

let ready = Promise.resolve();

/** One after another: what is asked before the engine has begun waits for it. */
self.onmessage = ({ data }) => (ready = ready.then(() => act(data)));

async function act(data) {
  try {
    await actions[data.kind](data);
  } catch (error) {
    postMessage({ kind: "refused", of: data.kind, number: data.number, message: String(error.message) });
  }
}
