// assemble.mjs BUILD SOURCES: writes BUILD/play.html, one file with the module, the worker and the
// scenes of the library with their solutions.
import {readFileSync, readdirSync, writeFileSync} from "node:fs";
import {join, resolve} from "node:path";
import {gzipSync} from "node:zlib";

const [build, sources] = process.argv.slice(2).map(p => resolve(p)),
  text = name => readFileSync(join(sources, name), "utf8"),
  web = name => text(join("web", name));
const library = Object.fromEntries(
  readdirSync(join(sources, "scenes"))
    .filter(name => name.endsWith(".toml"))
    .sort()
    .map(name => [name.slice(0, -5), text(join("scenes", name))]),
);
// Solutions of strings as they stand in the library, from the set of problems: the headline's tap
// over 50 ms after the pluck, 16 bits a sample, as differences, which pack well.
const problems = join(sources, "results/problems"),
  solutions = {};
for (const file of readdirSync(problems).filter(name =>
  Object.hasOwn(library, name.slice(0, -5)),
)) {
  const {reference, tap_quantities} = JSON.parse(readFileSync(join(problems, file), "utf8")),
    tap = Math.max(0, tap_quantities.indexOf("nut_force")),
    {name, modes, free_from_s: from, uncertainty_l2_50ms: uncertainty, trace} = reference,
    first = Math.ceil(44100 * from - 1e-6),
    after = trace[tap].slice(first, Math.floor(44100 * (from + 0.05) + 1e-6) + 1),
    unit = after.reduce((most, y) => Math.max(most, Math.abs(y)), 0) / 32767,
    whole = after.map(y => Math.round(y / unit));
  solutions[file.slice(0, -5)] = {
    ...{reference: name, modes, window: 0.05, uncertainty: uncertainty[tap], unit},
    differences: whole.map((y, k) => y - (whole[k - 1] ?? 0)),
  };
}
const wasm = readFileSync(join(build, "jvari.wasm"));

const safe = text => text.replaceAll("</script", "<\\/script").replaceAll("<!--", "<\\!--");
const parts = {
  STYLE: text("bench/report/page/base.css") + web("play.css"),
  GLUE: safe(readFileSync(join(build, "jvari.js"), "utf8")),
  CORE: safe(web("core.js")),
  WORKER: safe(web("worker.js")),
  MODULE: gzipSync(wasm, {level: 9}).toString("base64"),
  SOLUTIONS: gzipSync(JSON.stringify(solutions), {level: 9}).toString("base64"),
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
