// Runs a scene in the compiled laboratory and prints its summary: run_scene.mjs GLUE SCENE [SETTING...]
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

import { Engine } from "../../web/page/engine.mjs";

const [glue, file, ...settings] = process.argv.slice(2);
const make = createRequire(import.meta.url)(glue);
const engine = new Engine(await make({ wasmBinary: readFileSync(glue.replace(/js$/, "wasm")) }));
const { run } = engine.open({ scene: readFileSync(file, "utf8"), settings });
while (engine.advance(run, 1000));
console.log(JSON.stringify(engine.summary(run)));
