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
    const {parts, draw} = chart_of(chart);
    section.append(...parts);
    drawings.push(draw);
  }
  section.append(...pictures_of(s.pictures), ...sounds_of(s.sounds), ...s.left_out.map(text => element("p", {className: "soft"}, text)));
  if (s.table) section.append(...table_of(s.table, s.heading));
  return section;
}

// Nested names are written with dots.
function entries_of(value, name = "") {
  if (value === null || value === "") return [];
  if (typeof value !== "object") return [[name, typeof value === "number" && !Number.isInteger(value) ? String(Number(value.toPrecision(6))) : String(value)]];
  if (Array.isArray(value) && value.every(x => typeof x !== "object")) return value.length ? [[name, value.join(", ")]] : [];
  return Object.entries(value).flatMap(([key, x]) => entries_of(x, name ? `${name}.${key}` : key));
}

document.querySelector("h1").textContent = page.title;
document.getElementById("about").textContent = page.about;
const main = document.querySelector("main");
if (page.missing) main.append(element("p", {className: "soft"}, page.missing));
main.append(...page.sections.map(section_of));
document.querySelector("nav").append(...page.sections.map(s => element("a", {href: "#" + s.id}, s.heading)), element("a", {href: "#provenance"}, "Measured with"));
for (const [name, text] of entries_of(page.manifest)) document.querySelector("footer dl").append(element("dt", {}, name.replaceAll("_", " ")), element("dd", {}, text));
(async () => {
  if (page.sections.some(s => s.charts.length)) for (const draw of drawings) await draw();
  document.documentElement.dataset.ready = "true";
})();
