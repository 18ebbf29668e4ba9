"use strict";
// The page of several runs, from the data that harness/report/site.c put into it: one ranking of the methods,
// a table with a line a scene and a column a method, and each scene's own table.

const MEMORY = [["", "any"], ["1e5", "up to 100 kB"], ["1e6", "up to 1 MB"], ["1e7", "up to 10 MB"], ["1e8", "up to 100 MB"]];

const askText = (ask) => ({ distance: "the distance", contact: "whether the bodies touch" })[ask] ?? (ask || "not recorded");
const dayOf = (run) => run.started.slice(0, 10) || "an unknown day";
const different = (list) => [...new Set(list)];
const counted = (count, name) => `${count} ${name}${count === 1 ? "" : "s"}`;
const median = (values) => {
    const sorted = [...values].sort((a, b) => a - b);
    const middle = sorted.length >> 1;
    return sorted.length % 2 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
};

// "2 runs of 2 days, by 2 builds": what a list of rows mixes.
function origin(data, rows) {
    const runs = different(rows.map((row) => row.run)).map((index) => data.runs[index]);
    const [days, builds] = [different(runs.map(dayOf)), different(runs.map((run) => run.program))];
    return { runs, text: `${counted(runs.length, "run")} of ${days.length === 1 ? days[0] : counted(days.length, "day")}, ` +
        `by ${counted(builds.length, "build")}` };
}

// What a scene's rows were asked, and what must not be compared in them.
function cautionOf(data, block) {
    const rows = data.rows.slice(block.first, block.end);
    const { runs, text } = origin(data, rows);
    const [first, last] = block.frames;
    const parts = [`Asked: ${askText(block.ask)}`];
    if (block.tolerance > 0) parts.push(`, contact within ${block.tolerance}`);
    if (first > 0) parts.push(`, frames ${first} to ${last}`);
    parts.push(`; scene ${textOf(block.fingerprint).slice(0, 8)}, on ${block.machine || "an unknown machine"}; ${text}.`);
    if (runs.length > 1)
        parts.push(" Times of different runs are side by side here, not paired: the machine may have been busier in one. " +
            "Ratios are within a run.");
    return parts.join("");
}

// Each row knows its run: where it links to, and what is said below its method.
function prepare(data) {
    for (const row of data.rows) {
        const run = data.runs[row.run];
        row.address = pathAddress(`${run.folder}/${run.report ? "report.html" : "summary.json"}`);
        row.notes.push(`${run.name}, ${dayOf(run)}`);
    }
    for (const block of data.blocks) block.caution = cautionOf(data, block);
}

// Of the rows of one method on one scene, the one to show: the fastest that passes, and if there is one, one
// that stands for its method in its run.
function chosenRow(data, rows, choice) {
    const timed = rows.filter((row) => row.status === "ok" && row.times_comparable !== false &&
        row.accounting !== "given" && passes(row, choice) && valueAt(row, data.time.path) > 0);
    const standing = timed.filter((row) => row.stands_for_method);
    const list = standing.length > 0 ? standing : timed;
    return list.reduce((best, row) => (!best || valueAt(row, data.time.path) < valueAt(best, data.time.path) ? row : best), null);
}

const visibleBlocks = (data, choice) => data.blocks.filter((block) =>
    block.ask === choice.ask && (!choice.machine || block.machine === choice.machine));

// method -> the chosen row of each visible scene, null where it has none
function chosenRows(data, choice) {
    const blocks = visibleBlocks(data, choice);
    const table = new Map();
    for (const method of methodsOf(data).filter((name) => !choice.method || name === choice.method)) {
        const chosen = blocks.map((block) => chosenRow(data,
            data.rows.slice(block.first, block.end).filter((row) => row.method === method), choice));
        if (chosen.some((row) => row)) table.set(method, chosen);
    }
    return { blocks, table };
}

