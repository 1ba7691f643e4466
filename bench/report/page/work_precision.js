// The first chart, cost against error for one scene, in layers: bands of uncertainty, real time,
// the tolerance, front, lines, points, failures.
const costs = [
  ["cost_s_per_s", "computing time for one second of sound", ", one core"],
  ["rate", "sample rate [kHz]", ""],
];
const cost_of = rows => costs.find(([column]) => has_finite(rows, column)) ?? costs[0];
const time_text = s =>
  Number.isFinite(s) ? (s < 1 ? `${digits(1000 * s, 2)} ms` : `${digits(s, 2)} s`) : "";
const cost_text = (x, cost) =>
  cost !== "cost_s_per_s"
    ? digits(x, 3)
    : `${time_text(x)} per second (${digits(x < 1 ? 1 / x : x, 2)} \u00d7 ` +
      `${x < 1 ? "faster" : "slower"} than real time)`;

// Label of a point on a line: the rate, and the number of modes if different along the line or if
// there is no rate.
function place_label(rate, modes, modes_differ) {
  const text = Number.isNaN(modes) || !(modes_differ || Number.isNaN(rate)) ? "" : `${modes} modes`;
  return Number.isNaN(rate) ? text : `${text}${text && ", "}${digits(rate / 1000, 4)} kHz`;
}
// Series with several numbers of modes, among schemes with a choice of modes.
function of_several_modes(rows, series) {
  const modes = new Map();
  for (const c of rows)
    if (!(c.fact_grid_intervals > 0))
      modes.set(c[series], (modes.get(c[series]) ?? new Set()).add(c.modes));
  return new Set([...modes].filter(([, all]) => all.size > 1).map(([name]) => name));
}

// Points of a chart from cells: {series, x, y, ...}. `series`: column that names the line.
function points_of(rows, error, cost, series = "series") {
  const drawn = rows.filter(c => c.status !== "refused" && c[series]),
    looks = looks_of(distinct(drawn.map(c => c[series]))),
    several = of_several_modes(drawn, series);
  return drawn.map(c => {
    const {rate, modes, [series]: name} = c,
      x = c[cost] * (cost === "rate" ? 1e-3 : 1),
      y = error_of(c, error),
      differ = several.has(name);
    const label = place_label(rate, modes, differ),
      timed = cost === "cost_s_per_s" && x > 0,
      from = timed ? finite(c.cost_lower) : null,
      to = timed ? finite(c.cost_upper) : null,
      bounded = is_bounded(c, error) ? "\u2264 " : "";
    return {
      series: name,
      scheme: c.scheme,
      problem: c.problem,
      n: c.n,
      x: finite(x),
      y: finite(y),
      most: finite(bound_of(c, error).most),
      from,
      to,
      label,
      rate: finite(rate),
      modes: finite(modes),
      status: c.status,
      flags: c.flags ?? "",
      may_win: c.may_win,
      control: looks.get(name).control,
      order: finite(Number.isNaN(rate) ? modes : differ ? x : rate),
      tooltip: tooltip([
        ["scheme", spoken(name)],
        ["rate", kilohertz(rate)],
        ["modes", c.modes],
        ["error", Number.isFinite(y) ? bounded + error_text(y, error) : ""],
        ["cost", Number.isFinite(x) ? cost_text(x, cost) : ""],
        ["quartiles", from === null ? "" : `${time_text(from)} to ${time_text(to)}`],
        ["below its floor", c.below_floor],
        ["not to be trusted", c.flags],
        ["reason", c.status === "ok" ? "" : c.reason || c.status],
      ]),
    };
  });
}
const is_sound = p => p.status === "ok" && p.x > 0 && p.y > 0;

// Main lines among many schemes: the answer, the cheapest as published, the next in rank, and the
// first in rank of each hue.
function main_series(rows, error, within) {
  const {ranking, published} = answer_at(rows, error, within),
    lines = ranking.map(r => (r.best ?? r.nearest).c.line),
    hues = lines.map(line => looks_of([line]).get(line).colour);
  return [published?.c.line, ...lines.filter((_, k) => k < 5 || hues.indexOf(hues[k]) === k)];
}

