// The laboratory: a scene, what can be turned in it, its run by one method or two, and their ledgers.
import { Completion } from "./completion.js";
import { csv, pasted, recorded, save } from "./files.js";
import { read, written } from "./link.js";
import { showPaths } from "./pictures/paths.js";
import { Picture } from "./pictures/picture.js";
import { Plot } from "./pictures/plot.js";
import { Study } from "./pictures/study.js";
import { Views, asEvents, drawnBy, withoutRefused } from "./pictures/views.js";
import { controls, literal } from "./turned.js";

const element = (id) => document.getElementById(id);
const gallery = JSON.parse(element("gallery").textContent);
const own = ""; // the method that the scene itself names
const toWrite = "your own Lagrangian"; // of the gallery, to be changed by the reader

const state = { scene: "", settings: new Map(), first: own, second: null, fair: false, views: [] };
// fair: at the same cost; views: pictures that the reader has added (pictures/views.js)
const places = new Map(); // 0 and 1: {columns, last, sections, summary, goes_on}
let worker;
let plots = [];
let panelsShown = "";
let turned = []; // what the scene has that can be turned
let whole = ""; // the scene with all changes
let isAwaited = false; // another change, until what was asked for is answered
let isGoing = false;
let rate = 0;
let engine; // {source, wasm}
let number = 0; // of what is asked for: answers to what was asked before are late
let unanswered = 0; // of the scenes that the worker was asked to read
let askedAt = 0;
const patience = 3000; // ms; whatever is asked for after that begins with another worker

const ask = (message) => worker.postMessage(message);
const sceneText = () => state.scene + asEvents(state.views);
const asked = (method) => ({ scene: sceneText(), settings: [...state.settings].map(([k, v]) => `${k}=${v}`), method });

/** Tells it, and returns whether it is about what the page has added to the scene. */
function refuse(message) {
  const place = /^scene:(\d+): /.exec(message);
  const lines = state.scene.split("\n");
  const isAdded = place !== null && place[1] > lines.length;
  const where = isAdded ? "a section" : `line ${place?.[1]}`;
  element("refusal").textContent = place ? `${where}: ${message.slice(place[0].length)}` : message;
  element("refusal").hidden = message === "";
  if (!place || isAdded) return isAdded;
  const from = lines.slice(0, place[1] - 1).join("\n").length + (place[1] > 1 ? 1 : 0);
  element("editor").setSelectionRange(from, from + lines[place[1] - 1].length);
  return false;
}

/** In the address. */
function remember() {
  history.replaceState(null, "", written({ ...state, settings: [...state.settings] }));
}

/** From the start, as the page says now. */
function prepare() {
  refuse("");
  study.forget();
  remember();
  if (unanswered > 0 && performance.now() - askedAt > patience) begin();
  ++number;
  go(false);
  places.clear();
  ask({ kind: "close", place: 1 });
  [state.first, state.second].forEach((method, place) => {
    if (method === null) return;
    ask({ kind: "open", place, number, ...asked(method), fair: place === 1 && state.fair, phases: drawnBy(state.views) });
    ++unanswered;
  });
  askedAt = performance.now();
}

/** The same while a hand moves something: never more at once than the worker answers. */
function prepareSoon() {
  if (unanswered === 0) return prepare();
  isAwaited = true;
}
function answered() {
  --unanswered;
  if (unanswered > 0 || !isAwaited) return;
  isAwaited = false;
  prepare();
}

/** What can be moved by hand in a picture of the plane: where a path begins and ends. */
function handlesOf({ x, curves }) {
  if (x !== "x" || curves[0] !== "y") return [];
  return turned.filter(({ path, value }) => path.endsWith(".position") && value.length >= 2).map(({ path, value }) => {
    const now = state.settings.has(path) ? JSON.parse(state.settings.get(path)) : value;
    return {
      name: path, x: now[0], y: now[1],
      moved(...to) {
        state.settings.set(path, literal([...to.map((each) => Number(each.toPrecision(4))), ...now.slice(2)], true));
        prepareSoon();
      },
      released() {
        element("turned").replaceChildren(); // which then has the new numbers
        prepareSoon();
      },
    };
  });
}

function go(on) {
  isGoing = on;
  element("run").textContent = on ? "Pause" : "Run";
  ask({ kind: "go", on });
}

function choose(scene) {
  state.scene = scene;
  state.settings.clear();
  [state.first, state.second, state.views] = [own, null, []];
  element("editor").value = scene;
  element("turned").replaceChildren();
  prepare();
}

/** A change of the text; of the same system methods and pictures stay. */
function edit(scene) {
  const system = (text) => /^system *=.*$/m.exec(text)?.[0];
  if (system(scene) !== system(state.scene)) return choose(scene);
  state.scene = scene;
  state.settings.clear();
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
  for (const plot of plots) plot.draw(columns, handlesOf(plot.panel));
  views.draw([...places].sort(([a], [b]) => a - b).map(([, held]) => held));
}

const frames = []; // ms that the page's own work took in the last ones
function took(ms) {
  frames.push(ms);
  if (frames.length > 100) frames.shift();
}

let isDue = false;
/** Once a frame, however many rows came. */
function redraw() {
  if (isDue) return;
  isDue = true;
  requestAnimationFrame(() => {
    isDue = false;
    if (!places.has(0)) return;
    const begun = performance.now();
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
    showPaths(element("paths"), summary, Number(state.settings.get("solver.path") ?? 0), (which) => {
      state.settings.set("solver.path", String(which));
      prepare();
    });
    for (const id of ["run", "step"]) element(id).disabled = ended;
    picture.offer(isGoing ? null : places.get(0));
    took(performance.now() - begun);
  });
}

