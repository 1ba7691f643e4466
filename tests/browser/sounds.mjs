// sounds.mjs PROGRAM: of each scene of the library, by the first scheme that represents it, the
// .wav that `run --out` writes by default is read by Chromium: it plays, and its rate, length,
// channels and samples are those of the file. A file that is cut short is told from it.
import {spawnSync} from "node:child_process";
import {mkdtempSync, readFileSync, rmSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {open} from "./chromium.mjs";

const [program] = process.argv.slice(2);
const scratch = mkdtempSync(join(tmpdir(), "jvari-sounds-"));
const seconds = 0.1,
  rate = 44100,
  rows = seconds * rate + 1; // a run has a row at its end

function jvari(...words) {
  const run = spawnSync(program, words, {encoding: "utf8", maxBuffer: 1 << 26});
  if (run.status !== 0)
    throw new Error(`jvari ${words.join(" ")} ended with ${run.status}: ${run.stderr}`);
  return run.stdout;
}

// In the page: a file as a player has it, and as its decoder does. Samples come back as 24 bit
// integers, channel after channel.
const heard = base64 => `(async () => {
    const bytes = Uint8Array.from(atob("${base64}"), c => c.charCodeAt(0)),
      audio = new Audio(URL.createObjectURL(new Blob([bytes], {type: "audio/wav"})));
    const played = await new Promise(resolve => {
      audio.onended = () => resolve(audio.duration);
      audio.onerror = () => resolve("it does not play: " + audio.error.message);
      audio.play().catch(error => resolve("it does not play: " + error.message));
      setTimeout(() => resolve("it has not ended after 20 s"), 20000);
    });
    try {
      const sound = await new OfflineAudioContext(1, 1, ${rate}).decodeAudioData(bytes.buffer);
      const channels = [...Array(sound.numberOfChannels).keys()].map(k =>
        Array.from(sound.getChannelData(k), x => Math.round(x * 2 ** 23)),
      );
      return {played, rate: sound.sampleRate, channels};
    } catch (error) {
      return {played, refused: error.message};
    }
  })()`;

// What is wrong with what was heard of a file, as libsndfile lays it out: PCM of 24 bit in the
// chunk "data".
function wrong(file, sound, channels) {
  if (sound.refused) return `it is not decoded: ${sound.refused}`;
  if (typeof sound.played !== "number") return sound.played;
  if (Math.abs(sound.played - rows / rate) > 1e-3) return `it lasts ${sound.played} s`;
  if (sound.rate !== rate || sound.channels.length !== channels)
    return `it has ${sound.channels.length} channels at ${sound.rate} Hz`;
  if (sound.channels.some(c => c.length !== rows))
    return `it has ${sound.channels.map(c => c.length)} rows, not ${rows}`;
  const first = file.indexOf("data") + 8,
    loudest = sound.channels.map(
      c => c.reduce((most, x) => Math.max(most, Math.abs(x)), 0) / 2 ** 23,
    );
  for (let n = 0; n < rows; ++n)
    for (let k = 0; k < channels; ++k)
      if (Math.abs(file.readIntLE(first + 3 * (n * channels + k), 3) - sound.channels[k][n]) > 1)
        return `its row ${n} is not the file's`;
  if (Math.min(...loudest) < 0.01 || Math.abs(Math.max(...loudest) - 10 ** (-1 / 20)) > 1e-3)
    return `its channels have peaks of ${loudest}`;
  return "";
}

let failures = 0;
const say = (holds, text) => {
  failures += !holds;
  console.log(`${holds ? "" : "FAILED: "}${text}`);
};
const browser = await open();
try {
  const {scenes, matrix} = JSON.parse(jvari("list", "--json"));
  for (const {name} of scenes) {
    const {scheme} = matrix.find(pair => pair.scene === name && pair.represents),
      wav = join(scratch, `${name}.wav`);
    jvari("run", name, "--scheme", scheme, "--duration", String(seconds), "--out", wav);
    // a body with two responses
    const file = readFileSync(wav),
      channels = name === "tanpura_drone" ? 2 : 1;
    const sound = await browser.evaluate(heard(file.toString("base64"))),
      fault = wrong(file, sound, channels);
    say(
      !fault,
      `${name} by ${scheme}: ` +
        `${fault || `${sound.channels.length} channel(s), ${sound.played.toFixed(3)} s`}`,
    );
    if (name !== "tanpura_drone") continue;
    const cut = {
      "its header": file.subarray(0, 20),
      "half of it": file.subarray(0, file.length / 2),
      "a byte of its header": Buffer.concat([file.subarray(0, 11), file.subarray(12)]),
    };
    for (const [left, bytes] of Object.entries(cut))
      say(
        wrong(file, await browser.evaluate(heard(bytes.toString("base64"))), channels) !== "",
        `${left} ${left.startsWith("a ") ? "less" : "alone"} is told from it`,
      );
  }
} catch (error) {
  say(false, error.stack);
} finally {
  await browser.close();
  rmSync(scratch, {recursive: true, force: true});
}
process.exit(failures ? 1 : 0);