// Limits to the knowledge of an error: the noise floor, and the certificate of the reference if
// common to all points.
function bands_of(rows, error) {
  const given = page.manifest?.noise_floor?.[error],
    floor = given ?? rows.map(c => figure_of(c, error, "floor")).find(Number.isFinite);
  const certificates = rows
    .map(c => figure_of(c, error, "certificate"))
    .filter(x => !Number.isNaN(x));
  const least = Math.min(...certificates),
    most = Math.max(...certificates),
    known = x => (x > 0 && Number.isFinite(x) ? x : null);
  return {floor: known(floor), certificate: least === most ? known(most) : null};
}

// Rectangle across the plot between two heights, given by expressions of scales or signals.
const across = (from, to, style) =>
  once({type: "rect", x: 0, x2: {expr: "width"}, y: {expr: from}, y2: {expr: to}, ...style});
const small_text = more => once({type: "text", fontSize: 11, ...more});
const height_of = y => `clamp(scale('y', ${y}), 0, height)`;
// Band from a limit of the error down to the lower edge.
const band = (level, name) =>
  level === null
    ? []
    : [
        across(height_of(level), "height", {color: "#888", opacity: 0.18}),
        small_text({
          x: 6,
          y: {expr: "height - 9"},
          align: "left",
          text: {expr: `${height_of(level)} < height - 18 ? '${name}' : ''`},
        }),
      ];
function real_time() {
  // Line at one second of computing per second of sound.
  const at = "scale('x', 1)",
    there = value => ({expr: `${at} > 0 && ${at} < width ? ${value}`});
  return [
    once({
      type: "rect",
      x: there(`${at} : 0`),
      x2: there(`${at} + 1 : 0`),
      y: 0,
      y2: {expr: "height"},
      color: "#888",
    }),
    small_text({x: there(`${at} - 5 : 0`), y: 10, align: "right", text: there("'real time' : ''")}),
  ];
}

