// The laboratory: a scene, what can be turned in it, its run by one method or two, and their ledgers.
import { read, written } from "./link.js";
import { Picture } from "./picture.js";
import { Plot } from "./plot.js";
import { controls } from "./turned.js";

const element = (id) => document.getElementById(id);
const gallery = JSON.parse(element("gallery").textContent);
const own = ""; // the method that the scene itself names

const state = { scene: "", settings: new Map(), first: own, second: null };
const places = new Map(); // 0 and 1: {columns, summary, goes_on}
let worker;
let plots = [];
let panelsShown = "";
let isGoing = false;
let rate = 0;
let engine; // {source, wasm}
let unanswered = 0; // of the scenes that the worker was asked to read
let askedAt = 0;
const patience = 3000; // ms; whatever is asked for after that begins with another worker

const ask = (message) => worker.postMessage(message);
const asked = (method) => ({ scene: state.scene, settings: [...state.settings].map(([k, v]) => `${k}=${v}`), method });

function refuse(message) {
  const place = /^scene:(\d+): /.exec(message);
  element("refusal").textContent = place ? `line ${place[1]}: ${message.slice(place[0].length)}` : message;
  element("refusal").hidden = message === "";
  if (!place) return;
  const lines = state.scene.split("\n");
  const from = lines.slice(0, place[1] - 1).join("\n").length + (place[1] > 1 ? 1 : 0);
  element("editor").setSelectionRange(from, from + lines[place[1] - 1].length);
}

/** From the start, as the page says now. */
function prepare() {
  refuse("");
  history.replaceState(null, "", written({
    scene: state.scene, settings: [...state.settings], first: state.first, second: state.second }));
  if (unanswered > 0 && performance.now() - askedAt > patience) begin();
  go(false);
  places.clear();
  ask({ kind: "close", place: 1 });
  [state.first, state.second].forEach((method, place) => {
    if (method === null) return;
    ask({ kind: "open", place, ...asked(method) });
    ++unanswered;
  });
  askedAt = performance.now();
}

function go(on) {
  isGoing = on;
  element("run").textContent = on ? "Pause" : "Run";
  ask({ kind: "go", on });
}

function choose(scene) {
  state.scene = scene;
  state.settings.clear();
  [state.first, state.second] = [own, null];
  element("editor").value = scene;
  element("turned").replaceChildren();
  prepare();
}

function offerMethods(methods) {
  for (const [id, chosen, none] of [["first", state.first, "of the scene"], ["second", state.second, "nothing"]]) {
    const select = element(id);
    select.replaceChildren(new Option(none, ""));
    for (const { name, order } of methods) select.add(new Option(`${name} (order ${order})`, name));
    select.value = chosen ?? "";
  }
}

function showLedger() {
  const rows = element("ledger");
  rows.replaceChildren();
  const short = (x) => (x === undefined ? "" : x === null ? "not a number" : x.toExponential(2));
  for (const [, { summary }] of [...places].sort(([a], [b]) => a - b))
    for (const { name, promise, drift, bound, verdict, reason } of summary.ledger.entries) {
      const row = rows.insertRow();
      for (const text of [summary.method, name, promise, short(drift), short(bound), verdict])
        row.insertCell().textContent = text;
      row.lastChild.className = verdict;
      if (reason) row.lastChild.title = reason;
    }
}

function showPlots() {
  const { panels } = places.get(0).summary.picture;
  const asText = JSON.stringify(panels);
  if (asText !== panelsShown) {
    element("plots").replaceChildren();
    plots = panels.map((panel) => new Plot(element("plots"), panel));
    panelsShown = asText;
  }
  const columns = [...places].sort(([a], [b]) => a - b).map(([, held]) => held.columns);
  for (const plot of plots) plot.draw(columns);
}

let isDue = false;
/** Once a frame, however many rows came. */
function redraw() {
  if (isDue) return;
  isDue = true;
  requestAnimationFrame(() => {
    isDue = false;
    if (!places.has(0)) return;
    const { summary, columns, goes_on } = places.get(0);
    const ended = [...places.values()].every((held) => !held.goes_on);
    if (ended && isGoing) go(false);
    showLedger();
    showPlots();
    const failed = [...places.values()].map(({ summary: { message } }) => message).filter(Boolean);
    const time = columns.t.length ? columns.t[columns.t.length - 1] : 0;
    // Told once a run rests: nobody wants every frame read out.
    element("status").setAttribute("aria-live", isGoing ? "off" : "polite");
    element("status").textContent = [
      `${summary.system}: step ${summary.steps} of ${summary.steps_asked}, t = ${Number(time.toPrecision(5))} s`,
      goes_on ? "" : summary.status,
      rate > 0 ? `${Number(rate.toPrecision(2)).toLocaleString("en")} steps a second` : "",
    ].filter(Boolean).join("; ");
    if (failed.length) refuse(failed.join("; "));
    for (const id of ["run", "step"]) element(id).disabled = ended;
    picture.offer(isGoing ? null : places.get(0));
  });
}

