// The first chart: any cost against any error, scene by scene, layer upon layer: bands of what
// cannot be known, real time, goals, front, lines, points, failures.
const costs = [
  ["cost_s_per_s", "computing time for one second of sound, one core"],
  ["ns_per_step", "time per step [ns]"],
  ["worst_block_of_deadline", "worst block of 64 samples, as a fraction of its deadline"],
  ["rate", "sample rate [kHz]"],
  ["dofs", "state carried [doubles]"],
];
const timed = cost => cost === "cost_s_per_s" || cost === "ns_per_step";
const time_text = s =>
  Number.isFinite(s) ? (s < 1 ? `${digits(1000 * s, 2)} ms` : `${digits(s, 2)} s`) : "";
const cost_text = (x, cost) =>
  cost !== "cost_s_per_s"
    ? digits(x, 3)
    : `${time_text(x)} per second (${digits(x < 1 ? 1 / x : x, 2)} \u00d7 ` +
      `${x < 1 ? "faster" : "slower"} than real time)`;

// Where on its line: at which rate, and with how many modes where they differ along it or there is
// no rate.
function place_label(rate, modes, modes_differ) {
  const text = Number.isNaN(modes) || !(modes_differ || Number.isNaN(rate)) ? "" : `${modes} modes`;
  return Number.isNaN(rate) ? text : `${text}${text && ", "}${digits(rate / 1000, 4)} kHz`;
}
// series of schemes with numbers of modes to choose, that have several
function of_several_modes(rows) {
  const modes = new Map();
  for (const c of rows)
    if (!(number(c.fact_grid_intervals) > 0))
      modes.set(c.series, (modes.get(c.series) ?? new Set()).add(c.modes));
  return new Set([...modes].filter(([, all]) => all.size > 1).map(([series]) => series));
}

// Cells as points of a chart: {series, x, y, ...}. `series` names the column that a line is of.
function points_of(rows, error, cost, series = "series") {
  const named = rows
      .filter(c => c.status !== "refused" && c[series])
      .map(c => ({...c, series: c[series]})),
    looks = looks_of(distinct(named.map(c => c.series)));
  const several = of_several_modes(named);
  return named.map(c => {
    const rate = number(c.rate),
      modes = number(c.modes),
      x = number(c[cost]) * (cost === "rate" ? 1e-3 : 1),
      y = error_of(c, error),
      differ = several.has(c.series);
    const side = which =>
      timed(cost) && number(c.cost_s_per_s) > 0
        ? finite((x * number(c["cost_" + which])) / number(c.cost_s_per_s))
        : null;
    const label = place_label(rate, modes, differ),
      from = side("lower"),
      to = side("upper"),
      bounded = is_bounded(c, error) ? "\u2264 " : "";
    return {
      series: c.series,
      problem: c.problem,
      n: c.n,
      x: finite(x),
      y: finite(y),
      uncertain: figure_of(c, error, "certificate") || 0,
      from,
      to,
      label,
      rate: finite(rate),
      modes: finite(modes),
      status: c.status,
      flags: c.flags ?? "",
      trusted: c.trusted,
      may_win: c.may_win,
      control: looks.get(c.series).control,
      order: finite(Number.isNaN(rate) ? modes : differ ? x : rate),
      tooltip: tooltip([
        ["scheme", spoken(c.series)],
        ["rate", kilohertz(rate)],
        ["modes", c.modes],
        ["error", Number.isFinite(y) ? bounded + error_text(y, error) : ""],
        ["cost", Number.isFinite(x) ? cost_text(x, cost) : ""],
        [
          "quartiles",
          from === null
            ? ""
            : cost === "cost_s_per_s"
              ? `${time_text(from)} to ${time_text(to)}`
              : `${digits(from, 3)} to ${digits(to, 3)}`,
        ],
        ["below its floor", c.below_floor],
        ["not to be trusted", c.flags],
        ["reason", c.status === "ok" ? "" : c.reason || c.status],
      ]),
    };
  });
}
const is_sound = p => p.status === "ok" && p.x > 0 && p.y > 0;

// Of many schemes those that a reader looks for first: each that is on the front, with what is
// matched there as published too, then of each hue the one that comes nearest to it.
function main_series(all) {
  const names = in_order(all.map(p => p.series)),
    looks = looks_of(names),
    sound = all.filter(p => is_sound(p) && p.trusted && !p.control);
  if (names.length <= 8) return names;
  const behind = new Map(); // times the cost of the cheapest that may be as accurate
  for (const p of sound) {
    const least = Math.min(
      ...sound
        .filter(other => other.y <= p.y + p.uncertain + other.uncertain)
        .map(other => other.x),
    );
    behind.set(p.series, Math.min(behind.get(p.series) ?? Infinity, p.x / least));
  }
  const chosen = [],
    hues = new Set();
  for (const [name, times] of behind)
    if (times === 1 && name.includes(" compliance=matched"))
      chosen.push(name.replace("matched", "own"));
  for (const [name, times] of [...behind].sort(([, a], [, b]) => a - b))
    if ((times === 1 || !hues.has(looks.get(name).colour)) && chosen.length < 8) {
      chosen.push(name);
      hues.add(looks.get(name).colour);
    }
  return names.filter(name => chosen.includes(name));
}

