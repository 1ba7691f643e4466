// The built module in node, behind web/core.js.
import {readFileSync} from "node:fs";
import {createRequire} from "node:module";
import {join, resolve} from "node:path";
import vm from "node:vm";

export async function core(build, sources) {
  const factory = createRequire(import.meta.url)(resolve(build, "jvari.js"));
  const module = await factory({wasmBinary: readFileSync(join(build, "jvari.wasm"))});
  return vm.runInThisContext(`${readFileSync(join(sources, "web/core.js"), "utf8")}; jvari_core`)(
    module,
  );
}
