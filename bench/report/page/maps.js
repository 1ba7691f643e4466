// Maps: outcomes of each scheme over a plane of two keys (maps.csv), with the refined and the
// theoretical boundaries (boundaries.csv). A tile per run reaches half-way to both neighbours.
// Trimmed scenes: the path and the needs (path.csv, needs.csv).
const outcomes = {
  sound: ["#009e73", "circle"],
  unjudged: ["#882255", "wedge"],
  flagged: ["#999933", "triangle-left"],
  inaccurate: ["#e69f00", "square"],
  adhesive: ["#cc79a7", "diamond"],
  energy_gaining: ["#0072b2", "triangle-up"],
  not_converged: ["#56b4e9", "triangle-down"],
  diverged: ["#d55e00", "cross"],
  refused: ["#8c8c8c", "triangle-right"],
  error: ["#000000", "stroke"],
};

// Axis of a map: numeric if all values are numbers, and logarithmic if all are positive and span
// more than five to one.
function map_axis(rows, which) {
  const numbers = rows.every(r => Number.isFinite(r[which])),
    places = distinct(rows.map(r => r[which]).filter(Number.isFinite)).sort((a, b) => a - b);
  const least = places[0] ?? 0,
    most = places.at(-1) ?? 0,
    logarithmic = numbers && least > 0 && most > 5 * least,
    title = with_unit(plain(rows[0][which + "_key"]));
  const on = logarithmic ? Math.log : x => x,
    back = logarithmic ? Math.exp : x => x;
  const around = x => {
    // Edges of a tile.
    const k = places.indexOf(x),
      step = i => on(places[i + 1]) - on(places[i]),
      last = places.length - 1;
    const [before, after] =
      places.length < 2 ? [1, 1] : [step(Math.max(0, k - 1)), step(Math.min(k, last - 1))];
    return [back(on(x) - before / 2), back(on(x) + after / 2)];
  };
  const scale = !numbers
    ? {type: "band", padding: 0}
    : {type: logarithmic ? "log" : "linear", nice: false, ...(logarithmic ? {} : {zero: false})};
  const format = numbers ? {format: most >= 1e6 || (least > 0 && least < 1e-3) ? "~e" : "~r"} : {};
  const channel = {
    field: which,
    type: numbers ? "quantitative" : "ordinal",
    scale,
    axis: {title, ...format, labelOverlap: true, grid: false},
  };
  return {
    numbers,
    count: distinct(rows.map(r => r[which])).length,
    around,
    title,
    channel,
    value: x => (numbers ? x : plain(x)),
  };
}