// What an error of a scene is known to: the noise floor, and the certificate of the reference where
// all points were measured against one.
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

const goal_text = g => `${g.goal}: ${g.run}${g.ties ? ` or ${g.ties}` : ""}`;
// The goals that some cells of the scene reach and some do not, so that they lie among the points.
function goals_of(rows, scene, error) {
  const measured = c => figure_of(c, error, "value");
  const most = c => measured(c) + (is_percent(error) ? figure_of(c, error, "certificate") : 0);
  return of_scene(records("cheapest"), scene)
    .filter(
      g =>
        g.measure === error &&
        g.scheme !== "" &&
        rows.some(
          c => c.status === "ok" && Number.isFinite(measured(c)) && most(c) > number(g.target),
        ),
    )
    .map(g => ({y: number(g.target), text: goal_text(g)}));
}

// the points of the front, from the cheapest on, with the name of each scheme at its dearest
function front_of(rows, error, cost) {
  const on = of_scene(
    records("fronts")
      .filter(f => error_name(f) === error && f.cost === cost)
      .map(f => cells()[f.row]),
    rows[0]?.problem,
  );
  const front = on
    .map(c => ({
      n: c.n,
      series: c.line,
      x: number(c[cost]) * (cost === "rate" ? 1e-3 : 1),
      y: error_of(c, error),
    }))
    .filter(p => p.y > 0);
  for (const p of front)
    p.name = front.some(o => o.series === p.series && o.x > p.x) ? "" : p.series;
  return front.sort((a, b) => a.x - b.x);
}

// From the level of what limits the error down to the lower edge.
function band(level, name, color, opacity) {
  if (level === null) return [];
  const at = `clamp(scale('y', ${level}), 0, height)`;
  return [
    once({
      type: "rect",
      x: 0,
      x2: {expr: "width"},
      y: {expr: at},
      y2: {expr: "height"},
      color,
      opacity,
    }),
    once({
      type: "text",
      x: 6,
      y: {expr: at},
      dy: 10,
      align: "left",
      fontSize: 10,
      text: {expr: `${at} < height - 14 && width > 400 ? '${name}' : ''`},
    }),
  ];
}
function real_time(cost) {
  // where a scheme takes a second for a second
  const at = "scale('x', 1)",
    there = `${at} > 0 && ${at} < width`;
  return cost !== "cost_s_per_s"
    ? []
    : [
        once({
          type: "rect",
          x: {expr: `${there} ? ${at} : 0`},
          x2: {expr: `${there} ? ${at} + 1 : 0`},
          y: 0,
          y2: {expr: "height"},
          color: "#888",
        }),
        once({
          type: "text",
          x: {expr: `${there} ? ${at} : 0`},
          y: {expr: "height - 6"},
          dx: -5,
          align: "right",
          fontSize: 10,
          text: {expr: `${there} ? 'real time' : ''`},
        }),
      ];
}
// The axis of errors spans half a decade at least, so that no noise is blown up; and where it says
// nothing, a sentence does.
function span_and_silence(all, sound, bands) {
  const say = text => [
    once({
      type: "text",
      x: {expr: "width / 2"},
      y: {expr: "height / 2"},
      fontSize: 13,
      fontWeight: "bold",
      text,
    }),
  ];
  if (!sound.length)
    return all.some(p => p.status === "ok")
      ? say("These runs ended well and have no such error: choose another measure.")
      : [];
  const ys = sound.map(p => p.y),
    least = Math.min(...ys),
    most = Math.max(...ys),
    middle = Math.sqrt(least * most),
    half = Math.sqrt(Math.sqrt(10));
  const ends = [Math.max(most, middle * half), Math.min(least, middle / half)].map(y => ({
    x: sound[0].x,
    y,
  }));
  const silence =
    bands.floor !== null && most <= bands.floor
      ? say(
          "All errors lie within the noise floor: no scheme is better than another by this " +
            "measure.",
        )
      : [];
  return [{data: {values: ends}, mark: {type: "point", opacity: 0, tooltip: null}}, ...silence];
}
// For papers: rates along the front, and the name of each scheme at its dearest point there, where
// they are a line apart.
function front_labels(front, all) {
  const span = Math.log(Math.max(...all.map(p => p.y)) / Math.min(...all.map(p => p.y))),
    rows = [];
  for (const f of front.toReversed()) {
    const p = all.find(q => q.n === f.n);
    if (p.control || rows.some(r => Math.abs(Math.log(r.y / f.y)) < 0.04 * span)) continue;
    rows.push({
      x: f.x,
      y: f.y,
      text: (f.name && print_width() > 500 ? f.name + ", " : "") + p.label,
    });
  }
  return {
    data: {values: rows},
    mark: {type: "text", align: "left", dx: 8, dy: -7, fontSize: 10},
    encoding: {text: {field: "text"}},
  };
}