// Chart with the tolerance as a line to drag (signals `within`, `best` and `winner`). Points surely
// within are filled, the answer has a ring, and points without a cost stand at the right edge.
function work_precision_spec(choice, print) {
  const rows = of_scene(cells(), choice.scene),
    {column: error, title} = chosen_error(rows, choice),
    [cost, cost_title, where] = cost_of(rows),
    every = points_of(rows, error, cost, "line");
  const {first, from, to} = tolerances(rows, error),
    within = choice.within ?? first,
    answer = answer_at(rows, error, within).best?.c,
    priceless = unpriced_in(rows),
    unpriced = every.filter(p => p.may_win && p.y > 0 && priceless.has(p.scheme));
  const series = in_order(every.map(p => p.series)),
    few = series.length <= 8,
    wanted = [answer?.line, ...main_series(rows, error, first), ...unpriced.map(p => p.series)],
    names = few || choice.every ? series : series.filter(name => wanted.includes(name)),
    all = every.filter(p => names.includes(p.series)),
    sound = all.filter(is_sound),
    failed = all.filter(p => p.x > 0 && p.status !== "ok");
  const bands = bands_of(rows, error),
    {color, shape, strokeDash} = encodings_of(names),
    inside = "datum.may_win && datum.most !== null && datum.most <= within",
    wins = (value, other) => ({condition: {test: "datum.series === winner", value}, value: other});
  const time =
    "datum.value < 1 ? format(1000*datum.value, ',~r') + ' ms' : format(datum.value, " +
    "',~r') + ' s'";
  const marks = (values, mark, more) => ({
    data: {values},
    mark: {type: "point", filled: false, strokeWidth: 1.6, size: 60, ...mark},
    encoding: {
      color,
      shape,
      fill: {condition: {test: inside, ...color}, value: paper[0]},
      ...hover,
      ...more,
    },
  });
  const ring = mark => ({
    data: {values: sound},
    transform: [{filter: "datum.n === best"}],
    mark: {tooltip: null, ...mark},
    encoding: mark.type === "text" ? {text: {field: "label"}} : {},
  });
  const layer = [
    ...band(bands.certificate, "below what the reference is known to"),
    ...band(bands.floor, bands.certificate === null ? "below the noise floor" : ""),
    ...(cost === "cost_s_per_s" ? real_time() : []),
    across(height_of("within"), "height", {color: key[0], opacity: 0.08}),
    across(height_of("within") + " - 1", height_of("within") + " + 1", {color: key[0]}),
    {
      data: {values: sound.filter(p => p.from > 0 && p.to > 0)},
      mark: {type: "rule", strokeWidth: 1, opacity: 0.5},
      encoding: {x: {field: "from", type: "quantitative"}, x2: {field: "to"}, color},
    },
    {
      data: {values: sound},
      mark: {type: "line"},
      encoding: {color, strokeDash, order: {field: "order"}, size: wins(3, 1.5)},
    },
    marks(sound, {}),
    ...(unpriced.length
      ? [
          marks(unpriced, {x: {expr: "width - 10"}}, {x: null}),
          small_text({align: "right", x: {expr: "width"}, y: -10, text: "no cost measured"}),
        ]
      : []),
    ring({type: "point", filled: false, size: 420, strokeWidth: 2.5, color: key[0]}),
    ...(print
      ? [ring({type: "text", color: ink[0], align: "left", dx: 16, dy: -6, fontSize: 11})]
      : line_labels_layers()),
    {
      data: {values: failed},
      mark: {type: "text", text: "\u2715", fontSize: 14, fontWeight: "bold", y: 8},
      encoding: {y: null, color, ...hover},
    },
    {
      data: {values: [from, to].map(y => ({x: sound[0]?.x, y}))},
      mark: {type: "point", opacity: 0, tooltip: null},
    },
    above(title),
    once({
      type: "text",
      x: {expr: "width < 400 ? width + 14 : width"},
      y: {expr: "height + 36"},
      align: "right",
      fontSize: {expr: "width < 400 ? 11 : 12"},
      fontWeight: "bold",
      text: {expr: `'${cost_title}' + (width < 400 ? '' : '${where}')`},
    }),
  ];
  if (sound.every(p => p.y <= bands.floor))
    layer.push(
      small_text({
        x: {expr: "width / 2"},
        y: {expr: "height / 2"},
        text: sound.length
          ? "All errors lie within the noise floor: none is better than another by this measure."
          : "No run that ended well has this error: choose another measure.",
      }),
    );
  const encoding = {
    x: quantity("x", decades("x", cost === "cost_s_per_s" ? time : plain_number), log(36)),
    y: quantity("y", error_axis(error), log(24)),
  };
  const signals = {within, best: answer?.n ?? null, winner: answer?.line || null},
    params = Object.entries(signals).map(([name, value]) => ({name, value})),
    one = scenes_of_cells().length === 1;
  const height = print
      ? Math.min(470, Math.max(220, 0.75 * print_width()))
      : choice.narrow
        ? 300
        : 350,
    padding = print
      ? {}
      : {padding: {left: 12, top: 12, bottom: 12, right: choice.narrow ? 18 : 120}};
  return {
    spec: framed(
      {height, encoding, layer, params, ...padding},
      {title: `${one ? page.title : choice.scene}: error and cost`, subtitle: page.undated, names},
      print,
    ),
    names,
    // a phone's plot is narrower than most names
    ...(choice.narrow
      ? {legend: names}
      : {labels: view => line_labels(names, [...sound, ...unpriced], view)}),
    few,
  };
}

