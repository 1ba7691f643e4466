// check.mjs PROGRAM RESULTS: makes a comparison, a suite and a page of made-up numbers with the built program, opens them in Chromium, and asks what
// a reader would: is everything drawn, do the menus act, does it sound, does it fit a phone, is the console clean.
import {spawnSync} from "node:child_process";
import {cpSync, mkdtempSync, rmSync, statSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join} from "node:path";
import {pathToFileURL} from "node:url";
import {open} from "./chromium.mjs";

const [program, results] = process.argv.slice(2);
const scratch = mkdtempSync(join(tmpdir(), "jvari-browser-"));
let failures = 0;
const expect = (holds, what) => {
    if (!holds) ++failures;
    if (!holds) console.log(`  FAILED: ${what}`);
};
const pause = ms => new Promise(resolve => setTimeout(resolve, ms));

function jvari(...words) {
    const run = spawnSync(program, words, {encoding: "utf8"});
    if (run.status !== 0) throw new Error(`jvari ${words.join(" ")} ended with ${run.status}: ${run.stderr}`);
}

const suite = `name = "of the browser's test"
[[cells]]
scenes = ["free_string", "tanpura_c3_release"]
schemes = ["modal_two_point", "modal_two_point_trapezoidal"]
rates = [44100, 88200]
modes = 10
duration = 0.06
repeats = 1
measure = ["errors", "cost", "spectrogram", "sound"]
`;

function make_folders() {
    const folders = Object.fromEntries(["comparison", "suite", "made-up"].map(name => [name, join(scratch, name)]));
    jvari("compare", "tanpura_c3_release", "--schemes", "modal_two_point,modal_two_point_trapezoidal,modal_explicit_penalty", "--rates", "44100,88200",
        "--modes", "10", "--duration", "0.06", "--repeats", "1", "--out", folders.comparison);
    writeFileSync(join(scratch, "suite.toml"), suite);
    jvari("suite", join(scratch, "suite.toml"), "--out", folders.suite);
    cpSync(results, folders["made-up"], {recursive: true});
    jvari("report", folders["made-up"]);
    return folders;
}

// In the page. What a chart shows: the marks of its SVG, or the pixels of its canvas.
const helpers = `
    const outline = e => [e.getAttribute("d"), e.getAttribute("transform"), e.getAttribute("stroke"), e.getAttribute("fill"), e.getAttribute("opacity"), e.textContent].join();
    const picture = chart => chart.querySelector("canvas")?.toDataURL() ?? [...chart.querySelectorAll("svg.marks path, svg.marks text")].map(outline).sort().join("|");
    const marks = chart => {
        const svg = chart.querySelector("svg.marks");
        if (svg) return svg.querySelectorAll(".mark-symbol path, .mark-line path, .mark-area path, .mark-rect path, .mark-text text").length;
        const canvas = chart.querySelector("canvas");
        if (!canvas) return 0;
        const colours = new Set(new Uint32Array(canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.buffer));
        return colours.size > 8 ? colours.size : 0;
    };
    const settled = () => new Promise(resolve => setTimeout(resolve, 120));`;

const in_page = {
    drawn: `(() => {${helpers} return [...document.querySelectorAll(".chart")].map(c => ({name: c.getAttribute("aria-label"), marks: marks(c)})); })()`,
    menus: `(async () => {${helpers}
        const dead = [];
        for (const select of document.querySelectorAll(".menus select")) {
            const chart = select.closest(".menus").nextElementSibling, before = picture(chart);
            select.selectedIndex = select.options.length - 1;
            select.dispatchEvent(new Event("change"));
            await settled();
            if (picture(chart) === before || !marks(chart)) dead.push(select.closest("label").textContent.slice(0, 30) + " of " + chart.getAttribute("aria-label"));
            select.selectedIndex = 0;
            select.dispatchEvent(new Event("change"));
            await settled();
            if (picture(chart) !== before) dead.push(select.closest("label").textContent.slice(0, 30) + " does not go back");
        }
        return {menus: document.querySelectorAll(".menus select").length, dead};
    })()`,
    sound: `(async () => {
        const all = [...document.querySelectorAll("audio")], silent = [];
        for (const audio of [all[0], all.at(-1)]) {
            await audio.play();
            const until = performance.now() + 5000;
            while (audio.currentTime === 0 && !audio.ended && performance.now() < until) await new Promise(resolve => setTimeout(resolve, 20));
            if (!(audio.currentTime > 0 && audio.readyState >= 2 && Math.abs(audio.duration - 0.06) < 0.001)) silent.push(audio.getAttribute("aria-label"));
        }
        return {count: all.length, silent, named: all.every(a => a.getAttribute("aria-label"))};
    })()`,
    table: `(async () => {
        const table = [...document.querySelectorAll("#cells table")].at(-1), heading = name => [...table.querySelectorAll("th")].find(th => th.textContent.startsWith(name));
        const column = () => { const k = [...table.querySelectorAll("th")].indexOf(heading("rate")); return [...table.querySelectorAll("tbody tr")].map(tr => Number(tr.cells[k].textContent)); };
        return {button: document.activeElement === heading("rate").querySelector("button"), sort: heading("rate").getAttribute("aria-sort"), column: column()};
    })()`,
    width: "document.documentElement.scrollWidth"
};