function work_precision_spec(choice, print) {
  const rows = of_scene(cells(), choice.scene),
    {column: error, title} = chosen_error(rows, choice),
    cost = choice.cost_field,
    every = points_of(rows, error, cost, "line");
  const names = choice.every ? in_order(every.map(p => p.series)) : main_series(every),
    all = every.filter(p => names.includes(p.series)),
    sound = all.filter(is_sound);
  const bands = bands_of(rows, error),
    front = front_of(rows, error, cost).filter(f => all.some(p => p.n === f.n)),
    failed = all.filter(p => p.x > 0 && p.status !== "ok");
  const {color, shape, strokeDash} = encodings_of(names),
    drawn = names.filter(
      name => sound.some(p => p.series === name) || failed.some(p => p.series === name),
    );
  const time =
      "datum.value < 1 ? format(1000*datum.value, ',~r') + ' ms' : format(datum.value, " +
      "',~r') + ' s'",
    opacity = brought_out;
  const lines = (which, strokeWidth) => ({
    data: {values: sound.filter(p => p.control === which)},
    mark: {type: "line", strokeWidth},
    encoding: {color, strokeDash, order: {field: "order"}, opacity},
  });
  const marks = (which, mark) => ({
    data: {values: sound.filter(p => (p.flags === "") === which)},
    ...points(
      {color, shape, opacity, size: {condition: {test: "datum.control", value: 30}, value: 75}},
      mark,
    ),
  });
  const goals = cost === "cost_s_per_s" ? goals_of(rows, choice.scene, error) : [],
    cost_title = costs.find(([column]) => column === cost)[1];
  const layer = [
    ...band(bands.certificate, "the reference is certain to here", "#56b4e9", 0.16),
    ...band(bands.floor, "noise floor", "#888", 0.18),
    ...real_time(cost),
    {
      data: {values: goals},
      mark: {type: "rule", strokeDash: [2, 4], color: "#888"},
      encoding: {x: null},
    },
    ...(print
      ? [
          {
            data: {values: goals},
            mark: {
              type: "text",
              x: {expr: "width - 6"},
              dy: -6,
              align: "right",
              fontSize: 10,
              limit: {expr: "0.6 * width"},
              opacity: {expr: "width < 500 ? 0 : 1"},
            },
            encoding: {x: null, text: {field: "text"}},
          },
        ]
      : []),
    ...[
      [10, front_edge],
      [7, front_track],
    ].map(([strokeWidth, tone]) => ({
      data: {values: front},
      mark: {
        type: "line",
        strokeWidth,
        color: tone[0],
        strokeCap: "round",
        strokeJoin: "round",
        tooltip: null,
      },
      encoding: {order: {field: "x"}},
    })),
    {
      data: {values: sound.filter(p => p.from > 0 && p.to > 0)},
      mark: {type: "rule", strokeWidth: 1},
      encoding: {x: {field: "from", type: "quantitative"}, x2: {field: "to"}, color, opacity},
    },
    // hollow: not to be trusted
    lines(true, 0.8),
    lines(false, 1.8),
    {...marks(true, {}), ...(print || choice.narrow ? {} : zoomed("x", "y"))},
    marks(false, {filled: false, strokeWidth: 1.6}),
    print ? front_labels(front, all) : line_labels_layer(),
    {
      data: {values: failed},
      mark: {type: "text", text: "\u2715", fontSize: 14, fontWeight: "bold", y: 8},
      encoding: {y: null, color, opacity, ...hover},
    },
    ...span_and_silence(every, sound, bands),
    above(title),
    once({
      type: "text",
      x: {expr: "width"},
      y: {expr: "height + 36"},
      align: "right",
      fontSize: 12,
      fontWeight: "bold",
      text: {
        expr:
          "width < 400 ? " +
          `'${cost === "cost_s_per_s" ? "computing time per second" : cost_title.split(",")[0]}' ` +
          `: '${cost_title}'`,
      },
    }),
  ];
  const encoding = {
    x: quantity("x", decades("x", cost === "cost_s_per_s" ? time : plain_number), log(36)),
    y: quantity("y", error_axis(error), log(36)),
  };
  const one = scenes_of_cells().length === 1,
    about = page.manifest?.reference ? page.about.split("; ").slice(0, -1).join("; ") : page.source;
  const spec = framed(
    {
      height: print
        ? Math.min(470, Math.max(220, 0.75 * print_width()))
        : choice.narrow
          ? 220
          : 400,
      encoding,
      layer,
    },
    {title: `${one ? page.title : choice.scene}: error and cost`, subtitle: about, names},
    print,
  );
  return {
    spec,
    legend: drawn,
    labels: sound,
    zooms: choice.narrow ? null : {x: "zoom_x", y: "zoom_y"},
    few: in_order(every.map(p => p.series)).length <= 8,
  };
}