const hears = {
  ready({ about }) {
    if (element("version").textContent !== "") return;
    element("version").textContent = about.version;
    for (const [name, scene] of Object.entries(gallery))
      if (about.systems.includes(/^system = "(\w+)"/m.exec(scene)?.[1])) element("scenes").add(new Option(name, name));
    for (const id of ["run", "step", "again", "export", "link"]) element(id).disabled = false;
    const linked = read(location.hash);
    if (!linked) return choose(gallery[element("scenes").value]);
    Object.assign(state, linked, { settings: new Map(linked.settings) });
    element("scenes").selectedIndex = Object.values(gallery).indexOf(state.scene);
    element("editor").value = state.scene;
    prepare();
  },
  opened({ place, opened }) {
    --unanswered;
    if (place !== 0) return;
    offerMethods(opened.methods);
    if (element("turned").childElementCount === 0)
      controls(element("turned"), opened.turned, (path, text) => {
        state.settings.set(path, text);
        prepare();
        go(true);
      });
  },
  rows({ place, columns, summary, goes_on, rate: made }) {
    if (place === 1 && state.second === null) return;
    places.set(place, { columns, summary, goes_on });
    rate = made;
    redraw();
  },
  refused({ message, of }) {
    if (of === "open") --unanswered;
    go(false);
    refuse(message);
  },
  exported({ columns }) {
    const labels = Object.keys(columns);
    const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
    const lines = [labels.map(quoted).join(",")];
    columns.t.forEach((_, row) => lines.push(labels.map((name) => {
      const value = columns[name][row];
      return Number.isNaN(value) ? "" : value;
    }).join(",")));
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([`${lines.join("\n")}\n`], { type: "text/csv" }));
    link.download = "trajectory.csv";
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  },
};

const picture = new Picture(element("stage"), element("animate"));

function listen() {
  element("scenes").addEventListener("change", ({ target }) => choose(gallery[target.value]));
  element("first").addEventListener("change", ({ target }) => ((state.first = target.value), prepare()));
  element("second").addEventListener("change", ({ target }) => ((state.second = target.value || null), prepare()));
  element("run").addEventListener("click", () => go(!isGoing));
  element("step").addEventListener("click", () => {
    go(false);
    ask({ kind: "step", steps: 1 });
  });
  element("again").addEventListener("click", prepare);
  element("export").addEventListener("click", () => ask({ kind: "export", place: 0 }));
  element("link").addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(location.href);
      element("status").textContent = "The link is on the clipboard; it holds the scene and all that was changed.";
    } catch {
      element("status").textContent = "The address of this page holds the scene and all that was changed.";
    }
  });
  element("editor").addEventListener("change", ({ target }) => {
    choose(target.value);
    element("scenes").selectedIndex = -1;
  });
  window.addEventListener("resize", redraw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  window.addEventListener("hashchange", () => {
    if (written({ ...state, settings: [...state.settings] }) !== location.hash) location.reload();
  });
}

/** In one file the engine stands in the page, which may then lie on a disk; on a site it is beside it. */
async function findEngine() {
  const inlined = element("wasm");
  if (!inlined) return { source: "worker.js", wasm: await (await fetch("lagroid.wasm")).arrayBuffer() };
  const bytes = Uint8Array.from(atob(inlined.textContent.trim()), (c) => c.charCodeAt(0));
  const blob = new Blob([JSON.parse(element("worker").textContent)], { type: "text/javascript" });
  return { source: URL.createObjectURL(blob), wasm: bytes.buffer };
}

/** With a worker that computes nothing yet; what another one is at is given up. */
function begin() {
  worker?.terminate();
  unanswered = 0;
  worker = new Worker(engine.source);
  worker.onmessage = ({ data }) => hears[data.kind](data);
  worker.onerror = (event) => refuse(`the engine stopped: ${event.message}; load the page again`);
  ask({ kind: "begin", wasm: engine.wasm });
}

async function start() {
  listen();
  engine = await findEngine();
  begin();
  window.lagroid = { state, places };
}

start().catch((error) => refuse(String(error.message)));
