// Builds the page from the data: sections in the given order, and the machine at the foot.
const drawings = [];
const report = {}; // from the tables: {sections, scenes, judged: scenes with an answer}

// Parts of a section below the heading.
function parts_of(s) {
  const parts = s.notes.map(note);
  for (const chart of s.charts) {
    const {parts: drawn, draw} = chart_of(chart, s.id);
    parts.push(...drawn);
    drawings.push({id: s.id, draw});
  }
  parts.push(...s.left_out.map(note));
  if (s.table) parts.push(...table_of(s.table, s.heading));
  return parts;
}

// Section opened by a click. Charts are drawn when first seen: a page with twenty charts opens as
// fast as a page with one.
function section_of(s) {
  const section = element(
    "details",
    {id: s.id, className: "part"},
    element("summary", {}, element("h2", {}, s.heading)),
    ...parts_of(s),
  );
  section.addEventListener("toggle", () => {
    if (section.open) draw_in(s.id);
  });
  return section;
}
async function draw_in(id) {
  for (const drawing of drawings.filter(d => d.id === id && !d.drawn)) {
    drawing.drawn = true;
    await drawing.draw();
  }
}
function show(id) {
  const part = document.getElementById(id);
  if (part instanceof HTMLDetailsElement) part.open = true;
  part?.scrollIntoView();
}

const words = {
  "relative L2 error": "root of the summed squared difference from the reference, over that of it",
  horizon: "when the running error first passes 10 %. After it judge by third octaves",
  "noise floor": "the error that a change of the start by 1e-12 makes: smaller ones are ties",
  "not to be trusted":
    "the contact pulls the string (adhesion), stored energy remains in an open contact " +
    "(psi_gap), or the energy balance does not close (energy)",
  columns: "'jvari list columns' explains every column of the tables",
};
function how_to_read() {
  const list = element("dl"),
    {schemes = {}} = page.manifest ?? {},
    sources = Array.isArray(schemes)
      ? schemes.map(s => [s.name, s.source])
      : Object.entries(schemes);
  for (const [word, meaning] of [...Object.entries(words), ...sources])
    list.append(element("dt", {}, word), element("dd", {}, meaning));
  const scenes =
    page.manifest?.scenes ??
    (page.manifest?.scene?.text ? {[page.manifest.scene.name]: page.manifest.scene.text} : {});
  const texts = Object.entries(scenes).map(([name, text]) => {
    const of = "the scene " + name,
      whole = element("pre", {tabIndex: 0, role: "region", ariaLabel: of}, text);
    return element("details", {}, element("summary", {}, of), whole);
  });
  if (page.command)
    texts.push(element("p", {className: "soft"}, "Made by ", element("code", {}, page.command)));
  return element(
    "details",
    {id: "reading", className: "part"},
    element("summary", {}, element("h2", {}, "How to read it")),
    list,
    ...texts,
  );
}

// Entries of a value; nested names are joined by dots.
function entries_of(value, name = "") {
  if (value === null || value === "") return [];
  if (typeof value !== "object")
    return [
      [
        name,
        typeof value === "number" && !Number.isInteger(value)
          ? String(Number(value.toPrecision(6)))
          : String(value),
      ],
    ];
  if (Array.isArray(value) && value.every(x => typeof x !== "object"))
    return value.length ? [[name, value.join(", ")]] : [];
  // The page shows the scene's text above.
  const scene_text = key =>
    (name === "scene" && key === "text") || (name === "" && key === "scenes");
  return Object.entries(value)
    .filter(([key]) => !scene_text(key))
    .flatMap(([key, x]) => entries_of(x, name ? `${name}.${key}` : key));
}

function fill_page() {
  const main = document.querySelector("main"),
    nav = document.querySelector("nav");
  report.sections = sections_of();
  const traces = report.sections.find(s => s.id === "sounds"),
    [first, ...rest] = report.sections.filter(s => s !== traces);
  const answered = first?.id === "work-precision" && first.charts.length > 0;
  report.judged = answered ? first.charts[0].scenes : [];
  report.scenes = distinct([
    ...report.judged,
    ...report.sections.flatMap(s => s.charts).flatMap(c => c.scenes ?? []),
  ]);
  if (report.scenes.length > 1) nav.after(scene_menu(report.scenes));
  document.getElementById("about").textContent = [page.title, page.about]
    .filter(Boolean)
    .join(" \u00b7 ");
  document.querySelector("h1").textContent =
    finding_of_maps() || finding_of_trim() || finding_of_share() || page.title;
  if (page.missing) main.append(element("p", {className: "soft"}, page.missing));
  const beginning = element("div", {className: "first"}),
    heard = sounds().length ? [hear_it(), ...(traces ? [see_it(traces)] : [])] : [];
  if (answered) beginning.append(...answer_of(first, heard));
  else if (first)
    beginning.append(
      ...(page.run ? heard : []),
      element(
        "section",
        {id: first.id, className: "card", ariaLabel: first.heading},
        ...parts_of(first),
      ),
      ...(page.run ? [] : heard),
    );
  main.append(beginning, ...rest.map(section_of), how_to_read());
  for (const [id, heading] of [
    ...rest.map(s => [s.id, s.heading]),
    ["reading", "How to read it"],
    ["provenance", "Measured with"],
  ]) {
    const link = element("a", {href: "#" + id}, heading);
    link.onclick = event => {
      event.preventDefault();
      show(id);
      choose("at", id);
    };
    nav.append(link);
  }
  for (const [name, text] of entries_of(page.manifest))
    document
      .querySelector("footer dl")
      .append(element("dt", {}, name.replaceAll("_", " ")), element("dd", {}, text));
  return first;
}
(async () => {
  const first = fill_page();
  if (first) await draw_in(first.id);
  if (document.getElementById("sounds")) await draw_in("sounds");
  const at = view.get("at") ?? location.hash.slice(1);
  if (at) show(at);
  document.documentElement.dataset.ready = "true";
})();
