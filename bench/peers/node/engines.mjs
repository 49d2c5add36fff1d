// The engines by one measure. Each has cases {method, prepare(h, steps)}; what is prepared has run(watched), which makes all steps
// and returns their seconds, then state() and, where it was watched, drift() of the energy; free() where it holds memory.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

import { Engine } from "../../../web/page/engine.mjs";
import { energy } from "./problems.mjs";

const looks = 64; // at the energy, evenly along a run

/** Seconds of the processor, whatever else the machine does. */
function processor() {
  const { user, system } = process.cpuUsage();
  return (user + system) / 1e6;
}

/** Steps one by one, and how far the energy went, where it is to be looked at. */
function stepped(steps, step, energyNow) {
  let drift = 0;
  return {
    run(watched) {
      const begin = watched ? energyNow() : 0;
      const stride = watched ? Math.max(1, Math.floor(steps / looks)) : steps + 1;
      const begun = processor();
      for (let k = 1; k <= steps; ++k) {
        step();
        if (k % stride === 0) drift = Math.max(drift, Math.abs(energyNow() - begin));
      }
      return processor() - begun;
    },
    drift: () => drift,
  };
}

export async function lagroid(glue) {
  const make = createRequire(import.meta.url)(glue);
  const engine = new Engine(await make({ wasmBinary: readFileSync(glue.replace(/js$/, "wasm")) }));
  const prepare = ({ scene, read, energy: ofEnd }, h, steps) => {
    let summary;
    return {
      run(watched) {
        const every = watched ? Math.max(1, Math.floor(steps / looks)) : steps;
        const { run } = engine.open({ scene: scene(`[output]\nevery = ${every}\n[time]\nstep = ${h}\nsteps = ${steps}\n`) });
        const begun = processor();
        while (engine.advance(run, 1e6));
        const seconds = processor() - begun; // without reading the scene
        summary = engine.summary(run);
        engine.close(run);
        if (summary.status !== "converged") throw new Error(summary.message);
        return seconds;
      },
      state: () => read(summary.final),
      drift: () => ofEnd ? Math.abs(ofEnd(summary.final) - ofEnd(summary.initial))
        : summary.ledger.entries.find(({ name }) => name === "energy").drift,
    };
  };
  return {
    name: "lagroid", version: engine.about.version,
    cases: (problem) => problem.lagroid.map((way) => ({ method: way.method, prepare: (h, steps) => prepare(way, h, steps) })),
    reference: (problem, steps) => {
      const held = prepare({ ...problem.reference, read: problem.lagroid[0].read }, problem.end / steps, steps);
      held.run(false);
      return problem.state(held.state());
    },
  };
}

const load = (packages, name) => import(pathToFileURL(createRequire(`${packages}/`).resolve(name)));

export async function mujoco(packages) {
  const mj = await (await load(packages, "@mujoco/mujoco")).default();
  const prepare = (problem, method, h, steps) => {
    const { option, flag, world, begin, ball } = problem.mujoco;
    const model = mj.MjModel.from_xml_string(`<mujoco><compiler inertiafromgeom="auto"/><option timestep="${h}" ${option} ` +
      `integrator="${method}"><flag energy="disable" ${flag}/></option><worldbody>${world}</worldbody></mujoco>`);
    const data = new mj.MjData(model);
    begin?.(data);
    const first = ball ?? 1; // body 0 is the world
    const rows = (all, width, body) => Array.from(all.slice(width * body, width * body + width));
    const energyNow = () => {
      if (ball) return problem.energy([{ velocity: Array.from(data.qvel.slice(1, 4)) }]);
      mj.mj_forward(model, data);
      mj.mj_energyPos(model, data);
      mj.mj_energyVel(model, data);
      return data.energy[0] + data.energy[1];
    };
    const held = stepped(steps, () => mj.mj_step(model, data), energyNow);
    return {
      ...held,
      state() {
        mj.mj_kinematics(model, data);
        mj.mj_comPos(model, data);
        const seen = problem.bodies.map((_, i) => i + first);
        return { positions: seen.map((body) => rows(data.xipos, 3, body)), attitudes: seen.map((body) => rows(data.xquat, 4, body)) };
      },
      free: () => [data, model].forEach((object) => object.delete()),
    };
  };
  return {
    name: "MuJoCo", version: mj.mj_versionString(),
    cases: (problem) => problem.mujoco.methods.map((method) => ({ method, prepare: (h, steps) => prepare(problem, method, h, steps) })),
  };
}

export async function rapier(packages) {
  const R = (await load(packages, "@dimforge/rapier3d-compat")).default;
  await R.init();
  const prepare = (problem, { build, gravity }, h, steps) => {
    const world = new R.World({ x: 0, y: 0, z: -gravity });
    world.timestep = h;
    const bodies = build(world, R);
    const vector = ({ x, y, z }) => [x, y, z];
    const attitude = ({ w, x, y, z }) => [w, x, y, z];
    const energyNow = () => energy(problem, bodies.map((body) => ({
      position: vector(body.translation()), attitude: attitude(body.rotation()), velocity: vector(body.linvel()),
      turning: vector(body.angvel()) })));
    return {
      ...stepped(steps, () => world.step(), energyNow),
      state: () => ({ positions: bodies.map((body) => vector(body.translation())),
                      attitudes: bodies.map((body) => attitude(body.rotation())) }),
      free: () => world.free(),
    };
  };
  return {
    name: "Rapier", version: R.version(),
    cases: (problem) => problem.rapier.map((way) => ({ method: way.method, prepare: (h, steps) => prepare(problem, way, h, steps) })),
  };
}