function map_rows(name) {
  const runs = records("maps").filter(r => r.map === name),
    x = map_axis(runs, "x"),
    y = map_axis(runs, "y");
  const tiles = runs.map(r => {
    const [left, right] = x.numbers ? x.around(r.x) : [],
      [below, upper] = y.numbers ? y.around(r.y) : [];
    return {
      kind: "tile",
      series: r.series,
      x: x.value(r.x),
      y: y.value(r.y),
      left,
      right,
      below,
      upper,
      outcome: r.outcome,
      detail: r.detail,
      tooltip: tooltip([
        ["scheme", spoken(r.series)],
        [x.title, r.x],
        [y.title, r.y],
        ["outcome", r.outcome],
        ["", r.detail],
      ]),
    };
  });
  const lines = x.numbers
    ? records("boundaries")
        .filter(b => b.map === name)
        .map(b => {
          const {x_low: low, x_high: high} = b;
          return {
            kind: "line",
            series: b.series,
            x: finite(low > 0 && high > 0 ? Math.sqrt(low * high) : (low + high) / 2),
            y: y.value(b.y),
            between: b.between,
            theory: finite(b.theory),
          };
        })
    : [];
  return {x, y, rows: [...tiles, ...lines]};
}
function map_layers({x, y, rows}, glyph) {
  const scale = k => ({
    domain: Object.keys(outcomes),
    range: Object.values(outcomes).map(o => o[k]),
  });
  const legend = {
    title: null,
    values: Object.keys(outcomes).filter(o => rows.some(t => t.outcome === o)),
    labelExpr: "replace(datum.label, '_', ' ')",
  };
  const edges = (axis, channel, from, to) =>
    axis.numbers
      ? {[channel]: {field: from, type: "quantitative"}, [channel + "2"]: {field: to}}
      : {};
  const line = (field, mark) => ({
    transform: [{filter: `datum.kind == 'line' && isValid(datum.${field})`}],
    mark: {type: "line", tooltip: null, ...mark},
    encoding: {x: {...x.channel, field}, detail: {field: "between"}, order: {field: "y"}},
  });
  return [
    {
      transform: [{filter: "datum.kind == 'tile'"}],
      mark: {type: "rect", stroke: "#fff", strokeWidth: 0.5},
      encoding: {
        ...edges(x, "x", "left", "right"),
        ...edges(y, "y", "below", "upper"),
        color: {field: "outcome", type: "nominal", scale: scale(0), legend},
        ...hover,
      },
    },
    {
      transform: [{filter: "datum.kind == 'tile' && datum.outcome != 'sound'"}],
      mark: {
        type: "point",
        filled: true,
        color: "#fff",
        opacity: 0.9,
        tooltip: null,
        size: {expr: `${glyph} * ${glyph}`},
      },
      encoding: {shape: {field: "outcome", type: "nominal", scale: scale(1), legend}},
    },
    line("x", {strokeWidth: 4, color: "#fff"}),
    line("x", {strokeWidth: 1.6, color: "#222", point: {size: 22, color: "#222"}}),
    line("theory", {strokeWidth: 4, color: "#fff"}),
    line("theory", {strokeWidth: 1.5, strokeDash: [6, 4], color: "#222"}),
  ];
}
function map_spec(name, choice, print) {
  const map = map_rows(name),
    {x, y} = map,
    encoding = {x: x.channel, y: y.channel};
  const glyph = (width, height) =>
    `clamp(0.45 * min(${width} / ${x.count}, ${height} / ${y.count}), 3, 9)`;
  if (!print) {
    const rows = map.rows.filter(row => row.series === choice.series_field);
    return {
      spec: framed(
        {
          height: 380,
          data: {values: rows},
          encoding,
          layer: map_layers({x, y, rows}, glyph("width", "height")),
        },
        {},
        false,
      ),
    };
  }
  // For papers: all schemes side by side.
  const facet = {
    field: "series",
    type: "nominal",
    title: null,
    sort: in_order(map.rows.map(t => t.series)),
    header: {labelFontSize: 9, labelLimit: 400},
  };
  const spec = {width: 230, height: 140, encoding, layer: map_layers(map, glyph(230, 140))};
  return {
    spec: framed(
      {
        width: undefined,
        data: {values: map.rows},
        facet,
        columns: 4,
        bounds: "flush",
        spacing: {row: 26, column: 18},
        spec,
      },
      {title: name, subtitle: records("maps").find(r => r.map === name).scene},
      true,
    ),
  };
}
function map_section() {
  const names = distinct(records("maps").map(r => r.map));
  if (!names.length) return null;
  const charts = names.map(name => {
    const ours = name => known().has(scheme_in(name)),
      series = in_order(
        records("maps")
          .filter(r => r.map === name)
          .map(r => r.series),
      ).sort((a, b) => ours(a) - ours(b)), // the reader's own scheme first
      menus = () => [
        {label: name + ": scheme", key: "series_field", choices: series.map(s => [s, spoken(s)])},
      ];
    return {
      name: "what becomes of a scheme: " + name,
      menus,
      spec: (choice, print) => map_spec(name, choice, print),
      twins: [{file: `map-${file_part(name, names)}.svg`, choice: first_choice(menus())}],
    };
  });
  const notes = [
    "Each tile is one run. White symbols repeat the colours for readers whom colour does " +
      "not help. Solid lines are boundaries found by bisection, broken ones what theory says.",
    ...distinct(records("boundaries").map(b => b.theory_holds_for))
      .filter(Boolean)
      .map(motion => `Broken lines hold for ${motion}.`),
  ];
  return {
    id: "maps",
    heading: "Where methods fail",
    notes,
    charts,
    table: without(table("boundaries"), ["problem", "series"]),
  };
}