async function ready(browser) {
    for (let k = 0; k < 600; ++k) {
        if (await browser.evaluate("document.documentElement?.dataset.ready === 'true' && ![...document.querySelectorAll('.chart')].some(c => c.dataset.drawn !== 'true')")) return;
        await pause(50);
    }
    expect(false, "the page comes to rest within half a minute");
}
const enter = browser => browser.page("Input.dispatchKeyEvent", {type: "keyDown", key: "Enter", code: "Enter", text: "\r", windowsVirtualKeyCode: 13})
    .then(() => browser.page("Input.dispatchKeyEvent", {type: "keyUp", key: "Enter", code: "Enter", windowsVirtualKeyCode: 13}));
const sorted = numbers => numbers.every((x, k) => k === 0 || Number.isNaN(x) || numbers[k - 1] <= x);

async function check(browser, name, file, charts) {
    console.log(name);
    expect(statSync(file).size < 15e6, `the page is below 15 MB: ${statSync(file).size}`);
    await browser.page("Emulation.setDeviceMetricsOverride", {width: 1280, height: 900, deviceScaleFactor: 1, mobile: false});
    await browser.page("Page.navigate", {url: pathToFileURL(file).href});
    await ready(browser);
    const drawn = await browser.evaluate(in_page.drawn);
    expect(drawn.length === charts, `${charts} charts stand there: ${drawn.length}`);
    for (const chart of drawn) expect(chart.marks > 0, `${chart.name} is drawn`);
    const menus = await browser.evaluate(in_page.menus);
    expect(menus.menus > 0 && menus.dead.length === 0, `each of ${menus.menus} menus redraws its chart: ${menus.dead.join("; ")}`);
    expect(await browser.evaluate("[...document.querySelectorAll('select, input')].every(e => e.closest('label'))"), "each menu has a label");
    if (name !== "made-up") {
        const sound = await browser.evaluate(in_page.sound);
        expect(sound.count >= 5 && sound.silent.length === 0 && sound.named, `${sound.count} sounds play and are named; silent: ${sound.silent.join("; ")}`);
    }
    await browser.evaluate("[...document.querySelectorAll('#cells th button')].find(b => b.textContent.startsWith('rate')).focus()");
    const before = await browser.evaluate(in_page.table);
    await enter(browser);
    const after = await browser.evaluate(in_page.table);
    expect(before.button && before.sort === "none" && after.button && after.sort === "ascending", "a heading sorts by keyboard and keeps the focus");
    expect(!sorted(before.column) && sorted(after.column), "the rows are sorted then");
    if (name === "made-up")
        expect(await browser.evaluate("[...document.querySelectorAll('#cells td')].some(td => td.textContent === '\\u22645.56e-03')"), "an error is no more than it and its certificate together");
    await browser.page("Emulation.setDeviceMetricsOverride", {width: 360, height: 740, deviceScaleFactor: 2, mobile: true});
    await browser.page("Emulation.setEmulatedMedia", {features: [{name: "prefers-color-scheme", value: "dark"}]});
    await pause(200);
    await ready(browser);
    const width = await browser.evaluate(in_page.width);
    expect(width <= 360, `nothing overflows at 360 pixels: ${width}`);
    for (const chart of await browser.evaluate(in_page.drawn)) expect(chart.marks > 0, `${chart.name} is drawn on a phone in the dark`);
    await browser.page("Emulation.setEmulatedMedia", {features: [{name: "prefers-color-scheme", value: "light"}]});
}

let browser;
try {
    const folders = make_folders();
    browser = await open();
    browser.listen(({method, params}) => {
        if (method === "Runtime.exceptionThrown") expect(false, `no exception: ${params.exceptionDetails.exception?.description ?? params.exceptionDetails.text}`);
        if (method === "Runtime.consoleAPICalled" && params.type === "error") expect(false, `no console error: ${JSON.stringify(params.args)}`);
        if (method === "Log.entryAdded" && params.entry.level === "error") expect(false, `no error in the log: ${params.entry.text}`);
        if (method === "Network.requestWillBeSent" && !/^(file|data|blob):/.test(params.request.url)) expect(false, `no network: ${params.request.url}`);
    });
    await check(browser, "comparison", join(folders.comparison, "report.html"), 3);
    await check(browser, "suite", join(folders.suite, "report.html"), 5);  // the fifth: time per step against the rate
    await check(browser, "made-up", join(folders["made-up"], "report.html"), 7);
} catch (error) {
    expect(false, error.stack);
} finally {
    await browser?.close();
    rmSync(scratch, {recursive: true, force: true});
}
console.log(failures ? `${failures} failures` : "all holds");
process.exit(failures ? 1 : 0);
