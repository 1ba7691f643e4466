// Verdict on each scene: the cheapest scheme within any tolerance, with the uncertainties. The
// program decides: readers drag the tolerance, and the page looks the answer up.
const scheme_words = (name, own) => spoken(name, own).replaceAll("_", " ");
// Modes and rate: ": 133 modes at 88.2 kHz". A grid takes its nodes from the rate: " at 88.2 kHz".
const modes_words = c => (c.modes && !(c.fact_grid_intervals > 0) ? `${c.modes} modes` : ""),
  rate_words = c => (c.rate ? `at ${digits(c.rate / 1000, 4)}\u00a0kHz` : ""),
  place_words = c =>
    (modes_words(c) && ": " + modes_words(c)) + (rate_words(c) && " " + rate_words(c));
const option_words = c =>
  options_of(c)
    .map(([name, value]) =>
      name !== "compliance" ? `${name}=${value}` : value === "matched" ? value : "as published",
    )
    .join(", ");
const run_words = c => scheme_words(variant(c)) + place_words(c);
const times_words = x => `${digits(x, 2)}\u00a0\u00d7`;
// Error in words: "at most 0.57 %", "0.49 %", "0.49 % as measured"; "not known".
function quoted(c, error) {
  const text = error_text(error_of(c, error), error),
    says = c.errors[error]?.text ?? "";
  if (!(error_of(c, error) >= 0)) return "not known";
  if (is_bounded(c, error)) return says === "not known" ? says : "at most " + text;
  return Number.isNaN(bound_of(c, error).most) ? text + " as measured" : text;
}