// Names beside the ends of lines, in the free places found by the page, with a halo over the plot.
// The fields have separate names, so labels do not enter the scales.
function line_labels_layers() {
  const layer = more => ({
    data: {name: "labels", values: []},
    mark: {
      type: "text",
      align: "left",
      fontSize: 11,
      tooltip: null,
      x: {expr: "datum.left"},
      y: {expr: "datum.middle"},
      ...more,
    },
    encoding: {x: null, y: null, text: {field: "text", type: "nominal"}},
  });
  return [layer({stroke: paper[0], strokeWidth: 5, strokeJoin: "round"}), layer({})];
}
// Places a name beside the most accurate points of each line, clear of points, lines, the tolerance
// and other names; the answer's name comes first.
function line_labels(names, points, view) {
  const [x, y] = [view.scale("x"), view.scale("y")],
    [width, height] = [view.width(), view.height()],
    first = points.find(p => p.n === view.signal("best")),
    tolerance_y = y(view.signal("within") ?? 0);
  const placed = points.map(p => ({...p, x: p.x === null ? width - 10 : x(p.x), y: y(p.y)})),
    box = (p, r) => ({left: p.x - r, right: p.x + r, top: p.y - r, bottom: p.y + r}),
    boxes = [
      {left: 0, right: width, top: tolerance_y - 3, bottom: tolerance_y + 3},
      ...placed.map(p => box(p, p.n === first?.n ? 13 : 5)),
    ],
    labels = [];
  for (const name of names) {
    const line = placed.filter(p => p.series === name).sort((a, b) => a.order - b.order);
    line.slice(1).forEach((p, k) => {
      const steps = Math.ceil(Math.hypot(p.x - line[k].x, p.y - line[k].y) / 8),
        between = (a, b, s) => a + ((b - a) * s) / steps;
      for (let s = 1; s < steps; ++s)
        boxes.push(box({x: between(line[k].x, p.x, s), y: between(line[k].y, p.y, s)}, 2));
    });
  }
  const free = box =>
    box.left >= 0 &&
    box.right <= width + view.padding().right &&
    box.top >= 0 &&
    box.bottom <= height - 18 &&
    !boxes.some(
      b => b.left < box.right && b.right > box.left && b.top < box.bottom && b.bottom > box.top,
    );
  for (const name of [...names].sort((a, b) => (b === first?.series) - (a === first?.series))) {
    const ends = placed.filter(p => p.series === name).sort((a, b) => b.y - a.y),
      text = scheme_words(name, ""),
      wide = 6.2 * text.length;
    const places = ends.slice(0, 4).flatMap(p => [
      [p.x + 9, p.y],
      [p.x - 9 - wide, p.y],
      [p.x - wide / 2, p.y + 15],
      [p.x - wide / 2, p.y - 15],
      [p.x + 6, p.y + 14],
      [p.x + 6, p.y - 14],
      [p.x - 6 - wide, p.y + 14],
    ]);
    const place = places
      .map(([left, middle]) => ({left, right: left + wide, top: middle - 7, bottom: middle + 7}))
      .find(free);
    if (!place) continue;
    boxes.push(place);
    labels.push({left: place.left, middle: (place.top + place.bottom) / 2, text});
  }
  return labels;
}

const scenes_of_cells = () => distinct(cells().map(c => c.problem));
function work_precision_section() {
  const usable = scene => errors_in(of_scene(cells(), scene)).length > 0;
  const scenes = scenes_of_cells().filter(usable);
  if (!scenes.length) return null;
  const twins = scenes
    .slice(0, most_twins)
    .map(scene => ({file: twin_file("work_precision", scene, scenes_of_cells()), choice: {scene}}));
  return {
    id: "work-precision",
    heading: "Error against cost",
    charts: [
      {
        name: "error against cost of each scheme at each rate",
        scenes,
        spec: work_precision_spec,
        twins,
        main: true,
      },
    ],
  };
}
const most_twins = 12; // pictures per chart
const first_choice = (menus, scene) =>
  Object.fromEntries([
    ["scene", scene],
    ...menus.filter(menu => menu.choices.length).map(menu => [menu.key, menu.choices[0][0]]),
  ]);
