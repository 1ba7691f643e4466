// Until when does the truth itself hold: draws horizon.svg beside this file, and horizon.csv with
// what is drawn.
//     node results/certificates/horizon.mjs [FOLDER]       FOLDER keeps the runs; those that are
//     there are not made again
// JVARI: the program, build/release/jvari where absent. The exact solution takes seconds;
// `sundials` some minutes, so it has less of the run. A line is the running relative L2 difference
// of the force on the nut (the guitar's saddle) from the exact solution at its default tolerance
// (Agreement in reference/).
import {execFileSync} from "node:child_process";
import {existsSync, mkdirSync, mkdtempSync, readFileSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {dirname, join} from "node:path";
import {fileURLToPath} from "node:url";
import * as vega from "vega";
import * as vegaLite from "vega-lite";

const here = dirname(fileURLToPath(import.meta.url));
const jvari = process.env.JVARI ?? join(here, "../../build/release/jvari");
const folder = process.argv[2] ?? mkdtempSync(join(tmpdir(), "horizon-"));
mkdirSync(folder, {recursive: true});

const scenes = [
  {name: "tanpura_c3_release", tap: "nut", duration: 1, sundials: 0.05, amplitude: 1.9e-3},
  {name: "guitar_over_fret", tap: "saddle", duration: 0.1, sundials: 0.1, amplitude: 2e-3},
];
const against = [
  {
    line: "tolerance 1e-12",
    key: "tight",
    of: s => ["exact_contact", s.duration, "--option", "tolerance=1e-12"],
  },
  {
    line: "started 1e-12 apart",
    key: "moved",
    of: s => [
      "exact_contact",
      s.duration,
      "--set",
      `string.0.start.amplitude=${s.amplitude * (1 + 1e-12)}`,
    ],
  },
  {line: "sundials", key: "sundials", of: s => ["sundials", s.sundials, "--option", "rtol=1e-12"]},
];

function trace(scene, key, [scheme, duration, ...options]) {
  const file = join(folder, `${scene.name}-${key}.csv`);
  if (!existsSync(file))
    execFileSync(jvari, [
      "run",
      scene.name,
      "--scheme",
      scheme,
      "--duration",
      `${duration}`,
      "--quiet",
      "--out",
      file,
      ...options,
    ]);
  const [head, ...rows] = readFileSync(file, "utf8")
    .trim()
    .split("\n")
    .map(line => line.split(","));
  const [time, column] = [head.indexOf("time_s"), head.indexOf(scene.tap)];
  return rows.map(row => ({t: Number(row[time]), y: Number(row[column])}));
}

// Some 200 points, evenly spaced in time: sqrt(sum of squared differences / sum of squares) until
// then.
function difference(a, b) {
  const count = Math.min(a.length, b.length),
    points = [];
  let apart = 0,
    norm = 0;
  for (let n = 0; n < count; ++n) {
    apart += (a[n].y - b[n].y) ** 2;
    norm += b[n].y ** 2;
    if (n > 0 && (n % Math.ceil(b.length / 200) === 0 || n === count - 1))
      points.push({t: b[n].t, d: Math.sqrt(apart / norm)});
  }
  return points;
}

const table = [];
for (const scene of scenes) {
  const truth = trace(scene, "default", ["exact_contact", scene.duration]);
  for (const {line, key, of} of against)
    for (const {t, d} of difference(trace(scene, key, of(scene)), truth))
      table.push({
        scene: scene.name,
        against: line,
        time_s: Number(t.toPrecision(6)),
        difference: Number(d.toPrecision(3)),
      });
}
const columns = Object.keys(table[0]);
writeFileSync(
  join(here, "horizon.csv"),
  [columns, ...table.map(row => columns.map(c => row[c]))].map(row => row.join(",")).join("\n") +
    "\n",
);

const lines = against.map(a => a.line);
const panel = scene => ({
  title: scene.name,
  width: 420,
  height: 280,
  transform: [{filter: {field: "scene", equal: scene.name}}, {filter: "datum.difference > 0"}],
  mark: {type: "line", clip: true},
  encoding: {
    x: {field: "time_s", type: "quantitative", title: "time [s]"},
    y: {
      field: "difference",
      type: "quantitative",
      title: "relative L2 difference until then",
      scale: {type: "log", domain: [1e-16, 1]},
      axis: {format: ".0e", values: [1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1]},
    },
    color: {
      field: "against",
      type: "nominal",
      title: "against",
      scale: {domain: lines, range: ["#0072b2", "#d55e00", "#009e73"]},
    },
    strokeDash: {
      field: "against",
      type: "nominal",
      title: "against",
      scale: {
        domain: lines,
        range: [
          [1, 0],
          [6, 3],
          [2, 2],
        ],
      },
    },
  },
});
const spec = vegaLite.compile({
  data: {values: table},
  background: "white",
  hconcat: scenes.map(panel),
}).spec;
writeFileSync(
  join(here, "horizon.svg"),
  await new vega.View(vega.parse(spec), {renderer: "none"}).toSVG(),
);
