// Error against cost, recomputed for the current string: a line for each scheme, a point for each
// sample rate. Costs are measured in this browser.
const chart = {points: [], own: [], cells: 0, whole: false, why: ""};
const chart_schemes = [
  ["modal_two_moment", "matched"],
  ["modal_two_point", "own"],
  ["modal_two_point", "matched"],
  ["modal_quadratised", "matched"],
  ["modal_spatial_newton", "own"],
  ["finite_difference_explicit", "own"],
  ["finite_difference_theta", "own"],
  ["sitar_waveguide", "own"],
];
const chart_rates = [1, 2, 4, 8].map(k => 44100 * k);
const colours = {
  modal_two_moment: "#0a4f80",
  modal_two_point: "#0072b2",
  modal_quadratised: "#7a4fb5",
  modal_spatial_newton: "#00805a",
  finite_difference_explicit: "#b07800",
  finite_difference_theta: "#8a5a1a",
  sitar_waveguide: "#aa3377",
  mine: "#c4261d",
};
const colour_of = name => colours[name] ?? "#777";

const first_able = () =>
  [...chart_schemes.map(([name]) => name), ...shown.scene.able].find(
    name => shown.scene.able.includes(name) && !descriptor(name).control,
  );

// Text of an error, as in the program's tables (bench/compare/bound.hpp).
function error_text({error, uncertainty}) {
  if (uncertainty <= 0.1 * error) return percent(error);
  if (!Number.isFinite(uncertainty)) return `${percent(error)}?`;
  return error + uncertainty < 1 ? `\u2264 ${percent(error + uncertainty)}` : "not known";
}
const sound_point = p => p.outcome === "ok" && Number.isFinite(p.error);
const label_of = p => p.scheme + (p.compliance === "matched" ? ", matched" : "");
function percent(x) {
  if (!Number.isFinite(x)) return "not known";
  const p = 100 * x;
  return `${p >= 10 ? p.toFixed(0) : p >= 0.01 ? p.toPrecision(2) : p.toExponential(1)} %`;
}
const two_digits = x => String(Number(x.toPrecision(2)));
const time_text = s =>
  s >= 1
    ? `${two_digits(s)} s`
    : s >= 1e-3
      ? `${two_digits(1e3 * s)} ms`
      : `${two_digits(1e6 * s)} µs`;

// Cheapest scheme within an accuracy, by the rules in `jvari compare` (analysis/cheapest.hpp).
// Costs are measured in this browser, with a coarse clock.
async function verdict(points, accuracy) {
  const all = points.filter(
      p => p.scheme !== "mine" && !descriptor(p.scheme)?.control && sound_point(p),
    ),
    found = await ask("cheapest", {points: all, accuracy});
  return {
    best: all[found.best],
    ties: found.ties.map(k => all[k]),
    perhaps: found.perhaps.map(k => all[k]),
  };
}
const run_name = p => `${label_of(p)} at ${p.rate / 1e3} kHz`,
  run_names = list => list.map(run_name).join("; ");

function answer_of({best, ties, perhaps}) {
  if (!best && !chart.whole) return ["computing …"];
  if (!best)
    return perhaps.length
      ? [
          "cannot be decided",
          `the reference is known to ${percent(perhaps[0].uncertainty)} only`,
          `candidates: ${run_names(perhaps)}`,
        ]
      : ["none"];
  return [
    label_of(best),
    `${best.rate / 1e3} kHz, ${error_text(best)} error, ${time_text(best.cost)} per second ` +
      "in this browser",
    ties.length && `a tie with ${run_names(ties)}`,
    perhaps.length && `perhaps for less ${run_names(perhaps)}`,
  ].filter(Boolean);
}
async function draw_answers() {
  const request = ++draw_answers.count,
    accuracies = [0.1, 0.01, 0.001];
  const points = chart.points,
    verdicts =
      points.length === 0
        ? accuracies.map(() => ({}))
        : await Promise.all(accuracies.map(accuracy => verdict(points, accuracy))).catch(error => {
            if (!(error instanceof Stale_question)) throw error;
          });
  // Returns if the worker was replaced, or if newer points came.
  if (!verdicts || request !== draw_answers.count) return;
  by_id("answers").replaceChildren(
    ...(chart.why ? [] : verdicts).map((v, k) => {
      const [found, ...more] = answer_of(v),
        card = element("div", {className: "card"});
      card.append(
        element("p", {className: "soft"}, `within ${100 * accuracies[k]} %`),
        element("p", {}, found),
        ...more.map(text => element("p", {className: "soft"}, text)),
      );
      if (v.best) card.style.borderLeftColor = colour_of(v.best.scheme);
      return card;
    }),
  );
}
draw_answers.count = 0;

function svg(name, attributes, ...inside) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...inside);
  return node;
}

// Looks of a scheme's line and points: dashed and hollow as published.
const line_of = p => ({
    stroke: colour_of(p.scheme),
    "stroke-width": 1.6,
    "stroke-dasharray": p.compliance === "own" ? "5 4" : "none",
  }),
  dot_of = p => ({
    stroke: colour_of(p.scheme),
    fill: p.compliance === "own" ? "var(--paper)" : colour_of(p.scheme),
  });