// Cheapest offer, ties and possible winners within a tolerance, as the program has them.
function cheapest_within(within, {problem}, error, offers) {
  const from = (page.answers[problem]?.[error] ?? []).filter(([least]) => least <= within),
    [, best, ties, perhaps] = from.at(-1) ?? [0, null, [], []],
    of = row => offers.find(o => o.c.n === row);
  return {best: best === null ? null : of(best), ties: ties.map(of), perhaps: perhaps.map(of)};
}
const has_cost = c => c.cost_s_per_s > 0;
// Schemes run without any measured cost, if others have costs.
function unpriced_in(rows) {
  const priced = new Set(rows.filter(has_cost).map(c => c.scheme));
  return new Set(
    rows
      .filter(c => priced.size && c.may_win && c.status === "ok" && !priced.has(c.scheme))
      .map(c => c.scheme),
  );
}
// Answer: {error, within, best, ties, perhaps, published: the cheapest without matched compliance,
// ranking: {scheme, best, nearest} for each scheme, unpriced: likewise}
function answer_at(rows, error, within) {
  const offers = rows
      .filter(c => c.may_win && Number.isFinite(figure_of(c, error, "value")))
      .map(c => ({
        c,
        scheme: c.scheme,
        ...bound_of(c, error),
        cost: c.cost_s_per_s,
        lower: c.cost_lower,
        upper: c.cost_upper,
      })),
    priced = offers.filter(o => o.cost > 0),
    found = cheapest_within(within, rows[0] ?? {}, error, priced),
    least = (all, of) => all.reduce((a, b) => (of(b) < of(a) ? b : a), all[0]),
    met = all => all.filter(o => o.most <= within);
  const rank = all =>
    distinct(all.map(o => o.scheme)).map(scheme => {
      const own = all.filter(o => o.scheme === scheme);
      return {
        scheme,
        best: least(met(own), o => o.cost || o.most),
        nearest: least(own, o => error_of(o.c, error)),
        open: own.some(o => !(o.most <= within) && o.least <= within),
      };
    });
  const guests = unpriced_in(rows);
  return {
    error,
    within,
    ...found,
    published: least(
      met(priced).filter(o => !is_matched(o.c)),
      o => o.cost,
    ),
    nearest: least(priced, o => error_of(o.c, error)),
    ranking: rank(priced).sort(
      (a, b) =>
        (a.best?.cost ?? Infinity) - (b.best?.cost ?? Infinity) ||
        error_of(a.nearest.c, error) - error_of(b.nearest.c, error),
    ),
    unpriced: rank(offers.filter(o => guests.has(o.scheme))),
  };
}
// Ends the sentence "To keep ... within 1 %".
function finding_of({error, best, perhaps, nearest, unpriced}) {
  const guests = unpriced
    .map(
      r =>
        ` ${scheme_words(r.scheme)} ` +
        (r.best ? "keeps it too" : r.open ? "may keep it or not" : "does not keep it") +
        ` (${quoted((r.best ?? r.nearest).c, error)}): no cost measured.`,
    )
    .join("");
  if (best) return ` take ${run_words(best.c)}.${guests}`;
  if (perhaps.length) return `: cannot be decided.${guests}`;
  return `${nearest ? " is more than any run here does" : ": no trusted run has a cost"}.${guests}`;
}
// Longest shorter window over which the reference is known within the tolerance.
function decided_over(cell, error, within) {
  const known = ms => figure_of(cell, error.replace(/(50ms|whole)$/, `${ms}ms`), "certificate"),
    longest = {error_l2_50ms: [10], error_l2_whole: [50, 10]}[error]?.find(
      ms => known(ms) <= within,
    );
  return longest
    ? `Over the first ${longest} ms${after_pluck([cell])} it is known to ` +
        `*${error_text(known(longest), error)}*.`
    : "";
}
// Sentences below the finding; asterisks mark the *important* part.
function consequences({error, within, best, ties, perhaps, published, nearest}, rows) {
  const all = list =>
    list
      .slice(0, 3)
      .map(o => `${run_words(o.c)} (${quoted(o.c, error)})`)
      .join("; ") + (list.length > 3 ? ` and ${list.length - 3} more` : "");
  const certificate = figure_of(rows[0], error, "certificate");
  const unknown = "How wrong the reference itself may be is not known";
  if (!best) {
    const stated = records("cheapest").find(
      c =>
        c.problem === rows[0].problem &&
        c.status === "none" &&
        c.measure === error &&
        c.target >= within,
    );
    return perhaps.length
      ? [
          Number.isNaN(certificate)
            ? `${unknown}.`
            : `The reference itself may be wrong by *${error_text(certificate, error)}*.`,
          decided_over(rows[0], error, within),
          `It may be kept by ${all(perhaps)}.`,
        ].filter(Boolean)
      : nearest
        ? [
            (stated && scheme_words(stated.why)) ||
              `The closest is ${run_words(nearest.c)}: *${quoted(nearest.c, error)}*.`,
          ]
        : [];
  }
  const {c, cost} = best,
    limit = c.fact_reference_limit_hz / 1000, // highest mode of a measured table
    worst = c.worst_block_of_deadline,
    whole = error.replace(/error_l2_(10|50)ms/, "error_l2_whole"),
    later = c.errors[whole];
  return [
    `It errs by *${quoted(c, error)}* and takes *${percent(cost)} of a core*: ` +
      (cost < 1
        ? `${Math.floor(1 / cost)} voice${cost > 0.5 ? "" : "s"} on one core.`
        : "it is slower than real time."),
    worst > 0 && `Its worst block takes ${percent(worst)} of the deadline.`,
    is_matched(c) &&
      (published
        ? `As published the cheapest is ${scheme_words(published.c.scheme)}` +
          `${place_words(published.c)}, ` +
          `${digits(published.cost / cost, 2)} times dearer.`
        : "As published none gets there."),
    later &&
      whole !== error &&
      `After the window: over the whole run it errs by ${quoted(c, whole)}.`,
    ties.length && `No dearer by this clock: ${all(ties)}.`,
    perhaps.length &&
      `Perhaps for less: ${all(perhaps)}; the reference is not known well enough to tell.`,
    !(scene_facts(rows).certificate >= 0) && `${unknown}; this is as measured.`,
    limit > 0 && `What lies above ${digits(limit, 2)} kHz is not in your table.`,
    scene_facts(rows).busy && `Costs: ${scene_facts(rows).busy}.`,
  ].filter(Boolean);
}
const scene_facts = rows => records("scenes").find(s => s.problem === rows[0]?.problem) ?? {};
// Range of the tolerance, and the first value: 1 % or 1 dB if a run is known to be so accurate,
// otherwise the next usual tolerance that a run keeps.
function tolerances(rows, error) {
  const usual = is_percent(error) ? [0.01, 0.1] : [1, 3],
    first = usual.find(t => answer_at(rows, error, t).best) ?? usual[0],
    {ranking, unpriced} = answer_at(rows, error, first),
    least = [...ranking, ...unpriced].map(r => error_of(r.nearest.c, error)).filter(y => y > 0);
  return {
    first,
    from: Number((0.7 * Math.min(first, ...least)).toPrecision(1)),
    to: Number((1.5 * Math.max(usual[1], ...least)).toPrecision(1)),
  };
}
// Probability of so many right guesses or more by chance: one side of the binomial test.
function chance(right, guesses) {
  let p = 0;
  for (let k = 0, ways = 1; k <= guesses; ways *= (guesses - k) / (k + 1), ++k)
    if (k >= right) p += ways;
  return p / 2 ** guesses;
}
function score_text(right, guesses) {
  if (!guesses) return "";
  const p = chance(right, guesses);
  const heard = p < 0.05 ? "you hear a difference" : "no difference shown";
  return `so far ${right} of ${guesses}: ${heard} (p = ${digits(p, 2)})`;
}

// ---- The table at the end
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
  "error_l2_heard",
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
    own = ["problem", "series", "trusted", "may_win", "line"],
    columns = all.columns.filter(
      (name, k) => !own.includes(name) && all.rows.some(row => !is_blank(row[k])),
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
// Sections of the page in order; a section without data does not appear.
function sections_of() {
  const drawn = [
    run_section(),
    share_section(),
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
  const all = [...drawn, cell_section()].map(s => ({
    ...{notes: [], left_out: [], ...s},
    charts: (s.charts ?? []).map(chart => ({menus: () => [], twins: [], ...chart})),
  }));
  return all.filter(s => s.charts.length || s.left_out.length || s.table?.rows.length);
}
