// The page of a run: animation, curves, ledger, and the time that they share.
import { Stage } from "./bodies.js";
import { listHappened } from "./events.js";
import { rowAt } from "./frames.js";
import { Plots } from "./plots.js";

const element = (id) => document.getElementById(id);
const run = JSON.parse(element("run").textContent);
run.columns.t = run.time;

/** A text is touched only where it changes: 60 times a second programs that read pages aloud would hear of it. */
function write(id, text) {
  if (element(id).textContent !== text) element(id).textContent = text;
}

function fillIn() {
  document.title = `${run.system} - lagroid`;
  element("title").textContent = run.system;
  element("status").textContent = `${run.status}, ${run.steps} steps${run.message ? `: ${run.message}` : ""}`;
  element("status").classList.toggle("failed", run.status !== "converged");
  const rows = element("ledger").querySelector("tbody");
  element("ledger").querySelector("table").hidden = run.ledger.length === 0;
  for (const { name, promise, drift, relative_drift, verdict } of run.ledger) {
    const row = rows.insertRow();
    const short = (x) => (x === null ? "not a number" : x.toExponential(2));
    for (const text of [name, promise, short(drift), short(relative_drift), verdict])
      row.insertCell().textContent = text;
    row.lastChild.className = verdict;
  }
  for (const note of run.notes) {
    const item = document.createElement("li");
    item.textContent = note;
    element("notes").append(item);
  }
}

/** A sentence where the picture would be; an empty one takes it away. */
function sayNothing(sentence) {
  element("nothing").textContent = sentence;
  element("nothing").hidden = sentence === "";
  element("bodies").hidden = sentence !== "";
}

const rest = "The plots, the time and the table work without it.";

/** The bodies in space, or null where there are none or this browser cannot draw them: all else goes on. */
function makeStage() {
  let stage = null;
  try {
    if (run.shapes.length > 0) stage = new Stage(element("bodies"), run);
    else sayNothing("This system has no picture in space; its curves are below.");
  } catch (error) {
    console.warn(error);
    sayNothing(`The picture in space cannot be drawn: ${error.message}. ${rest}`);
  }
  document.querySelector("main").classList.toggle("flat", stage === null);
  element("camera").hidden = stage === null;
  element("trails").parentElement.hidden = !run.shapes.some(({ trail }) => trail) || stage === null;
  const canvas = element("bodies");
  canvas.addEventListener("webglcontextlost", () => sayNothing(`The graphics card has dropped the picture. ${rest}`));
  canvas.addEventListener("webglcontextrestored", () => sayNothing(""));
  return stage;
}

/** Whether somebody has asked the system for pages that keep still. */
const keepsStill = () => window.matchMedia("(prefers-reduced-motion: reduce)").matches;

/** The time shown: runs from the first row to the last, and again. */
class Player {
  constructor(time) {
    this.time = time;
    this.first = time[0];
    this.last = time[time.length - 1];
    this.t = this.first;
    this.playing = this.last > this.first && !keepsStill();
    this.speed = this.speeds()[2];
  }
  /** From a quarter of the speed that shows all in 20 s, to four times that. */
  speeds() {
    return [0.25, 0.5, 1, 2, 4].map((factor) => (factor * (this.last - this.first)) / 20);
  }
  pass(seconds) {
    if (!this.playing) return;
    this.t += seconds * this.speed;
    if (this.t > this.last) this.t = this.first;
  }
  row() {
    return rowAt(this.time, this.t);
  }
}

function start() {
  fillIn();
  const player = new Player(run.time);
  const plots = new Plots(element("plots"), run);
  const stage = makeStage();

  const scrub = element("scrub");
  scrub.min = player.first;
  scrub.max = player.last;
  const goTo = (t) => {
    player.playing = false;
    player.t = t;
  };
  scrub.addEventListener("input", () => goTo(Number(scrub.value)));
  listHappened(run, element("happened"), goTo);
  const toggle = () => (player.playing = !player.playing);
  element("play").addEventListener("click", toggle);
  document.addEventListener("keydown", (event) => {
    if (event.code !== "Space" || event.target.closest("button, select, input")) return;
    event.preventDefault();
    toggle();
  });
  for (const speed of player.speeds()) {
    const choice = new Option(`${Number(speed.toPrecision(2))} x`, speed);
    element("speed").add(choice);
    choice.selected = speed === player.speed;
  }
  element("speed").addEventListener("change", ({ target }) => (player.speed = Number(target.value)));
  element("camera").addEventListener("click", () => stage?.lookAtAll());
  element("trails").addEventListener("change", ({ target }) => stage?.showTrails(target.checked));

  let before = performance.now();
  const frame = (now) => {
    player.pass((now - before) / 1000);
    before = now;
    const row = player.row();
    stage?.draw(row);
    plots.mark(row);
    if (document.activeElement !== scrub || player.playing) scrub.value = player.t;
    write("clock", `t = ${player.t.toPrecision(5)} s`);
    write("play", player.playing ? "Pause" : "Play");
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
  window.lagroid = { player, plots, stage };
}

start();
