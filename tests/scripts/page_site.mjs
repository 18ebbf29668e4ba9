// The page of several runs (mote site), for page.mjs: compares it with the runs' own summary.json.
import { cpSync, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const NARROW = "\u202f";
const rowsOf = (directory) => JSON.parse(readFileSync(`${directory}/summary.json`, "utf8")).rows;

// A copy of a run as if measured on another machine, a day later, with a row that crashed.
function makeOther(run, directory) {
    rmSync(directory, { recursive: true, force: true });
    mkdirSync(directory, { recursive: true });
    const summary = JSON.parse(readFileSync(`${run}/summary.json`, "utf8"));
    for (const row of summary.rows) {
        row.machine = "another machine";
        row.total_ns.median *= 0.5;
    }
    const [row] = summary.rows.filter(({ method }) => method === "particle-paper");
    summary.rows.push({ ...row, label: "particle-paper:n=9", parameters: { ...row.parameters, n: 9 }, status: "crashed",
        reason: "signal 11", heap_peak_bytes: null });
    writeFileSync(`${directory}/summary.json`, JSON.stringify(summary));
    const manifest = readFileSync(`${run}/manifest.json`, "utf8").replace(/("started": ")[^T]*T/g, "$12031-05-06T");
    writeFileSync(`${directory}/manifest.json`, manifest);
}

// The same machine, later: its rows stand beside the first run's.
function makeLater(run, directory) {
    cpSync(`${run}/../other`, directory, { recursive: true });
    writeFileSync(`${directory}/summary.json`, readFileSync(`${run}/summary.json`, "utf8").replace(/"replicates": 1,/g, '"replicates":  1,'));
}

const passing = (rows) => rows.filter((row) => row.status === "ok" && row.times_comparable && row.accounting !== "given");
const cellOf = (page, table, line, head) => page.evaluate(([id, first, name]) => {
    const element = document.querySelector(`section[aria-labelledby=${id}] table`);
    const column = [...element.querySelectorAll("thead th")].findIndex((th) => th.textContent === name);
    const row = [...element.querySelectorAll("tbody tr")].find((tr) => tr.cells[0].textContent.startsWith(first));
    const cell = row?.cells[column];
    return cell && { text: cell.textContent, href: cell.querySelector("a")?.href ?? "", wrong: cell.className };
}, [table, line, head]);
const lines = (page, id) => page.locator(`section[aria-labelledby=${id}] tbody tr`).count();
const shownBlocks = (page) => page.locator(".block:not([hidden])").count();

async function testContent(page, { check, equal, truth }, runs, site) {
    const all = runs.flatMap(rowsOf);
    await check("the site has a line a row in its CSV, and names every run", async () => {
        equal(readFileSync(`${site}/results.csv`, "utf8").trim().split("\n").length, all.length + 1, "lines");
        equal(await page.locator("#runs ~ details, section[aria-labelledby=runs] details").count(), runs.length, "runs");
    });
    await check("a cell of the overview is the fastest row that stands for its method, and links to its report", async () => {
        await page.locator("#choice-machine").selectOption("another machine");
        const row = passing(rowsOf(runs[1])).filter(({ scenario, method, stands_for_method: stands }) =>
            scenario === "ww" && method === "certified" && stands)[0];
        const cell = await cellOf(page, "overview", "ww", "certified");
        const us = row.total_ns.median / 1e3;
        truth(cell.text.startsWith(us.toFixed(us < 9.995 ? 2 : us < 99.95 ? 1 : 0) + NARROW), `${cell.text}, not ${us} µs`);
        truth(cell.href.endsWith("/other/summary.json"), cell.href); // it has no report
        await page.locator("#choice-machine").selectOption("");
        for (const link of await page.locator("section[aria-labelledby=overview] td a").evaluateAll((list) => list.map((a) => a.href)))
            truth(existsSync(fileURLToPath(link)), `no ${link}`);
        truth((await cellOf(page, "overview", "ww-1k", "particle-paper")).href.endsWith("/several/report.html"), "the report");
    });
    await check("the ranking has the median over scenes of the ratios within runs", async () => {
        await page.locator("#choice-machine").selectOption("another machine");
        await page.locator("#choice-ask").selectOption("distance");
        const ratios = passing(rowsOf(runs[1])).filter((row) => row.ask === "distance" && row.method === "certified")
            .map((row) => row.ratio.value).sort((a, b) => a - b);
        const middle = (ratios[(ratios.length - 1) >> 1] + ratios[ratios.length >> 1]) / 2;
        const { text } = await cellOf(page, "ranking", "certified", "FCL / this");
        truth(Math.abs(Number(text) / middle - 1) < 6e-3, `${text}, not ${middle}`);
        await page.locator("#choice-machine").selectOption("");
    });
    await check("what a ranking mixes is said: machines, days, runs; and what was asked", async () => {
        const said = () => page.locator("section[aria-labelledby=ranking] .caution").textContent();
        truth(/Asked: the distance\..*exactness: any/.test(await said()), await said());
        truth(/Mixed here: \d runs of 2 days, by \d builds?, on 2 machines; choose one/.test(await said()), await said());
        await page.locator("#choice-machine").selectOption("another machine");
        truth(/Mixed here: 1 run of 2031-05-06, by 1 build, on 1 machine\./.test(await said()), await said());
        await page.locator("#choice-machine").selectOption("");
        const cautions = await page.locator(".block .caution").allTextContents();
        truth(cautions.some((text) => /2 runs of 2 days.*not paired/.test(text)), "rows of two runs side by side");
        truth(cautions.every((text) => /^Asked: .*scene [0-9a-f]{8}, on /.test(text)), "what each scene was asked");
    });
}

async function testFilters(page, { check, equal, truth }, runs) {
    const all = runs.flatMap(rowsOf);
    await check("filters by exactness, memory, machine and question act on ranking, overview and scenes", async () => {
        const before = await lines(page, "ranking");
        await page.locator("#choice-exactness").selectOption("exact");
        equal(await cellOf(page, "ranking", "particle-paper", "method") === undefined,
            !passing(all).some((row) => row.ask === "distance" && row.method === "particle-paper" && row.missed === 0 &&
                row.false_contacts === 0 && !(row.error.max > 1e-9)), "particle-paper");
        await page.locator("#choice-exactness").selectOption("any");
        await page.locator("#choice-memory").selectOption("1e5");
        const small = new Set(passing(all).filter((row) => row.ask === "distance" && row.heap_peak_bytes <= 1e5).map((row) => row.method));
        equal(await lines(page, "ranking"), Math.max(1, small.size), "methods of little memory");
        await page.locator("#choice-rows").selectOption("all");
        const crashed = page.locator(".block:not([hidden]) td.ended", { hasText: "crashed" });
        equal(await crashed.count(), 0, "rows of unknown memory");
        await page.locator("#choice-memory").selectOption("");
        equal(await crashed.count(), 1, "rows that crashed");
        await page.locator("#choice-rows").selectOption("one");
        equal(await lines(page, "ranking"), before, "all again");
        const [total, asks] = [await page.locator(".block").count(), await page.locator("#choice-ask option").count()];
        equal(asks, new Set(all.map((row) => row.ask)).size, "questions");
        let shown = 0;
        for (const ask of new Set(all.map((row) => row.ask))) {
            await page.locator("#choice-ask").selectOption(ask);
            shown += await shownBlocks(page);
        }
        equal(shown, total, "each scene under one question");
        await page.locator("#choice-ask").selectOption("distance");
    });
    await check("pointing at a front shows method, parameters, figures and interval", async () => {
        await page.locator("#choice-rows").selectOption("all");
        const block = page.locator(".block:not([hidden])").filter({ has: page.locator(".point") }).first();
        await block.locator(".point").first().hover();
        const tip = block.locator(".tip:visible");
        const label = await tip.locator("strong").textContent();
        const row = all.find((other) => other.label === label);
        for (const [key, value] of Object.entries(row.parameters))
            truth((await tip.textContent()).includes(`${key} ${value}`), `no ${key}`);
        truth(/total median: .*(µs|ns|ms)/.test(await tip.textContent()), "no time");
        truth(/error \/ L p99: /.test(await tip.textContent()), "no error");
    });
}

// open(browser, directory, options, before, file); program(...words)
export async function testSite(browser, tools, open, program, work) {
    const { check, equal, truth } = tools;
    makeOther(`${work}/run`, `${work}/other`);
    makeLater(`${work}/run`, `${work}/later`);
    const runs = ["run", "other", "later", "several", "letters", "hostile"].map((name) => `${work}/${name}`);
    program("site", ...runs, "-o", `${work}/site`);
    const page = await open(browser, `${work}/site`, {}, null, "index.html");
    await testContent(page, tools, runs, `${work}/site`);
    await testFilters(page, tools, runs);
    await check("names from elsewhere are text on the site, and nothing is asked for or said", async () => {
        truth((await page.locator("main").textContent()).includes("<script>"), "the hostile name is not shown");
        equal(page.troubles.join("; "), "", "troubles");
    });
    await page.close();
    for (const colorScheme of ["light", "dark"]) {
        await check(`the site fits 400 pixels, ${colorScheme}`, async () => {
            const narrow = await open(browser, `${work}/site`, { viewport: { width: 400, height: 800 }, colorScheme }, null, "index.html");
            equal(await narrow.evaluate(() => document.documentElement.scrollWidth), 400, "width");
            equal(narrow.troubles.join("; "), "", "troubles");
            await narrow.screenshot({ path: `${work}/site-400-${colorScheme}.png`, fullPage: true });
            await narrow.close();
        });
    }
}