// Counts runs and sound runs of each scheme on each map: [{series, map, sound, runs}].
function shares() {
  const count = new Map();
  for (const r of records("maps")) {
    if (["refused", "error"].includes(r.outcome)) continue;
    const key = r.series + "\n" + r.map,
      share = count.get(key) ?? {series: r.series, map: r.map, sound: 0, runs: 0};
    ++share.runs;
    share.sound += r.outcome === "sound";
    count.set(key, share);
  }
  const names = in_order(records("maps").map(r => r.series)),
    maps = distinct(records("maps").map(r => r.map));
  return names.flatMap(series => maps.map(map => count.get(series + "\n" + map)).filter(Boolean));
}
function overview_spec(choice, print) {
  const values = shares().map(s => ({
    ...s,
    share: (100 * s.sound) / s.runs,
    tooltip: tooltip([
      ["scheme", spoken(s.series)],
      ["map", s.map],
      ["sound runs", `${s.sound} of ${s.runs}`],
    ]),
  }));
  // All rows fit above the fold on the page.
  const step = print
    ? 20
    : Math.min(20, Math.max(11, 400 / distinct(values.map(s => s.series)).length));
  const axis = {title: null, grid: false, domain: false, ticks: false};
  const encoding = {
    x: {
      field: "map",
      type: "nominal",
      sort: null,
      axis: {...axis, labelAngle: -50, labelLimit: 130},
    },
    y: {
      field: "series",
      type: "nominal",
      sort: null,
      axis: {...axis, labelFontSize: choice.narrow ? 8 : 10, labelLimit: choice.narrow ? 180 : 250},
    },
  };
  const layer = [
    {
      mark: {type: "rect", cornerRadius: 2},
      encoding: {
        color: {
          field: "share",
          type: "quantitative",
          scale: {scheme: "viridis", domain: [0, 100]},
          legend: null,
        },
        ...hover,
      },
    },
    {
      mark: {type: "text", fontSize: 9, tooltip: null},
      encoding: {
        text: {field: "share", format: ".0f"},
        color: {condition: {test: "datum.share > 43", value: "#000"}, value: "#fff"},
      },
    },
  ];
  return {
    spec: framed(
      {
        ...(print ? {} : {title: {text: "sound runs, per cent", anchor: "start", fontSize: 12}}),
        ...(choice.narrow ? {width: {step: 24}} : {}),
        height: {step},
        data: {values},
        encoding,
        layer,
      },
      {title: "Sound runs, per cent", subtitle: page.title},
      print,
    ),
  };
}
function overview_section() {
  if (!records("maps").length) return null;
  const rows = shares().map(s => [s.series, s.map, s.sound, s.runs]);
  return {
    id: "overview",
    heading: "How often each scheme stays sound",
    charts: [
      {
        name: "the share of sound runs of each scheme on each map",
        wide_on_phones: true,
        spec: overview_spec,
        twins: [{file: "overview.svg", choice: {}}],
      },
    ],
    notes: [
      "Per cent of the runs of a map that end sound. Refused runs do not count; where " +
        "nothing stands the scheme was not run on the map.",
    ],
    table: {columns: ["scheme", "map", "sound", "runs"], rows},
  };
}
function finding_of_maps() {
  const all = shares(),
    names = distinct(all.map(s => s.series)),
    sum = (name, key) => all.reduce((n, s) => n + (s.series === name ? s[key] : 0), 0),
    share = name => sum(name, "sound") / sum(name, "runs"),
    words = name => `in ${sum(name, "sound")} of ${sum(name, "runs")} runs`,
    [best, ...rest] = [...names].sort().sort((a, b) => share(b) - share(a));
  if (!names.length) return "";
  const worst = rest.at(-1),
    most = `${best} stays sound ${words(best)}`;
  return worst ? `of ${names.length} schemes ${most}, ${worst} ${words(worst)}` : most;
}

