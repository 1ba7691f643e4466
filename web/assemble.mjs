// assemble.mjs BUILD SOURCES: writes BUILD/play.html, one file with the module, the worker and the
// scenes of the library.
import {readFileSync, readdirSync, writeFileSync} from "node:fs";
import {join, resolve} from "node:path";
import {gzipSync} from "node:zlib";

const [build, sources] = process.argv.slice(2).map(p => resolve(p)),
  web = name => readFileSync(join(sources, "web", name), "utf8");
const library = Object.fromEntries(
  readdirSync(join(sources, "scenes"))
    .filter(name => name.endsWith(".toml"))
    .sort()
    .map(name => [name.slice(0, -5), readFileSync(join(sources, "scenes", name), "utf8")]),
);
const wasm = readFileSync(join(build, "jvari.wasm"));

const safe = text => text.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
const parts = {
  STYLE: web("play.css"),
  GLUE: safe(readFileSync(join(build, "jvari.js"), "utf8")),
  CORE: safe(web("core.js")),
  WORKER: safe(web("worker.js")),
  MODULE: gzipSync(wasm, {level: 9}).toString("base64"),
  LIBRARY: safe(JSON.stringify(library)),
  PROGRAM: safe(
    [
      "state.js",
      "client.js",
      "sound.js",
      "picture.js",
      "chart.js",
      "map.js",
      "own.js",
      "take.js",
      "drop.js",
      "tours.js",
      "main.js",
    ]
      .map(web)
      .join("\n"),
  ),
};
const page = web("play.html").replace(/@([A-Z_]+)@/g, (_, name) => parts[name]),
  limit = 1.5e6;
if (page.length > limit)
  throw new Error(`play.html has ${page.length} bytes, expected at most ${limit}`);
writeFileSync(join(build, "play.html"), page);
