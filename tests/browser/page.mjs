// page.mjs PROGRAM RESULTS SOURCES NODE_MODULES: the JavaScript that draws the report, under node,
// on the data of pages that the built program makes of made-up results: which rows each chart is
// given, under which names and looks; and that Vega draws it where it is installed. One line per
// test.
import assert from "node:assert/strict";
import {spawnSync} from "node:child_process";
import {copyFileSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";

const [program, results, sources, modules] = process.argv.slice(2),
  only = process.argv[6];
const scratch = mkdtempSync(join(tmpdir(), "jvari-page-"));
const files = [
  "data",
  "looks",
  "work_precision",
  "along",
  "maps",
  "sound_charts",
  "run",
  "share",
  "verdict",
].map(name => readFileSync(join(sources, `${name}.js`), "utf8"));
const css = ["base.css", "page.css"]
  .map(name => readFileSync(join(sources, name), "utf8"))
  .join("");
let folders = 0,
  failures = 0;

// The functions of the page on a page's data: of("sections_of()").
const on = (page, more = []) =>
  new Function(
    "page",
    `"use strict"; ${[...files, ...more].join("\n")}; return code => eval(code);`,
  )(page);
function report(folder, allowed = 0) {
  const run = spawnSync(program, ["report", folder], {
    encoding: "utf8",
    env: {...process.env, JVARI_NODE_MODULES: "/nowhere"},
  });
  assert.equal(run.status, allowed, run.stderr);
  const page = readFileSync(join(folder, "report.html"), "utf8"),
    from = page.indexOf('id="data">') + 10;
  return {...JSON.parse(page.slice(from, page.indexOf("</script>", from))), missing: ""};
}
function folder_of(names, extra = {}) {
  const folder = mkdtempSync(join(scratch, `${++folders}-`));
  for (const name of names) copyFileSync(join(results, name), join(folder, name));
  for (const [name, text] of Object.entries(extra)) writeFileSync(join(folder, name), text);
  return folder;
}
const every_file = [
  "manifest.json",
  "facts.csv",
  "errors.csv",
  "cost.csv",
  "convergence.csv",
  "maps.csv",
  "boundaries.csv",
];
const whole = () => on(report(folder_of(every_file)));
// facts.csv, errors.csv and cost.csv of a table of both, in which an error of the headline's tap
// stands below its measure's name, its certificate and floor below certificate_... and floor_...
function files_of(text) {
  const [head, ...rows] = text
    .trim()
    .split("\n")
    .map(line => line.split(","));
  const is_error = name => /^(error_l2|third_octave_db|certificate_|floor_)/.test(name),
    is_cost = name => /^(cost|processor|ns_per|times|worst|repeats|machine|untimed)/.test(name),
    names = ["cell", "scheme", "options", "rate", "modes", "status"];
  const with_cell = rows.map((row, n) => ({
    cell: String(n),
    ...Object.fromEntries(head.map((name, k) => [name, row[k]])),
  }));
  const csv = (columns, records) =>
    [columns, ...records.map(r => columns.map(name => r[name] ?? ""))].join("\n") + "\n";
  const facts = with_cell.map(r => ({headline_nut: "nut", headline_bridge: "nut", ...r})),
    measures = head.filter(name => /^(error_l2|third_octave_db)/.test(name));
  const errors = with_cell.flatMap(r =>
    measures.map(measure => ({
      cell: r.cell,
      tap: "nut",
      measure,
      value: r[measure],
      floor: r["floor_" + measure],
      certificate: r[measure.replace("error", "certificate")],
    })),
  );
  for (const e of errors) if (!e.measure.startsWith("error")) delete e.certificate;
  return {
    "facts.csv": csv(
      [
        ...new Set([
          "cell",
          ...head.filter(n => !is_error(n) && !is_cost(n)),
          "flags",
          "headline_nut",
          "headline_bridge",
        ]),
      ],
      facts,
    ),
    "errors.csv": csv(["cell", "tap", "measure", "value", "floor", "certificate"], errors),
    "cost.csv": csv(
      [...names.filter(n => n === "cell" || head.includes(n)), ...head.filter(is_cost)],
      with_cell,
    ),
  };
}
const of_cells = (cells, manifest = '{"suite": "made up"}') =>
  on(report(folder_of([], {"manifest.json": manifest, ...files_of(cells)})));
const section = (of, id) => of("sections_of()").find(s => s.id === id);
const first = (chart, scene = chart.scenes?.[0]) =>
  Object.assign({scene}, ...chart.menus(scene).map(menu => ({[menu.key]: menu.choices[0][0]})));
const choices = (chart, key, scene) =>
  chart
    .menus(scene)
    .find(menu => menu.key === key)
    .choices.map(([value]) => value);
const layers = spec =>
  [
    spec,
    ...(spec.layer ?? []),
    ...(spec.hconcat ?? []),
    ...(spec.vconcat ?? []),
    ...(spec.spec ? [spec.spec] : []),
  ].flatMap((part, k) => (k ? layers(part) : [part]));
const rows_of = (spec, mark) =>
  layers(spec)
    .filter(layer => layer.data?.values && (layer.mark?.type ?? layer.mark) === mark)
    .flatMap(layer => layer.data.values);
function test(name, run) {
  if (only && !name.includes(only)) return;
  try {
    run();
    console.log(`ok ${name}`);
  } catch (error) {
    ++failures;
    console.log(`FAILED ${name}\n${error.stack}`);
  }
}

// ---- Tables
const table = (columns, ...rows) => ({columns: columns.split(","), rows});
test("a field of a table is what the program wrote: a number, a truth value, a text, or none", () =>
  assert.deepEqual(
    on({tables: {t: table("a,b", [1, "7"], [null, ""], [[1], [-1]], [true, false])}})("table('t')")
      .rows,
    [
      [1, "7"],
      [NaN, ""],
      [Infinity, -Infinity],
      [true, false],
    ],
  ));

test("a field is saved as the program's files have it: no text is a number or a formula", () => {
  const saved = on({tables: {}}, [readFileSync(join(sources, "table.js"), "utf8")])("csv_field");
  for (const [plain, text] of [
    ["@SUM(1)", "'@SUM(1)"],
    ["=1+1", "'=1+1"],
    ['=HYPERLINK("a,b")', '"\'=HYPERLINK(""a,b"")"'],
    ["7", '"7"'],
    ["-1e-3", '"-1e-3"'],
    ["-a", "'-a"],
    ["'=1", "''=1"],
    ["a", "a"],
    ["", ""],
    [-1e-3, "-0.001"],
    [-Infinity, "-inf"],
    [NaN, ""],
    [true, "1"],
  ])
    assert.equal(saved(plain), text);
});

// ---- Take it
test("a command is read back by a shell as it was meant, whoever wrote the record", () => {
  const names = ["it's mine.toml", "x; echo PWNED #", "$(echo PWNED)", "plain.toml", "a\nb", "-x"];
  for (const asked_as of names) {
    const page = {
        tables: {},
        schemes: [["modal_two_point", false]],
        options: {
          "compliance=matched nodes='3;x": [
            ["compliance", "matched"],
            ["nodes", "'3;x"],
          ],
        },
        manifest: {scene: {asked_as, set: ["string.0.material=phosphor bronze"]}},
      },
      of = on(page, [readFileSync(join(sources, "answer.js"), "utf8")]),
      cell = {
        scheme: "modal_two_point",
        options: "compliance=matched nodes='3;x",
        rate: "44100; echo PWNED",
        modes: "20",
      },
      {shell} = of("commands")(cell);
    const read = spawnSync("sh", ["-c", `jvari() { printf '%s\\0' "$@"; }; ${shell}`], {
      encoding: "utf8",
    });
    assert.deepEqual(read.stdout.split("\0").slice(0, -1), [
      ...["run", asked_as, "--scheme", "modal_two_point", "--modes", "20"],
      ...["--option", "compliance=matched", "--option", "nodes='3;x"],
      ...["--set", "string.0.material=phosphor bronze", "--out", "string.wav"],
    ]);
    page.manifest.scene.set = [];
    const {Python, "C++": cpp} = of("commands")(cell),
      text = JSON.stringify(asked_as);
    assert.ok(Python.includes(`jvari.run(${text}, "modal_two_point"`), Python);
    assert.ok(Python.includes(`options={"compliance": "matched", "nodes": "'3;x"}`), Python);
    assert.ok(cpp.includes(`read_scene(${text})`), cpp);
    assert.ok(cpp.includes(`.options = {{"compliance", "matched"}, {"nodes", "'3;x"}}`), cpp);
  }
});

// ---- Sections
test("sections stand in their order, and those without data do not appear", () => {
  const of = whole();
  assert.deepEqual(
    of("sections_of()").map(s => s.id),
    ["work-precision", "sweep", "convergence", "overview", "maps", "cells"],
  );
  assert.deepEqual(
    on(report(folder_of(["manifest.json", "maps.csv"])))("sections_of()").map(s => s.id),
    ["overview", "maps"],
  );
  // nothing draws: tables alone
  const bare = on({...report(folder_of(every_file)), missing: "no charts"})("sections_of()");
  assert.deepEqual(
    bare.map(s => s.heading),
    ["Convergence", "How often each scheme stays sound", "Where methods fail", "Cells"],
  );
});
test("an overview counts sound runs among those that were not refused", () => {
  const of = on(report(folder_of(["manifest.json", "maps.csv"])));
  assert.deepEqual(section(of, "overview").table.rows, [
    ["one", "stiffness x rate", 13, 32],
    ["one", "exponent x modes", 9, 12],
    ["two", "stiffness x rate", 15, 29],
  ]);
  assert.equal(
    of("finding_of_maps()"),
    "of 2 schemes two stays sound in 15 of 29 runs, one in 22 of 44 runs",
  );
});
test("an overview of many schemes is as high as a screen lets it be", () => {
  const [head, row] = readFileSync(join(results, "maps.csv"), "utf8").split("\n"),
    at = head.split(",").indexOf("scheme"),
    named = (text, k) =>
      text
        .split(",")
        .map((field, n) => (n === at ? `modal_${k}` : field))
        .join();
  const page_of = n =>
    on(
      report(
        folder_of(["manifest.json"], {
          "maps.csv": [head, ...Array.from({length: n}, (_, k) => named(row, k)), ""].join("\n"),
        }),
      ),
    );
  const height = (n, print) =>
    n *
    layers(section(page_of(n), "overview").charts[0].spec({}, print).spec).find(l => l.height?.step)
      .height.step;
  assert.equal(height(10, false), 200);
  for (const n of [21, 26, 35])
    assert.ok(height(n, false) <= 401, `${n} schemes: ${height(n, false)}`);
  assert.equal(height(26, true), 520); // on paper nothing is below the fold
});
test("a map opens on one's own scheme", () => {
  const [head, row] = readFileSync(join(results, "maps.csv"), "utf8").split("\n"),
    by = name => row.replace(",one,", `,${name},`),
    names = ["modal_two_point", "mine", "modal_tension"],
    maps = [head, ...names.map(by), ""].join("\n");
  const of = on(report(folder_of(["manifest.json"], {"maps.csv": maps}))),
    [menu] = section(of, "maps").charts[0].menus();
  assert.equal(menu.choices[0][0], "mine");
});
test("pictures of different problems have different names", () => {
  const start = "a, " + "x".repeat(200);
  const problems = [
    "a, height = -0.001",
    "a, height = 0.001",
    "a, k = 1e-05",
    "a, k = 1e+05",
    "a, name = (x)",
    "a, name = [x]",
    start + " = 1",
    start + " = 2",
    "a, n = a b",
    "a, n = a,b",
  ];
  const twin = on({tables: {}})("twin_file"),
    names = problems.map(p => twin("map", p, problems));
  assert.equal(new Set(names).size, problems.length);
  for (const name of names) assert.match(name, /^[A-Za-z0-9_.+-]{1,108}$/);
  for (const name of ["map-a-height--0.001.svg", "map-a-height-0.001.svg", "map-a-k-1e+05.svg"])
    assert.ok(names.includes(name), name);
});

// ---- Error and cost
const problems = [
  "a, string.0.tension = 30",
  "a, string.0.tension = 31",
  "b, string.0.tension = 30",
  "b, string.0.tension = 31",
];
test("only runs of one scene at one swept point are compared", () => {
  const of = whole(),
    [chart] = section(of, "work-precision").charts;
  assert.deepEqual(chart.scenes, problems);
  assert.deepEqual(chart.twins.map(t => t.file)[2], "work_precision-b-string.0.tension-30.svg");
  assert.equal(chart.twins.length, 4);
  const drawn = rows_of(chart.spec(chart.twins[2].choice, true).spec, "point").filter(
    p => p.problem,
  );
  assert.ok(drawn.length > 0 && drawn.every(p => p.problem === problems[2]));
});
test("noise floor and certificate are of the scene and the error that is shown", () => {
  const of = whole(),
    bands = (problem, error) => of("bands_of")(of("of_scene")(of("cells()"), problem), error);
  assert.deepEqual(bands(problems[0], "error_l2_50ms"), {floor: 2e-3, certificate: 4e-3});
  assert.deepEqual(bands(problems[2], "error_l2_50ms"), {floor: 1e-12, certificate: null});
  assert.deepEqual(bands(problems[0], "error_l2_10ms"), {floor: null, certificate: null});
});
test("a band is of the reference of all points or not there", () => {
  const bands = second => {
    const of = of_cells(
      "cell,scene,scheme,options,rate,modes,status,flags,error_l2_50ms,certificate_l2_50ms," +
        "cost_s_per_s,cost_lower,cost_upper\n" +
        "1,a,modal_quadratised,,44100,10,ok,,0.1,0.002,1,1,1\n" +
        `2,a,exact_contact,,,10,ok,,0.0007,${second},1,1,1\n`,
    );
    return of("bands_of(cells(), 'error_l2_50ms')").certificate;
  };
  assert.equal(bands("0.002"), 0.002);
  assert.equal(bands("0.0002"), null); // 0.07 % is known of the second, and not of the first
});
const sample_head =
  "scheme,rate,modes,status,error_l2_50ms,third_octave_db,cost_s_per_s,cost_lower,cost_upper," +
  "ns_per_step,dofs,below_floor,reason";
const sample_rows = [
  "a,44100,133,ok,1e-2,3,0.01,0.009,0.011,100,266,,",
  "a,88200,133,ok,1e-3,2,0.02,0.019,0.021,100,266,,",
  "b,44100,133,ok,5e-3,4,0.03,0.029,0.031,200,266,,",
  "b,88200,133,diverged,inf,,0.05,0.05,0.05,200,266,,diverged at step 7",
  "c,44100,133,refused,,,,,,,,,has no </script> thread",
];
function sample({
  names = {},
  more = "",
  certificate = "1e-9",
  manifest = '{"suite": "a scene"}',
} = {}) {
  const rows = sample_rows.map(row => (row[0] in names ? names[row[0]] + row.slice(1) : row));
  return of_cells(
    `scene,${sample_head},certificate_l2_50ms,floor_error_l2_50ms${more && ",flags"}\n` +
      rows.map((row, k) => `s,${row},${certificate},1e-12${more && "," + more[k]}\n`).join(""),
    manifest,
  );
}
test("every cell that ran is drawn once, at its cost, its quartiles and its error", () => {
  const of = sample(),
    all = of("points_of(cells(), 'error_l2_50ms', 'cost_s_per_s')");
  assert.equal(all.length, 4);
  assert.deepEqual(
    [all[1].series, all[1].rate, all[1].y, all[1].x, all[1].label],
    ["a", 88200, 1e-3, 0.02, "88.2 kHz"],
  );
  assert.ok(Math.abs(all[1].from - 0.019) < 1e-9 && Math.abs(all[1].to - 0.021) < 1e-9);
  assert.equal(all[3].y, null);
  assert.deepEqual(of("bands_of(cells(), 'error_l2_50ms')"), {floor: 1e-12, certificate: 1e-9});
});
test("a control is the answer only where it competes", () => {
  const best = manifest =>
    sample({names: {a: "modal_explicit_penalty"}, manifest})(
      "answer_at(cells(), 'error_l2_50ms', 0.1)",
    ).best.scheme;
  assert.equal(best('{"suite": "a scene"}'), "b");
  assert.equal(best('{"suite": "a scene", "controls": true}'), "modal_explicit_penalty");
});
test("an error stands at error and certificate together, and what is flagged is hollow", () => {
  const of = sample({certificate: "6e-4", more: ["", "", "adhesion", "", ""]}),
    all = of("points_of(cells(), 'error_l2_50ms', 'cost_s_per_s', 'line')");
  // 6 %: as measured
  assert.deepEqual(
    all.slice(0, 2).map(p => p.y.toFixed(9)),
    ["0.010000000", "0.001600000"],
  );
  assert.ok(!all[0].tooltip.error.includes("\u2264") && all[1].tooltip.error.startsWith("\u2264"));
  const inside = p => p.may_win && p.most <= 0.01;
  assert.deepEqual(
    all.map(p => [p.series, inside(p)]),
    [
      ["a", false], // 1.06 %
      ["a", true],
      ["b", false], // pulls
      ["b", false],
    ],
  );
  const [chart] = section(of, "work-precision").charts,
    {fill} = layers(chart.spec(first(chart), false).spec).find(
      l => l.mark?.type === "point" && l.encoding?.fill,
    ).encoding;
  assert.match(fill.condition.test, /datum\.may_win && .*datum\.most <= within/);
});
test("what ended well is never drawn as failed", () => {
  const of = sample(),
    [chart] = section(of, "work-precision").charts,
    crosses = layers(chart.spec(first(chart), false).spec).filter(l => l.mark?.text === "\u2715");
  assert.deepEqual(
    crosses.flatMap(l => l.data.values).map(p => p.status),
    ["diverged"],
  );
});
test("errors are offered only where there is a finite value, and the headline comes first", () => {
  assert.deepEqual(
    sample()("errors_in(cells())").map(e => e.column),
    // of the headline's tap, then of each
    ["error_l2_50ms", "third_octave_db", "error_l2_50ms_nut", "third_octave_db_nut"],
  );
  assert.deepEqual(sample()("points_of(cells(), 'error_l2_50ms', 'cost_s_per_s')")[0].tooltip, {
    scheme: "a",
    rate: "44.1 kHz",
    modes: 133,
    error: "1\u00a0%",
    cost: "10 ms per second (100 \u00d7 faster than real time)",
    quartiles: "9 ms to 11 ms",
  });
});
test("of modes and rates the best of each scheme are one line", () => {
  const row = (cell, modes, rate, status, error, cost) =>
    `${cell},a,modal_quadratised,compliance=own,${rate},${modes},${status},,${error},0,` +
    `${cost},${cost},${cost}\n`;
  const of = of_cells(
    "cell,scene,scheme,options,rate,modes,status,flags,error_l2_50ms,certificate_l2_50ms," +
      "cost_s_per_s,cost_lower,cost_upper\n" +
      row(1, 10, 44100, "ok", 0.1, 1) +
      row(2, 10, 88200, "ok", 0.08, 2) +
      row(3, 20, 88200, "ok", 0.02, 1.9) /* beats the second */ +
      row(4, 20, 176400, "not_needed", 0.03, ""),
  );
  const all = of("points_of(cells(), 'error_l2_50ms', 'cost_s_per_s', 'line')");
  assert.deepEqual(
    all.map(p => [p.series, p.label]),
    [
      ["modal_quadratised compliance=own", "10 modes, 44.1 kHz"],
      ["modal_quadratised compliance=own", "20 modes, 88.2 kHz"],
    ],
  );
});
test("names are of what is drawn and nothing else", () => {
  const of = sample(),
    [chart] = section(of, "work-precision").charts;
  assert.deepEqual(chart.spec(first(chart), false).names, ["a", "b"]); // c was refused
});

// ---- The answer
test("errors of a plucked string begin after the pluck: sentence and axis say so", () => {
  for (const [from, after_pluck] of [
    ["0", false],
    ["0.05", true],
  ]) {
    const of = of_cells(
        `scene,${sample_head},certificate_l2_50ms,free_from_s\n` +
          sample_rows.map(row => `s,${row},1e-9,${from}\n`).join(""),
      ),
      [error] = of("errors_in(cells())");
    for (const text of [error.title, of("spoken_error")(error, of("cells()"))])
      assert.equal(text.includes(" after the last pluck"), after_pluck, text);
  }
});
test("an error is spoken of by what its tap measures", () => {
  const tap = '[[tap]]\nname = "nut"\nquantity = "nut_force"\n',
    spoken = manifest => {
      const of = sample({manifest});
      return of("errors_in(cells())").map(e => of("spoken_error")(e, of("cells()")));
    };
  assert.deepEqual(spoken(JSON.stringify({suite: "x", scenes: {s: tap}})).slice(0, 2), [
    "the force on the nut, first 50 ms",
    "third octaves of the force on the nut",
  ]);
  assert.equal(spoken('{"suite": "x"}')[0], "the signal at nut, first 50 ms");
  assert.equal(
    sample()("spoken_error")({measure: "error_l2_heard", tap: "nut", name: "heard"}, []),
    "the signal at nut, first 50 ms of its modes below 20 kHz",
  );
});
const at = (of, scene, within, error = "error_l2_50ms") => {
  const rows = of("of_scene")(of("cells()"), scene),
    found = of("answer_at")(rows, error, within),
    plain = text => text.replaceAll("\u00a0", " ");
  return {
    ...found,
    finding: plain(of("finding_of")(found)),
    sentences: plain(of("consequences")(found, rows).join(" ")),
  };
};
test("the answer names run, error, cost and what is certain", () => {
  const of = whole(),
    found = at(of, problems[0], 0.1); // e = 2.5e-2 and c = 4e-3 at 88.2 kHz
  assert.equal(found.finding, " take one: 40 modes at 88.2 kHz.");
  assert.ok(
    found.sentences.startsWith("It errs by *at most 2.9 %* and takes *2 % of a core*: 50 voices"),
    found.sentences,
  );
  assert.equal(at(of, problems[0], 0.01).best.c.rate, 352800);
  // 0.4 % is what the reference is known to
  assert.match(at(of, problems[0], 0.004).finding, /^: cannot be decided/);
  assert.match(
    at(of, problems[0], 0.004).sentences,
    /^The reference itself may be wrong by \*0\.4/,
  );
  const columns = ["10ms", "50ms"].map(w => `error_l2_${w},certificate_l2_${w}`),
    shorter = of_cells(
      `scene,scheme,rate,modes,status,${columns},cost_s_per_s\n` +
        "s,a,44100,10,ok,0.004,0.002,0.0095,0.03,1\n",
    );
  assert.match(
    at(shorter, "s", 0.01).sentences,
    /wrong by \*3.*\. Over the first 10 ms it is known to \*0\.2/,
  );
  const open = at(of, problems[2], 0.01); // no certificate there
  assert.match(open.finding, /^: cannot be decided/);
  assert.match(open.sentences, /^How wrong the reference itself may be is not known/);
});
test("what none is within is said, with the closest", () => {
  const found = at(sample(), "s", 1e-4);
  assert.match(found.finding, /^ is more than any run here does/);
  assert.match(found.sentences, /a: 133 modes at 88\.2 kHz|a, 133 modes at 88\.2 kHz/);
});
test("ties stand beside the answer and never change it, as in the program", () => {
  const row = (scheme, rate, error, cost) =>
    `s,${scheme},${rate},10,ok,${error},,${cost},${0.8 * cost},${1.1 * cost},,,,,1e-6\n`;
  const of = of_cells(
    `scene,${sample_head},certificate_l2_50ms\n` +
      row("a", 44100, 0.05, 1) +
      row("a", 88200, 0.001, 1.1) +
      row("b", 44100, 0.02, 1.05) +
      row("c", 44100, 0.01, 1.25),
  );
  const {best, ties} = at(of, "s", 0.1),
    // the program's words for a run
    run = (page, {c}) =>
      page("variant")(c) + page("place_words")(c).replace(":", ",").replace("\u00a0", " ");
  assert.deepEqual(
    [best, ...ties].map(o => run(of, o)),
    ["a, 10 modes at 44.1 kHz", "a, 10 modes at 88.2 kHz", "b, 10 modes at 44.1 kHz"],
  );
  assert.match(
    at(of, "s", 0.1).sentences,
    /No dearer by this clock: a: 10 modes at 88\.2 kHz \(0\.1/,
  );
  for (const page of [of, whole(), sample()])
    for (const c of page("records('cheapest')")) {
      const found = at(page, c.problem, c.target, c.measure);
      assert.deepEqual(
        [found.best ? run(page, found.best) : "", found.ties.map(o => run(page, o)).join("; ")],
        [c.run, c.ties],
      );
    }
});
test("a scheme without a cost stands in the sentence, the ranking and the chart", () => {
  const folder = folder_of(every_file),
    cost = readFileSync(join(folder, "cost.csv"), "utf8");
  writeFileSync(join(folder, "cost.csv"), cost.replace(/^.*,two,.*\n/gm, ""));
  const of = on(report(folder)),
    found = at(of, problems[0], 0.1),
    [chart] = section(of, "work-precision").charts;
  assert.match(found.finding, /^ take one.* two keeps it too .*: no cost measured\.$/);
  assert.deepEqual(
    found.unpriced.map(r => r.scheme),
    ["two"],
  );
  const drawn = rows_of(chart.spec({scene: problems[0]}, false).spec, "point");
  assert.ok(drawn.some(p => p.scheme === "two" && p.x === null && p.y > 0));
});
test("of a string of guesses as many or more are right by chance so often", () => {
  const text = on({tables: {}})("score_text");
  assert.equal(text(7, 10), "so far 7 of 10: no difference shown (p = 0.17)");
  assert.equal(text(9, 10), "so far 9 of 10: you hear a difference (p = 0.011)");
  assert.equal(text(0, 0), "");
});

// ---- Along something
test("what is swept has a chart of error along it", () => {
  const of = whole(),
    {charts} = section(of, "sweep");
  assert.equal(charts.length, 1);
  assert.deepEqual(choices(charts[0], "base_field"), ["a", "b"]);
  assert.deepEqual(
    charts[0].twins.map(t => t.file),
    ["sweep-string.0.tension-a.svg", "sweep-string.0.tension-b.svg"],
  );
  const drawn = new Set();
  for (const base of ["a", "b"])
    for (const rate of choices(charts[0], "rate_field")) {
      const {spec} = charts[0].spec(
        {
          ...first(charts[0]),
          base_field: base,
          rate_field: rate,
          measure_field: "error_l2_10ms",
          tap_field: "",
        },
        false,
      );
      assert.equal(spec.encoding.x.axis.title, "tension [N]");
      for (const p of rows_of(spec, "line")) drawn.add([base, p.at, p.series, rate, p.y].join());
    }
  const expected = of("cells()")
    .filter(c => c.status === "ok" && Number.isFinite(c.error_l2_10ms))
    .map(c =>
      [c.scene, c["string.0.tension"], c.scheme, c.rate, of("error_of")(c, "error_l2_10ms")].join(),
    );
  assert.deepEqual([...drawn].sort(), expected.sort());
});
test("error falls along modes in one line for each scheme", () => {
  const of = of_cells(
    "cell,scene,scheme,options,rate,modes,status,flags,error_l2_50ms\n" +
      "1,a,modal_quadratised,,88200,10,ok,,0.1\n2,a,modal_quadratised,,88200,20,ok,,0.01\n" +
      // a grid: its nodes go with the rate
      "3,a,finite_difference_theta,,88200,155,ok,,0.1\n" +
      "4,a,finite_difference_theta,,176400,225,ok,,0.05\n",
  );
  const {charts} = section(of, "sweep"),
    {spec} = charts[0].spec(first(charts[0]), false);
  assert.equal(charts.length, 1);
  assert.equal(spec.encoding.x.axis.title, "modes");
  assert.deepEqual(
    rows_of(spec, "line").map(p => [p.series, p.at, p.y]),
    [
      ["modal_quadratised", 10, 0.1],
      ["modal_quadratised", 20, 0.01],
    ],
  );
  assert.equal(charts[0].twins[0].file, "sweep-modes.svg");
});
test("orders are those of the file where it has them, else of the cells", () => {
  const of = whole(),
    orders = of("orders()"),
    s = section(of, "convergence");
  // convergence.csv
  assert.equal(orders.get("a, string.0.tension = 30|one|error_l2_50ms").text, "1.99 \u00b1 0.05");
  // 0.15 x 4^-k
  assert.ok(orders.get("b, string.0.tension = 31|one|error_l2_50ms").text.startsWith("2.00 "));
  // 0.1 x 2^-k
  assert.ok(
    orders.get("a, string.0.tension = 31|three <b>|error_l2_50ms").text.startsWith("1.00 "),
  );
  assert.ok(!s.table.columns.includes("series"));
  assert.equal(s.table.rows.length, 4);
});
test("no order stands where its interval is wider than the order, or where there is none", () => {
  const text = on({tables: {}})("order_text");
  assert.equal(text(0.84, 2.9), "");
  assert.equal(text(1, Infinity), "");
  assert.equal(text(1, NaN), "");
  assert.equal(text(1.99, 0.05), "1.99 \u00b1 0.05");
  assert.equal(text(2, 1), "2.00 \u00b1 1");
});
test("errors below their noise floor have no order", () => {
  const s = section(
      on(report(folder_of(["manifest.json", "facts.csv", "errors.csv", "cost.csv"]))),
      "convergence",
    ),
    at = name => s.table.columns.indexOf(name);
  const rows = s.table.rows.filter(
    row =>
      row[at("scene")] === problems[0] &&
      row[at("scheme")] === "one" &&
      row[at("error")] === "error_l2_50ms",
  );
  // 0.1 x 4^-3 = 1.56e-3 lies below the floor of 2e-3
  assert.deepEqual(
    rows.map(row => row[at("points")]),
    [3],
  );
});
test("maps hold their boundaries and theory, and their tiles meet half-way", () => {
  const page = report(folder_of(every_file)),
    of = on(page),
    {charts, table} = section(of, "maps"),
    [map, other] = charts.map(c => c.spec(first(c), false).spec);
  assert.equal(charts.length, 2);
  assert.deepEqual(choices(charts[0], "series_field"), ["one", "two"]);
  assert.equal(map.encoding.x.scale.type, "log");
  assert.equal(other.encoding.x.scale.type, "linear");
  assert.ok(map.encoding.y.axis.title.includes("[Hz]"));
  assert.equal(table.rows.length, 8);
  const lines = of("map_rows('stiffness x rate')").rows.filter(r => r.kind === "line");
  assert.equal(lines.length, 8);
  for (const line of lines) assert.ok(Math.abs(line.theory / line.x - 1.2) < 1e-3);
  const uneven = on({
    ...page,
    tables: {
      ...page.tables,
      maps: {...page.tables.maps, rows: page.tables.maps.rows.filter(row => !row.includes(1e6))},
    },
  });
  for (const [where, has] of [
    [of, true],
    [uneven, false],
  ]) {
    const tiles = new Map(
        where("map_rows('stiffness x rate')")
          .rows.filter(r => r.kind === "tile")
          .map(t => [t.x, t]),
      ),
      places = [...tiles.keys()].sort((a, b) => a - b);
    assert.equal(tiles.has(1e6), has);
    for (let k = 0; k + 1 < places.length; ++k) {
      const {right} = tiles.get(places[k]),
        {left} = tiles.get(places[k + 1]);
      // on a logarithmic axis
      assert.ok(
        Math.abs(right / Math.sqrt(places[k] * places[k + 1]) - 1) < 1e-12 &&
          Math.abs(right / left - 1) < 1e-12,
        `${places[k]}`,
      );
    }
    assert.ok(tiles.get(places[0]).left < places[0]);
  }
});
test("a map over one key has a row of tiles", () => {
  const [head, ...rows] = readFileSync(join(results, "maps.csv"), "utf8").trim().split("\n"),
    at = ["y_key", "y"].map(name => head.split(",").indexOf(name)),
    flat = row => row.split(",").map((field, k) => (at.includes(k) ? "" : field)),
    maps = [head, ...rows.map(flat), ""].join("\n"),
    of = on(report(folder_of(["manifest.json"], {"maps.csv": maps}))),
    {y, rows: tiles} = of("map_rows('stiffness x rate')");
  assert.equal(y.title, "");
  assert.ok(tiles.length > 0 && tiles.every(t => t.y === "" && t.left < t.right));
  for (const chart of section(of, "maps").charts) assert.ok(chart.spec(first(chart), true).spec);
});
test("a step of a population's curve has the string that a click opens", () => {
  const strings =
      "string,window_s,uncertainty,outcome\nlow,0.1,0.001,decided within 1 %\nhigh,0.1,0.2,undecided\n",
    fronts =
      "string,scheme,options,rate,modes,error,cost_s_per_s\n" +
      "low,one,,44100,20,0.05,0.001\nlow,one,,88200,40,0.005,0.004\nhigh,two,,44100,20,0.3,0.002\n";
  const of = on(
    report(folder_of(["manifest.json"], {"strings.csv": strings, "fronts.csv": fronts})),
  );
  const values = spec =>
    JSON.stringify(spec)
      .match(/"string":"[a-z]+"/g)
      ?.map(text => text.slice(10, -1));
  const steps = print => values(of(`share_spec({within_field: 0.01}, ${print}).spec`));
  assert.deepEqual([...new Set(steps(false))], ["low"]);
  assert.equal(steps(false).length, steps(true).length + 1); // the mark to click
  const rows = of('string_spec({scene: "low"}, false).spec.data.values');
  assert.deepEqual(
    rows.map(row => [row.series, row.x, row.y]),
    [
      ["one", 0.001, 0.05],
      ["one", 0.004, 0.005],
    ],
  );
});
test("steps to a trimmed scene have the look of their schemes", () => {
  const measure = '"relative L2 error, whole run"',
    path =
      "step,change,scheme,options,modes,rate,error,certificate,within,cost_s_per_s,measure,target\n" +
      `0,whole,modal_two_point,,,88200,0.03,0.001,no,0.2,${measure},0.01\n` +
      `1,less,modal_two_point,compliance=matched,20,44100,0.009,0.001,yes,0.1,${measure},0.01\n` +
      `2,least,finite_difference_theta,,,44100,0.009,0.001,yes,0.05,${measure},0.01\n`;
  const of = on(
      report(
        folder_of([], {"manifest.json": '{"suite": "trim a", "trimmed": "a"}', "path.csv": path}),
      ),
    ),
    names = ["modal_two_point", "modal_two_point compliance=matched", "finite_difference_theta"],
    looks = of("looks_of")(names);
  assert.equal(
    of("finding_of_trim()"),
    "a within 1 %: the trimmed model costs 4 times less than the whole scene as published",
  );
  const [chart] = section(of, "path").charts;
  for (const print of [false, true]) {
    const {
        hconcat: [left, right],
      } = chart.spec({}, print).spec.vconcat?.[0] ?? chart.spec({}, print).spec,
      dashes = left.layer.map(l => l.encoding.strokeDash).filter(Boolean);
    for (const [encoding, what] of [
      [left.encoding.color, "colour"],
      [right.encoding.color, "colour"],
      [left.layer.at(-1).encoding.shape, "shape"],
      [right.layer.at(-1).encoding.shape, "shape"],
      ...dashes.map(d => [d, "dash"]),
    ]) {
      assert.deepEqual(encoding.scale.domain, names);
      assert.deepEqual(
        encoding.scale.range,
        names.map(name => looks.get(name)[what]),
        what,
      );
    }
    assert.equal(dashes.length, 2);
    assert.deepEqual(
      left.data.values.map(r => r.series),
      names,
    );
  }
  globalThis.innerWidth = 390;
  const {vconcat} = chart.spec({narrow: true}, false).spec;
  assert.ok(
    vconcat.length === 2 &&
      vconcat.every(part => part.width <= 300 && /split/.test(part.encoding.y.axis.labelExpr)),
    "on a phone one above the other, named by the steps' numbers",
  );
  for (const axis of vconcat.map(part => part.layer.at(-1).encoding.x.axis))
    assert.ok(!/domain/.test(axis.labelExpr), "labels of a part do not ask for the whole's scale");
});

// ---- Looks
const registry = [
  ["modal_two_point", false],
  ["modal_quadratised", false],
  ["modal_spatial_newton", false],
  ["finite_difference_theta", false],
  ["finite_difference_explicit", false],
  ["sitar_fdm", false],
  ["modal_explicit_penalty", true],
  ["exact_contact", false],
];
// sRGB, IEC 61966-2-1
const linear = hex =>
  [1, 3, 5]
    .map(k => parseInt(hex.slice(k, k + 2), 16) / 255)
    .map(x => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4));
const times = (m, v) => m.map(row => row.reduce((sum, x, k) => sum + x * v[k], 0));
const to_xyz = [
  [0.4124564, 0.3575761, 0.1804375],
  [0.2126729, 0.7151522, 0.072175],
  [0.0193339, 0.119192, 0.9503041],
];
function lab(rgb) {
  // CIELAB under D65
  const f = times(
    to_xyz,
    rgb.map(x => Math.min(1, Math.max(0, x))),
  )
    .map((x, k) => x / [0.95047, 1, 1.08883][k])
    .map(x => (x > 0.008856 ? Math.cbrt(x) : 7.787 * x + 16 / 116));
  return [116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])];
}
// Sight without the cones for long, middle and short waves: Machado, Oliveira & Fernandes 2009,
// severity 1.
const sights = [
  [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ],
  [
    [0.152286, 1.052583, -0.204868],
    [0.114503, 0.786281, 0.099216],
    [-0.003882, -0.048116, 1.051998],
  ],
  [
    [0.367322, 0.860646, -0.227968],
    [0.280085, 0.672501, 0.047413],
    [-0.01182, 0.04294, 0.968881],
  ],
  [
    [1.255528, -0.076749, -0.178779],
    [-0.078411, 0.930809, 0.147602],
    [0.004733, 0.691367, 0.3039],
  ],
];
function contrast(a, b) {
  // WCAG 2
  const [p, q] = [a, b].map(hex => times(to_xyz, linear(hex))[1] + 0.05);
  return Math.max(p, q) / Math.min(p, q);
}
function css_colour(name, dark) {
  const in_dark = /@media \(prefers-color-scheme: dark\) \{[^]*?\n\}/g,
    hex = (dark ? css.match(in_dark).join("") : css.replace(in_dark, "")).match(
      new RegExp(`--${name}: (#[0-9a-f]+);`),
    )[1];
  return hex.length === 4 ? "#" + [...hex.slice(1)].map(x => x + x).join("") : hex;
}
const looks = on({schemes: registry, tables: {}});
test("families are told apart by every kind of sight and seen on their page", () => {
  for (const dark of [0, 1]) {
    const colours = looks("families").map(f => f[2 + dark]);
    colours.forEach((one, i) => {
      assert.ok(contrast(one, css_colour("paper", dark)) >= 3, one);
      for (const other of colours.slice(0, i))
        for (const sight of sights) {
          const [p, q] = [one, other].map(hex => lab(times(sight, linear(hex))));
          assert.ok(Math.hypot(...p.map((x, k) => x - q[k])) >= 15, `${one} and ${other}`);
        }
    });
  }
});
test("a run's picture for a column is at most 120 mm high, in letters of 7 pt or more", () => {
  const file = join(scratch, "column.svg"),
    words = "run tanpura_c3_release --scheme modal_two_point --energy --quiet --width 85mm --plot",
    run = spawnSync(program, [...words.split(" "), file], {
      encoding: "utf8",
      env: {...process.env, JVARI_NODE_MODULES: modules},
    });
  if (!existsSync(join(modules, "vega"))) return;
  assert.equal(run.status, 0, run.stderr);
  const svg = readFileSync(file, "utf8"),
    [, wide, high, box] = /width="([\d.]+)mm" height="([\d.]+)mm" viewBox="0 0 ([\d.]+)/.exec(svg),
    points = ((72 / 25.4) * wide) / box; // of a pixel
  assert.ok(high <= 120, `${high} mm`);
  for (const [, pixels] of svg.matchAll(/font-size="([\d.]+)px/g))
    assert.ok(pixels * points >= 7, `${pixels * points} pt`);
});
test("lines and points of the first chart keep the full colour of their family", () => {
  const of = whole(),
    section_ = section(of, "work-precision"),
    {spec} = section_.charts[0].spec(first(section_.charts[0]), false);
  for (const layer of layers(spec))
    if (["line", "point"].includes(layer.mark?.type) && layer.encoding?.color)
      assert.equal(layer.encoding.opacity, undefined, JSON.stringify(layer.encoding.opacity));
});
test("text of the page has a contrast of four and a half", () => {
  for (const dark of [false, true])
    for (const ink of ["ink", "soft", "bad", "key"])
      for (const ground of ["paper", "raised"])
        assert.ok(contrast(css_colour(ink, dark), css_colour(ground, dark)) >= 4.5, ink + ground);
});
test("charts have the page's own ink, blue and paper", () => {
  for (const tone of ["ink", "key", "paper"]) {
    for (const dark of [0, 1]) assert.equal(looks(tone)[dark], css_colour(tone, dark));
    assert.equal(looks("dark_of")[looks(tone)[0]], looks(tone)[1]);
  }
});
// outcomes of a map are no schemes, and looks.js holds them all
test("no chart has a hue of its own", () => {
  for (const name of ["work_precision", "along", "sound_charts", "run", "verdict", "answer"])
    for (const [, hex] of readFileSync(join(sources, `${name}.js`), "utf8").matchAll(
      /"#([0-9a-f]{6}|[0-9a-f]{3})"/g,
    )) {
      const wide = hex.length / 3,
        parts = [0, 1, 2].map(k => hex.slice(k * wide, (k + 1) * wide));
      // the ground of viridis
      assert.ok(new Set(parts).size === 1 || hex === "440154", `${name}: #${hex}`);
    }
});
test("a scheme looks the same in any company and like no other", () => {
  const {schemes} = report(folder_of(["manifest.json", "maps.csv"])),
    forms = [
      "",
      " compliance=own",
      " compliance=matched",
      " compliance=own tolerance=1e-6",
      " compliance=matched tolerance=1e-6",
    ],
    pairs = form => [...form.matchAll(/(\S+)=(\S+)/g)].map(([, ...pair]) => pair),
    runs = schemes.flatMap(([name]) => forms.map(form => [name, form.trim()])),
    of = on({
      schemes,
      options: Object.fromEntries(forms.map(form => [form.trim(), pairs(form)])),
      tables: {path: table("scheme,options", ...runs)},
    }),
    names = schemes.map(([name]) => name),
    all = of("looks_of")(names);
  assert.ok(names.length > 15 && schemes.some(([, control]) => control));
  const own = names.filter(name => all.get(name).family !== of("other_family"));
  assert.equal(
    new Set(own.map(name => all.get(name).colour + all.get(name).shape)).size,
    own.length,
  );
  for (const [name, control] of schemes) {
    const alone = of("looks_of")(["a plugin", name + " compliance=matched"]).get(
        name + " compliance=matched",
      ),
      look = all.get(name);
    assert.deepEqual(
      [alone.colour, alone.shape, alone.control],
      [look.colour, look.shape, control],
      name,
    );
    assert.notDeepEqual(alone.dash, look.dash);
    if (control) assert.equal(look.colour, of("families").at(-2)[2]);
  }
  const beside_others = name =>
    of("looks_of")(["another plugin", "a plugin", name]).get(name).colour;
  assert.equal(
    beside_others("finite_difference_theta_quadratised"),
    all.get("finite_difference_theta").colour,
  );
  // no family begins like it
  assert.equal(beside_others("modal_three_point_moreau_jean"), of("families").at(-1)[2]);
  const dash = name => of("looks_of")([name]).get(name).dash;
  assert.equal(new Set(forms.map(form => dash("exact_contact" + form).join())).size, forms.length);
  for (const form of [" compliance=own", " compliance=matched"])
    assert.deepEqual(
      dash(`exact_contact${form} tolerance=1e-6`).slice(0, 2),
      dash("modal_two_point" + form),
    );
  assert.deepEqual(
    of("in_order")([
      "modal_explicit_penalty",
      "a plugin",
      "finite_difference_theta",
      "modal_two_point",
    ]),
    ["modal_two_point", "finite_difference_theta", "a plugin", "modal_explicit_penalty"],
  );
});

// ---- Sounds
const base64 = numbers => Buffer.from(new Int16Array(numbers).buffer).toString("base64");
const sound = (samples, more = {}) => ({
  rate: 44100,
  peak: 32767,
  samples: base64(samples),
  ...more,
});
test("samples are read as they were written", () =>
  assert.deepEqual(
    on({tables: {}})("integers")(base64([0, 1, -1, 32767, -32768])),
    [0, 1, -1, 32767, -32768],
  ));
test("a trace is drawn from where its reference is liveliest, with the difference", () => {
  const n = 4410,
    truth = Array.from({length: n}, (_, k) =>
      k < 1900 ? Math.round(k / 10) : Math.round(3000 * Math.sin(k)),
    ),
    own = truth.map(x => x + 7);
  const rows_of_sounds = table(
    "problem,series,scheme,rate,tap,quantity,file,reference_file",
    ["s", "reference", "reference", null, "nut", "nut_force", "r.wav", null],
    ["s", "a", "a", 44100, "nut", "nut_force", "a.wav", "r.wav"],
  );
  const of = on({
    title: "t",
    schemes: registry,
    measures: [],
    options: {},
    tables: {sounds: rows_of_sounds},
    sounds: [sound(truth, {row: 0}), sound(own, {row: 1})],
    left_out: {sounds: []},
    manifest: {},
    levels: [],
  });
  const {charts} = of("waveform_section()"),
    {spec} = charts[0].spec({...first(charts[0]), sound_field: "a.wav"}, false),
    rows = spec.layer[0].data.values,
    who = name => rows.filter(r => r.who === name);
  // the stretch of 10 ms in which it begins to move
  assert.equal(who("scheme")[0].ms, (1000 * Math.round(0.04 * 44100)) / 44100);
  assert.ok(
    who("difference").every(r => Math.abs(r.value - 7) < 1e-9) &&
      who("difference").length === who("reference").length,
  );
  assert.equal(who("reference")[0].value, truth[Math.round(0.04 * 44100)]);
});
test(
  "spectrograms merge equal neighbours, leave out the background, and grow coarser until " +
    "they fit",
  () => {
    const of = on({tables: {}}),
      noise = {
        start: 0,
        hop: 0.02,
        row_hz: 80,
        frames: 60,
        rows: 100,
        level: Array.from({length: 6000}, (_, k) => -200 - ((k * 7919) % 600)),
      };
    const quiet = {...noise, frames: 2, rows: 2, level: [-1200, -200, -200, -200]},
      panels = [{levels: noise}, {levels: quiet}, {levels: null}];
    const frame = of("tiled")(panels, 2000);
    assert.ok(
      panels[0].tiles.length + panels[1].tiles.length <= 2000 && panels[0].tiles.length > 200,
    );
    assert.deepEqual([frame.first, frame.last, frame.highest], [0, 1.2, 8]);
    const alone = [{levels: quiet}];
    of("tiled")(alone, 2000);
    // one of four is 100 dB below: background
    assert.deepEqual(
      alone[0].tiles.map(t => [t.a, t.b, t.f]),
      [
        [0, 0.04, 0.08],
        [0.02, 0.04, 0],
      ].sort((a, b) => a[2] - b[2]),
    );
    // 200 dB below: background alone, for the scale is common
    const far = [{levels: noise}, {levels: {...noise, level: noise.level.map(x => x - 2000)}}];
    of("tiled")(far, 2000);
    assert.equal(far[1].tiles.length, 0);
    assert.ok(Math.max(...far[0].tiles.map(t => t.l)) === 0);
    assert.equal(
      of("panel_spec")({title: "y", levels: null, status: "refused"}, frame, {
        left: null,
        lowest: true,
      }).mark.text,
      "refused",
    );
    const louder = {...quiet, level: [-200, -200, -200, -100]},
      truth = {...quiet, level: [-200, -200, -200, -200]},
      compared = [{levels: louder, against: truth}, {levels: truth}];
    of("tiled")(compared, 2000, true);
    // the reference differs from nothing
    assert.deepEqual(
      compared.map(p => p.tiles.map(t => t.l)),
      [[10], []],
    );
  },
);

// ---- Columns
test("the page reads no column that the program does not write", () => {
  const quiet = {encoding: "utf8", env: {...process.env, JVARI_NODE_MODULES: "/nowhere"}},
    records = join(sources, "../../../results"),
    {facts} = JSON.parse(spawnSync(program, ["list", "facts", "--json"], quiet).stdout),
    optional = [
      ...facts.map(fact => "cells.fact_" + fact.name),
      "cells.fact_reference_limit_hz", // of strings whose modes were measured
      "sounds.what", // of trim
    ],
    names = ["scheme", "options", "series"], // looked for in every table
    cells = folder_of([]),
    maps = folder_of([], {
      "s.toml":
        '[[cells]]\nname = "m"\nscenes = "free_string"\nschemes = "finite_difference_explicit"\n' +
        'measure = "outcome"\nduration = 0.002\noptions = { grid = 100 }\n' +
        "sweep = { rate = [20000, 88200] }\n",
    });
  const run = "free_string --rates 44100,88200 --modes 20 --duration 0.06 --repeats 1 --schemes",
    schemes = ["finite_difference_theta,modal_two_point,sitar_fdm"];
  for (const words of [
    ["compare", ...run.split(" "), ...schemes, "--out", cells],
    ["suite", join(maps, "s.toml"), "--out", maps],
  ])
    assert.equal(spawnSync(program, [...words, "--quiet"], quiet).status, 0, words.join(" "));
  const own_tables = ["cells", "convergence", "sounds", "maps", "boundaries"],
    // held against the program by tests/bench
    recorded_tables = ["path", "needs", "strings", "fronts", "advice"],
    copies = ["trim/two_point_bridge-10", "population"].map(record =>
      folder_of(
        [],
        Object.fromEntries(
          ["manifest.json", ...recorded_tables.map(name => name + ".csv")]
            .filter(name => existsSync(join(records, record, name)))
            .map(name => [name, readFileSync(join(records, record, name), "utf8")]),
        ),
      ),
    );
  const seen = new Set(),
    copied = new Set(),
    missing = new Set();
  for (const folder of [cells, maps, ...copies]) {
    const page = report(folder),
      of = on(page);
    for (const name of Object.keys(page.tables)) {
      const t = of("table")(name);
      if (t.rows.length) seen.add(name);
      t.records = t.records.map(
        record =>
          new Proxy(record, {
            // a copy of a row would hide what is read of it
            ownKeys: record => {
              copied.add(name);
              return Reflect.ownKeys(record);
            },
            get: (record, key) => {
              const column = `${name}.${String(key)}`;
              if (!(key in record) && !names.includes(key) && !optional.includes(column))
                missing.add(column);
              return record[key];
            },
          }),
      );
    }
    for (const {charts} of of("sections_of()"))
      for (const chart of charts)
        for (const twin of chart.twins)
          for (const print of [false, true]) chart.spec(twin.choice, print);
    of("[finding_of_maps(), finding_of_trim(), finding_of_share()]");
    for (const scene of of("scenes_of_cells()")) {
      const rows = of("of_scene")(of("cells()"), scene);
      for (const error of of("errors_in")(rows)) of("spoken_error")(error, rows);
      for (const within of [1e-9, 0.1, 10]) at(of, scene, within);
    }
  }
  assert.deepEqual(
    [...own_tables, ...recorded_tables].filter(name => !seen.has(name)),
    [],
  );
  assert.deepEqual([...missing, ...copied], []);
});

// ---- And Vega draws them
if (!existsSync(join(modules, "vega/build/vega.min.js")))
  console.log("not drawn: no vega (npm ci at the root of the sources)");
else
  test("charts are drawn with their words", () => {
    const folder = folder_of([], {
        "manifest.json": '{"suite": "a scene"}',
        ...files_of(`scene,${sample_head}\n${sample_rows.map(row => `s,${row}\n`).join("")}`),
      }),
      run = spawnSync(program, ["report", folder], {
        encoding: "utf8",
        env: {...process.env, JVARI_NODE_MODULES: modules},
      });
    assert.equal(run.status, 0, run.stderr);
    const svg = readFileSync(join(folder, "work_precision.svg"), "utf8");
    for (const word of ["a scene", "relative L2 error", "computing time", "\u2715"])
      assert.ok(svg.includes(word), word);
  });

rmSync(scratch, {recursive: true, force: true});
console.log(failures ? `${failures} failed` : "all hold");
process.exit(failures ? 1 : 0);
