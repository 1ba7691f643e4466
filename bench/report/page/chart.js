// A chart on the page. Menus choose the arguments for the specification; colours and scene follow
// the page. The legend shows line and marker for each drawn series, and a click brings a series
// out. The ranking beside the first chart has the names as well.
const dark = matchMedia("(prefers-color-scheme: dark)"),
  narrow = matchMedia("(max-width: 720px)");

function page_config() {
  const ink = dark.matches ? "#e6eaee" : "#1d2329",
    grid = dark.matches ? "#3a424a" : "#dfe3e7";
  const colours = {labelColor: ink, titleColor: ink},
    symbols = {symbolSize: 90, symbolOpacity: 1, symbolStrokeWidth: 0};
  return {
    background: "transparent",
    axis: {...colours, gridColor: grid, domainColor: ink, tickColor: ink},
    title: {color: ink, subtitleColor: ink},
    header: colours,
    text: {color: ink},
    rule: {color: ink},
    legend: {
      ...colours,
      ...symbols,
      ...(narrow.matches
        ? {orient: "bottom", columns: 1, labelFontSize: 10, labelLimit: 235}
        : {orient: "right", offset: 14, labelFontSize: 11, labelLimit: 600}),
    },
  };
}
// Shade for a dark page: schemes keep their hue, the front and differences their tone, and both
// stay visible.
const shade = colour => (dark.matches && dark_of[colour]) || colour;
function coloured(part) {
  if (!dark.matches) return part;
  return JSON.parse(JSON.stringify(part), (key, value) =>
    typeof value === "string" && Object.hasOwn(dark_of, value) ? dark_of[value] : value,
  );
}

const svg_element = (name, attributes) => {
  const e = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, value);
  return e;
};
// Sample for the legend: line, dash and marker, equal to the chart's.
function sample_of(look) {
  const sample = svg_element("svg", {
      width: 40,
      height: 14,
      viewBox: "0 0 40 14",
      "aria-hidden": "true",
    }),
    symbol = vega.path(),
    colour = shade(look.colour);
  vega.pathSymbols(look.shape).draw(symbol, 60);
  sample.append(
    svg_element("line", {
      x1: 0,
      x2: 40,
      y1: 7,
      y2: 7,
      stroke: colour,
      "stroke-width": look.control ? 1 : 2,
      "stroke-dasharray": look.dash[1] ? look.dash.join(" ") : "none",
    }),
    svg_element("path", {d: String(symbol), transform: "translate(20, 7)", fill: colour}),
  );
  return sample;
}

