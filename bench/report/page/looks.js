// Looks of schemes, the same in every chart, picture and suite: the hue tells the family, the
// marker the scheme within the family, the dash the options. Controls are thin and grey. Names
// unknown to the program (plugins) take the remaining looks in alphabetical order.
//
// Colours: a search maximised the smallest distance in CIELAB between families, with normal sight
// and without one kind of cones (Machado, Oliveira & Fernandes 2009), at a contrast of 3 or more
// to the page. tests/browser/page.mjs measures both.
// Families in the order of legends: name, prefix for names of schemes, colours on a light and on a
// dark page.
const families = [
  ["two-moment and two-point", "modal_two_", "#0d44e1", "#3799e1"],
  ["quadratised", "modal_quadratised", "#480588", "#9a38f7"],
  ["spatial", "modal_spatial", "#0a722e", "#25ff90"],
  ["grid", "finite_difference", "#c07c00", "#e0a326"],
  ["sitar", "sitar_", "#610a2d", "#da0a42"],
  ["control", null, "#767676", "#8d959c"],
  ["other", null, "#81347f", "#994195"],
];
const control_family = families.length - 2,
  other_family = families.length - 1;
const shapes = [
  "circle",
  "diamond",
  "square",
  "triangle-up",
  "triangle-down",
  "cross",
  "triangle-right",
  "triangle-left",
  "wedge",
  "arrow",
  "M0,-.5L.12,-.16L.48,-.16L.19,.06L.3,.4L0,.2L-.3,.4L-.19,.06L-.48,-.16L-.12,-.16Z",
]; // a star
// Ink for a difference, the page's blue for the tolerance.
const ink = ["#1d2329", "#e6eaee"],
  key = ["#0072b2", "#56b4e9"],
  paper = ["#ffffff", "#14181c"];
const dark_of = Object.fromEntries([
  ...families.map(([, , light, dark]) => [light, dark]),
  ink,
  key,
  paper,
]);

let known_schemes = null; // name: {family, place in the family, control}
function known() {
  if (known_schemes) return known_schemes;
  const count = families.map(() => 0);
  known_schemes = new Map(
    page.schemes.map(([name, control]) => {
      const found = families.findIndex(([, prefix]) => prefix !== null && name.startsWith(prefix)),
        family = control ? control_family : found < 0 ? other_family : found;
      return [name, {family, place: count[family]++, control}];
    }),
  );
  return known_schemes;
}

// Series and variants by name: {scheme, options, variant}, as the tables have them.
let known_series = null;
function series_of(name) {
  known_series ??= new Map(
    Object.keys(page.tables)
      .flatMap(records)
      .filter(r => r.scheme)
      .flatMap(r => [r.series, variant(r)].map(key => [key, r]))
      .map(([key, r]) => [key, {scheme: r.scheme, options: options_of(r), variant: variant(r)}]),
  );
  return known_series.get(name) ?? {scheme: name, options: [], variant: name};
}
const scheme_in = name => series_of(name).scheme;

// Dash for options: matched is dashed, as published dotted; further options add a dot.
const dashes = {matched: [6, 3], own: [2, 3]};
function dash_of(name) {
  const {scheme, options, variant} = series_of(name);
  if (name === scheme) return [1, 0];
  const dash = dashes[Object.fromEntries(options).compliance];
  if (dash) return options.length === 1 && name === variant ? dash : [...dash, 1, dash[1]];
  let hash = 0;
  for (const letter of name.slice(scheme.length)) hash = (31 * hash + letter.charCodeAt(0)) >>> 0;
  return [
    [10, 3],
    [4, 2],
    [1, 2],
  ][hash % 3];
}

