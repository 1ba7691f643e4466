// take.mjs PROGRAM BUILD SOURCES PREFIX [PYTHON_MODULE PYTHON]: the files that "Take it" gives compile
// against the engine installed in PREFIX as they stand, and run. The C++ file plays what the program
// plays; the script does where the module is given.
import {spawnSync} from "node:child_process";
import {mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join, resolve} from "node:path";
import vm from "node:vm";

const [program, , sources, prefix, module, python] = process.argv.slice(2).map(p => resolve(p)),
  taken = vm.runInThisContext(`${readFileSync(join(sources, "web/take.js"), "utf8")}; taken`),
  scratch = mkdtempSync(join(tmpdir(), "jvari-take-"));
let failures = 0;
function ended(what, words, options = {}) {
  const run = spawnSync(words[0], words.slice(1), {cwd: scratch, encoding: "utf8", ...options});
  if (run.status === 0) return run.stdout;
  console.log(`FAILED: ${what}: ${run.stdout}${run.stderr}`, ++failures);
  return "";
}
const strings = {
  tanpura_c3_release: {overrides: ["string.0.tension=34.5"], options: ["compliance=matched"]},
  sitar_c5: {overrides: [], options: []},
};
for (const [name, more] of Object.entries(strings)) {
  const text = readFileSync(join(sources, "scenes", `${name}.toml`), "utf8"),
    taps = [...text.matchAll(/quantity = "(\w+)"/g)].map(m => m[1]),
    string = {
      ...{about: `${name} is wrong by 1 %`, text, files: [], scheme: "modal_two_point"},
      ...{rate: 44100, modes: 30, tap: Math.max(0, taps.indexOf("nut_force")), ...more},
    },
    cpp = taken["C++"](string),
    folder = join(scratch, name);
  mkdirSync(folder);
  writeFileSync(join(folder, "string.cpp"), cpp);
  // the lines of CMake are those in its comment
  const cmake = cpp
    .split("\n")
    .map(line => /^\/\/ ((?:cmake|project|find|add|target)_?\w*\(.*)/.exec(line)?.[1])
    .filter(Boolean);
  writeFileSync(join(folder, "CMakeLists.txt"), cmake.join("\n") + "\n");
  ended(`${name}, configured`, [
    ...["cmake", "-S", folder, "-B", join(folder, "build"), `-DCMAKE_PREFIX_PATH=${prefix}`],
    ...["-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS=-Wall -Wextra"],
  ]);
  const built = ended(`${name}, built`, ["cmake", "--build", join(folder, "build")]);
  if (/warning/.test(built)) console.log(`FAILED: ${name}: ${built}`, ++failures);
  const [first, second] = ended(`${name}, run`, [join(folder, "build/string")])
      .trim()
      .split("\n")
      .map(line => Number(line.split(": ")[1])),
    run = JSON.parse(
      ended(`${name} by the program`, [
        ...[program, "run", name, "--scheme", "modal_two_point", "--modes", "30", "--json"],
        ...["--duration", String((64 * Math.floor(22050 / 64)) / 44100), "--out", "t.csv"],
        ...string.options.flatMap(o => ["--option", o]),
        ...string.overrides.flatMap(o => ["--set", o]),
      ]),
    ),
    rows = readFileSync(join(scratch, "t.csv"), "utf8").trim().split("\n"),
    column = rows
      .find(line => line.startsWith("t"))
      .split(",")
      .findIndex(word => /^nut/.test(word)),
    largest = rows
      .filter(line => /^[\d-]/.test(line))
      .reduce((most, line) => Math.max(most, Math.abs(Number(line.split(",")[column]))), 0);
  if (run.status !== "ok" || !(Math.abs(first / largest - 1) < 1e-5) || !(second > 0))
    console.log(`FAILED: ${name}: ${first}, then ${second}; the program: ${largest}`, ++failures);
  if (!cpp.startsWith(`// ${name} is wrong by 1 %`))
    console.log(`FAILED: ${name}: it does not begin with its error`, ++failures);
  writeFileSync(join(scratch, "string.py"), taken.Python(string));
  if (!module) continue;
  const script = ended(`${name}, script`, [python, "string.py"], {
    env: {...process.env, PYTHONPATH: module},
  });
  if (!/largest value [\d.e-]+ N/.test(script))
    console.log(`FAILED: ${name}: ${script}`, ++failures);
}
rmSync(scratch, {recursive: true});
process.exit(failures ? 1 : 0);