/** Whether a scene of the gallery is of a system that the engine has, or of bodies. */
function canRun(about, scene) {
  const system = /^system = "(\w+)"/m.exec(scene)?.[1];
  return system ? about.systems.includes(system) : /^\[\[body\]\]/m.test(scene);
}

const hears = {
  ready({ about }) {
    if (element("version").textContent !== "") return;
    element("version").textContent = about.version;
    for (const [name, scene] of Object.entries(gallery))
      if (canRun(about, scene)) element("scenes").add(new Option(name, name));
    for (const id of ["run", "step", "again", "measure", "link", "export", "png", "webm", "save"])
      element(id).disabled = false;
    const linked = read(location.hash);
    if (!linked) {
      choose(gallery[element("scenes").value]);
      if (location.hash.length > 1) refuse("the link is no scene, or lacks its end; this is a scene of the gallery");
      return;
    }
    Object.assign(state, linked, { settings: new Map(linked.settings) });
    const isScene = ([, scene]) => scene === state.scene;
    element("scenes").value = Object.entries(gallery).find(isScene)?.[0] ?? ""; // or none of them
    element("editor").value = state.scene;
    prepare();
  },
  opened({ place, number: of, opened, pace }) {
    answered();
    if (of !== number) return;
    if (place === 1 && state.fair)
      element("pace").textContent = `at the same cost: ${Number(pace.toPrecision(2))} steps for one`;
    if (place !== 0) return;
    element("pace").textContent = "at the same cost";
    element("fair").checked = state.fair;
    ({ turned, whole } = opened);
    element("measure").disabled = opened.methods.length === 0;
    views.offer(opened.columns.flatMap(({ labels, on_arrows }) => (on_arrows ? [] : labels)), opened.within);
    offerMethods(opened.methods);
    if (element("turned").childElementCount === 0)
      controls(element("turned"), opened.turned, (path, text) => {
        state.settings.set(path, text);
        prepare();
        go(true);
      });
  },
  rows({ place, number: of, rate: made, ...run }) {
    if (of !== number || (place === 1 && state.second === null)) return;
    places.set(place, run);
    rate = made;
    redraw();
  },
  refused({ message, of, number: asked }) {
    if (of === "open") answered();
    if (of === "study") study.end();
    if (asked !== undefined && asked !== number) return;
    go(false);
    const isOfSection = refuse(message) || message.startsWith("event ");
    if (of !== "open") return;
    whole = "";
    if (!isOfSection || !state.views.some(({ through }) => through)) return;
    // A section that is refused has no picture by which it could be removed.
    const own = [...state.scene.matchAll(/^\s*\[\[event\]\]/gm)].length;
    state.views = withoutRefused(state.views, message, own);
    prepare();
    refuse(message);
  },
  exported({ columns }) {
    save("trajectory.csv", "text/csv", csv(columns));
  },
  schema: (answer) => completion.hear(answer),
  studied: ({ begun }) => study.begun(begun),
  measured: ({ point }) => (point.done ? study.end() : study.hear(point)),
};

const tell = (text) => (element("status").textContent = text);
const completion = new Completion(element("editor"), element("offers"), (system) => ask({ kind: "schema", system }));
const study = new Study(element("study"), element("measure"), ask, tell);
const views = new Views(element("views"), element("added"), state, (all) => {
  const before = sceneText();
  state.views = all;
  if (sceneText() === before) {
    remember();
    return ask({ kind: "draw", phases: drawnBy(all) });
  }
  prepare();
  go(true);
});
const picture = new Picture(element("stage"), element("animate"), took);

function listen() {
  element("scenes").addEventListener("change", ({ target }) => {
    if (target.value === toWrite) element("editor").closest("details").open = true;
    choose(gallery[target.value]);
  });
  element("first").addEventListener("change", ({ target }) => ((state.first = target.value), prepare()));
  element("second").addEventListener("change", ({ target }) => ((state.second = target.value || null), prepare()));
  element("fair").addEventListener("change", ({ target }) => ((state.fair = target.checked), prepare()));
  element("run").addEventListener("click", () => go(!isGoing));
  element("step").addEventListener("click", () => {
    go(false);
    ask({ kind: "step", steps: 1 });
  });
  element("again").addEventListener("click", prepare);
  element("measure").addEventListener("click", () => {
    go(false);
    study.begin(state.scene, asked(own).settings);
  });
  element("export").addEventListener("click", () => ask({ kind: "export", place: 0 }));
  element("save").addEventListener("click", () => {
    const isChanged = state.settings.size > 0 || state.first !== own;
    save("scene.toml", "application/toml", isChanged && whole ? whole : sceneText());
  });
  element("png").addEventListener("click", async () => {
    const canvases = [...document.querySelectorAll("figure canvas, #stage canvas")];
    if (canvases.length) save("lagroid.png", "image/png", await pasted(canvases));
  });
  element("webm").addEventListener("click", async () => {
    try {
      picture.begin();
      save("lagroid.webm", "video/webm", await recorded(picture.canvas, 8));
    } catch (error) {
      refuse(String(error.message));
    }
  });
  element("link").addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(location.href);
      tell("The link is on the clipboard; it holds the scene and all that was changed.");
    } catch {
      tell("The address of this page holds the scene and all that was changed.");
    }
  });
  element("editor").addEventListener("change", ({ target }) => {
    edit(target.value);
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
  window.lagroid = { state, places, study, frames, plots: () => plots };
}

start().catch((error) => refuse(String(error.message)));
