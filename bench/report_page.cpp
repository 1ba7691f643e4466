// Kept as text here, so that the program has no file to look for when it runs.
#include "bench/report_page.hpp"

#include <utility>

#include "bench/vega.hpp"

namespace jvari {

namespace {
constexpr const char* html = R"html(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>@TITLE@</title>
<style>
:root { color-scheme: light dark; --ink: #1d2329; --soft: #5c6670; --line: #d9dee3; --paper: #fff; --raised: #f5f7f9; --mark: #fff4d6; --bad: #b3261e; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6eaee; --soft: #9aa5b0; --line: #353c44; --paper: #14181c; --raised: #1d2329; --mark: #3a3218; --bad: #ff8a80; }
}
* { box-sizing: border-box; }
body { margin: 0; font: 15px/1.5 system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; color: var(--ink); background: var(--paper); }
main { max-width: 1240px; margin: 0 auto; padding: 28px 24px 60px; }
h1 { font-size: 24px; margin: 0 0 2px; }
h2 { font-size: 17px; margin: 34px 0 8px; }
p { margin: 4px 0; }
.soft { color: var(--soft); }
.menus { display: flex; flex-wrap: wrap; gap: 10px 22px; margin: 22px 0 6px; align-items: center; }
.menus label { display: inline-flex; gap: 8px; align-items: center; color: var(--soft); }
select, button { font: inherit; color: var(--ink); background: var(--raised); border: 1px solid var(--line); border-radius: 6px; padding: 4px 8px; max-width: 100%; }
#chart { width: 100%; min-height: 40px; }
.scroll { overflow: auto; max-height: 70vh; border: 1px solid var(--line); border-radius: 8px; }
table { border-collapse: separate; border-spacing: 0; width: 100%; font-size: 13px; font-variant-numeric: tabular-nums; }
th, td { padding: 5px 10px; text-align: right; white-space: nowrap; border-bottom: 1px solid var(--line); }
th { position: sticky; top: 0; background: var(--raised); cursor: pointer; font-weight: 600; z-index: 1; }
th:focus-visible { outline: 2px solid #56b4e9; outline-offset: -2px; }
td.text, th.text { text-align: left; }
td.reason { white-space: normal; min-width: 260px; }
tr.front td { background: var(--mark); }
tr.bad td { color: var(--bad); }
tbody tr:last-child td { border-bottom: 0; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 2px 18px; font-size: 13px; }
dt { color: var(--soft); } dd { margin: 0; overflow-wrap: anywhere; }
#vg-tooltip-element { max-width: 420px; }
</style>
</head>
<body>
<main>
<h1 id="name"></h1>
<p class="soft" id="about"></p>
<div id="drawing">
<div class="menus">
<label>error <select id="error"></select></label>
<label>cost <select id="cost"></select></label>
<span class="soft">Hover a point for its figures; click a name in the legend to bring that scheme out. The grey track is the Pareto front.</span>
</div>
<div id="chart"></div>
</div>
<p id="missing" class="soft"></p>
<h2>Cells</h2>
<p class="soft">Click a heading to sort. Marked rows are on the Pareto front. <label><input type="checkbox" id="all"> every column</label></p>
<div class="scroll"><table><thead></thead><tbody></tbody></table></div>
<h2>Noise floor</h2>
<p class="soft">What a relative change of 1e-12 of the initial state makes of the reference: an error no larger than this is a tie.</p>
<dl id="floor"></dl>
<details><summary class="soft">of every tap</summary><dl id="floors"></dl></details>
<h2>Measured with</h2>
<dl id="machine"></dl>
</main>
@SCRIPTS@
<script>
"use strict";
const spec = @SPEC@, table = @TABLE@, manifest = @MANIFEST@, choices = @CHOICES@, missing = @MISSING@;
const $ = id => document.getElementById(id);

$("name").textContent = manifest.scene.name;
$("about").textContent = `${manifest.scene.source} \u2014 ${manifest.scene.duration} s against ${manifest.reference.name}, ${manifest.date}`;
$("missing").textContent = missing;

// ---- chart
if (!spec) $("drawing").hidden = true;
else {
  for (const [id, list] of [["error", choices.errors], ["cost", choices.costs]])
    for (const [column, title] of list) $(id).add(new Option(title, column));
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const draw = async () => {
    const ink = dark.matches ? "#e6eaee" : "#1d2329", grid = dark.matches ? "#3a424a" : "#dfe3e7";
    const config = {background: "transparent", axis: {labelColor: ink, gridColor: grid, domainColor: ink, tickColor: ink},
                    legend: {labelColor: ink}, title: {color: ink, subtitleColor: ink}, text: {color: ink}};
    const {view} = await vegaEmbed("#chart", spec, {config, renderer: "svg", logLevel: 1, actions: {export: true, source: false, compiled: false, editor: false},
                                                     tooltip: {theme: dark.matches ? "dark" : "light"}});
    const choose = () => view.signal("error_field", $("error").value).signal("cost_field", $("cost").value).runAsync();
    $("error").onchange = $("cost").onchange = choose;
    choose();
  };
  dark.addEventListener("change", draw);
  draw();
}

// ---- table
const texts = new Set(["scheme", "status", "reason", "below_floor"]);
const first = ["scheme", "rate", "modes", "status", "error_l2_10ms", "error_l2_50ms", "error_l2_whole", "horizon_s", "third_octave_db", "stft_db", "cost_s_per_s",
               "times_real_time", "ns_per_step", "energy_residual_accumulated", "smallest_contact_force", "deepest_penetration", "reason"];
const at = Object.fromEntries(table.columns.map((name, k) => [name, k]));
let sorted = null, downward = false;
const shown = () => $("all").checked ? table.columns : first.filter(name => name in at);
const value = (row, name) => { const t = row[at[name]]; return texts.has(name) ? t : !t ? NaN : Number(t.replace("inf", "Infinity")); };
const certificate = (row, name) => name.startsWith("error_l2_") ? value(row, name.replace("error", "certificate")) : NaN;
function written(row, name) {
  const t = row[at[name]];
  if (texts.has(name) || t === "") return t;
  const x = value(row, name), known = certificate(row, name);
  if (x < known) return "\u2264" + known.toExponential(2);
  if (!Number.isFinite(x)) return "\u221e";
  if (Number.isInteger(x) && Math.abs(x) < 1e9) return String(x);
  return Math.abs(x) < 1e-3 || Math.abs(x) >= 1e6 ? x.toExponential(2) : String(Number(x.toPrecision(4)));
}
function fill() {
  const names = shown(), head = document.querySelector("thead"), body = document.querySelector("tbody");
  head.replaceChildren(); body.replaceChildren();
  const headings = head.insertRow();
  for (const name of names) {
    const th = document.createElement("th");
    th.textContent = name.replaceAll("_", " ") + (name === sorted ? (downward ? " \u2193" : " \u2191") : "");
    th.className = texts.has(name) ? "text" : "";
    th.tabIndex = 0;
    th.setAttribute("aria-sort", name === sorted ? (downward ? "descending" : "ascending") : "none");
    th.onclick = () => { downward = name === sorted && !downward; sorted = name; fill(); };
    th.onkeydown = e => { if (e.key === "Enter" || e.key === " ") { e.preventDefault(); th.onclick(); } };
    headings.append(th);
  }
  const rows = [...table.rows];
  if (sorted) rows.sort((a, b) => {
    const x = value(a, sorted), y = value(b, sorted), sign = downward ? -1 : 1;
    if (texts.has(sorted)) return sign * x.localeCompare(y);
    return Number.isNaN(x) ? (Number.isNaN(y) ? 0 : 1) : Number.isNaN(y) ? -1 : x === y ? 0 : sign * (x < y ? -1 : 1);  // nothing goes last
  });
  for (const row of rows) {
    const tr = body.insertRow();
    tr.className = row[at.pareto] === "1" ? "front" : row[at.status] === "ok" ? "" : "bad";
    for (const name of names) {
      const td = tr.insertCell();
      td.textContent = written(row, name);
      td.className = (texts.has(name) ? "text " : "") + name;
      if (!texts.has(name)) td.title = row[at[name]] + (certificate(row, name) ? `; reference certain to ${certificate(row, name)}` : "");
    }
  }
}
$("all").onchange = fill;
fill();

// ---- what it was measured with
function list(id, entries) {
  for (const [name, x] of entries) {
    if (x === null || x === "" || typeof x === "object") continue;
    const dt = document.createElement("dt"), dd = document.createElement("dd");
    dt.textContent = name; dd.textContent = typeof x === "number" && !Number.isInteger(x) ? x.toPrecision(3) : x;
    $(id).append(dt, dd);
  }
}
const of_taps = ([name]) => scene.taps.some(tap => name.endsWith("_" + tap.name));

const {scene, reference, ...rest} = manifest;
list("floor", Object.entries(manifest.noise_floor).filter(e => !of_taps(e) && !e[0].startsWith("horizon")));
list("floors", Object.entries(manifest.noise_floor).filter(e => of_taps(e) && !e[0].startsWith("horizon")));
list("machine", [...Object.entries(rest), ["scene hash", scene.hash], ["set", scene.set.join(" ")], ["reference", `${reference.name} (${reference.source})`],
                 ["reference rate", reference.rate], ["reference note", reference.note],
                 ["reference certain by", reference.certificate?.against ?? reference.certificate?.missing ?? ""],
                 ...Object.entries(reference.certificate?.figures ?? {}).map(([k, x]) => [k.replaceAll("_", " "), x]), ["reference valid until [s]", reference.valid_until_s],
                 ...Object.entries(reference.facts).map(([k, x]) => ["reference: " + k.replaceAll("_", " "), x]),
                 ...manifest.schemes.map(s => [s.name, s.source + Object.entries(s.options).map(([k, x]) => `; ${k}=${x}`).join("")])]);
</script>
</body>
</html>
)html";

std::string escaped(const std::string& text) {
    std::string safe;
    for (char c : text) {
        if (c == '<') safe += "&lt;";
        else if (c == '&') safe += "&amp;";
        else safe += c;
    }
    return safe;
}

std::string string_literal(const std::string& text) {  // JSON
    std::string literal = "\"";
    for (char c : text) {
        if (c == '"' || c == '\\') literal += '\\';
        literal += c == '\n' ? ' ' : c;
    }
    return literal + "\"";
}
}  // namespace

std::string page_of(const Page& page) {
    const std::pair<const char*, std::string> parts[] = {{"@TITLE@", escaped(page.title)},
                                                         {"@SCRIPTS@", page.scripts},
                                                         {"@SPEC@", page.spec.empty() ? "null" : inside_script(page.spec)},
                                                         {"@TABLE@", inside_script(page.table)},
                                                         {"@MANIFEST@", inside_script(page.manifest)},
                                                         {"@CHOICES@", inside_script(page.choices)},
                                                         {"@MISSING@", inside_script(string_literal(page.missing))}};
    std::string text;
    std::string rest = html;
    for (const auto& [mark, part] : parts) {  // in the order in which they stand, so that what is put in is not looked through
        const auto at = rest.find(mark);
        text += rest.substr(0, at) + part;
        rest.erase(0, at + std::string(mark).size());
    }
    return text + rest;
}

}  // namespace jvari