// ---- A trimmed scene: the path from the whole scene, one thing less at each step, and the need
// for each part.
function path_spec(choice, print) {
  const steps = records("path").map((r, k, all) => ({
    label: `${r.step}. ${r.change}`,
    before: k ? `${all[k - 1].step}. ${all[k - 1].change}` : null,
    series: variant(r),
    cost: r.cost_s_per_s,
    cost_before: k ? all[k - 1].cost_s_per_s : null,
    error: r.error,
    target: r.target,
    tooltip: tooltip([
      ["", r.change],
      ["scheme", spoken(variant(r))],
      ["modes", r.modes],
      ["rate", kilohertz(r.rate)],
      ["cost", cost_text(r.cost_s_per_s, "cost_s_per_s")],
      ["error", r.error],
      ["uncertainty of the reference", r.certificate],
    ]),
  }));
  const names = in_order(steps.map(s => s.series)),
    {color, shape, strokeDash} = encodings_of(names),
    waveform = is_ratio(records("path")[0].measure);
  // A narrow page has the two charts below each other, and numbers for the lines as in the table.
  const small = choice.narrow || (print && print_width() < 500),
    width = choice.narrow
      ? Math.max(200, innerWidth - 120)
      : small
        ? print_width() - 30
        : Math.min(300, print_width() / 2.5);
  const y = {
    field: "label",
    type: "nominal",
    sort: null,
    axis: {
      title: null,
      labelLimit: 480,
      domain: false,
      ticks: false,
      ...(small ? {labelExpr: "split(datum.label, '. ')[0]"} : {}),
    },
  };
  const part = (more, layer) => ({
    width,
    height: {step: small ? 18 : 24},
    data: {values: steps},
    encoding: {y: {...y, axis: {...y.axis, ...more}}, color},
    layer,
  });
  const moved = {
    data: {values: steps.filter(s => s.before !== null)},
    mark: {type: "rule", strokeWidth: 1.6},
  };
  const left = part({}, [
    {
      ...moved,
      encoding: {
        x: {field: "cost_before", type: "quantitative"},
        x2: {field: "cost"},
        y: {...y, field: "before"},
        strokeDash,
      },
    },
    {
      ...moved,
      encoding: {
        x: {field: "cost", type: "quantitative"},
        y: {...y, field: "before"},
        y2: {field: "label"},
        strokeDash,
      },
    },
    points({
      x: quantity(
        "cost",
        {
          labelExpr:
            "datum.value < 1 ? format(1000*datum.value, '.3~r') + ' ms' : " +
            "format(datum.value, '.3~r') + ' s'",
          title: "computing time for one second of sound",
        },
        log(20),
      ),
      shape,
    }),
  ]);
  const right = part({labels: Boolean(small)}, [
    {
      mark: {type: "rule", strokeDash: [2, 3], opacity: 0.8, tooltip: null},
      encoding: {
        x: {field: "target", type: "quantitative", aggregate: "max"},
        y: null,
        color: null,
      },
    },
    points({
      x: quantity(
        "error",
        {
          labelExpr: waveform
            ? "format(100*datum.value, '.3~r') + ' %'"
            : "format(datum.value, '.3~r')",
          title: "error, " + records("path")[0].measure,
        },
        log(20),
      ),
      shape,
    }),
  ]);
  return {
    legend: names,
    spec: framed(
      {
        width: undefined,
        spacing: 24,
        ...(small ? {vconcat: [left, right]} : {hconcat: [left, right]}),
      },
      {
        title: page.title,
        subtitle: "each step leaves out one thing more; dotted: the tolerance",
        names,
      },
      print,
    ),
  };
}
function path_section() {
  if (!records("path").length) return null;
  return {
    id: "path",
    heading: "From the whole scene to the trimmed one",
    table: without(table("path"), []),
    notes: [
      "Costs are processor time, median of models timed in turn. Errors are from the " +
        "motion of the whole scene.",
    ],
    charts: [
      {
        name: "cost and error of each step from the whole scene to the trimmed one",
        scrolls: true,
        spec: path_spec,
        twins: [{file: "trim.svg", choice: {}}],
      },
    ],
  };
}
function needs_section() {
  return {
    id: "needs",
    heading: "What each part is needed for",
    table: without(table("needs"), []),
    notes: [
      "Error and saving of the whole scene without the part alone. A part is needed where " +
        "that error is beyond the tolerance.",
    ],
  };
}
const is_ratio = title => page.measures.some(([, , name, unit]) => name === title && unit === "1");
function finding_of_trim() {
  const path = records("path"),
    first = path[0],
    last = path.at(-1);
  if (!last) return "";
  const scene = page.trimmed,
    {target} = last,
    within = is_ratio(last.measure) ? `${digits(100 * target, 6)} %` : `${digits(target, 6)} dB`;
  if (last.within !== "yes") return `No model of ${scene} within ${within} was found`;
  return (
    `${scene} within ${within}: the trimmed model costs ` +
    `${digits(first.cost_s_per_s / last.cost_s_per_s, 2)} times less than ` +
    "the whole scene as published"
  );
}
