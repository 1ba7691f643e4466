// node draw.js N: spec.0.json ... beside it, Vega-Lite, become 0.svg ...; what cannot be drawn says why in 0.said. One process for all: node and its
// libraries take longer to load than a picture takes to draw.
const fs = require("fs"), vega = require("vega"), lite = require("vega-lite");
(async () => {
  for (let k = 0; k < Number(process.argv[2]); ++k) {
    try {
      const view = new vega.View(vega.parse(lite.compile(JSON.parse(fs.readFileSync(`spec.${k}.json`, "utf8")), {logger: vega.logger(vega.Error)}).spec), {renderer: "none", logLevel: vega.Error});
      fs.writeFileSync(`${k}.svg`, await view.toSVG());
    } catch (error) {
      fs.writeFileSync(`${k}.said`, String(error));
    }
  }
})();
