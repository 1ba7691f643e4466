// What the folder says of each of its scenes: the cheapest scheme for each accuracy and how certain
// that is, what the reference is, how the machine was. The program has found the cheapest and
// judged every cell; here it is put in words.
function wanted(c, rows) {
  if (c.measure === "third_octave_db") return `third octaves within ${c.goal}${after_pluck(rows)}`;
  const window = {error_l2_50ms: "first 50 ms", error_l2_10ms: "first 10 ms"}[c.measure];
  return `waveform within ${c.goal}, ${window ?? "whole run"}${after_pluck(rows)}`;
}
// A row of the cheapest: its error as it is quoted, with the uncertainty of the reference where
// that is more than a tenth of it.
function quoted(c) {
  const bounded = number(c.bound) - number(c.error) > 0.1 * number(c.error);
  return {bounded, text: error_text(number(bounded ? c.bound : c.error), c.measure)};
}
// the trusted cell that comes nearest, where none is near enough
function nearest_text(rows, measure) {
  const near = rows.filter(c => c.may_win && Number.isFinite(error_of(c, measure)));
  if (!near.length) return "no trusted run has this error";
  const best = near.reduce((a, b) => (error_of(b, measure) < error_of(a, measure) ? b : a));
  return `closest: ${best.run}, ${error_text(error_of(best, measure), measure)}`;
}
function answer_of(c, rows) {
  if (c.status !== "found") {
    const open = c.status === "not_known";
    return {
      within: wanted(c, rows),
      scheme: open ? "cannot be decided" : "none",
      modes: "",
      rate: "",
      error: "",
      cost: "",
      certain: open
        ? c.why + (c.perhaps && `; candidates: ${c.perhaps}`)
        : nearest_text(rows, c.measure),
    };
  }
  const found = quoted(c),
    scheme = variant(c),
    more = [
      [c.ties, "a tie with "],
      [c.perhaps, "perhaps for less "],
      [c.as_published, "without matched compliance: "],
    ];
  return {
    within: wanted(c, rows),
    scheme,
    modes: c.modes,
    rate: kilohertz(number(c.rate)),
    error: (found.bounded ? "\u2264 " : "") + found.text,
    cost: time_text(number(c.cost_s_per_s)),
    colour: looks_of([scheme]).get(scheme).colour,
    certain:
      (c.why ||
        (found.bounded ? "upper bound: includes the uncertainty of the reference" : "measured")) +
      more.map(([text, before]) => (text ? `; ${before}${text}` : "")).join(""),
  };
}
// The cheapest within 1 % of the waveform, else the first that is found: what it does, and how
// fast.
function finding_of(scene, cheapest, rows) {
  const found = cheapest.filter(c => c.status === "found"),
    best = found.find(c => number(c.target) === 0.01) ?? found[0];
  if (!best) return `No scheme is known to be near enough on ${scene}`;
  const {bounded, text} = quoted(best),
    rate = kilohertz(number(best.rate)),
    cost = number(best.cost_s_per_s),
    matched = best.options.includes("compliance=matched");
  return (
    `${best.scheme}${matched ? " with matched compliance" : ""} errs by ` +
    `${bounded ? "at most " : ""}${text}${after_pluck(rows)}${rate && ` at ${rate}`}, ` +
    `${digits(cost < 1 ? 1 / cost : cost, 2)} times ${cost < 1 ? "faster" : "slower"} than ` +
    "real time"
  );
}
function reference_text(s, rows) {
  const name = page.manifest?.reference?.name ?? rows[0]?.reference ?? "",
    modes = number(rows[0]?.reference_modes),
    horizon = number(rows[0]?.reference_horizon_s),
    certificate = number(s.certificate);
  // its modes were measured
  const beyond = /what lies above .*? is not in your table/.exec(
    rows[0]?.reference_doubling ?? "",
  )?.[0];
  if (!name) return "";
  return (
    `Reference: ${name}${Number.isNaN(modes) ? "" : ` with ${modes} modes`}. Its uncertainty is ` +
    (Number.isNaN(certificate)
      ? "unknown."
      : `${error_text(certificate, s.headline)} in the first error of the table.`) +
    (beyond ? ` W${beyond.slice(1)}.` : "") +
    (Number.isNaN(horizon)
      ? ""
      : " Two reference runs whose starting points differ by 1e-12 agree within 10 % for " +
        `${digits(horizon, 3)} s${after_pluck(rows)}.`)
  );
}
// schemes that carry another number of modes than the reference: their error is of the cut as well
function modes_text(rows) {
  const of_reference = number(rows[0]?.reference_modes);
  const others = distinct(
    rows
      .filter(c => c.status === "ok" && number(c.modes) > 0 && number(c.modes) !== of_reference)
      .map(c => c.scheme),
  ).sort();
  return Number.isNaN(of_reference) || !others.length
    ? ""
    : `The reference has ${of_reference} modes. These schemes have fewer or more, and that ` +
        `difference is part of their error: ${others.join(", ")}.`;
}
function runs_text(rows) {
  const count = of => rows.filter(of).length,
    ok = count(c => c.status === "ok"),
    left = count(c => c.status === "not_needed"),
    refused = count(c => c.status === "refused");
  const flagged = count(c => c.status === "ok" && !c.trusted),
    failed = rows.length - ok - left - refused;
  const some = (n, text) => (n ? `, ${n} ${text}` : "");
  return (
    `${ok === rows.length ? `All ${ok}` : `${ok} of ${rows.length}`} runs succeeded` +
    some(flagged, "of them with a flag against them") +
    some(failed, "failed") +
    some(left, "left out, because a cheaper one does as well") +
    `${some(refused, "were refused")}.`
  );
}
function machine_text(s) {
  const {cpu, load, cores} = page.manifest ?? {},
    spread = number(s.spread);
  if (!cpu || Number.isNaN(spread)) return "";
  const busy = load !== undefined && cores !== undefined;
  return (
    `Timed on ${cpu}${busy ? `, ${cores} cores, at a load of ${digits(load, 2)}` : ""}; ` +
    `the costs scatter by \u00b1${(100 * spread).toFixed(0)} % between their quartiles (median).`
  );
}
function verdicts() {
  return records("scenes").map(s => {
    const rows = of_scene(cells(), s.problem),
      cheapest = of_scene(records("cheapest"), s.problem),
      answers = cheapest.map(c => answer_of(c, rows));
    const none = answers.length
      ? ""
      : "No scheme can be called the cheapest here: none has a cost, an error and no flag.";
    return {
      scene: s.problem,
      finding: finding_of(s.problem, cheapest, rows),
      answers,
      sentences: [
        none,
        reference_text(s, rows),
        modes_text(rows),
        runs_text(rows),
        machine_text(s),
        s.busy && `Costs: ${s.busy}.`,
      ].filter(Boolean),
    };
  });
}