function chart_of(chart, section) {
  const frame = element("div", {
    className: chart.scrolls || chart.wide_on_phones ? "chart wide" : "chart",
    id: "chart-" + drawings.length,
  });
  const menus = element("div", {className: "menus"}),
    notice = element("p", {className: "soft"}),
    legend = element("div", {className: "legend"});
  menus.dataset.chart = frame.id;
  legend.setAttribute("role", "group");
  legend.setAttribute("aria-label", "lines of the chart: a click brings one out");
  const key = menu => `${section}.${menu.key}`,
    every = element("input", {type: "checkbox", className: "every"});
  let vega_view = null,
    scene = scene_shown(),
    selects = new Map(),
    picked = [],
    drawing = Promise.resolve();
  const choice = () => ({
    scene,
    narrow: narrow.matches,
    every: every.checked,
    ...chart.chosen?.(),
    ...Object.fromEntries(
      [...selects].map(([menu, select]) => [menu.key, menu.choices[select.selectedIndex][0]]),
    ),
  });

  // Fills the menus for the scene; a choice is kept if the scene has it.
  function fill_menus() {
    selects = new Map(
      chart
        .menus(scene)
        .filter(menu => menu.choices.length)
        .map(menu => {
          const select = element("select", {}, ...menu.choices.map(([, text]) => new Option(text))),
            wanted = view.get(key(menu));
          select.selectedIndex = Math.max(
            0,
            menu.choices.findIndex(([value]) => String(value) === String(wanted)),
          );
          select.onchange = () => {
            choose(
              key(menu),
              select.selectedIndex === 0 ? null : String(menu.choices[select.selectedIndex][0]),
            );
            return draw();
          };
          return [menu, select];
        }),
    );
    menus.replaceChildren(
      ...[...selects]
        .filter(([menu]) => menu.choices.length > 1)
        .map(([menu, select]) => element("label", {}, menu.label + " ", select)),
    );
  }
  function fill_legend(names) {
    const looks = looks_of(names);
    legend.replaceChildren(
      ...(names.length > 1 ? names : []).map(name => {
        const button = element(
          "button",
          {type: "button"},
          sample_of(looks.get(name)),
          element("span", {}, spoken(name)),
        );
        button.dataset.series = name;
        button.setAttribute("aria-pressed", String(picked.includes(name)));
        button.onclick = () => {
          picked = picked.includes(name)
            ? picked.filter(other => other !== name)
            : [...picked, name];
          for (const b of legend.children)
            b.setAttribute("aria-pressed", String(picked.includes(b.dataset.series)));
          return vega_view.signal("picked", picked).runAsync();
        };
        return button;
      }),
    );
  }
  // Draws in turn: a scene may be chosen while another is being drawn.
  const draw = () => (drawing = drawing.then(draw_now));
  async function draw_now() {
    frame.setAttribute("data-drawn", "false");
    if (vega_view) vega_view.finalize();
    const {spec, legend = [], names = legend, labels, few} = chart.spec(choice(), false);
    picked = picked.filter(name => names.includes(name));
    every.parentElement?.toggleAttribute("hidden", few === true);
    ({view: vega_view} = await vegaEmbed(frame, coloured(spec), {
      config: page_config(),
      renderer: chart.scrolls ? "canvas" : "svg",
      logLevel: vega.Error,
      tooltip: {theme: dark.matches ? "dark" : "light"},
      actions: {export: true, source: false, compiled: false, editor: false},
    }));
    fill_legend(legend);
    vega_view.signal("picked", picked);
    const label = () => labels && vega_view.data("labels", labels(vega_view));
    label();
    await vega_view.runAsync();
    // Removes the role "picture" from parts without a name: a screen reader would announce them
    // for nothing. The whole chart has a name, and the tables have the numbers.
    for (const part of frame.querySelectorAll("svg [role]:not([aria-label])")) {
      part.removeAttribute("role");
      part.removeAttribute("aria-roledescription");
    }
    frame.querySelector("summary")?.setAttribute("aria-label", "save the picture of " + chart.name);
    chart.seen?.({view: vega_view, frame, names, label});
    frame.dataset.scene = scene;
    frame.setAttribute("data-drawn", "true");
  }
  on_scene.push(async name => {
    const there = !chart.scenes || chart.scenes.includes(name);
    scene = there ? name : chart.scenes[0];
    notice.textContent = there || !name ? "" : `No runs of ${name} here: this is ${scene}.`;
    fill_menus();
    if (vega_view) await draw();
  });
  if (chart.scenes && !chart.scenes.includes(scene)) scene = chart.scenes[0];
  fill_menus();
  let next = 0;
  const draw_again = () => {
    // Draws once if width and colours change together.
    frame.setAttribute("data-drawn", "false");
    cancelAnimationFrame(next);
    next = requestAnimationFrame(draw);
  };
  for (const media of [dark, narrow])
    media.addEventListener("change", () => {
      if (vega_view) draw_again();
    });
  if (chart.scrolls || chart.wide_on_phones) frame.tabIndex = 0;
  frame.dataset.drawn = "later";
  frame.setAttribute("role", "group");
  frame.setAttribute("aria-label", "chart: " + chart.name);
  every.onchange = draw;
  const below = element("div", {className: "below"}, legend);
  if (chart.main) below.append(element("label", {className: "soft"}, every, " every scheme"));
  return {parts: [menus, frame, below, notice], draw};
}