function rankingLines(data, table) {
    const lines = [...table].map(([method, chosen]) => {
        const rows = chosen.filter((row) => row);
        const ratios = rows.map((row) => valueAt(row, data.ratio.path)).filter(isNumber);
        const most = (values) => values.filter(isNumber).reduce((a, b) => Math.max(a, b), -Infinity);
        return {
            method, scenes: rows.length, compared: ratios.length,
            ratio: ratios.length > 0 ? median(ratios) : NaN,
            error: most(rows.map((row) => valueAt(row, data.error.path))),
            wrong: rows.reduce((sum, row) => sum + (row.missed || 0) + (row.false_contacts || 0), 0),
            memory: most(rows.map((row) => valueAt(row, data.memory.path))),
        };
    });
    const key = (line) => (isNumber(line.ratio) ? line.ratio : -1);
    return lines.sort((a, b) => key(b) - key(a) || a.method.localeCompare(b.method, "en"));
}

function rankingTable(data, { blocks, table }) {
    const lines = rankingLines(data, table).map((line) => el("tr", {}, el("th", { scope: "row" }, line.method),
        el("td", {}, show("ratio", line.ratio)), el("td", {}, `${line.compared} of ${blocks.length}`),
        el("td", {}, show("error", line.error)),
        el("td", { class: line.wrong > 0 ? "wrong" : undefined }, show("count", line.wrong)),
        el("td", {}, show("bytes", line.memory))));
    const heads = [["method", "Its fastest configuration that passes the filters, on each scene"],
        ["FCL / this", "Median over scenes: how many times slower FCL's AABB tree is in the same run"],
        ["scenes", "On how many of the scenes it was measured beside FCL's AABB tree"],
        ["worst p99 error / L", "The largest of its 99th percentiles of the error"],
        ["wrong contacts", "Frames missed or falsely reported, summed over scenes"],
        ["most memory", "The largest peak of its heap"]];
    if (lines.length === 0) lines.push(el("tr", {}, el("td", { class: "ended", colspan: heads.length }, "No row matches.")));
    return el("table", {}, el("thead", {}, el("tr", {}, heads.map(([text, title]) => el("th", { scope: "col", title }, text)))),
        el("tbody", {}, lines));
}

// What the ranking is of, and what it is not.
function rankingCaution(data, choice, { table }) {
    const rows = [...table.values()].flat().filter((row) => row);
    const machines = different(rows.map((row) => textOf(row.machine)));
    const mixed = origin(data, rows);
    const parts = [`Asked: ${askText(choice.ask)}. The error is that of the distance, over the size L of the larger body; ` +
        `exactness: ${EXACTNESS[choice.exactness][0]}. `,
    "The ratio compares a method with FCL's AABB tree frame by frame within one run, so no time of one run is divided by " +
        "one of another. Methods that were measured on different scenes are not comparable by its median. "];
    if (rows.length > 0)
        parts.push(`Mixed here: ${mixed.text}, on ${counted(machines.length, "machine")}` +
            `${machines.length > 1 ? "; choose one machine above to keep to it" : ""}.`);
    return el("p", { class: "caution" }, parts);
}

function matrixCell(data, row) {
    if (!row) return el("td", {}, NONE);
    const ratio = valueAt(row, data.ratio.path);
    const wrong = (row.missed || 0) + (row.false_contacts || 0);
    const said = row.right ? (isNumber(ratio) ? `${show("ratio", ratio)} ×` : "")
        : wrong > 0 ? `${show("count", wrong)} wrong` : `p99 ${show("error", valueAt(row, data.error.path))}`;
    const title = [row.label, ...pointLines(row, data.columns), ...row.notes].join("\n");
    return el("td", { class: wrong > 0 ? "wrong" : undefined },
        el("a", { href: row.address, title }, show("time", valueAt(row, data.time.path))), el("small", {}, said));
}

