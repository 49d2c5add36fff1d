// That the problems are equal: with fine steps every engine ends where ours does, to what its order and its precision allow, and
// a problem that is another one is told apart: check.mjs GLUE PACKAGES
import assert from "node:assert/strict";
import test from "node:test";

import { lagroid, mujoco, rapier } from "./engines.mjs";
import { problems } from "./problems.mjs";

const [glue, packages] = process.argv.slice(2);
const ours = await lagroid(glue);
const [theirs, games] = [await mujoco(packages), await rapier(packages)];

function error(problem, way, steps, reference) {
  const held = way.prepare(problem.end / steps, steps);
  held.run(false);
  const off = Math.max(...problem.state(held.state()).map((x, i) => Math.abs(x - reference[i])));
  held.free?.();
  return off;
}
const referenceOf = (problem) => problem.exact ?? ours.reference(problem, problem.coarsest * 128);
const named = (engine, problem, name) => engine.cases(problem).find(({ method }) => method === name);

/** How far off an engine may be with so many steps. */
const bounds = [
  [theirs, { "Tumbling body": ["RK4", 100000, 1e-6], "Double pendulum": ["RK4", 3000, 1e-8], Chain: ["RK4", 3200, 1e-6],
             "Rolling ball": ["Euler", 1571, 0.02] }],
  [games, { "Tumbling body": ["free body", 3200, 0.5], "Double pendulum": ["impulse joints", 10000, 5e-3], Chain: ["impulse joints", 6400, 2e-3],
            "Rolling ball": ["contact", 15708, 0.02] }],
];

for (const problem of problems) {
  const reference = referenceOf(problem);
  for (const [engine, of] of bounds)
    test(`${problem.name}: ${engine.name} ends where ours does`, () => {
      const [method, steps, bound] = of[problem.name];
      assert.ok(error(problem, named(engine, problem, method), steps, reference) < bound);
    });
  test(`${problem.name}: all of ours end at one place`, () => {
    for (const way of ours.cases(problem)) assert.ok(error(problem, way, problem.coarsest * 32, reference) < 2e-3, way.method);
  });
}

test("another problem is told apart", () => {
  const [, pendulum] = problems;
  const longer = { ...pendulum, end: pendulum.end * 1.001 };
  assert.ok(error(longer, named(theirs, longer, "RK4"), 3000, referenceOf(pendulum)) > 1e-4);
});
