// A chart of the page: its menus set the signals of a Vega-Lite view, its colours follow the page's, its scene is the page's.
const dark = matchMedia("(prefers-color-scheme: dark)"), narrow = matchMedia("(max-width: 720px)");

function config(first) {
  const ink = dark.matches ? "#e6eaee" : "#1d2329", grid = dark.matches ? "#3a424a" : "#dfe3e7";
  const colours = {labelColor: ink, titleColor: ink};
  return {
    background: "transparent",
    axis: {...colours, gridColor: grid, domainColor: ink, tickColor: ink},
    legend: {...colours, symbolSize: 90, symbolOpacity: 1, symbolStrokeWidth: 0,
             ...(narrow.matches ? {orient: "bottom", columns: 1, offset: 38, labelFontSize: 10, labelLimit: 235} : first ? {orient: "bottom", columns: 2, offset: 38, labelFontSize: 11, labelLimit: 340} : {orient: "right", offset: 14, labelFontSize: 11, labelLimit: 600})},
    title: {color: ink, subtitleColor: ink}, header: colours,
    text: {color: ink}, rule: {color: ink}
  };
}

// A scheme keeps its hue on a dark page, and the front and a difference their tone, in the shade that can be seen there.
function coloured(spec) {
  if (!dark.matches) return spec;
  return JSON.parse(JSON.stringify(spec), (_, value) => typeof value === "string" && Object.hasOwn(page.dark, value) ? page.dark[value] : value);
}

// Of many schemes those that a reader looks for first: each that is on the front, then of each hue the one that comes nearest to it.
function main_series(rows, scale, error, cost) {
  const hue = name => scale.range[scale.domain.indexOf(name)];
  const sound = rows.filter(row => row.status === "ok" && row.flags === "" && row[error] > 0 && row[cost] > 0 && !row.control);
  const behind = new Map();  // times the cost of the cheapest that is as accurate
  for (const row of sound) {
    const least = Math.min(...sound.filter(other => other[error] <= row[error]).map(other => other[cost]));
    behind.set(row.series, Math.min(behind.get(row.series) ?? Infinity, row[cost] / least));
  }
  const chosen = [], hues = new Set();
  for (const [name, times] of [...behind].sort(([, a], [, b]) => a - b))
    if ((times === 1 || !hues.has(hue(name))) && chosen.length < 8) {
      chosen.push(name);
      hues.add(hue(name));
    }
  return scale.domain.filter(name => chosen.includes(name));
}

// A name beside the most accurate point of each line, where it covers neither a point nor another name.
function line_labels(rows, names, vega_view, error, cost) {
  const x = vega_view.scale("x"), y = vega_view.scale("y"), width = vega_view.width(), height = vega_view.height();
  const points = rows.filter(row => names.includes(row.series) && row.status === "ok" && row[error] > 0 && row[cost] > 0)
    .map(row => ({series: row.series, x: x(row[cost] * (cost === "rate" ? 1e-3 : 1)), y: y(row[error])}));
  const boxes = points.map(p => ({left: p.x - 5, right: p.x + 5, top: p.y - 5, bottom: p.y + 5})), labels = [];
  const free = box => box.left >= 0 && box.right <= width && box.top >= 0 && box.bottom <= height &&
    !boxes.some(b => b.left < box.right && b.right > box.left && b.top < box.bottom && b.bottom > box.top);
  for (const name of names) {
    const ends = points.filter(p => p.series === name).sort((a, b) => b.y - a.y), text = spoken(name), wide = 6.4 * text.length;
    const places = ends.flatMap(p => [[p.x + 9, p.y], [p.x - 9 - wide, p.y], [p.x - wide / 2, p.y + 15], [p.x - wide / 2, p.y - 15], [p.x + 6, p.y + 14], [p.x + 6, p.y - 14]]);
    const place = places.map(([left, middle]) => ({left, right: left + wide, top: middle - 7, bottom: middle + 7})).find(free);
    if (!place) continue;
    boxes.push(place);
    labels.push({x: place.left, y: (place.top + place.bottom) / 2, text});
  }
  return labels;
}

