// plot.py beside the tables: the first chart by matplotlib, with the looks that schemes have
// everywhere, from the rows of cells.csv.
function plot_program() {
  const marks = {
    circle: "o",
    diamond: "D",
    square: "s",
    "triangle-up": "^",
    "triangle-down": "v",
    cross: "P",
    "triangle-right": ">",
    "triangle-left": "<",
    wedge: "1",
    arrow: "2",
  };
  const scenes = scenes_of_cells()
    .filter(
      scene =>
        errors_in(of_scene(cells(), scene)).length &&
        has_finite(of_scene(cells(), scene), "cost_s_per_s"),
    )
    .map(scene => {
      const {column, title} = errors_in(of_scene(cells(), scene))[0],
        all = points_of(of_scene(cells(), scene), column, "cost_s_per_s", "line").filter(is_sound),
        names = in_order(all.map(p => p.series)),
        looks = looks_of(names);
      const lines = names.map(name => {
        const own = all.filter(p => p.series === name).sort((a, b) => a.order - b.order),
          look = looks.get(name);
        return [spoken(name), look.colour, marks[look.shape] ?? "*", look.dash, own.map(p => p.n)];
      });
      return [
        scene,
        column,
        title,
        bands_of(of_scene(cells(), scene), column),
        Object.fromEntries(all.filter(p => cells()[p.n].bounds[column]).map(p => [p.n, p.y])),
        lines,
      ];
    });
  if (!scenes.length) return "";
  const python = value =>
    JSON.stringify(value)
      .replaceAll("null", "None")
      .replaceAll("true", "True")
      .replaceAll("false", "False");
  return `#!/usr/bin/env python3
"""Draws error against cost of this folder: python3 plot.py [OUT.pdf [SCENE [WIDTH_MM]]]

A line is (name, colour, marker, dash, rows of the table). Errors that are only bounded stand at
their upper bound, as in work_precision.svg."""
import csv
import pathlib
import sys

import matplotlib
matplotlib.use("Agg")
from matplotlib import pyplot

# scene: error column, its title, what is known (floor, certificate), {row: upper bound}, lines
SCENES = {
${scenes
  .map(
    ([scene, column, title, bands, bounds, lines]) =>
      `    ${python(scene)}: (` +
      [column, title, [bands.floor, bands.certificate]].map(python).join(", ") +
      ", {" +
      Object.entries(bounds)
        .map(([n, y]) => `${n}: ${y}`)
        .join(", ") +
      `}, [\n${lines.map(line => `        ${python(line)},\n`).join("")}    ]),\n`,
  )
  .join("")}}

folder = pathlib.Path(__file__).resolve().parent
table = folder / "cells.csv"
if table.exists():
    cells = list(csv.DictReader(open(table, newline="")))
else:  # a record keeps errors and costs apart
    names = ("errors.csv", "cost.csv")
    tables = [csv.DictReader(open(folder / name, newline="")) for name in names]
    cells = [errors | costs for errors, costs in zip(*tables)]
out = sys.argv[1] if len(sys.argv) > 1 else str(folder / "work_precision.pdf")
scene = sys.argv[2] if len(sys.argv) > 2 else next(iter(SCENES))
width = float(sys.argv[3]) / 25.4 if len(sys.argv) > 3 else 7
column, title, (floor, certificate), bounds, lines = SCENES[scene]

figure, axes = pyplot.subplots(figsize=(width, 0.65 * width), layout="constrained")
for name, colour, marker, dash, rows in lines:
    cost = [float(cells[row]["cost_s_per_s"]) for row in rows]
    error = [bounds.get(row) or float(cells[row][column]) for row in rows]
    spread = [[c - float(cells[row]["cost_lower"]) for c, row in zip(cost, rows)],
              [float(cells[row]["cost_upper"]) - c for c, row in zip(cost, rows)]]
    axes.errorbar(cost, error, xerr=spread, color=colour, marker=marker, markersize=4,
                  linewidth=1.2, linestyle=(0, dash if dash[1] else []), label=name)
axes.set(xscale="log", yscale="log", ylabel=title, title=scene,
         xlabel="computing time for one second of sound, one core [s]")
low, high = axes.get_ylim()
for level, colour in ((certificate, "#56b4e9"), (floor, "#888888")):
    if level and level > low:
        axes.axhspan(low, level, color=colour, alpha=0.16, linewidth=0)
axes.axvline(1, color="#888888", linewidth=0.8)
axes.set_ylim(low, high)
axes.legend(fontsize="x-small")
figure.savefig(out)
print(out)
`;
}
