// Population of strings: the share solved by each scheme against cost, and the estimate of an
// advice against the true error.
const strings_in = () => records("strings");
const schemes_in = rows => in_order(rows.map(row => row.scheme));
const all_schemes = "best of all";

// Cheapest costs within a tolerance by scheme and string, and the strings with a known answer.
function solved_within(within) {
  const cheapest = new Map([[all_schemes, new Map()]]);
  for (const f of records("fronts")) {
    if (!(f.error <= within)) continue;
    for (const series of [all_schemes, f.scheme]) {
      const costs = cheapest.get(series) ?? new Map(),
        cost = f.cost_s_per_s;
      cheapest.set(series, costs.set(f.string, Math.min(cost, costs.get(f.string) ?? Infinity)));
    }
  }
  const solved = cheapest.get(all_schemes),
    decided = strings_in().filter(s => s.uncertainty <= within / 2 || solved.has(s.string));
  return {cheapest, decided: decided.length};
}
const within_text = within => `within ${percent(within)}`;

// One panel: a curve per scheme; grey marks the share of strings without a known answer.
function share_panel(within, names, domain, first, width, print) {
  const {cheapest, decided} = solved_within(within),
    count = strings_in().length,
    steps = [...cheapest].flatMap(([series, of]) => {
      const costs = [...of].sort(([, a], [, b]) => a - b),
        row = (x, k, string) => ({
          series,
          x,
          y: k / count,
          string,
          last: k === costs.length && x < domain[1],
          tooltip: tooltip([
            ["scheme", series],
            ["cost", cost_text(x, "cost_s_per_s")],
            ["solved", `${k} of ${count} strings`],
            ...(string ? [["string", `${string}, which a click opens`]] : []),
          ]),
        });
      return costs.length
        ? [
            row(costs[0][1], 0),
            ...costs.map(([string, x], k) => row(x, k + 1, string)),
            row(domain[1], costs.length),
          ]
        : [];
    });
  const {color, shape} = encodings_of(names),
    x = quantity(
      "x",
      {
        ...decades(
          "x",
          "datum.value < 1 ? format(1000*datum.value, '~r') + ' ms' : datum.value + ' s'",
        ),
        title:
          first === null ? "processor time for one second of sound" : "processor time a second",
      },
      {...log(4), domain},
    ),
    y = quantity(
      "y",
      {format: "%", ...(first === false ? {labels: false} : {title: "share of strings solved"})},
      {domain: [0, 1]},
    );
  const line = (rows, more, encoding) => ({
    data: {values: rows},
    mark: {type: "line", interpolate: "step-after", ...more},
    encoding: {...encoding, ...hover},
  });
  return {
    width,
    height: 300,
    encoding: {x, y},
    layer: [
      {
        data: {values: [{x: domain[0], to: domain[1], y: decided / count, high: 1}]},
        mark: {type: "rect", color: "#8d959c", opacity: 0.35, tooltip: null},
        encoding: {x2: {field: "to"}, y2: {field: "high"}},
      },
      line(
        steps.filter(s => s.series === all_schemes),
        {strokeWidth: 3, opacity: 0.35, color: ink[0]},
        {},
      ),
      line(
        steps.filter(s => s.series !== all_schemes),
        {strokeWidth: 1.8},
        {color, opacity: brought_out},
      ),
      {
        data: {values: steps.filter(s => s.last && s.series !== all_schemes)},
        ...points({color, shape, opacity: brought_out}, {size: 40}),
      },
      ...(print
        ? []
        : [
            {
              data: {values: steps.filter(s => s.string && s.series !== all_schemes)},
              mark: {type: "point", filled: true, size: 60, opacity: 0, cursor: "pointer"},
              encoding: hover,
            },
          ]),
      once({
        type: "text",
        x: 6,
        y: 12,
        align: "left",
        fontSize: 10,
        text: `${count - decided} undecided`,
      }),
      above(within_text(within)),
    ],
  };
}
const share_tolerances = [0.1, 0.01, 0.001];
function share_spec(choice, print) {
  const costs = records("fronts").map(f => f.cost_s_per_s),
    domain = [0.8 * Math.min(...costs), 1.2 * Math.max(...costs)],
    names = schemes_in(records("fronts")),
    one = choice.within_field > 0,
    width = one ? (print ? print_width() : "container") : (print_width() - 60) / 3;
  const panels = one
    ? share_panel(choice.within_field, names, domain, null, width, print)
    : {
        width: undefined,
        spacing: 20,
        hconcat: share_tolerances.map((within, k) =>
          share_panel(within, names, domain, k === 0, width, print),
        ),
      };
  return {
    legend: names,
    spec: framed(
      panels,
      {
        title: `${page.title}: share of strings solved against cost`,
        subtitle:
          `${strings_in().length} strings, nut force; each scheme as published or matched, whichever is ` +
          "cheaper; thick: the best of all; grey: the reference is not known well enough. What is " +
          "missing below it was refused, failed, or needs other settings",
        names,
      },
      print,
    ),
  };
}

// ---- One string: the front of each scheme
const opens_strings = ({view: drawn}) =>
  drawn.addEventListener("click", (event, item) => {
    const select = document.getElementById("scene"),
      string = item?.datum?.string;
    if (!string || !select) return;
    select.value = string;
    document
      .querySelector(`[aria-label="chart: ${string_chart}"]`)
      .scrollIntoView({block: "center"});
    return select.onchange();
  });
