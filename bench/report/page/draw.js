// Draws every picture of the charts from page.json in the same folder, under node, after the other
// files: `node draw.js`. drawn.json lists the files written, and each failure with a reason.
// Scales a picture to the requested width exactly: axes beside the plot make the width differ a
// little from the plan.
function sized(svg) {
  const [whole, before, width, height] =
      svg.match(/^<svg([^>]*?) width="([\d.]+)" height="([\d.]+)"/) ?? [],
    mm = (page.width * 25.4) / 96;
  return page.width && whole
    ? svg.replace(
        whole,
        `<svg${before} width="${mm.toFixed(2)}mm" height="${((mm * height) / width).toFixed(2)}mm"`,
      )
    : svg;
}
async function draw_all() {
  const fs = require("fs"),
    vega = require("vega"),
    lite = require("vega-lite"),
    drawn = [],
    failed = [];
  const draw = async (file, make) => {
    try {
      const spec = make(),
        log = vega.logger(vega.Error);
      const view = new vega.View(vega.parse(lite.compile(spec, {logger: log}).spec), {
        renderer: "none",
        logLevel: vega.Error,
      });
      fs.writeFileSync(file, sized(await view.toSVG()));
      drawn.push(file);
    } catch (error) {
      failed.push([file, error.message ?? String(error)]);
    }
  };
  for (const section of sections_of())
    for (const chart of section.charts)
      for (const twin of chart.twins)
        await draw(twin.file, () => chart.spec(twin.choice, true).spec);
  fs.writeFileSync("drawn.json", JSON.stringify({drawn, failed}));
}