// Looks by name ("modal_two_point compliance=matched" or "modal_two_point, 40 modes"): {family,
// control, colour, shape, dash}.
function looks_of(names) {
  const unknown = distinct(names.filter(name => !known().has(scheme_in(name)))).sort();
  return new Map(
    names.map(name => {
      const k = known().get(scheme_in(name));
      if (k)
        return [
          name,
          {
            ...k,
            colour: families[k.family][2],
            shape: shapes[k.place % shapes.length],
            dash: dash_of(name),
          },
        ];
      // A pairing belongs to the string's family,
      const place = unknown.indexOf(name),
        begins = families.findIndex(([, prefix]) => prefix !== null && name.startsWith(prefix));
      const of =
        begins < 0 && [...known().keys()].some(string => name.startsWith(string + "_"))
          ? other_family
          : begins;
      // other names take the families' hues with other markers.
      const hue = of >= 0 ? of : place === 0 ? other_family : (place - 1) % control_family;
      return [
        name,
        {
          family: of >= 0 ? of : other_family,
          control: false,
          colour: families[hue][2],
          shape: shapes[(place + 3) % shapes.length],
          dash: of >= 0 ? dash_of(name) : [1, 0],
        },
      ];
    }),
  );
}
function in_order(names) {
  // The order of a legend: family by family, controls last.
  const key = name => {
    const {family, place} = known().get(scheme_in(name)) ?? {
      ...looks_of([name]).get(name),
      place: 0,
    };
    return 100 * (family === control_family ? other_family + 1 : family) + place;
  };
  return distinct(names).sort((a, b) => key(a) - key(b));
}

// Name of a scheme in a sentence; tables keep the options in their own form.
function spoken(name, own = ", as published") {
  const {scheme, options, variant} = series_of(name),
    words = {"compliance=matched": ", matched", "compliance=own": own};
  const all = options.map(option => option.join("=")).map(text => words[text] ?? " " + text);
  return scheme + all.join("") + name.slice(variant.length);
}

// Vega-Lite encodings for the series: {color, shape, strokeDash}. The legend is drawn apart, with
// line and marker together.
function encodings_of(names, field = "series") {
  const looks = looks_of(names),
    of = what => ({
      field,
      type: "nominal",
      scale: {domain: names, range: names.map(name => looks.get(name)[what])},
      legend: null,
    });
  return {color: of("colour"), shape: of("shape"), strokeDash: of("dash")};
}

const vega_lite = "https://vega.github.io/schema/vega-lite/v5.json",
  font = "system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', sans-serif";
// Width of the plot in a picture [px]; the axis takes the rest.
const print_width = () => (page.width ? page.width - 76 : 760);
const chart_config = {
  font,
  view: {stroke: null},
  axis: {gridOpacity: 0.45, domainOpacity: 0.6, labelFontSize: 11},
  title: {fontSize: 16, subtitleFontSize: 12},
};
// Wraps text: without a screen Vega counts 0.8 of the font size per letter, and makes the picture
// as wide as the longest line.
function wrapped(text, length) {
  const lines = [""];
  for (const word of text.split(" "))
    if (lines.at(-1) && lines.at(-1).length + 1 + word.length > length) lines.push(word);
    else lines[lines.length - 1] += (lines.at(-1) && " ") + word;
  return lines;
}
function title_of(text, subtitle) {
  const size = print_width() < 500 ? 12 : 16,
    small = print_width() < 500 ? 10 : 12,
    across = print_width() + 40;
  return {
    text: wrapped(text, Math.floor(across / (0.8 * size))),
    subtitle: subtitle ? wrapped(subtitle, Math.floor(across / (0.8 * small))) : "",
    fontSize: size,
    subtitleFontSize: small,
    anchor: "start",
    offset: print_width() < 500 ? 10 : 26,
    subtitlePadding: 5,
  };
}

// Chart for the page, with the width and the colours of the page, or for a picture: on white with a
// title and a legend.
function framed(spec, {title, subtitle = "", names = []}, print) {
  const own = {width: print ? print_width() : "container", ...spec};
  // `picked`: names brought out in the legend; none means all.
  const params = [{name: "picked", value: []}, ...(spec.params ?? [])];
  delete own.params;
  if (own.width === undefined) delete own.width; // the parts have their own widths
  if (!print) return {$schema: vega_lite, padding: 12, params, ...own, config: chart_config};
  const legend =
    names.length < 2
      ? {}
      : own.layer
        ? {layer: [...own.layer, ...legend_layers(names, "height + 62")]}
        : {
            vconcat: [own, {width: print_width(), height: 1, layer: legend_layers(names, "4")}],
            spacing: 44,
          };
  return {
    $schema: vega_lite,
    padding: 12,
    title: title_of(title, subtitle),
    background: "white",
    params,
    ...(legend.vconcat ? {} : own),
    ...legend,
    config: chart_config,
  };
}
function legend_layers(names, top) {
  // Draws each name with line and marker.
  const across = print_width() > 500 ? 2 : 1,
    at = text => ({expr: text}),
    y = at(`${top} + datum.down`),
    {color, shape, strokeDash} = encodings_of(names);
  const data = {
    values: names.map((series, k) => ({
      series,
      text: spoken(series),
      down: 17 * Math.floor(k / across),
      left: (print_width() / across) * (k % across),
    })),
  };
  const part = (mark, encoding, rows = data) => ({
    data: rows,
    mark: {tooltip: null, y, ...mark},
    encoding: {x: null, y: null, ...encoding},
  });
  const ends = {values: data.values.flatMap(row => [row, {...row, left: row.left + 34}])};
  return [
    part({type: "line", strokeWidth: 1.8, x: at("datum.left")}, {color, strokeDash}, ends),
    part(
      {type: "point", filled: true, opacity: 1, size: 60, x: at("datum.left + 17")},
      {color, shape},
    ),
    part(
      {
        type: "text",
        align: "left",
        fontSize: print_width() < 500 ? 10 : 11,
        x: at("datum.left + 42"),
      },
      {text: {field: "text"}},
    ),
  ];
}

