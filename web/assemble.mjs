// assemble.mjs BUILD SOURCES: play.html in BUILD, one file with the module, the worker, the scenes
// of the library and two recorded sounds in it.
import {createRequire} from "node:module";
import {readFileSync, readdirSync, writeFileSync} from "node:fs";
import {join, resolve} from "node:path";
import vm from "node:vm";
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
const core = vm.runInThisContext(`${web("core.js")}; jvari_core`)(
  await createRequire(import.meta.url)(join(build, "jvari.js"))({wasmBinary: wasm}),
);

// For browsers without WebAssembly: half a second at 22.05 kHz, as a WAV file of 16 bit.
function recorded(asked) {
  const rate = 22050,
    run = core.run({scene: library.tanpura_c3_release, tap_rate: rate, duration: 0.5, ...asked}),
    samples = run.tap(0),
    most = samples.reduce((m, x) => Math.max(m, Math.abs(x)), 0);
  const file = Buffer.alloc(44 + 2 * samples.length),
    length = 2 * samples.length;
  (file.write("RIFF", 0),
    file.writeUInt32LE(36 + length, 4),
    file.write("WAVEfmt ", 8),
    file.writeUInt32LE(16, 16),
    file.writeUInt16LE(1, 20),
    file.writeUInt16LE(1, 22));
  (file.writeUInt32LE(rate, 24),
    file.writeUInt32LE(2 * rate, 28),
    file.writeUInt16LE(2, 32),
    file.writeUInt16LE(16, 34),
    file.write("data", 36),
    file.writeUInt32LE(length, 40));
  samples.forEach((x, n) => file.writeInt16LE(Math.round((23000 * x) / most), 44 + 2 * n));
  run.free();
  return `data:audio/wav;base64,${file.toString("base64")}`;
}

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
      "tours.js",
      "main.js",
    ]
      .map(web)
      .join("\n"),
  ),
  RECORDED_SCHEME: recorded({scheme: "modal_two_point", rate: 44100}),
  RECORDED_REFERENCE: recorded({scheme: "exact_contact", options: ["compliance=matched"]}),
};
const page = web("play.html").replace(/@([A-Z_]+)@/g, (_, name) => parts[name]),
  limit = 1.5e6;
if (page.length > limit)
  throw new Error(`play.html has ${page.length} bytes, expected at most ${limit}`);
writeFileSync(join(build, "play.html"), page);
