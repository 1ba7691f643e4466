// Data for the report: the folder's tables, with look-ups. `page` holds the tables and is written by
// report.cpp. The page and draw.js, which makes the SVG files, run the same code.
// Field of a table: a number, a truth value or a text; NaN for a blank. JSON has [1] for Infinity.
const field = x => (x === null ? NaN : Array.isArray(x) ? x[0] * Infinity : x);
const is_blank = x => x === "" || x === undefined || x === null || Number.isNaN(x);
const plain = x => (is_blank(x) ? "" : typeof x === "string" ? x : String(Number(x)));
const distinct = values => [...new Set(values)];
const finite = x => (Number.isFinite(x) ? x : null);
const digits = (x, n) => String(Number(x.toPrecision(n))); // "280", "0.0021"
const percent = x => `${digits(100 * x, 2)}\u00a0%`;
const kilohertz = hz => (hz > 0 ? `${digits(hz / 1000, 5)} kHz` : "");

const tables = {}; // name: {columns, rows, records}; `n` in a record is the row number
function table(name) {
  return (tables[name] ??= with_records(page.tables[name] ?? {columns: [], rows: []}));
}
function with_records({columns, rows}) {
  const t = {columns, rows: rows.map(row => row.map(field))};
  t.records = t.rows.map((row, n) =>
    Object.assign(Object.fromEntries(columns.map((column, k) => [column, row[k]])), {n}),
  );
  return t;
}
const records = name => table(name).records;
// Table without the named columns, which the report adds and which repeat other columns.
function without(t, names) {
  const kept = t.columns
    .map((column, k) => [column, k])
    .filter(([column]) => !names.includes(column));
  return {
    columns: kept.map(([column]) => column),
    rows: t.rows.map(row => kept.map(([, k]) => row[k])),
  };
}

// Cells with the program's judgement: `trusted`, `may_win`, `line` (series in the chart with the
// front; none if another number of modes is better), and errors by name.
const error_name = ({measure, tap}) => measure + (is_blank(tap) ? "" : "_" + tap); // blank: headline
let joined = null;
function cells() {
  if (joined) return joined;
  joined = records("cells");
  for (const c of joined) c.errors = {};
  for (const e of records("errors")) joined[e.row].errors[error_name(e)] = e;
  return joined;
}
const options_of = c => page.options[c.options] ?? []; // [[name, value]]
const is_matched = c =>
  options_of(c).some(([name, value]) => name === "compliance" && value === "matched");
// Figure `what` for an error: value, floor, certificate; for a bound also shown, text.
const figure_of = (cell, error, what) => cell.errors[error]?.[what] ?? NaN;
const is_bounded = (cell, error) => Boolean(cell.errors[error]?.text);
const error_of = (cell, error) =>
  figure_of(cell, error, is_bounded(cell, error) ? "shown" : "value");
// Upper and lower bound for an error, by the rule in bench/compare/bound.hpp: spectral measures
// count as measured. NaN if the uncertainty of the reference is unknown.
function bound_of(cell, error) {
  const value = figure_of(cell, error, "value"),
    certificate = is_percent(error) ? figure_of(cell, error, "certificate") : 0;
  return {
    most: value + certificate,
    least: value < Infinity ? Math.max(0, value - (certificate >= 0 ? certificate : value)) : value,
  };
}
const of_scene = (rows, scene) => rows.filter(row => row.problem === scene);
const has_finite = (rows, column) => rows.some(row => Number.isFinite(row[column]));

