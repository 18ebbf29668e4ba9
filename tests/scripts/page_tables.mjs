// The page's tables, fronts and figures, for page.mjs: compares the page with summary.json and with the
// files of figures/.
import { existsSync, readFileSync, renameSync, writeFileSync } from "node:fs";

const units = { ns: 1, "µs": 1e3, ms: 1e6, s: 1e9 };
const NARROW = "\u202f";

// "5.45 µs" in nanoseconds.
function nanoseconds(text) {
    const [number, unit] = text.split(NARROW);
    return Number(number) * units[unit];
}

const labels = (page, block) => page.locator(".block").nth(block).locator("tbody th a").allTextContents();
const cells = (page, block, column) =>
    page.locator(".block").nth(block).locator(`tbody tr td:nth-of-type(${column}) a`).allTextContents();
const isSorted = (values) => values.every((value, k) => k === 0 || values[k - 1] <= value);

// The place of a scenario's block among all of the page.
async function blockOf(page, scenario) {
    const titles = await page.locator(".block h3").allTextContents();
    return titles.findIndex((title) => title.startsWith(`${scenario} `));
}

// The rows of the summary that a table shows, found by scenario and caches.
function rowsOf(run, scenario) {
    const { rows } = JSON.parse(readFileSync(`${run}/summary.json`, "utf8"));
    return rows.filter((row) => row.scenario === scenario && row.cache === "hot");
}

async function testSorting(page, { check, equal, truth }, run) {
    const ww = rowsOf(run, "ww");
    const block = await blockOf(page, "ww");
    await page.locator("#choice-rows").selectOption("all");
    const head = (text) => page.locator(".block").nth(block).locator("thead button", { hasText: text }).first();
    await check("all rows are there, the fastest first", async () => {
        const shown = await labels(page, block);
        equal(shown.length, ww.length, "rows");
        const order = [...ww].sort((a, b) => a.total_ns.median - b.total_ns.median).map((row) => row.label);
        equal(shown.join(" "), order.join(" "), "order");
    });
    await check("rows with positions given come after those that pay for deformation", async () => {
        const shown = await labels(page, await blockOf(page, "tt"));
        const times = await cells(page, await blockOf(page, "tt"), 1);
        equal(shown.at(-1), "particle:n=8,positions=given", "last");
        truth(nanoseconds(times.at(-1)) < nanoseconds(times.at(-2)), "it is not the slowest");
    });
    await check("a table shows the summary's medians to three digits", async () => {
        const shown = await labels(page, block);
        const times = await cells(page, block, 1);
        shown.forEach((label, k) => {
            const { median } = ww.find((row) => row.label === label).total_ns;
            truth(Math.abs(nanoseconds(times[k]) / median - 1) < 0.0051, `${label}: ${times[k]}, not ${median} ns`);
        });
    });
    await check("every head sorts, up and down, and says so", async () => {
        const count = await page.locator(".block").nth(block).locator("thead button").count();
        truth(count >= 9, `${count} heads`);
        for (let k = 0; k < count; ++k) {
            const button = () => page.locator(".block").nth(block).locator("thead button").nth(k);
            const sort = () => button().locator("xpath=..").getAttribute("aria-sort");
            await button().click();
            const first = await sort();
            await button().click();
            equal([first, await sort()].sort().join(" "), "ascending descending", `aria-sort of head ${k}`);
        }
    });
    await check("the heap column sorts by bytes, not by text", async () => {
        await head("live").focus();
        await page.keyboard.press("Enter");
        const bytes = (await labels(page, block)).map((label) => ww.find((row) => row.label === label).heap_live_bytes);
        const up = (await head("live").locator("xpath=..").getAttribute("aria-sort")) === "ascending";
        truth(isSorted(up ? bytes : bytes.reverse()), `bytes ${bytes}`);
        truth(await head("live").evaluate((button) => button === document.activeElement), "focus is lost");
    });
    await head("median").click();
}

