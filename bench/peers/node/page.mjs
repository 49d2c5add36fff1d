// What was measured, as Markdown.
import { cpus } from "node:os";

const targets = [1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8];
const power = (error) => error.toExponential(0);

function time(seconds) {
  for (const [unit, size] of [["s", 1], ["ms", 1e-3], ["us", 1e-6]])
    if (seconds >= size || unit === "us") return `${Number((seconds / size).toPrecision(3))} ${unit}`;
}

/** The cheapest run that is no farther off than that; undefined where there is none. */
const cheapest = (runs, target) =>
  runs.filter(({ error }) => error <= target).sort((a, b) => a.seconds - b.seconds)[0];

function row({ engine, method, runs }) {
  const best = [...runs].sort((a, b) => a.error - b.error)[0];
  const done = runs.filter(({ error }) => error < Infinity);
  const cells = targets.map((target) => {
    const run = cheapest(runs, target);
    return run ? `${time(run.seconds)} (${run.drift.toExponential(0)})` : "-";
  });
  const ends = done.length === 0 ? ["-", "-"] : [best.error.toExponential(1), best.drift.toExponential(1)];
  const perStep = done.length === 0 ? "-" : time(done.at(-1).seconds / done.at(-1).steps);
  return `| ${engine} ${method} | ${[...cells, ...ends, perStep].join(" | ")} |`;
}

/** The cheapest of ours, or of theirs, that gets there; undefined where none does. */
const bestOf = (found, isOurs, target) => found.filter(({ engine }) => (engine === "lagroid") === isOurs)
  .map((way) => ({ way, run: cheapest(way.runs, target) })).filter(({ run }) => run)
  .sort((a, b) => a.run.seconds - b.run.seconds)[0];

/** The best of theirs over the best of ours, for each error. */
function comparison(found) {
  return targets.map((target) => {
    const [ours, theirs] = [bestOf(found, true, target), bestOf(found, false, target)];
    if (!ours && !theirs) return "";
    const said = (one) => one ? `${time(one.run.seconds)}, ${one.way.engine} ${one.way.method}` : "-";
    const ratio = ours && theirs ? theirs.run.seconds / ours.run.seconds : undefined;
    const verdict = !ours ? "**loss**: we do not get there" : !theirs ? "win: no other gets there"
      : `${Number(ratio.toPrecision(3))}${ratio < 1 ? ", **loss**" : ""}`;
    return `| ${power(target)} | ${said(ours)} | ${said(theirs)} | ${verdict} |`;
  }).filter(Boolean);
}

/** One line a problem: their time over ours, error by error. */
function summary(studies) {
  const cells = ({ found }) => targets.map((target) => {
    const [ours, theirs] = [bestOf(found, true, target), bestOf(found, false, target)];
    if (!ours) return theirs ? "**loss**" : "-";
    if (!theirs) return "win";
    const ratio = theirs.run.seconds / ours.run.seconds;
    return ratio < 1 ? `**${Number(ratio.toPrecision(2))}**` : `${Number(ratio.toPrecision(2))}`;
  });
  return [`| their time over ours, for an error of | ${targets.map(power).join(" | ")} |`, `|---|${targets.map(() => "---|").join("")}`,
          ...studies.map((made) => `| ${made.problem.name} | ${cells(made).join(" | ")} |`)].join("\n");
}

export function sectionOf({ problem, uncertain, found }) {
  const failed = found.flatMap(({ engine, method, runs }) => runs.filter((run) => run.failed).map((run) =>
    `${engine} ${method} with ${run.steps} steps: ${run.failed}.`));
  return [
    `## ${problem.name}`, "",
    `${problem.comment} Until t = ${Number(problem.end.toPrecision(5))} s` +
      (problem.exact ? "." : `; the reference (ours, ${problem.reference.method}, two sizes of step) is uncertain by ${uncertain.toExponential(0)}.`), "",
    "| error | best of ours | best of theirs | their time over ours |", "|---|---|---|---|", ...comparison(found), "",
    `| time (drift of the energy) for an error of | ${targets.map(power).join(" | ")} | smallest error | drift there | a step |`,
    `|---|${targets.map(() => "---|").join("")}---|---|---|`, ...found.map(row), "",
    ...(failed.length ? [`Failed: ${failed.join(" ")}`, ""] : []),
  ].join("\n");
}

export function pageOf(engines, studies) {
  const versions = engines.map(({ name, version }) => `${name} ${version}`).join(", ");
  const machine = `${cpus()[0].model.trim()}, node ${process.versions.node}, ${new Date().toISOString().slice(0, 10)}`;
  return [
    "<!-- Written by `./lagroid peers --node --page` (bench/peers/node). Edit that, not this. -->",
    "# Ours and others in a browser's engine", "",
    `The laboratory's own WebAssembly ([in the browser](../web.md)) beside what is on npm: ${versions}, all in one process of node,`,
    `one run on one machine (${machine}), by`, "",
    "    ./lagroid peers --node --page", "",
    "which installs the packages, pinned by their hashes in `bench/peers/node/package-lock.json`, into `build/`: nothing of them",
    "comes with lagroid. Without `--page` it prints the tables. The native ones, of Debian and some years older, are in",
    "[ours and others](../peers.md).", "",
    summary(studies), "",
    "Above one we win, and *win* stands where no other gets there; bold is what we lose. Free bodies and rolling, where the geometry is known, are ours.",
    "Bodies on joints are MuJoCo's: it has one unknown a hinge, explicit stages and a solver for trees, our scenes of bodies",
    "solve the equations of every body and every joint in each step. The same motion in angles, as a formula, is nearer.", "",
    "**How it was measured.** Every method runs with ever smaller halves of a step, until a run takes more than a second or three",
    "halvings gained nothing. A time is that of the cheapest run that is no farther off than the error at the head of its column, in brackets how far its energy",
    "went, over the size of the problem's energies; times are of the processor, medians of three interleaved rounds, of the steps alone. Ours has its ledger in",
    "them, at the first and the last node, and makes its steps in one call; the others are asked for each step, as their users do, and MuJoCo and Rapier",
    "do other work in a step too (they look for contacts, and sort out what sleeps). Rapier computes in single precision, which bounds its errors;",
    "it is made for games. The engines' settings: no damping, no sleeping, the tumbling body and rods without contacts; MuJoCo's rolling ball with an elliptic",
    "cone and `impratio` 100, as its manual advises against slip; Rapier's defaults otherwise.", "",
    studies.map(sectionOf).join("\n"),
  ].join("\n");
}
