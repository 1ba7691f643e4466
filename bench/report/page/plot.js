// plot.py beside the tables: the first chart by matplotlib, with the looks that schemes have
// everywhere.
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
        const points = own.map(p => [p.x, p.from ?? p.x, p.to ?? p.x, p.y]);
        return [spoken(name), look.colour, marks[look.shape] ?? "*", look.dash, points];
      });
      return [scene, title, bands_of(of_scene(cells(), scene), column), lines];
    });
  if (!scenes.length) return "";
  const python = value =>
    JSON.stringify(value)
      .replaceAll("null", "None")
      .replaceAll("true", "True")
      .replaceAll("false", "False");
  return `#!/usr/bin/env python3
"""Draws error against cost of this folder: python3 plot.py [OUT.pdf [SCENE [WIDTH_MM]]]

A line is (name, colour, marker, dash, points), a point its cost, the quartiles of that, and its
error. Errors that are only bounded stand at their upper bound, as in work_precision.svg."""
import pathlib
import sys

import matplotlib
matplotlib.use("Agg")
from matplotlib import pyplot

# scene: title of the error, what is known (floor, certificate), lines
SCENES = {
${scenes
  .map(
    ([scene, title, bands, lines]) =>
      `    ${python(scene)}: (` +
      [title, [bands.floor, bands.certificate]].map(python).join(", ") +
      `, [\n${lines.map(line => `        ${python(line)},\n`).join("")}    ]),\n`,
  )
  .join("")}}

folder = pathlib.Path(__file__).resolve().parent
out = sys.argv[1] if len(sys.argv) > 1 else str(folder / "work_precision.pdf")
scene = sys.argv[2] if len(sys.argv) > 2 else next(iter(SCENES))
width = float(sys.argv[3]) / 25.4 if len(sys.argv) > 3 else 7
title, (floor, certificate), lines = SCENES[scene]

figure, axes = pyplot.subplots(figsize=(width, 0.65 * width), layout="constrained")
for name, colour, marker, dash, points in lines:
    cost, lower, upper, error = zip(*points)
    spread = [[c - low for c, low in zip(cost, lower)], [high - c for c, high in zip(cost, upper)]]
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
