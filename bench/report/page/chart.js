// A chart of the page: its menus set the signals of a Vega-Lite view, its colours follow the page's, its scene is the page's.
const dark = matchMedia("(prefers-color-scheme: dark)"), narrow = matchMedia("(max-width: 720px)");

function config() {
  const ink = dark.matches ? "#e6eaee" : "#1d2329", grid = dark.matches ? "#3a424a" : "#dfe3e7";
  const colours = {labelColor: ink, titleColor: ink};
  return {
    background: "transparent",
    axis: {...colours, gridColor: grid, domainColor: ink, tickColor: ink},
    legend: {...colours, symbolSize: 90, symbolOpacity: 1, symbolStrokeWidth: 0,
             ...(narrow.matches ? {orient: "bottom", columns: 1, offset: 38, labelFontSize: 10, labelLimit: 235} : {orient: "right", offset: 14, labelFontSize: 11, labelLimit: 600})},
    title: {color: ink, subtitleColor: ink}, header: colours,
    text: {color: ink}, rule: {color: ink}
  };
}

// A scheme keeps its hue on a dark page, and the front and a difference their tone, in the shade that can be seen there.
function coloured(spec) {
  if (!dark.matches) return spec;
  return JSON.parse(JSON.stringify(spec), (_, value) => typeof value === "string" && Object.hasOwn(page.dark, value) ? page.dark[value] : value);
}

function chart_of(chart, section) {
  const frame = element("div", {className: chart.scrolls ? "chart wide" : "chart"});
  const menus = element("div", {className: "menus"}), said = element("p", {className: "soft"});
  const of_scene = chart.menus.find(menu => menu.signal === "problem_field"), shown = chart.menus.filter(menu => menu !== of_scene);
  const selects = new Map(), scenes = of_scene ? of_scene.choices.map(([name]) => name) : [];
  const key = menu => `${section}.${menu.signal}`;
  let vega_view = null, scene = scenes[0];
  const value_of = menu => menu.choices[selects.get(menu).selectedIndex][0];
  const apply = async () => {
    if (!vega_view) return;
    if (of_scene) vega_view.signal("problem_field", scene);
    for (const menu of shown) vega_view.signal(menu.signal, value_of(menu));
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
  async function draw() {
    frame.setAttribute("data-drawn", "false");
    if (vega_view) vega_view.finalize();
    ({view: vega_view} = await vegaEmbed(frame, coloured(chart.spec), {
      config: config(), renderer: chart.scrolls ? "canvas" : "svg", logLevel: vega.Error, tooltip: {theme: dark.matches ? "dark" : "light"},
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
  dark.addEventListener("change", draw_again);
  narrow.addEventListener("change", draw_again);
  if (chart.scrolls) frame.tabIndex = 0;
  frame.setAttribute("role", "group");
  frame.setAttribute("aria-label", "chart: " + chart.name);
  return {parts: [...(menus.childElementCount ? [menus] : []), frame, said], draw};
}
