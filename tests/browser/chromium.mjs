// A headless Chromium at the end of a pipe: the DevTools protocol
// (https://chromedevtools.github.io/devtools-protocol) over file descriptors 3 and 4, one JSON
// message per zero byte. Nothing but node itself.
import {spawn, spawnSync} from "node:child_process";
import {mkdtempSync, rmSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";

export function missing() {
  const found = spawnSync("sh", ["-c", "command -v chromium"]);
  return found.status === 0 ? "" : "chromium is missing (Debian: apt-get install chromium)";
}

export async function open(extra = []) {
  const profile = mkdtempSync(join(tmpdir(), "jvari-chromium-"));
  // --no-sandbox: continuous integration runs as root; the page is our own
  const browser = spawn(
    "chromium",
    [
      "--headless=new",
      "--no-sandbox",
      "--disable-gpu",
      "--disable-dev-shm-usage",
      "--no-first-run",
      "--disable-extensions",
      "--disable-background-networking",
      "--autoplay-policy=no-user-gesture-required",
      "--mute-audio",
      "--hide-scrollbars",
      `--user-data-dir=${profile}`,
      "--remote-debugging-pipe",
      ...extra,
      "about:blank",
    ],
    {stdio: ["ignore", "ignore", "pipe", "pipe", "pipe"]},
  );
  const waiting = new Map(),
    listeners = [];
  let number = 0,
    rest = Buffer.alloc(0),
    output = "";
  browser.stderr.on("data", data => {
    output = (output + data).slice(-2000);
  });
  browser.stdio[4].on("data", data => {
    rest = Buffer.concat([rest, data]);
    for (let end = rest.indexOf(0); end >= 0; end = rest.indexOf(0)) {
      const message = JSON.parse(rest.subarray(0, end).toString());
      rest = rest.subarray(end + 1);
      if (message.id) {
        const {resolve, reject, method} = waiting.get(message.id);
        waiting.delete(message.id);
        if (message.error) reject(new Error(`${method}: ${message.error.message}`));
        else resolve(message.result);
      } else listeners.forEach(listener => listener(message));
    }
  });
  browser.stdio[3].on("error", () => {}); // it is gone: said below
  browser.on("exit", code =>
    waiting.forEach(({reject}) => reject(new Error(`chromium ended with ${code}: ${output}`))),
  );
  const send = (method, params = {}, sessionId) =>
    new Promise((resolve, reject) => {
      waiting.set(++number, {resolve, reject, method});
      browser.stdio[3].write(JSON.stringify({id: number, method, params, sessionId}) + "\0");
    });
  const {targetId} = await send("Target.createTarget", {url: "about:blank"});
  const {sessionId} = await send("Target.attachToTarget", {targetId, flatten: true});
  const page = (method, params) => send(method, params, sessionId);
  for (const domain of ["Page", "Runtime", "Log", "Network"]) await page(`${domain}.enable`);
  return {
    page,
    listen: listener => listeners.push(listener),
    async workers() {
      // the page's, each as a function like `page`
      const found = [];
      listeners.push(({method, params}) => {
        if (method === "Target.attachedToTarget" && params.targetInfo.type === "worker")
          found.push(params.sessionId);
      });
      await page("Target.setAutoAttach", {
        autoAttach: true,
        waitForDebuggerOnStart: false,
        flatten: true,
      });
      listeners.pop();
      return found.map(id => (method, params) => send(method, params, id));
    },
    async evaluate(expression) {
      const {result, exceptionDetails} = await page("Runtime.evaluate", {
        expression,
        awaitPromise: true,
        returnByValue: true,
      });
      if (exceptionDetails)
        throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
      return result.value;
    },
    async close() {
      const gone = new Promise(resolve => browser.once("exit", resolve));
      await send("Browser.close").catch(() => {});
      const late = setTimeout(() => browser.kill("SIGKILL"), 5000);
      await gone;
      clearTimeout(late);
      rmSync(profile, {recursive: true, force: true, maxRetries: 5, retryDelay: 100});
    },
  };
}