function draw_chart() {
  draw_answers();
  const box = document.getElementById("chart");
  if (chart.why)
    return box.replaceChildren(element("p", {className: "soft"}, "Nothing to compare: see above."));
  const width = Math.max(300, box.clientWidth),
    height = Math.min(380, Math.max(260, width * 0.55)),
    points = [...chart.points, ...chart.own].filter(sound_point);
  const left = 52,
    right = 12,
    top = 10,
    bottom = 40,
    errors = points.map(p => Math.max(1e-6, p.error)),
    costs = points.map(p => p.cost);
  const [y0, y1] = [
    Math.floor(Math.log10(Math.min(1e-3, ...errors))),
    Math.ceil(Math.log10(Math.min(1e3, Math.max(0.3, ...errors)))),
  ];
  const [x0, x1] = [
    Math.log10(Math.min(5e-3, ...costs)) - 0.1,
    Math.log10(Math.max(0.2, ...costs)) + 0.1,
  ];
  const X = cost => left + ((width - left - right) * (Math.log10(cost) - x0)) / (x1 - x0),
    Y = error =>
      top +
      ((height - top - bottom) * (y1 - Math.log10(Math.min(1e3, Math.max(1e-6, error))))) /
        (y1 - y0);
  const art = svg("svg", {
    viewBox: `0 0 ${width} ${height}`,
    width: "100%",
    role: "img",
    "aria-label": "error against computing time: the table below has the numbers",
  });
  const grid = (x1, x2, y1, y2, name = "grid") =>
      art.append(svg("line", {x1, x2, y1, y2, class: name})),
    words = (x, y, anchor, text) => art.append(svg("text", {x, y, "text-anchor": anchor}, text));
  for (let k = y0; k <= y1; ++k) {
    grid(left, width - right, Y(10 ** k), Y(10 ** k));
    words(left - 6, Y(10 ** k) + 4, "end", `${digits(100 * 10 ** k)} %`);
  }
  for (let k = Math.ceil(x0); k <= x1; ++k) {
    grid(X(10 ** k), X(10 ** k), top, height - bottom, k === 0 ? "real-time" : "grid");
    words(X(10 ** k), height - bottom + 16, "middle", time_text(10 ** k));
  }
  words(width - 2, height - 6, "end", "computing time for a second of sound, in this browser");
  const uncertainty = points[0]?.uncertainty;
  if (uncertainty > 10 ** y0)
    art.append(
      svg("rect", {
        x: left,
        y: Y(uncertainty),
        width: width - left - right,
        height: Math.max(0, Y(10 ** y0) - Y(uncertainty)),
        class: "uncertain",
      }),
    );
  const lines = new Map();
  for (const p of points) lines.set(label_of(p), [...(lines.get(label_of(p)) ?? []), p]);
  for (const [label, line] of lines) {
    line.sort((a, b) => a.rate - b.rate);
    const places = line.map(p => `${X(p.cost)},${Y(p.error)}`).join(" ");
    art.append(svg("polyline", {points: places, fill: "none", ...line_of(line[0])}));
    for (const p of line) {
      const chosen =
        p.scheme === state.scheme &&
        p.rate === state.rate &&
        (p.compliance || "own") === state.compliance;
      const dot = svg(
        "circle",
        {
          cx: X(p.cost),
          cy: Y(p.error),
          r: chosen ? 7 : 4.5,
          ...dot_of(p),
          "stroke-width": chosen ? 3 : 1.5,
          class: "point",
        },
        svg(
          "title",
          {},
          `${label}, ${p.rate / 1e3} kHz: ${percent(p.error)}, ${time_text(p.cost)} per second`,
        ),
      );
      if (p.scheme !== "mine")
        dot.onclick = () =>
          choose({scheme: p.scheme, rate: p.rate, compliance: p.compliance || "own", modes: 0});
      art.append(dot);
    }
  }
  const legend = element("p", {className: "legend"});
  for (const [label, line] of lines)
    legend.append(element("span", {}, swatch(line[0]), label), " ");
  box.replaceChildren(art, legend, table_of_points());
}

const swatch = p =>
  svg(
    "svg",
    {width: 26, height: 10, "aria-hidden": "true"},
    svg("line", {x1: 0, x2: 26, y1: 5, y2: 5, ...line_of(p)}),
    svg("circle", {cx: 13, cy: 5, r: 4, ...dot_of(p)}),
  );

function table_of_points() {
  const rows = [...chart.points, ...chart.own].map(p => [
    label_of(p),
    `${p.rate / 1e3} kHz`,
    p.refused ?? (p.outcome !== "ok" ? p.outcome.replace("_", " ") : percent(p.error)),
    p.cost ? time_text(p.cost) : "",
  ]);
  const row = (kind, texts, more = {}) =>
      element("tr", {}, ...texts.map(text => element(kind, more, text))),
    heads = ["scheme", "sample rate", "error", "time per second"],
    table = element(
      "table",
      {},
      element("thead", {}, row("th", heads, {scope: "col"})),
      element("tbody", {}, ...rows.map(texts => row("td", texts))),
    );
  const was_open = document.querySelector("#chart details")?.open,
    scroll = element("div", {className: "scroll", tabIndex: 0}, table);
  (scroll.setAttribute("role", "region"),
    scroll.setAttribute("aria-label", "table of the chart's points"));
  const count = chart.points.length,
    title = chart.whole
      ? `${count} points as a table`
      : `computing … ${count} of ${chart.cells || "the"} points`;
  return element("details", {open: Boolean(was_open)}, element("summary", {}, title), scroll);
}
