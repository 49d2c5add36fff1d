// Computes away from the page: a run that would not end can be stopped, for the page ends the worker.
import { Engine, columnsOf } from "./engine.mjs";

const mostRows = 1500;
const share = 12; // ms of computing, then messages are looked at
const pause = 80; // ms from one look at the rows to the next

let engine;
const runs = new Map(); // place on the page -> {run, series, goes_on, chunk}
let going = false;
let shown = 0;
let seconds = 0;
let made = 0;

function show(place) {
  const { run, series, goes_on } = runs.get(place);
  const columns = columnsOf(engine, run, series, mostRows);
  const rate = seconds > 0 ? made / seconds : 0;
  postMessage({ kind: "rows", place, columns, summary: engine.summary(run), goes_on, rate });
}

function advance(place, steps) {
  const held = runs.get(place);
  try {
    held.goes_on = engine.advance(held.run, steps);
  } catch (error) {
    held.goes_on = false;
    postMessage({ kind: "refused", of: "advance", message: String(error.message) });
  }
}

/** All runs go the same number of steps, so that they are compared at the same place. */
function work() {
  if (!going) return;
  const begin = performance.now();
  for (const [place, held] of runs) {
    if (!held.goes_on) continue;
    const from = performance.now();
    const chunk = Math.max(1, Math.floor(held.chunk));
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

function open({ place, scene, settings, method }) {
  if (runs.has(place)) engine.close(runs.get(place).run);
  runs.delete(place);
  const opened = engine.open({ scene, settings, method });
  runs.set(place, { run: opened.run, series: opened.columns, goes_on: opened.goes_on, chunk: 10 });
  [seconds, made] = [0, 0];
  postMessage({ kind: "opened", place, opened });
  show(place);
}

const actions = {
  async begin({ wasm }) {
    engine = new Engine(await lagroidModule({ wasmBinary: wasm }));
    postMessage({ kind: "ready", about: engine.about });
  },
  open,
  close({ place }) {
    if (!runs.has(place)) return;
    engine.close(runs.get(place).run);
    runs.delete(place);
  },
  go({ on }) {
    const begins = on && !going;
    going = on;
    if (begins) work();
    if (!on) for (const place of runs.keys()) show(place);
  },
  step({ steps }) {
    for (const place of runs.keys()) {
      if (runs.get(place).goes_on) advance(place, steps);
      show(place);
    }
  },
  export({ place }) {
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
    postMessage({ kind: "refused", of: data.kind, message: String(error.message) });
  }
}
