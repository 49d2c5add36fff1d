// Our own engine of the page and those of others, on equal problems in node: main.mjs GLUE PACKAGES [PAGE] prints what was
// measured, and writes it into PAGE.
import { writeFileSync } from "node:fs";

import { lagroid, mujoco, rapier } from "./engines.mjs";
import { pageOf, sectionOf } from "./page.mjs";
import { problems } from "./problems.mjs";

const rounds = 3;
const longest = 1; // s, of a run
const finest = 15; // halvings of the step, at most

const median = (values) => values.sort((a, b) => a - b)[Math.floor(values.length / 2)];

/** What one run left; where it failed the error is infinite. */
function look(problem, { prepare }, steps, { reference, uncertain }) {
  let held;
  try {
    held = prepare(problem.end / steps, steps);
    const seconds = held.run(true);
    const error = Math.max(uncertain, ...problem.state(held.state()).map((x, i) => Math.abs(x - reference[i])));
    return { steps, seconds, error: Number.isFinite(error) ? error : Infinity, drift: held.drift() / problem.scale };
  } catch (failed) {
    return { steps, seconds: 0, error: Infinity, drift: NaN, failed: String(failed.message) };
  } finally {
    held?.free?.();
  }
}

/** Runs with ever smaller steps, until they take too long or gain nothing any more. */
function ladder(problem, way, known) {
  const runs = [];
  for (let level = 0; level <= finest; ++level) {
    const run = look(problem, way, problem.coarsest * 2 ** level, known);
    runs.push(run);
    const gainsNothing = runs.length > 4 && runs.slice(-3).every(({ error }) => error >= runs.at(-4).error && error < Infinity);
    if (run.seconds > longest || gainsNothing) break;
  }
  return runs;
}

function study(problem, engines) {
  const coarse = problem.exact ?? engines[0].reference(problem, problem.coarsest * 64);
  const reference = problem.exact ?? engines[0].reference(problem, problem.coarsest * 128);
  const uncertain = Math.max(...reference.map((x, i) => Math.abs(x - coarse[i])));
  const found = engines.flatMap((engine) => engine.cases(problem).map((way) => {
    process.stderr.write(".");
    return { engine: engine.name, method: way.method, way, runs: ladder(problem, way, { reference, uncertain }) };
  }));
  const times = new Map();
  for (let round = 0; round < rounds; ++round) // interleaved: what else the machine does meets all of them
    for (const { way, runs } of found)
      for (const run of runs.filter(({ error }) => error < Infinity)) {
        const held = way.prepare(problem.end / run.steps, run.steps);
        times.set(run, [...(times.get(run) ?? []), held.run(false)]);
        held.free?.();
      }
  for (const [run, seconds] of times) run.seconds = median(seconds);
  return { problem, uncertain, found };
}

try {
  const [glue, packages, page] = process.argv.slice(2);
  const engines = [await lagroid(glue), await mujoco(packages), await rapier(packages)];
  const studies = problems.map((problem) => {
    process.stderr.write(`${problem.name} `);
    const made = study(problem, engines);
    console.log(sectionOf(made));
    return made;
  });
  if (page) writeFileSync(page, pageOf(engines, studies));
} catch (failed) {
  console.error(`peers in node: ${failed.message.slice(0, 500)}`);
  process.exitCode = 1;
}