// Names beside the ends of lines, where the page has found room for them.
function line_labels_layer() {
  // its fields have names of their own: it is no part of the scales
  return {
    data: {name: "labels", values: []},
    mark: {
      type: "text",
      align: "left",
      fontSize: 11,
      tooltip: null,
      x: {expr: "datum.left"},
      y: {expr: "datum.middle"},
    },
    encoding: {x: null, y: null, text: {field: "text", type: "nominal"}},
  };
}
// A name beside the most accurate point of each line, where it covers neither a point nor another
// name.
function line_labels(names, points, x, y, width, height) {
  const placed = points.map(p => ({series: p.series, x: x(p.x), y: y(p.y)})),
    boxes = placed.map(p => ({left: p.x - 5, right: p.x + 5, top: p.y - 5, bottom: p.y + 5})),
    labels = [];
  const free = box =>
    box.left >= 0 &&
    box.right <= width &&
    box.top >= 0 &&
    box.bottom <= height &&
    !boxes.some(
      b => b.left < box.right && b.right > box.left && b.top < box.bottom && b.bottom > box.top,
    );
  for (const name of names) {
    const ends = placed.filter(p => p.series === name).sort((a, b) => b.y - a.y),
      text = spoken(name),
      wide = 6.4 * text.length;
    const places = ends.flatMap(p => [
      [p.x + 9, p.y],
      [p.x - 9 - wide, p.y],
      [p.x - wide / 2, p.y + 15],
      [p.x - wide / 2, p.y - 15],
      [p.x + 6, p.y + 14],
      [p.x + 6, p.y - 14],
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
  const usable = scene =>
    errors_in(of_scene(cells(), scene)).length > 0 &&
    costs.some(([column]) => has_finite(of_scene(cells(), scene), column));
  const scenes = scenes_of_cells().filter(usable);
  if (!scenes.length) return null;
  const menus = scene => {
    const rows = of_scene(cells(), scene);
    return [
      ...error_menus(rows),
      {
        label: "cost",
        key: "cost_field",
        choices: costs.filter(([column]) => has_finite(cells(), column)),
      },
    ];
  };
  const notes = [
    "Down is more accurate, left is cheaper. The grey track is the Pareto front; its " +
      "points say their rates. Bars are quartiles of the cost. Crosses at the upper edge are " +
      "runs that failed. Dotted lines are accuracies that were asked for.",
    "A hue is a family of schemes, a marker a scheme, a dash its options; thin grey lines " +
      "are controls, known to be wrong somewhere. Click a name in the legend to bring it " +
      "out, more names with it, or the same name again to go back.",
  ];
  if (cells().some(c => c.flags))
    notes.push(
      "Hollow points are not to be trusted: the run's own figures speak against it. They " +
        "are on no front.",
    );
  if (
    scenes.some(scene =>
      Object.values(
        bands_of(of_scene(cells(), scene), errors_in(of_scene(cells(), scene))[0].column),
      ).some(x => x !== null),
    )
  )
    notes.push(
      "Points in the grey band cannot be told apart, because the problem is too sensitive. " +
        "Points in the blue band are below the accuracy of the reference. If the uncertainty " +
        "of the reference is more than a tenth of an error, it is added to it: the point is " +
        "an upper bound.",
    );
  const twins = scenes
    .slice(0, most_twins)
    .map(scene => ({
      file: twin_file("work_precision", scene, scenes_of_cells()),
      choice: first_choice(menus(scene), scene),
    }));
  return {
    id: "work-precision",
    heading: "Error and cost",
    notes,
    charts: [
      {
        name: "error against cost of each scheme at each rate",
        menus,
        scenes,
        spec: work_precision_spec,
        twins,
        main: true,
      },
    ],
  };
}
const most_twins = 12; // pictures of one chart
const first_choice = (menus, scene) =>
  Object.fromEntries([
    ["scene", scene],
    ...menus.filter(menu => menu.choices.length).map(menu => [menu.key, menu.choices[0][0]]),
  ]);