async function testFilters(page, { check, equal, truth }, run) {
    const ww = rowsOf(run, "ww");
    const block = await blockOf(page, "ww");
    const choose = (key, value) => page.locator(`#choice-${key}`).selectOption(value);
    const rowOf = (label) => ww.find((row) => row.label === label);
    await check("errors near L and above are written without an exponent", async () => {
        const texts = await page.locator(".results td").allTextContents();
        truth(!texts.some((text) => /e\+/.test(text)), "a number with e+");
    });
    await check("one a method shows each method once", async () => {
        await choose("rows", "one");
        const methods = (await labels(page, block)).map((label) => rowOf(label).method);
        equal(new Set(methods).size, methods.length, "methods");
        equal(methods.length, new Set(ww.map((row) => row.method)).size, "methods shown");
        await choose("rows", "all");
    });
    await check("a method can be chosen", async () => {
        await choose("method", "particle-paper");
        const shown = await labels(page, block);
        equal(shown.length, ww.filter((row) => row.method === "particle-paper").length, "rows");
        truth(shown.every((label) => label.startsWith("particle-paper")), shown.join(" "));
        await choose("method", "");
    });
    await check("rows can be chosen by exactness", async () => {
        const right = (row) => row.missed === 0 && row.false_contacts === 0;
        const kinds = {
            any: () => true,
            exact: (row) => right(row) && row.error.exact_rate === 1,
            contacts: right,
            inexact: (row) => !(right(row) && row.error.exact_rate === 1),
        };
        for (const [kind, wanted] of Object.entries(kinds)) {
            await choose("exactness", kind);
            equal((await labels(page, block)).sort().join(" "),
                ww.filter(wanted).map((row) => row.label).sort().join(" "), kind);
        }
    });
    await check("where nothing is left the table says so", async () => {
        await choose("method", "certified");
        await choose("exactness", "inexact");
        truth((await page.locator(".block").nth(block).textContent()).includes("No row matches."), "nothing said");
        await choose("method", "");
        await choose("exactness", "any");
    });
    await check("all columns can be had", async () => {
        const count = () => page.locator(".block").nth(block).locator("thead tr:nth-of-type(2) th").count();
        const before = await count();
        await page.locator("#choice-extra").check();
        truth((await count()) > before, "no more columns");
        await page.locator("#choice-extra").uncheck();
        equal(await count(), before, "columns");
    });
}

async function testFront(page, { check, equal, truth }, run) {
    const ww = rowsOf(run, "ww");
    const block = page.locator(".block").nth(await blockOf(page, "ww"));
    const tip = block.locator(".tip");
    const point = (label) => block.locator(`.point[aria-label^="${label};"]`);
    await check("the front has a point for every row with an error", async () => {
        equal(await block.locator(".point").count(), ww.filter((row) => row.error.p99 !== null).length, "points");
    });
    await check("a point tells method, parameters and figures under the pointer", async () => {
        const row = ww.find((other) => other.method === "particle-paper" && other.parameters.n === 5);
        truth(await tip.isHidden(), "a tip before anything is pointed at");
        await point(row.label).hover();
        const text = await tip.textContent();
        for (const part of [row.label, "n 5", `law ${row.parameters.law}`, row.error.p99.toExponential(1), "heap live: "])
            truth(text.includes(part), `no ${part} in ${text}`);
        equal(await block.locator("tr.pointed th a").textContent(), row.label, "row that is marked");
        const box = await tip.boundingBox();
        truth(box.x >= 0 && box.x + box.width <= 1280, "the tip leaves the page");
        await page.mouse.move(5, 5);
        truth(await tip.isHidden(), "the tip stays");
    });
    await check("a point tells the same to the keyboard", async () => {
        await point("certified").focus();
        truth((await tip.textContent()).startsWith("certified"), "no tip");
        await page.locator("h1").click();
    });
}

async function testHead(page, { check, truth }) {
    await check("the head of a table stays below the navigation", async () => {
        await page.setViewportSize({ width: 1280, height: 420 });
        const table = page.locator(".block").nth(await blockOf(page, "ww")).locator("table");
        const { nav, head, row } = await table.evaluate((element) => {
            const box = (e) => e.getBoundingClientRect();
            window.scrollBy(0, box(element).top + 60); // half of the table is above the window then
            return {
                nav: box(document.querySelector("nav")).bottom,
                head: box(element.querySelector("thead")).top,
                row: box(element.querySelector("tbody tr")).top,
            };
        });
        truth(row < nav, "the first row is still to be seen: the test shows nothing");
        truth(head >= nav - 2 && head <= nav + 3, `the head is at ${head}, the navigation ends at ${nav}`);
        await page.setViewportSize({ width: 1280, height: 900 });
    });
    await check("no table is cut off at 1280 pixels", async () => {
        const cut = await page.evaluate(() => [...document.querySelectorAll(".results")].filter(
            (frame) => frame.querySelector("table").offsetWidth > frame.clientWidth + 1).length);
        truth(cut === 0, `${cut} tables are`);
    });
}