// ---- Parts for many charts
// Mark without rows.
const once = mark => ({
  data: {values: [{}]},
  mark: {tooltip: null, clip: false, ...mark},
  encoding: {x: null, y: null},
});
// Name of an axis, upright; over a narrow plot it begins above the axis's labels.
const above = text =>
  once({
    type: "text",
    x: {expr: "width < 400 ? -24 : 0"},
    y: -10,
    align: "left",
    fontSize: 12,
    fontWeight: "bold",
    text,
  });
const quantity = (field, axis = {}, scale = {}) => ({
  field,
  type: "quantitative",
  scale,
  axis: {title: null, labelOverlap: true, ...axis},
});
const log = padding => ({type: "log", nice: false, padding});
let measures_by_error = null; // error name: [column, axis, title, unit, kind]
function measure_of(error) {
  measures_by_error ??= new Map(
    page.measures.flatMap(m => all_taps().map(tap => [error_name({measure: m[0], tap}), m])),
  );
  return measures_by_error.get(error) ?? [];
}
const is_percent = error => measure_of(error)[4] === "waveform";
const unit_of_error = error => measure_of(error)[3];
const error_text = (x, error) =>
  unit_of_error(error) === "1" ? percent(x) : `${digits(x, 2)}\u00a0${unit_of_error(error)}`;
// Labels decades; on an axis below three decades 2 and 5 as well. `text`: expression for a
// label.
function decades(channel, text) {
  const digit = "round(pow(10, log(datum.value)/LN10 - floor(log(datum.value)/LN10 + 1e-9)))",
    shown =
      `(${digit} == 1 || (domain('${channel}')[1]/domain('${channel}')[0] < 1000 && ` +
      `indexof([2, 5], ${digit}) >= 0))`,
    only = value => ({condition: {test: shown, value}, value: 0});
  return {
    title: null,
    labelOverlap: true,
    labelExpr: `${shown} ? (${text}) : ''`,
    gridOpacity: only(0.6),
    tickOpacity: only(1),
  };
}
const plain_number =
  "datum.value < 1e-3 || datum.value >= 1e6 ? format(datum.value, '~e') : " +
  "format(datum.value, ',~r')";
const error_axis = (error, channel = "y") =>
  decades(channel, is_percent(error) ? "format(100*datum.value, ',~r') + ' %'" : plain_number);
const brought_out = {
  condition: {test: "!length(picked) || indexof(picked, datum.series) >= 0", value: 1},
  value: 0.1,
};
// Tooltip: pairs of name and value, without empty values.
const tooltip = pairs => Object.fromEntries(pairs.filter(([, value]) => !is_blank(value)));
const hover = {tooltip: {field: "tooltip", type: "nominal"}};
// Zooms by wheel or pinch with Ctrl, by dragging, and by the page's buttons (chart.js), which set
// the signals zoom_FIELD.
const zoomed = (...channels) => ({
  params: [
    {
      name: "zoom",
      select: {type: "interval", encodings: channels, zoom: "wheel![event.ctrlKey]"},
      bind: "scales",
    },
  ],
});
const points = (encoding, more = {}) => ({
  mark: {type: "point", filled: true, opacity: 1, size: 60, ...more},
  encoding: {...encoding, ...hover},
});
