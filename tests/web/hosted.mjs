// hosted.mjs SOURCES [strict]: docs/play.html and docs/work-precision.html are the files that
// docs/hosted.json names, and the sources they were made from are those of the tree. Other sources
// are told by exit code 77, a skip to ctest, and refused if `strict`.
// hosted.mjs SOURCES write: writes docs/hosted.json for these files.
import {createHash} from "node:crypto";
import {existsSync, readFileSync, readdirSync, statSync, writeFileSync} from "node:fs";
import {join} from "node:path";

const [sources, how] = process.argv.slice(2);
const files = (path, kinds) =>
  statSync(join(sources, path)).isDirectory()
    ? readdirSync(join(sources, path))
        .sort()
        .flatMap(name => files(join(path, name), kinds))
    : kinds.test(path)
      ? [path]
      : [];
const core = /\.(cpp|hpp|def|toml|js|mjs|html|css|csv|json)$/,
  pages = {
    "play.html": [
      "scenes",
      "schemes",
      "reference",
      "analysis",
      "web",
      "bench/report/page/base.css",
      "results/problems",
    ],
    "work-precision.html": ["bench/report", "results/work-precision"],
  };
const hash = (list, of) => list.reduce((h, path) => h.update(of(path)), createHash("sha256"));
const found = Object.fromEntries(
  Object.entries(pages).map(([page, folders]) => {
    const list = folders.flatMap(folder => files(folder, core)),
      read = path => readFileSync(join(sources, path)),
      whole = hash(list, path => path + "\n" + read(path)).digest("hex"),
      path = join("docs", page);
    return [
      page,
      {
        file: existsSync(join(sources, path)) ? hash([path], read).digest("hex") : "",
        sources: whole,
      },
    ];
  }),
);
const kept = join(sources, "docs/hosted.json");
if (how === "write") {
  writeFileSync(kept, JSON.stringify(found, null, 2) + "\n");
  process.exit(0);
}
const named = existsSync(kept) ? JSON.parse(readFileSync(kept, "utf8")) : {};
let status = 0;
for (const page of Object.keys(pages))
  if (!found[page].file || found[page].file !== named[page]?.file) {
    console.log(`docs/${page} is missing, or not the file that docs/hosted.json names.`);
    status = 1;
  } else if (found[page].sources !== named[page].sources) {
    console.log(`docs/${page} was made from other sources. WRITE=1 ./play makes it again.`);
    status ||= how === "strict" ? 1 : 77;
  }
process.exit(status);
