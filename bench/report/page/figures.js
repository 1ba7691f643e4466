// Figures of a suite (bench/suites/NAME.vl.json): Vega-Lite whose data is a table of the folder, by its name. Fields that are numbers are numbers. The
// table "levels" has the spectrograms of its cells: a row for each tile, with its cell's columns.
function figure_rows(name, where) {
  const all = name === "levels" ? level_rows() : records(name);
  if (!all.length) throw new Error(`there is no table ${name}`);
  const value = text => text !== "" && !Number.isNaN(number(text)) ? number(text) : text;
  const rows = all.map(r => Object.fromEntries(Object.entries(r).map(([key, text]) => [key, typeof text === "string" ? value(text) : text])));
  const chosen = rows.filter(r => Object.entries(where ?? {}).every(([key, wanted]) => [wanted].flat().includes(r[key])));
  if (!chosen.length) throw new Error(`table ${name}: no row is left to draw`);
  return chosen;
}
function level_rows() {
  const panels = heard_cells().filter(p => p.levels), frame = tiled(panels, 700 * panels.length);
  return panels.flatMap(p => p.tiles.map(t => ({...p.cell, ...t, bounds: undefined, told: undefined, last: frame.last})));
}
function fields_of(spec) {  // columns that are asked for by name
  if (Array.isArray(spec)) return spec.flatMap(fields_of);
  if (spec === null || typeof spec !== "object") return [];
  return Object.entries(spec).flatMap(([key, value]) => key === "field" && typeof value === "string" ? [value] : key === "data" ? [] : fields_of(value));
}
const figure_config = {font, aria: false, axis: {gridOpacity: 0.45, labelFontSize: 11, titleFontSize: 12}, title: {fontSize: 16, subtitleFontSize: 12, anchor: "start", offset: 14, subtitlePadding: 5}, header: {title: null, labelFontSize: 12, labelFontWeight: "bold", labelAnchor: "start"},
                       line: {strokeWidth: 1.4, clip: true}, mark: {color: families[0][2]}, legend: {title: null, orient: "bottom", direction: "horizontal", columns: 3, labelFontSize: 12, labelLimit: 500, symbolStrokeWidth: 3}, range: {category: families.slice(0, -1).map(f => f[2])}};
function figure_spec(figure) {
  const fill = part => {  // tables in, titles in lines
    if (part === null || typeof part !== "object") return part;
    if (Array.isArray(part)) return part.map(fill);
    const whole = Object.fromEntries(Object.entries(part).map(([key, value]) => [key, fill(value)]));
    if (part.data?.name) {
      const values = figure_rows(part.data.name, part.data.where), made = JSON.stringify(part.transform ?? []), absent = fields_of({...part, transform: undefined}).find(f => !(f in values[0]) && !made.includes(`"${f}"`));
      if (absent) throw new Error(`table ${part.data.name}: there is no column ${absent}; it has ${Object.keys(values[0]).filter(k => k !== "n").join(", ")}`);
      const used = new Set([...fields_of(part), ...Object.keys(values[0]).filter(k => made.includes(k))]);
      whole.data = {values: values.map(r => Object.fromEntries([...used].filter(k => k in r).map(k => [k, r[k]])))};
    }
    if (part.title?.text) {
      const width = part.title.width ?? 700;
      whole.title = {text: wrapped(part.title.text, Math.floor(width / 12.8)), subtitle: wrapped(part.title.subtitle ?? "", Math.floor(width / 9.6))};
    }
    return whole;
  };
  const spec = fill(figure);
  wear_looks(spec, in_order(schemes_in(spec)));
  return {$schema: vega_lite, background: "white", padding: 12, config: figure_config, ...spec};
}
function schemes_in(part) {
  if (part === null || typeof part !== "object") return [];
  return part.data?.values ? distinct(part.data.values.map(r => r.scheme).filter(Boolean)) : Object.values(part).flatMap(schemes_in);
}
// A scheme has the colour and the marker that it has everywhere.
function wear_looks(part, names) {
  if (part === null || typeof part !== "object" || !names.length) return;
  for (const channel of ["color", "shape"]) {
    const encoding = part.encoding?.[channel];
    if (encoding?.field === "scheme") encoding.scale ??= encodings_of(names)[channel].scale;
  }
  for (const [key, inner] of Object.entries(part)) if (key !== "data") wear_looks(inner, names);
}
