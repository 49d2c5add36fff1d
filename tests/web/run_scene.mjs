// Runs a scene in the compiled laboratory and prints its summary: run_scene.mjs GLUE SCENE [SETTING...]; with --rate,
// the steps that it makes in a second.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

import { Engine } from "../../web/page/engine.mjs";

const [glue, file, ...rest] = process.argv.slice(2);
const settings = rest.filter((word) => word !== "--rate");
const make = createRequire(import.meta.url)(glue);
const engine = new Engine(await make({ wasmBinary: readFileSync(glue.replace(/js$/, "wasm")) }));
const { run } = engine.open({ scene: readFileSync(file, "utf8"), settings });
const begun = performance.now();
while (engine.advance(run, 1000));
const seconds = (performance.now() - begun) / 1000;
const summary = engine.summary(run);
console.log(rest.includes("--rate") ? summary.steps / seconds : JSON.stringify(summary));