function matrix(data, { blocks, table }) {
    const methods = rankingLines(data, table).map((line) => line.method);
    const several = different(blocks.map((block) => block.machine)).length > 1;
    const lines = blocks.map((block, k) => el("tr", {},
        el("th", { scope: "row" }, el("a", { href: `#scene-${data.blocks.indexOf(block)}` }, data.rows[block.first].scene),
            el("small", {}, [data.rows[block.first].cache, several && block.machine].filter(Boolean).join(", "))),
        methods.map((method) => matrixCell(data, table.get(method)[k]))));
    return el("table", {}, el("thead", {}, el("tr", {}, ["scene", ...methods].map((text) => el("th", { scope: "col" }, text)))),
        el("tbody", {}, lines));
}

function resultsSections(data) {
    const count = (ask) => data.blocks.filter((block) => block.ask === ask).reduce((sum, block) => sum + block.end - block.first, 0);
    const asks = different(data.blocks.map((block) => block.ask)).sort((a, b) => count(b) - count(a));
    const machines = different(data.blocks.map((block) => block.machine)).sort();
    const choice = { all: false, method: "", exactness: "any", extra: false, ask: asks[0], machine: "", memory: "" };
    const blocks = blocksOf(data, choice);
    blocks.forEach((block, k) => { block.element.id = `scene-${k}`; });
    const wide = (label) => el("div", { class: "wide plain", tabindex: 0, role: "region", "aria-label": label });
    const [ranking, overview] = [wide("Ranking"), wide("Scenes and methods")];
    const caution = el("div");
    const update = () => {
        const chosen = chosenRows(data, choice);
        ranking.replaceChildren(rankingTable(data, chosen));
        overview.replaceChildren(matrix(data, chosen));
        caution.replaceChildren(rankingCaution(data, choice, chosen));
        const visible = new Set(chosen.blocks);
        blocks.forEach((block, k) => {
            block.element.hidden = !visible.has(data.blocks[k]);
            if (!block.element.hidden) block.redraw();
        });
    };
    const more = [["Asked", "ask", ...asks.map((ask) => [ask, askText(ask)])],
        ["Memory", "memory", ...MEMORY],
        ["Machine", "machine", ["", "all"], ...machines.map((machine) => [machine, machine || "not recorded"])]];
    const bar = choices(methodsOf(data), choice, update, more);
    update();
    return [
        section("ranking", "Ranking", bar, caution, ranking),
        section("overview", "Scenes and methods",
            el("p", {}, "A cell is the median time of a query, deformation and refit included, of the method's fastest configuration that " +
                "passes the filters and stands for it; below, how many times slower FCL's AABB tree is in the same run, or " +
                "what is wrong. Each links to the report of its run."), overview),
        section("scenes", "Each scene", coloursLegend(methodsOf(data)), blocks.map((block) => block.element)),
    ];
}

function runsSection(data) {
    const file = (run, name) => el("a", { href: pathAddress(`${run.folder}/${name}`) }, name);
    return section("runs", "Runs",
        el("p", {}, "The rows of all of them are in ", el("a", { href: "results.csv" }, "results.csv"), "."),
        data.left_out?.length > 0 && [el("p", {}, "Shown once:"), el("ul", {}, data.left_out.map((text) => el("li", {}, text)))],
        data.runs.map((run, k) => el("details", { id: `run-${k}` },
            el("summary", {}, `${run.name}: ${dayOf(run)}, ${counted(run.rows, "row")}`),
            el("p", {}, run.report ? file(run, "report.html") : file(run, "summary.json")), pairsList(run.machine),
            run.commands.length > 0 && el("pre", {}, el("code", {}, run.commands.map(([when, command]) => `# ${when}\n${command}\n`).join(""))))));
}

function showSite() {
    const data = embedded("site-data");
    prepare(data);
    const results = data.rows.length > 0 ? resultsSections(data) : [];
    showSections([
        ["Ranking", results.length > 0, () => results[0]],
        ["Scenes and methods", results.length > 0, () => results[1]],
        ["Each scene", results.length > 0, () => results[2]],
        ["Runs", true, () => runsSection(data)],
    ]);
}

showSite();
