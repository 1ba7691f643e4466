// The page from its data: sections in the order in which they came, what it was measured with at the foot.
const page = JSON.parse(document.getElementById("data").textContent);
const drawings = [];

function pictures_of(pictures) {
  return pictures.map(p => element("figure", {}, element("img", {src: p.data, alt: p.name, loading: "lazy"}), element("figcaption", {}, p.name)));
}

function sounds_of(sounds) {
  if (!sounds.length) return [];
  const list = element("ul", {className: "sounds"});
  for (const s of sounds) {
    const audio = element("audio", {controls: true, preload: "none", src: s.data});
    audio.setAttribute("aria-label", `${s.scheme}, ${s.detail}`);
    audio.onplay = () => document.querySelectorAll("audio").forEach(other => { if (other !== audio) other.pause(); });
    list.append(element("li", {}, element("strong", {}, s.scheme), element("span", {className: "soft"}, " " + s.detail), audio));
  }
  return [list];
}

function section_of(s) {
  const section = element("section", {id: s.id}, element("h2", {}, s.heading));
  section.append(...s.notes.map(text => element("p", {className: "soft"}, text)));
  for (const chart of s.charts) {
    const {parts, draw} = chart_of(chart, s.id);
    section.append(...parts);
    drawings.push(draw);
  }
  section.append(...pictures_of(s.pictures), ...sounds_of(s.sounds), ...s.left_out.map(text => element("p", {className: "soft"}, text)));
  if (s.table) section.append(...table_of(s.table, s.heading));
  return section;
}

const words = [
  ["relative L2 error", "root of the summed squared difference from the truth over that of the truth: 1 % is close, 100 % is unrelated"],
  ["horizon", "first instant at which the running error passes 10 %; later the waveform means little, and third octaves are what can be judged"],
  ["third octaves", "root mean square over the bands of the difference in level"],
  ["noise floor", "what a change of 1e-12 at the start makes by itself: smaller errors are ties"],
  ["certain to", "how far the truth itself is known, its certificate; \u2264 counts it in where it matters"],
  ["not to be trusted", "the run's own figures speak against it: the contact pulls (adhesion), its stored energy is open (psi_gap), its ledger does not close (energy)"],
  ["control", "a scheme known to be wrong somewhere, run to show that the comparison finds it"],
  ["cost", "computing time of one core per second of sound, the median of several runs; quartiles beside it"],
  ["front", "runs that no other surely beats in both cost and error"]
];
function how_to_read() {
  const list = element("dl");
  for (const [word, meaning] of words) list.append(element("dt", {}, word), element("dd", {}, meaning));
  const sources = Array.isArray(page.manifest?.schemes) ? page.manifest.schemes.map(s => [s.name, s.source]) : Object.entries(page.manifest?.schemes ?? {});
  for (const [name, source] of sources) list.append(element("dt", {}, name), element("dd", {}, source));
  list.append(element("dt", {}, "columns"), element("dd", {}, "bench/README.md of the sources explains every column of the tables"));
  const scenes = page.manifest?.scenes ?? (page.manifest?.scene?.text ? {[page.manifest.scene.name]: page.manifest.scene.text} : {});
  const texts = Object.entries(scenes).map(([name, text]) => {
    const whole = element("pre", {tabIndex: 0}, text);
    whole.setAttribute("role", "region");
    whole.setAttribute("aria-label", "the scene " + name);
    return element("details", {className: "scene"}, element("summary", {}, `the scene ${name}`), whole);
  });
  return element("section", {id: "reading"}, element("h2", {}, "How to read it"), list, ...texts);
}

// Nested names are written with dots.
function entries_of(value, name = "") {
  if (value === null || value === "") return [];
  if (typeof value !== "object") return [[name, typeof value === "number" && !Number.isInteger(value) ? String(Number(value.toPrecision(6))) : String(value)]];
  if (Array.isArray(value) && value.every(x => typeof x !== "object")) return value.length ? [[name, value.join(", ")]] : [];
  const scene_text = key => (name === "scene" && key === "text") || (name === "" && key === "scenes");  // it stands above
  return Object.entries(value).filter(([key]) => !scene_text(key)).flatMap(([key, x]) => entries_of(x, name ? `${name}.${key}` : key));
}

document.querySelector("h1").textContent = page.title;
document.getElementById("about").textContent = page.about;
const main = document.querySelector("main"), nav = document.querySelector("nav");
const scenes = [...new Set([...page.verdicts.map(v => v.scene), ...page.sections.flatMap(s => s.charts).flatMap(c => c.menus)
  .filter(menu => menu.signal === "problem_field").flatMap(menu => menu.choices.map(([name]) => name))])];
if (scenes.length > 1) nav.before(element("div", {className: "scenes"}, scene_menu(scenes)));
if (page.missing) main.append(element("p", {className: "soft"}, page.missing));
if (page.verdicts.length) main.append(verdict_of(page.verdicts, page.command));
main.append(...page.sections.map(section_of), how_to_read());
for (const [id, heading] of [...page.sections.map(s => [s.id, s.heading]), ["reading", "How to read it"], ["provenance", "Measured with"]]) {
  const link = element("a", {href: "#" + id}, heading);
  link.onclick = event => {
    event.preventDefault();
    document.getElementById(id).scrollIntoView();
    choose("at", id);
  };
  nav.append(link);
}
for (const [name, text] of entries_of(page.manifest)) document.querySelector("footer dl").append(element("dt", {}, name.replaceAll("_", " ")), element("dd", {}, text));
(async () => {
  if (page.sections.some(s => s.charts.length)) for (const draw of drawings) await draw();
  document.getElementById(view.get("at") ?? location.hash.slice(1))?.scrollIntoView();
  document.documentElement.dataset.ready = "true";
})();
