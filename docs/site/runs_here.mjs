// Which scenes the page's engine takes: runs_here.mjs GLUE, with [{scene, settings}] on standard input. Prints its version, and
// for each scene why it is refused, or null.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

import { Engine } from "../../web/page/engine.mjs";

const glue = process.argv[2];
const make = createRequire(import.meta.url)(glue);
const engine = new Engine(await make({ wasmBinary: readFileSync(glue.replace(/js$/, "wasm")) }));
const refused = JSON.parse(readFileSync(0, "utf8")).map((asked) => {
  try {
    engine.close(engine.open(asked).run);
    return null;
  } catch (error) {
    return String(error.message);
  }
});
console.log(JSON.stringify({ version: engine.about.version, refused }));