async function testFigures(page, { check, equal, truth }, run) {
    const plain = (image) => image.evaluate((element) => decodeURIComponent(element.src.split(",").slice(1).join(",")));
    await check("a light page shows the drawings as they are", async () => {
        await page.emulateMedia({ colorScheme: "light" });
        await page.waitForFunction(() => [...document.querySelectorAll("#figures ~ figure img")].every((i) => i.src));
        const links = page.locator("figure > a:has(img)");
        const count = await links.count();
        truth(count >= 4, `${count} drawings`);
        for (let k = 0; k < count; ++k) {
            const file = decodeURIComponent(await links.nth(k).getAttribute("href"));
            await page.waitForFunction((index) => document.querySelectorAll("figure > a > img")[index].complete, k);
            equal(await plain(links.nth(k).locator("img")), readFileSync(`${run}/${file}`, "utf8"), file);
            truth(await links.nth(k).locator("img").evaluate((image) => image.naturalWidth > 0), `${file} is no image`);
        }
    });
    await check("figures follow a change to dark, and back", async () => {
        const image = page.locator("figure > a > img").first();
        const light = await plain(image);
        await page.emulateMedia({ colorScheme: "dark" });
        await page.waitForFunction((before) =>
            decodeURIComponent(document.querySelector("figure > a > img").src).indexOf(before) < 0, light);
        const dark = await plain(image);
        truth(!/#ffffff/i.test(dark), "white is left");
        const lightness = Number(/<rect[^>]*fill="hsl\(\S+ \S+ ([\d.]+)%\)"/.exec(dark)[1]);
        truth(lightness < 15, `the paper has a lightness of ${lightness} %`);
        equal(dark.replace(/hsl\([^)]*\)/g, "").length < light.length, true, "only colours are exchanged");
        await page.emulateMedia({ colorScheme: "light" });
        await page.waitForFunction((before) =>
            document.querySelector("figure > a > img").src.includes(encodeURIComponent(before.slice(0, 400))), light);
    });
}

// Links to places of the page and to files of the run.
async function testLinks(page, { check, truth }, run) {
    await check("every link leads somewhere", async () => {
        const targets = await page.evaluate(() => [...document.querySelectorAll("a[href]")].map((a) => a.getAttribute("href")));
        const ids = new Set(await page.evaluate(() => [...document.querySelectorAll("[id]")].map((e) => e.id)));
        truth(targets.length > 40, `only ${targets.length} links`);
        for (const target of new Set(targets)) {
            if (target.startsWith("#")) truth(ids.has(target.slice(1)), `${target} is nowhere`);
            else truth(existsSync(`${run}/${decodeURIComponent(target)}`), `${target} is not there`);
        }
    });
    await check("the navigation names every section", async () => {
        const names = await page.locator("nav a").allTextContents();
        const count = await page.locator("main > section").count();
        truth(names.length === count && count >= 6, `${names} for ${count} sections`);
    });
    await check("known defects are read as text with code", async () => {
        const defects = page.locator("section[aria-labelledby=defects]");
        truth((await defects.locator("h3").first().textContent()).startsWith("1. FCL"), "no heading");
        truth((await defects.locator("details pre").count()) > 0, "no code");
        truth(!(await defects.textContent()).includes("`"), "marks of code are left");
    });
}