function chart_of(chart, section, first) {
  const frame = element("div", {className: chart.scrolls ? "chart wide" : "chart", id: "chart-" + drawings.length});
  const menus = element("div", {className: "menus"}), said = element("p", {className: "soft"});
  menus.dataset.chart = frame.id;
  const of_scene = chart.menus.find(menu => menu.signal === "problem_field"), shown = chart.menus.filter(menu => menu !== of_scene);
  const selects = new Map(), scenes = of_scene ? of_scene.choices.map(([name]) => name) : [];
  const key = menu => `${section}.${menu.signal}`;
  let vega_view = null, scene = scenes[0];
  const value_of = menu => menu.choices[selects.get(menu).selectedIndex][0];
  const every = element("input", {type: "checkbox", className: "every"}), of_lines = first && chart.spec.datasets?.labels;
  const lines = () => {  // of the scene, the error and the cost that are chosen
    const rows = chart.spec.datasets.cells.filter(row => row.problem === scene), chosen = signal => value_of(shown.find(menu => menu.signal === signal));
    const error = [chosen("measure_field"), chosen("tap_field")].filter(Boolean).join("_"), cost = chosen("cost_field");
    const drawn = chart.colours.domain.filter(name => rows.some(row => row.series === name)), few = drawn.length <= 8;
    return {rows, error, cost, few, names: few || every.checked ? drawn : main_series(rows, chart.colours, error, cost)};
  };
  const apply = async () => {
    if (!vega_view) return;
    if (of_scene) vega_view.signal("problem_field", scene);
    for (const menu of shown) vega_view.signal(menu.signal, value_of(menu));
    if (of_lines) {
      const {names, few, error, cost, rows} = lines();
      every.parentElement.hidden = few;
      vega_view.signal("main_series", names).data("labels", []);
      await vega_view.runAsync();
      if (!narrow.matches && names.length <= 8) vega_view.data("labels", line_labels(rows, names, vega_view, error, cost));
    }
    await vega_view.runAsync();
    // what has no name is no picture to a reader's ear; the chart as a whole has one, and the tables its numbers
    for (const part of frame.querySelectorAll("svg [role]:not([aria-label])")) {
      part.removeAttribute("role");
      part.removeAttribute("aria-roledescription");
    }
    frame.querySelector("summary")?.setAttribute("aria-label", "save the picture of " + chart.name);
  };
  for (const menu of shown) {
    const select = element("select", {}, ...menu.choices.map(([, text]) => new Option(text)));
    select.selectedIndex = Math.max(0, menu.choices.findIndex(([value]) => String(value) === view.get(key(menu))));
    select.onchange = () => {
      choose(key(menu), select.selectedIndex === 0 ? null : String(value_of(menu)));
      return apply();
    };
    selects.set(menu, select);
    if (menu.choices.length > 1) menus.append(element("label", {}, menu.label + " ", select));
  }
  // The scene's own default error where it lacks the one that is chosen; of choices that are of a scene, those of this one.
  const follow = async name => {
    if (scenes.length) {
      const there = scenes.includes(name);
      scene = there ? name : scenes[0];
      said.textContent = there || !name ? "" : `No runs of ${name} here: this is ${scene}.`;
    }
    const measure = shown.find(menu => menu.signal === "measure_field"), tap = shown.find(menu => menu.signal === "tap_field");
    if (measure && tap && chart.offers[scene]) {
      const column = () => value_of(measure) + (value_of(tap) === "" ? "" : "_" + value_of(tap));
      if (!chart.offers[scene].includes(column()) || !(view.has(key(measure)) || view.has(key(tap)))) {
        selects.get(tap).selectedIndex = Math.max(0, tap.choices.findIndex(([value]) => value === ""));
        selects.get(measure).selectedIndex = Math.max(0, measure.choices.findIndex(([value]) => value === chart.offers[scene][0]));
      }
      const offered = new Set(chart.offers[scene]);
      measure.choices.forEach(([value], k) => { selects.get(measure).options[k].disabled = !tap.choices.some(([t]) => offered.has(value + (t === "" ? "" : "_" + t))); });
    }
    for (const menu of shown) {
      if (!menu.scenes.length || !menu.scenes.includes(name)) continue;
      const select = selects.get(menu);
      menu.scenes.forEach((of, k) => { select.options[k].hidden = select.options[k].disabled = of !== name; });
      if (menu.scenes[select.selectedIndex] !== name) select.selectedIndex = menu.scenes.indexOf(name);
    }
    await apply();
  };
  on_scene.push(follow);
  const colour_scale = part => part?.encoding?.color?.scale ?? part?.layer?.map(colour_scale).find(Boolean);
  chart.colours = colour_scale(chart.spec);
  async function draw() {
    frame.setAttribute("data-drawn", "false");
    if (vega_view) vega_view.finalize();
    let spec = chart.spec;
    if (of_lines) {  // its legend takes no more room than it needs
      const begun = {main_series: lines().names, problem_field: scene};
      spec = {...spec, height: narrow.matches ? 260 : 400, params: spec.params.map(p => p.name in begun ? {...p, value: begun[p.name]} : p)};
    }
    ({view: vega_view} = await vegaEmbed(frame, coloured(spec), {
      config: config(first), renderer: chart.scrolls ? "canvas" : "svg", logLevel: vega.Error, tooltip: {theme: dark.matches ? "dark" : "light"},
      actions: {export: true, source: false, compiled: false, editor: false}
    }));
    await follow(document.getElementById("scene")?.value ?? scene);
    frame.setAttribute("data-drawn", "true");
  }
  let next = 0;
  const draw_again = () => {  // once where both change
    frame.setAttribute("data-drawn", "false");
    cancelAnimationFrame(next);
    next = requestAnimationFrame(draw);
  };
  for (const media of [dark, narrow]) media.addEventListener("change", () => { if (vega_view) draw_again(); });
  if (chart.scrolls) frame.tabIndex = 0;
  frame.dataset.drawn = "later";
  frame.setAttribute("role", "group");
  frame.setAttribute("aria-label", "chart: " + chart.name);
  if (first && menus.childElementCount) {
    menus.append(element("label", {}, every, " every scheme"));
    every.onchange = apply;
    return {parts: [frame, said, folded("Another error or cost, every scheme", [menus])], draw};
  }
  return {parts: [...(menus.childElementCount ? [menus] : []), frame, said], draw};
}
