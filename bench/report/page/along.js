// Errors against the sample rate, with the observed order, and against a key that a suite sweeps.

// ---- Error against rate
// Text of an observed order with its interval; "" if the interval is wider than the order, or if
// two rates leave no interval: then the order is unknown.
function order_text(order, half_width) {
  return Number.isFinite(order) && 2 * half_width <= Math.abs(order)
    ? `${order.toFixed(2)} \u00b1 ${digits(half_width, 2)}`
    : "";
}
// Orders by "scene|series|error", {order, text}: from convergence.csv if measured there, otherwise
// from the cells.
function orders() {
  const all = new Map(),
    add = (o, error) =>
      all.set(`${o.problem}|${o.series}|${error_name(error)}`, {
        order: o.order,
        text: order_text(o.order, o.half_width),
      });
  for (const o of records("orders")) add(o, o);
  for (const o of records("convergence")) add(o, {measure: "error_l2_" + o.window, tap: o.tap});
  return all;
}

function convergence_spec(choice, print) {
  const rows = of_scene(cells(), choice.scene),
    {column: error, title} = chosen_error(rows, choice),
    known = orders();
  const all = points_of(rows, error, "rate").filter(
      p => p.status === "ok" && p.rate > 0 && p.y > 0,
    ),
    names = in_order(all.map(p => p.series)),
    {color, shape, strokeDash} = encodings_of(names);
  const order_of = p => known.get(`${choice.scene}|${p.series}|${error}`);
  for (const p of all)
    p.tooltip = tooltip([
      ["scheme", spoken(p.series)],
      ["rate", p.label],
      ["error", error_text(p.y, error)],
      ["order", order_of(p)?.text],
    ]);
  const ends = names
    .map(name => all.filter(p => p.series === name).reduce((a, b) => (b.rate > a.rate ? b : a)))
    .filter(p => order_of(p)?.text && !p.control)
    .sort((a, b) => a.y - b.y);
  const labels = ends
    .filter((p, k) => k === 0 || p.y > 1.15 * ends[k - 1].y)
    .map(p => ({rate: p.rate, y: p.y, text: order_of(p).order.toFixed(2)}));
  const shown = all.filter(p => p.y < 1),
    from = Math.min(...shown.map(p => p.rate)),
    to = Math.max(...shown.map(p => p.rate)),
    bottom = Math.min(...shown.map(p => p.y));
  const triangles = !(to > from)
    ? []
    : [1, 2].flatMap(p => {
        const run = Math.min(2, Math.sqrt(to / from)),
          left = from * (p === 1 ? 1 : 1.12 * run);
        return [0, 1, 2, 3].map(corner => ({
          p,
          corner,
          rate: corner === 1 ? left * run : left,
          y: bottom * (corner % 3 === 0 ? run ** p : 1),
          text: "order " + p,
        }));
      });
  const layer = [
    {
      data: {values: all},
      mark: "line",
      encoding: {
        color,
        strokeDash,
        strokeWidth: {condition: {test: "datum.control", value: 0.8}, value: 1.6},
        opacity: brought_out,
      },
    },
    {
      data: {values: all},
      ...points({color, shape, opacity: brought_out}),
      ...(print || choice.narrow ? {} : zoomed("x", "y")),
    },
    {
      data: {values: labels},
      mark: {type: "text", align: "left", dx: 7, fontSize: 10},
      encoding: {text: {field: "text"}},
    },
    {
      data: {values: triangles},
      mark: {type: "line", strokeWidth: 1, color: "#888", tooltip: null},
      encoding: {detail: {field: "p"}, order: {field: "corner"}},
    },
    {
      data: {values: triangles.filter(t => t.corner === 2)},
      mark: {type: "text", align: "left", baseline: "top", dy: 4, fontSize: 10},
      encoding: {text: {field: "text"}},
    },
    above(title),
  ];
  const x = quantity(
    "rate",
    {
      ...decades("x", "format(datum.value / 1000, ',~r')"),
      labelExpr: "format(datum.value / 1000, ',~r')",
      title: "sample rate [kHz]",
    },
    log(30),
  );
  return {
    legend: names,
    spec: framed(
      {
        height: print ? Math.min(420, Math.max(220, 0.75 * print_width())) : 420,
        encoding: {x, y: quantity("y", error_axis(error), log(20))},
        layer,
      },
      {
        title: `${choice.scene}: convergence`,
        subtitle:
          "error against sample rate; at the lines' ends the observed order, at the lower " +
          "left those of 1 and 2",
        names,
      },
      print,
    ),
  };
}

function convergence_section() {
  const found = records("orders"),
    scenes = distinct(found.map(o => o.problem));
  if (!scenes.length) return null;
  const menus = scene => error_menus(of_scene(cells(), scene));
  const twins = scenes
    .slice(0, most_twins)
    .map(scene => ({
      file: twin_file("convergence", scene, scenes),
      choice: first_choice(menus(scene), scene),
    }));
  const wanted = error =>
    [
      errors_in(of_scene(cells(), scenes[0]))[0].column,
      "error_l2_10ms",
      "error_l2_whole",
      "third_octave_db",
    ].includes(error);
  const of_cells = found
    .filter(o => wanted(error_name(o)))
    .map(o => [o.problem, o.series, error_name(o), o.order, o.half_width, o.points]);
  const own = {
    columns: ["scene", "scheme", "error", "order", "half_width", "points"],
    rows: of_cells,
  };
  return {
    id: "convergence",
    heading: "Convergence",
    charts: [
      {
        name: "error against sample rate of each scheme",
        menus,
        scenes,
        spec: convergence_spec,
        twins,
      },
    ],
    notes: [
      "The number at a line's end is the observed order p of error \u221d rate^\u2212p " +
        "over the rates drawn; hover for its 95 % interval. There is no number where that " +
        "interval is wider than the order. The triangles at the lower left fall as orders 1 " +
        "and 2 do. Near contact the order is about 1, and late windows saturate.",
    ],
    table: records("convergence").length
      ? without(table("convergence"), ["problem", "series"])
      : scenes.length > 1
        ? own
        : without(own, ["scene"]),
  };
}