// Start of the error windows in these rows, for a title.
const after_pluck = rows => (rows[0]?.free_from_s > 0 ? " after the last pluck" : "");
// Errors for the menus of a scene, headline first: {column, title, menu, name, measure, tap}.
let taps = null;
const all_taps = () => (taps ??= distinct(["", ...records("errors").map(e => e.tap)]));
function errors_in(rows) {
  const all = all_taps()
    .flatMap(tap =>
      page.measures.map(([measure, axis, name]) => ({
        column: error_name({measure, tap}),
        title: axis + after_pluck(rows) + (tap && `, tap ${tap}`),
        menu: axis + after_pluck(rows),
        name,
        measure,
        tap,
      })),
    )
    .filter(e => rows.some(c => Number.isFinite(figure_of(c, e.column, "value"))));
  const headline = records("scenes").find(s => s.problem === rows[0]?.problem)?.headline;
  return all.sort((a, b) => (b.column === headline) - (a.column === headline));
}
// Name of an error in a sentence: "the force on the nut, first 50 ms".
const forces = {nut_force: "nut", bridge_force: "bridge", thread_force: "thread"};
function spoken_error({measure, tap, name: title}, [row = {}]) {
  const octaves = measure === "third_octave_db",
    name = tap || row[octaves ? "headline_bridge" : "headline_nut"],
    quantity = page.quantities[row.scene]?.[name] ?? "signal",
    place = forces[quantity],
    signal = place
      ? `the force on the ${place}${name === place ? "" : ` (${name})`}`
      : `the ${quantity.replace("_", " ")}${name ? ` at ${name}` : ""}`,
    whole = octaves ? "third octaves" : title;
  const window = {
    error_l2_10ms: "first 10 ms",
    error_l2_50ms: "first 50 ms",
    error_l2_heard: "first 50 ms of its modes below 20 kHz",
  }[measure];
  return (
    (window
      ? `${signal}, ${window}`
      : is_percent(measure)
        ? `${signal}, whole run`
        : `${whole} of ${signal}`) + after_pluck([row])
  );
}
// Menus for an error: measure and tap.
function error_menus(rows) {
  const errors = errors_in(rows),
    measures = new Map(errors.map(e => [e.measure, e.menu]));
  return [
    {label: "error", key: "measure_field", choices: [...measures]},
    {
      label: "tap",
      key: "tap_field",
      choices: distinct(errors.map(e => e.tap)).map(tap => [tap, tap || "headline"]),
    },
  ];
}
function chosen_error(rows, choice) {
  // Falls back to the first error if the scene lacks the chosen one.
  const errors = errors_in(rows);
  return (
    errors.find(e => e.measure === choice.measure_field && e.tap === choice.tap_field) ?? errors[0]
  );
}

const longest_part = 100;
const plain_part = text =>
  text
    .replace(/[^A-Za-z0-9_.+-]+/g, "-")
    .replace(/^-/, "")
    .replace(/-$/, "")
    .slice(0, longest_part);
// Part of a file name for `text`, different from the part for any other text in `all`.
function file_part(text, all) {
  const part = plain_part(text),
    others = all.filter(other => plain_part(other) === part);
  if (others.length < 2) return part;
  let hash = 0xcbf29ce484222325n; // FNV-1a
  for (const byte of new TextEncoder().encode(text))
    hash = ((hash ^ BigInt(byte)) * 0x100000001b3n) & 0xffffffffffffffffn;
  return part.slice(0, longest_part - 17) + "-" + hash.toString(16).padStart(16, "0");
}
const twin_file = (chart, problem, problems) =>
  `${chart}${problems.length > 1 ? "-" + file_part(problem, problems) : ""}.svg`;

function with_unit(key) {
  // "string.0.barrier.0.stiffness" becomes "barrier 0 stiffness [N/m^exponent]"
  const unit = page.units[key.replace(/\.\d+/g, "")];
  return key.replace(/^string\.0\./, "").replaceAll(".", " ") + (unit ? ` [${unit}]` : "");
}
const unit_of = quantity => ({displacement: "m", velocity: "m/s"})[quantity] ?? "N";
function integers(base64) {
  // little-endian, two bytes each
  const text = atob(base64);
  return Array.from(
    {length: text.length / 2},
    (_, k) => ((text.charCodeAt(2 * k) | (text.charCodeAt(2 * k + 1) << 8)) << 16) >> 16,
  );
}
