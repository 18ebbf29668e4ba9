// node tests/scripts/page.mjs MOTE BUNDLE CHROMIUM WORK: opens reports in headless Chromium, plays, scrubs,
// switches methods, and compares what is shown with the cells. Ends with "N passed, N failed".
import { execFileSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, readdirSync, renameSync, rmSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { testSite } from "./page_site.mjs";
import { testMarks, testPoor, testTables } from "./page_tables.mjs";

const { chromium } = createRequire(new URL("../../plots/page/package.json", import.meta.url))("playwright-core");
const [mote, bundle, executablePath, work] = process.argv.slice(2).map((path) => resolve(path));
const run = `${work}/run`;
const HOSTILE = "'; system(\"x\")<script>";
const LIMIT = 5e6; // bytes of a page with ww

let passed = 0;
let failed = 0;

async function check(name, test) {
    try {
        await test();
        ++passed;
        console.log(`ok      ${name}`);
    } catch (error) {
        ++failed;
        console.log(`FAILED  ${name}\n        ${String(error.stack ?? error).replaceAll("\n", "\n        ")}`);
    }
}

function equal(shown, expected, what) {
    if (!Object.is(shown, expected)) throw new Error(`${what}: ${shown}, not ${expected}`);
}

function truth(condition, what) {
    if (!condition) throw new Error(what);
}

function program(...words) {
    return execFileSync(mote, words, { cwd: work, stdio: ["ignore", "pipe", "pipe"] }).toString();
}

// Rows of the cell of a scenario and a method with these parameters, by frame.
function readCell(scenario, method, parameters = {}) {
    for (const name of readdirSync(`${run}/cells`).filter((file) => file.endsWith(".json"))) {
        const cell = JSON.parse(readFileSync(`${run}/cells/${name}`));
        const same = Object.entries(parameters).every(([key, value]) => cell.parameters[key] === value);
        if (cell.scenario !== scenario || cell.method !== method || !same) continue;
        const [head, ...lines] = readFileSync(`${run}/cells/${cell.id}.csv`, "utf8").trim().split("\n");
        const names = head.split(",");
        const rows = new Map();
        for (const line of lines) {
            const fields = line.split(",");
            const row = Object.fromEntries(
                names.map((key, k) => [key, fields[k] === "" ? NaN : Number(fields[k])]));
            rows.set(row.frame, row);
        }
        return rows;
    }
    throw new Error(`no cell of ${scenario}, ${method}`);
}

function measure() {
    rmSync(work, { recursive: true, force: true });
    mkdirSync(work, { recursive: true });
    program("run", "ww", "--out", run, "--replicates", "1", "--method", "certified", "--method", "fcl-aabb",
        "--method", "particle-paper", "--particles", "1,5");
    program("run", "tt", "--out", run, "--replicates", "1", "--frames", "1-100", "--method", "certified",
        "--method", "fcl-aabb", "--method", "particle:n=8,positions=given");
    program("run", "morph", "bison-15k", "--out", `${work}/characters`, "--replicates", "1", "--frames", "1-60",
        "--method", "certified");
    program("report", `${work}/characters`);
    program("figures", run);
    program("report", run);
    program("run", "ww-1k", "--out", `${work}/several`, "--replicates", "4", "--frames", "1-200", "--method",
        "particle-paper:n=2,refine=no");
    program("report", `${work}/several`);
    program("run", "letters", "--out", `${work}/letters`, "--replicates", "1", "--frames", "1-2", "--method", "certified");
    program("report", `${work}/letters`);
    writeFileSync(`${work}/stretched.json`, JSON.stringify({
        purpose: "a field that is no CSRBF", frames: 20, ask: "distance", bodies: [
            { letter: "T", triangles: 1380, field: { kind: "stretch", displacement: { sines: [
                { control: 1, amplitude: [0.3, 0, 0], period: 20 }, { control: 2, amplitude: [0.1, 0.2, 0], period: 13 }] } },
            motion: [{ frame: 1, axis: [0, 1, 0.3], degrees: 0 }, { frame: 20, axis: [0, 1, 0.3], degrees: 40 }] },
            { letter: "T", triangles: 1380, motion: [{ frame: 1, position: [0.9, 0, 0] }] }],
    }));
    program("run", "./stretched.json", "--out", `${work}/stretched`, "--replicates", "1", "--method", "certified");
    program("report", `${work}/stretched`);
    writeFileSync(`${work}/${HOSTILE}.json`, JSON.stringify({
        purpose: HOSTILE, like: "mv", frames: 5, pace: 149.75, warmup: null, active: null,
    }));
    program("run", `./${HOSTILE}.json`, "--out", `${work}/hostile`, "--replicates", "1", "--method", "certified");
    program("report", `${work}/hostile`);
}

// A page that fails on any message, request or dialog.
async function open(browser, directory, options = {}, before = null, file = "report.html") {
    const page = await browser.newPage({ viewport: { width: 1280, height: 900 }, ...options });
    if (before) await page.addInitScript(before);
    page.troubles = [];
    page.on("console", (message) => {
        if (["error", "warning"].includes(message.type())) page.troubles.push(message.text());
    });
    page.on("pageerror", (error) => page.troubles.push(String(error)));
    page.on("dialog", (dialog) => page.troubles.push(`dialog: ${dialog.message()}`));
    page.on("request", (request) => {
        if (!/^(file|data|blob):/.test(request.url())) page.troubles.push(`asked for ${request.url()}`);
    });
    await page.goto(pathToFileURL(`${directory}/${file}`).href);
    return page;
}

// Resolves when the replay has unpacked its choice.
const settled = (page) => page.locator("#replay-app[aria-busy=false]").waitFor();

async function choose(page, id, option) {
    await page.locator(`#replay-${id}`).selectOption(option);
    await settled(page);
}

const shown = (page, id) => page.locator(`#replay-${id}`).evaluate((element) => element.value);
const frameOf = async (page) => Number(await shown(page, "slider"));

async function scrub(page, frame) {
    await page.locator("#replay-slider").evaluate((slider, to) => {
        slider.value = to;
        slider.dispatchEvent(new Event("input", { bubbles: true }));
    }, frame);
    equal(await frameOf(page), frame, "frame");
}

// The page has errors to six digits and distances from them; below 1e-12 an error is shown as 0.
function near(text, value, what, least = 0) {
    if (Number.isNaN(value)) return equal(text, "not asked", what);
    const off = Math.abs(Number(text) - value);
    return truth(off <= Math.max(least, 1e-5 * Math.abs(value)), `${what}: ${text}, not ${value}`);
}

async function compare(page, rows, frames) {
    for (const frame of frames) {
        await scrub(page, frame);
        const row = rows.get(frame);
        near(await shown(page, "distance"), row.distance, `distance at frame ${frame}`, 1e-12);
        near(await shown(page, "truth"), row.truth, `truth at frame ${frame}`);
        if (!Number.isNaN(row.error)) {
            const off = Math.abs(Number(await shown(page, "error")) - row.error);
            truth(off <= Math.max(1e-12, 0.0051 * Math.abs(row.error)), `error at frame ${frame}`);
        }
    }
}

const worstOf = (rows) => Math.max(...[...rows.values()].map((row) => Math.abs(row.error)));

// Texts whose contrast with their background is below WCAG AA.
function lowContrast() {
    const parse = (text) => {
        const n = text.match(/[\d.]+/g).map(Number);
        return { rgb: n.slice(0, 3), alpha: n.length > 3 ? n[3] : 1 };
    };
    const luminance = (rgb) => {
        const [r, g, b] = rgb.map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const behind = (element) => {
        for (let e = element; e; e = e.parentElement) {
            const colour = parse(getComputedStyle(e).backgroundColor);
            if (colour.alpha === 1) return colour.rgb;
        }
        return [255, 255, 255];
    };
    const low = [];
    let texts = 0;
    for (const element of document.querySelectorAll("body *")) {
        const own = [...element.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim());
        const control = element.tagName === "SELECT" || element.type === "number";
        if ((!own && !control) || element.closest("script, noscript") || element.disabled) continue;
        if (element.offsetParent === null) continue;
        ++texts;
        const style = getComputedStyle(element);
        const [a, b] = [luminance(parse(style.color).rgb), luminance(behind(element))];
        const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
        const large = parseFloat(style.fontSize) >= 24;
        if (ratio < (large ? 3 : 4.5)) low.push(`${element.tagName} "${element.textContent.slice(0, 30)}" ${ratio.toFixed(2)}`);
    }
    return { low, texts };
}

async function testNumbers(page) {
    const five = readCell("ww", "particle-paper", { n: 5 });
    const one = readCell("ww", "particle-paper", { n: 1 });
    const exact = readCell("ww", "certified");
    const frames = [1, 388, 951, 1130, 1500, 1984];
    await check("opens with the paper's n = 5 and draws both bodies", async () => {
        equal(await shown(page, "method"), "particle-paper", "method");
        equal(await page.locator("#replay-n option:checked").textContent(), "5", "n");
        truth((await page.evaluate(() => window.moteReplay.drawn())) >= 2 * 11920, "triangles drawn");
    });
    await check("scrubbing shows the CSV's distance, truth and error", () => compare(page, five, frames));
    await check("another n shows its own answers", async () => {
        await choose(page, "n", { label: "1" });
        await compare(page, one, frames);
    });
    await check("a missed contact is named", async () => {
        const missed = [...one.values()].find((row) => row.contact_truth === 1 && row.contact === 0);
        await scrub(page, missed.frame);
        equal(await page.locator("#replay-contact").textContent(), "Contact missed", "badge");
    });
    await check("the worst frame is the CSV's", async () => {
        await page.locator("#replay-worst").click();
        const { error } = one.get(await frameOf(page));
        truth(Math.abs(error) >= worstOf(one) * (1 - 1e-5), `the error there is ${error}`);
    });
    await check("another method shows its own answers", async () => {
        for (const [method, rows] of [["certified", exact], ["fcl-aabb", readCell("ww", "fcl-aabb")]]) {
            await choose(page, "method", method);
            await compare(page, rows, frames);
        }
    });
    await check("contacts of an exact method are contacts", async () => {
        const contact = [...exact.values()].find((row) => row.contact_truth === 1);
        await scrub(page, contact.frame);
        equal(await page.locator("#replay-contact").textContent(), "Contact", "badge");
    });
}

async function testKeys(page) {
    const stage = page.locator(".stage canvas");
    await check("space plays and pauses", async () => {
        await scrub(page, 100);
        await stage.focus();
        await page.keyboard.press("Space");
        equal(await page.locator("#replay-play").textContent(), "Pause", "button");
        await page.waitForFunction(() => Number(document.getElementById("replay-slider").value) > 110);
        await page.keyboard.press("Space");
        const frame = await frameOf(page);
        await page.waitForTimeout(250);
        equal(await frameOf(page), frame, "frame after the pause");
    });
    await check("arrows, shift, home and end step", async () => {
        await scrub(page, 500);
        await stage.focus();
        for (const [key, frame] of [["ArrowRight", 501], ["ArrowLeft", 500], ["Shift+ArrowRight", 510],
            ["Shift+ArrowLeft", 500], ["End", 1984], ["ArrowRight", 1984], ["Home", 1], ["ArrowLeft", 1]]) {
            await page.keyboard.press(key);
            equal(await frameOf(page), frame, key);
        }
        await page.locator("#replay-slider").focus();
        await page.keyboard.press("ArrowRight");
        equal(await frameOf(page), 2, "ArrowRight on the slider");
    });
    await check("the frame can be typed, and stays within the scenario", async () => {
        for (const [typed, frame] of [["1234", 1234], ["999999", 1984], ["-5", 1]]) {
            await page.locator("#replay-frame").fill(typed);
            await page.keyboard.press("Enter");
            equal(await frameOf(page), frame, typed);
        }
    });
    await check("tab goes through the controls in their order", async () => {
        await stage.focus();
        const order = [];
        for (let k = 0; k < 9; ++k) {
            await page.keyboard.press("Tab");
            order.push(await page.evaluate(() => document.activeElement.id));
        }
        equal(order.join(" "), ["slider", "play", "worst", "frame", "speed", "close", "scene", "method", ""]
            .map((id) => (id ? `replay-${id}` : "")).join(" "), "order");
    });
    await check("every focus can be seen", async () => {
        for (const id of ["replay-play", "replay-method", "replay-slider"]) {
            await page.locator(`#${id}`).focus();
            await page.keyboard.press("Shift");
            const style = await page.locator(`#${id}`).evaluate((e) => getComputedStyle(e).outlineStyle);
            truth(style !== "none", `${id} has no outline`);
        }
    });
}

// A vertex line of an exported mesh as three numbers.
const vertices = (file) => readFileSync(file, "utf8").split("\n")
    .filter((line) => line.startsWith("v ")).map((line) => line.slice(2).trim().split(/\s+/).map(Number));

async function testField(name, page, scenario, frames, length = 1) {
    await check(`the page deforms ${name} as the program does, to 1e-4 L`, async () => {
        let most = 0;
        for (const frame of frames) {
            program("export", scenario, "--frame", String(frame), "--out", `${work}/export`);
            await scrub(page, frame);
            for (const body of [0, 1]) {
                const exact = vertices(`${work}/export/${"AB"[body]}.obj`);
                const drawn = await page.evaluate((b) => {
                    const count = window.moteReplay.vertexCount(b);
                    return Array.from({ length: count }, (_, i) => window.moteReplay.vertex(b, i));
                }, body);
                equal(drawn.length, exact.length, "vertices");
                drawn.forEach((p, i) => {
                    most = Math.max(most, Math.hypot(...p.map((c, k) => c - exact[i][k])));
                });
            }
        }
        truth(most < 1e-4 * length, `a vertex is ${most} off`);
        console.log(`        largest difference ${most.toExponential(1)}`);
    });
}

async function testScenes(page) {
    await check("a scenario that asks for contact only shows no distance", async () => {
        await choose(page, "scene", { label: "tt" });
        await compare(page, readCell("tt", "certified"), [1, 50, 100]);
        equal(await shown(page, "distance"), "not asked", "distance");
    });
    await check("nothing went wrong on the way", async () => equal(page.troubles.join("; "), "", "messages"));
}

async function testLooks(browser) {
    mkdirSync(`${work}/shots`, { recursive: true });
    for (const colorScheme of ["light", "dark"]) {
        for (const width of [1280, 400]) {
            const page = await open(browser, run, { colorScheme, viewport: { width, height: 900 } });
            await page.evaluate(() => document.querySelectorAll("details").forEach((d) => (d.open = true)));
            await check(`legible and no wider than the screen: ${colorScheme}, ${width}`, async () => {
                const { low, texts } = await page.evaluate(lowContrast);
                equal(low.join("; "), "", "low contrast");
                truth(texts > 100, `only ${texts} texts`);
                truth(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "too wide");
                equal(page.troubles.join("; "), "", "messages");
            });
            await page.locator("#replay").scrollIntoViewIfNeeded();
            await page.screenshot({ path: `${work}/shots/${colorScheme}-${width}.png` });
            await page.close();
        }
    }
}

async function testOthers(browser) {
    await check("a hostile scenario name runs nothing", async () => {
        const page = await open(browser, `${work}/hostile`);
        await settled(page);
        equal(page.troubles.join("; "), "", "messages");
        equal(await page.evaluate(() => document.scripts.length), 9, "scripts"); // 2 of data, 6 plain, the replay
        truth((await page.locator("main").textContent()).includes(HOSTILE), "the name is not shown");
        truth(Number(await shown(page, "truth")) > 0, "no replay");
        await page.close();
    });
    await check("a run of other frames than the scenario's interval of interest begins with its first", async () => {
        const page = await open(browser, `${work}/several`);
        await settled(page);
        equal(await frameOf(page), 1, "frame");
        equal(page.troubles.join("; "), "", "messages");
        await page.close();
    });
    const stretched = await open(browser, `${work}/stretched`);
    await settled(stretched);
    await testField("a stretched body", stretched, "./stretched.json", [1, 8, 20]);
    await stretched.close();
    await check("the worst frame is that of all replicates", async () => {
        const page = await open(browser, `${work}/several`);
        await settled(page);
        const [row] = JSON.parse(readFileSync(`${work}/several/summary.json`)).rows;
        await page.locator("#replay-worst").click();
        const error = Math.abs(Number(await shown(page, "error")));
        truth(Math.abs(error / row.error.max - 1) < 0.0051, `${error}, not ${row.error.max}`);
        truth((await page.locator("#replay-origin").textContent()).includes("that of all 4"), "not said");
        await page.close();
    });
    await check("the noise floor is said to hold of nine rows in ten", async () => {
        const page = await open(browser, `${work}/several`);
        const text = await page.locator("section[aria-labelledby=results]").textContent();
        truth(/nine rows in ten differ from themselves by at most [0-9.]+.% \(the noise floor/.test(text), text);
        await page.close();
    });
    await check("many bodies are told by their number and shapes, their times are of a frame", async () => {
        const page = await open(browser, `${work}/letters`);
        const text = await page.locator(".block").textContent();
        truth(text.includes("100 bodies of 4 shapes, 1,380 to 11,920 triangles"), `the head of ${text}`);
        truth(/certified, [0-9.]+.(ms|µs) a frame/.test(text), `the time in ${text}`);
        equal(page.troubles.join("; "), "", "messages");
        await page.close();
    });
    await check("a page with ww stays below 5 MB", async () => {
        const { size } = statSync(`${run}/report.html`);
        truth(size < LIMIT, `${size} bytes`);
        console.log(`        ${size} bytes`);
    });
}

truth(existsSync(bundle), `${bundle} is not there: make page`);
measure();
const browser = await chromium.launch({
    executablePath,
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
});
const page = await open(browser, run);
const tools = { check, equal, truth, open, program };
await testTables(page, tools, run);
await settled(page);
await testNumbers(page);
await testKeys(page);
await testField("letters W", page, "ww", [1, 700, 1984]);
await testScenes(page);
await page.close();
await testLooks(browser);
await testOthers(browser);
const characters = await open(browser, `${work}/characters`);
await settled(characters);
for (const [name, length] of [["morph", 3.464], ["bison-15k", 3.697]]) {
    await choose(characters, "scene", { label: name });
    await testField(name, characters, name, [1, 60], length);
}
await characters.close();
await testSite(browser, tools, open, program, work);
await testMarks(browser, tools, work);
await testPoor(browser, tools, run, work, bundle);
await browser.close();
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