// ---- Error against a swept key: a line per scheme, one rate at a time. Other swept keys tell
// lines apart. The number of modes is a swept key for schemes with several numbers at one rate; a
// grid has another number at each rate, and is left out.
const swept_keys = () => {
  const columns = table("cells").columns,
    from = columns.indexOf("scene"),
    to = columns.indexOf("scheme");
  return from < 0 || to <= from ? [] : columns.slice(from + 1, to);
};
const variant = c => c.scheme + (c.options ? " " + c.options : "");
// Cells with a number in column `key`. If `key` is the modes, modes do not tell series apart.
function cells_along(key, keys) {
  const rows = cells().filter(
    c =>
      c.status !== "refused" &&
      Number.isFinite(c[key]) &&
      (key !== "modes" || c.series !== variant(c)),
  );
  return rows.map(c => ({
    ...c,
    base: c.scene ?? page.title,
    at: c[key],
    along: key === "modes" ? variant(c) : c.series,
    others: keys
      .filter(other => other !== key && !is_blank(c[other]))
      .map(other => `${other} = ${c[other]}`)
      .join(", "),
  }));
}
function sweep_chart(key, keys) {
  const rows = cells_along(key, keys),
    bases = distinct(rows.map(c => c.base)),
    rates = distinct(rows.map(c => c.rate).filter(Number.isFinite)).sort((a, b) => a - b);
  if (distinct(rows.map(c => c.at)).length < 2 || !errors_in(rows).length || !rates.length)
    return null;
  const menus = scene => {
    const own = cells().find(c => c.problem === scene)?.scene,
      first = bases.includes(own) ? own : bases[0];
    return [
      {
        label: "string",
        key: "base_field",
        choices: [first, ...bases.filter(b => b !== first)].map(b => [b, b]),
      },
      {label: "rate", key: "rate_field", choices: rates.map(r => [r, kilohertz(r)])},
      ...error_menus(rows),
    ];
  };
  const least = Math.min(...rows.map(c => c.at)),
    most = Math.max(...rows.map(c => c.at));
  const spec = (choice, print) => {
    const {column: error, title} = chosen_error(rows, choice),
      place = new Map(rows.map(c => [c.n, c]));
    const all = points_of(
      rows.filter(c => c.base === choice.base_field && c.rate === choice.rate_field),
      error,
      "rate",
      "along",
    ).filter(p => p.status === "ok" && p.y > 0);
    for (const p of all) Object.assign(p, {at: place.get(p.n).at, others: place.get(p.n).others});
    for (const p of all)
      p.tooltip = tooltip([
        ["scheme", spoken(p.series)],
        [with_unit(key), digits(p.at, 6)],
        ["at", p.others],
        ["error", error_text(p.y, error)],
        ["modes", p.modes],
        ["not to be trusted", p.flags],
      ]);
    const names = in_order(all.map(p => p.series)),
      {color, shape, strokeDash} = encodings_of(names),
      opacity = brought_out,
      scale = least > 0 && most > 5 * least ? log(24) : {zero: false, nice: false, padding: 24};
    const layer = [
      {
        data: {values: all},
        mark: {type: "line", strokeWidth: 1.6},
        encoding: {color, strokeDash, opacity, detail: {field: "others"}},
      },
      {data: {values: all.filter(p => p.flags === "")}, ...points({color, shape, opacity})},
      {
        data: {values: all.filter(p => p.flags !== "")},
        ...points({color, shape, opacity}, {filled: false, strokeWidth: 1.6}),
      },
      above(title),
    ];
    return {
      legend: names,
      spec: framed(
        {
          height: 380,
          encoding: {
            x: quantity("at", {title: with_unit(key), format: "~g"}, scale),
            y: quantity("y", error_axis(error), log(20)),
          },
          layer,
        },
        {
          title: `${choice.base_field}: error along ${key}`,
          subtitle: kilohertz(choice.rate_field),
          names,
        },
        print,
      ),
    };
  };
  const twins = bases
    .map(base => ({
      file: twin_file("sweep-" + file_part(key, keys), base, bases),
      choice: {...first_choice(menus()), base_field: base},
    }))
    .slice(0, most_twins);
  return {name: "error along " + key, menus, spec, twins};
}
function sweep_section() {
  const keys = [...swept_keys(), "modes"],
    charts = keys.map(key => sweep_chart(key, keys)).filter(Boolean);
  const notes = [
    (keys.length > 1
      ? "Each value of a scene's key is a scene of its own, with a reference of its own. "
      : "") + "Hollow points are not to be trusted.",
  ];
  return charts.length ? {id: "sweep", heading: "Error along what is swept", notes, charts} : null;
}