const string_chart = "error against cost of one string";
function string_spec({scene}, print) {
  const fronts = records("fronts").filter(f => f.string === scene),
    names = in_order(fronts.map(variant)),
    {color, shape, strokeDash} = encodings_of(names),
    rows = fronts.map(f => ({
      series: variant(f),
      x: f.cost_s_per_s,
      y: f.error,
      tooltip: tooltip([
        ["settings", `${spoken(variant(f))}, ${f.modes} modes, ${f.rate} Hz`],
        ["error", percent(f.error)],
        ["cost", cost_text(f.cost_s_per_s, "cost_s_per_s")],
      ]),
    })),
    string = strings_in().find(s => s.string === scene) ?? {};
  return {
    legend: names,
    spec: framed(
      {
        height: 320,
        data: {values: rows},
        encoding: {
          x: quantity("x", {title: "processor time for one second of sound [s]"}, log(4)),
          y: quantity("y", error_axis("error_l2_whole"), log(4)),
        },
        layer: [
          {mark: {type: "line"}, encoding: {color, strokeDash, opacity: brought_out}},
          points({color, shape, opacity: brought_out}),
          above(`${scene}: ${string.outcome}`),
        ],
      },
      {title: `${page.title}: ${scene}`, subtitle: string.outcome, names},
      print,
    ),
  };
}

// ---- The estimate of an advice against the true error
function advice_spec(choice, print) {
  const names = share_tolerances.map(within_text),
    given = records("advice")
      .filter(a => a.outcome !== "none" && a.estimate > 0 && a.error > 0)
      .map(a => ({
        series: within_text(a.tolerance),
        x: a.estimate,
        y: a.error,
        known: a.uncertainty <= a.tolerance / 2,
        tooltip: tooltip([
          ["string", a.string],
          ["settings", `${spoken(variant(a))}, ${a.modes} modes, ${a.rate} Hz`],
          ["estimate", percent(a.estimate)],
          ["true error", percent(a.error)],
          ["reference known to", percent(a.uncertainty)],
        ]),
      })),
    all = given.flatMap(a => [a.x, a.y]),
    ends = [0.7 * Math.min(...all), 1.4 * Math.max(...all)],
    scale = what => ({domain: names, range: what}),
    axis = (field, title) =>
      quantity(field, {...error_axis("error_l2_whole", field), title}, {...log(4), domain: ends});
  const encoding = {
    color: {field: "series", type: "nominal", scale: scale(["#c07c00", "#0d44e1", "#480588"])},
    shape: {field: "series", type: "nominal", scale: scale(shapes.slice(0, 3))},
  };
  for (const channel of Object.values(encoding))
    channel.legend = {title: null, orient: "top-left", symbolSize: 60};
  const line = (times, dash) => ({
    data: {values: [ends[0], ends[1] / times].map(x => ({x, y: times * x}))},
    mark: {
      type: "line",
      strokeWidth: 1,
      strokeDash: dash,
      color: "#8d959c",
      tooltip: null,
      clip: true,
    },
  });
  return {
    spec: framed(
      {
        height: print ? 420 : 380,
        encoding: {x: axis("x", "error that the advice estimates"), y: axis("y", "true error")},
        layer: [
          line(1, [1, 0]),
          line(2.5, [4, 3]),
          {data: {values: given.filter(a => a.known)}, ...points(encoding)},
          {
            data: {values: given.filter(a => !a.known)},
            ...points(encoding, {filled: false, opacity: 0.5}),
          },
        ],
      },
      {
        title: `${page.title}: what advice estimates, and the true error`,
        subtitle:
          "each point is a string and a tolerance; dashed: 2.5 times the estimate, which the advice " +
          "keeps within the tolerance; hollow: the reference is not known well enough to judge",
      },
      print,
    ),
  };
}
function finding_of_share() {
  const count = strings_in().length;
  if (!count) return "";
  const {cheapest, decided} = solved_within(0.01),
    [name, of] = [...cheapest]
      .filter(([series]) => series !== all_schemes)
      .reduce((a, b) => (b[1].size > a[1].size ? b : a), ["no scheme", new Map()]);
  return (
    `Of ${count} strings ${decided} can be decided within 1\u00a0%: ` +
    `${scheme_words(name)} solves ${of.size}`
  );
}
function share_section() {
  if (!strings_in().length) return null;
  const timed = records("fronts").length > 0,
    advised = records("advice").some(a => a.error > 0);
  const within = {
    label: "within",
    key: "within_field",
    choices: [
      [0, "10, 1 and 0.1 %"],
      ...[0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001].map(t => [t, percent(t)]),
    ],
  };
  const share = {
      name: "share of strings solved against cost",
      menus: () => [within],
      scrolls: true,
      spec: share_spec,
      seen: opens_strings,
      twins: [{file: "share.svg", choice: {within_field: 0}}],
    },
    string = {
      name: string_chart,
      scenes: distinct(records("fronts").map(f => f.string)),
      spec: string_spec,
    },
    advice = {
      name: "estimated against true error of each advice",
      spec: advice_spec,
      twins: [{file: "advice.svg", choice: {}}],
    };
  return {
    id: "share",
    heading: "Share of strings solved",
    notes: [
      "A string counts as solved where the error, the uncertainty of the reference added, is within " +
        "the tolerance. Costs are processor time of one thread.",
    ],
    charts: [...(timed ? [share, string] : []), ...(advised ? [advice] : [])],
    table: without(table("strings"), ["problem", "series"]),
  };
}