// ---- The tables and pictures at the end
const first_columns = [
  "scheme",
  "options",
  "rate",
  "modes",
  "status",
  "flags",
  "error_l2_10ms",
  "error_l2_50ms",
  "error_l2_whole",
  "horizon_s",
  "third_octave_db",
  "stft_db",
  "cost_s_per_s",
  "times_real_time",
  "ns_per_step",
  "energy_residual_accumulated",
  "smallest_contact_force",
  "deepest_penetration",
  "reason",
];
function cell_section() {
  const all = table("cells"),
    own = ["problem", "series", "trusted", "may_win", "run", "line"],
    columns = all.columns.filter(
      (name, k) => !own.includes(name) && all.rows.some(row => row[k] !== ""),
    );
  const shown = {};
  for (const e of records("errors"))
    if (e.text && !e.tap) (shown[e.measure] ??= {})[e.row] = e.text;
  const whole = without(
      all,
      all.columns.filter(name => !columns.includes(name)),
    ),
    naming = columns.slice(Math.max(0, columns.indexOf("scene")), columns.indexOf("scheme"));
  const front = columns.includes("pareto") ? " Marked rows are on the Pareto front." : "";
  return {
    id: "cells",
    heading: "Cells",
    charts: [],
    left_out: page.left_out.cells,
    notes: ["Each run, failures and refusals too." + front],
    table: {
      ...whole,
      shown,
      first: [...(columns.includes("scene") ? naming : []), ...first_columns].filter(name =>
        columns.includes(name),
      ),
    },
  };
}
function picture_section(drawn) {
  // SVGs in the folder that are none of the page's own
  const pictures = page.pictures.filter(p => !drawn.includes(p.name + ".svg"));
  return {
    id: "figures",
    heading: "Figures",
    notes: [],
    charts: [],
    pictures,
    left_out: page.left_out.figures,
  };
}

// All that stands on the page, in this order; a section without data does not appear.
function sections_of() {
  const drawn = [
    run_section(),
    path_section(),
    needs_section(),
    work_precision_section(),
    sweep_section(),
    convergence_section(),
    overview_section(),
    map_section(),
    spectrogram_section(),
    waveform_section(),
  ].filter(Boolean);
  if (page.missing) for (const s of drawn) s.charts = [];
  const all = [
    ...drawn,
    picture_section(drawn.flatMap(s => s.charts.flatMap(c => c.twins.map(t => t.file)))),
    cell_section(),
  ];
  for (const s of all) s.left_out = s.left_out ?? [];
  return all.filter(
    s => s.charts.length || s.pictures?.length || s.left_out.length || s.table?.rows.length,
  );
}