// Without --method a run asks about twice as many methods as there are colours.
export async function testMarks(browser, { check, equal, truth, open, program }, work) {
    program("run", "ww-1k", "--out", `${work}/marks`, "--frames", "1-3", "--replicates", "1");
    program("report", `${work}/marks`);
    const page = await open(browser, `${work}/marks`);
    const look = (element) => element.evaluate((shown) => {
        const { backgroundColor, fill, borderRadius, transform } = getComputedStyle(shown);
        const colour = shown.tagName === "SPAN" ? backgroundColor : fill;
        const round = shown.tagName === "circle" || borderRadius === "50%";
        return [colour, round ? "round" : transform === "none" && !shown.hasAttribute("transform") ? "square" : "diamond"].join(" ");
    });
    await check("each method has a mark of its own, in the legend as in the front", async () => {
        const entries = await page.locator(".legend.colours > span").all();
        const marks = new Map();
        for (const entry of entries) marks.set(await entry.textContent(), await look(entry.locator(".swatch")));
        truth(entries.length > 10, `only ${entries.length} methods`);
        equal(new Set(marks.values()).size, entries.length, "marks");
        const points = await page.locator(".point:not(.given)").all();
        truth(points.length > 10, `only ${points.length} points`);
        for (const point of points) {
            const method = (await point.getAttribute("aria-label")).split(/[:;]/)[0];
            equal(await look(point), marks.get(method), method);
        }
    });
    await check("a page of many methods fits 1280 and 400 pixels", async () => {
        for (const width of [1280, 400]) {
            await page.setViewportSize({ width, height: 900 });
            await page.waitForFunction(() => document.documentElement.scrollWidth <= innerWidth); // fronts are drawn again
            await page.locator("section[aria-labelledby=results]").screenshot({ path: `${work}/marks-${width}.png` });
        }
        equal(page.troubles.join("; "), "", "messages");
    });
    await page.close();
}

export async function testTables(page, tools, run) {
    await testSorting(page, tools, run);
    await testFilters(page, tools, run);
    await testFront(page, tools, run);
    await testHead(page, tools, run);
    await testFigures(page, tools, run);
    await testLinks(page, tools, run);
    await tools.check("nothing went wrong in the tables", async () => tools.equal(page.troubles.join("; "), "", "messages"));
}

// Pages under poor conditions: an old browser, no script, files that mote did not write.
export async function testPoor(browser, { check, equal, truth, open, program }, run, work, bundle) {
    await check("a browser that cannot unpack has the tables, and links to the drawings", async () => {
        const page = await open(browser, run, {}, () => delete window.DecompressionStream);
        truth((await page.locator(".block tbody tr").count()) >= 4, "no tables");
        equal(await page.locator("figure img").count(), 0, "drawings");
        truth((await page.locator("figure a").count()) >= 4, "no links");
        truth((await page.locator("main").textContent()).includes("The replay needs a browser"), "not said");
        equal(page.troubles.join("; "), "", "messages");
        await page.close();
    });
    await check("without JavaScript the page says so, and where the tables are", async () => {
        const page = await open(browser, run, { javaScriptEnabled: false });
        const notice = page.locator("noscript");
        truth((await notice.textContent()).includes("report.md"), "not said");
        truth(existsSync(`${run}/report.md`), "report.md is not there");
        truth(await page.locator("h1").isVisible(), "no title");
        await page.close();
    });
    await check("without the bundle the tables are there, sort, and the page says what it lacks", async () => {
        renameSync(bundle, `${bundle}.away`);
        try {
            program("report", run);
        } finally {
            renameSync(`${bundle}.away`, bundle);
        }
        const page = await open(browser, run);
        truth((await page.locator("main").textContent()).includes("This page has no replay"), "not said");
        equal(await page.locator("#replay-data").count(), 0, "data of a replay");
        const ww = page.locator(".block").nth(await blockOf(page, "ww"));
        const first = await ww.locator("tbody th a").first().textContent();
        await ww.locator("thead button", { hasText: "median" }).first().click();
        truth((await ww.locator("tbody th a").first().textContent()) !== first, "does not sort");
        equal(page.troubles.join("; "), "", "messages");
        await page.close();
        program("report", run);
    });
    await check("claims of any form are shown as far as they can be", async () => {
        program("run", "tt", "--out", `${work}/odd`, "--frames", "1-5", "--replicates", "1", "--method", "certified");
        const claims = ["[null, null]", "[1, null]", "[\"1\", 2]", "[1]", "[1, 9]"].map((interval, k) =>
            `{"id": "a${k}", "value": 7, "interval": ${interval}, "values": 5}`);
        writeFileSync(`${work}/odd/claims.json`, `[${claims.join(",")}, 7, null, {"id": 5, "values": [{}, 3]}]\n`);
        program("report", `${work}/odd`);
        const page = await open(browser, `${work}/odd`);
        const headlines = await page.locator(".claim .headline").allTextContents();
        equal(headlines.join("|"), "7|7|7|7|7 1 – 9|–", "headlines");
        equal(page.troubles.join("; "), "", "messages");
        await page.close();
    });
}
