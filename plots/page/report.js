"use strict";
// The page, section by section, from the data that harness/report/report_data.c put into it.

function askedSection(data) {
    const commands = data.commands.map(([when, command]) => `# ${when}\n${command}\n`).join("");
    const others = data.scenarios.filter(([, purpose]) => !purpose).map(([name]) => name);
    return section("asked", "What was asked",
        el("p", {}, "How much accuracy does a collision query by a few particles give up, and how much time and memory " +
            "does it save, against bounding volume hierarchies, on deforming triangle meshes? Every method gets the " +
            "same frames; its answers are compared with the exact distance."),
        pairsList(data.scenarios.filter(([, purpose]) => purpose)),
        others.length > 0 && el("p", {}, `Scenarios of ${data.scenarios.length > others.length ? "other " : ""}files: `,
            `${others.join(", ")}.`),
        commands && el("details", {}, el("summary", {}, "Commands that measured it"),
            el("pre", {}, el("code", {}, commands))));
}

function damagedSection(data) {
    return section("damaged", "Not readable, and so not on this page",
        el("ul", {}, data.damaged.map((what) => el("li", {}, inline(what)))));
}

// Filled by the replay's own program.
function replaySection(replay) {
    const absent = "This page has no replay: it was written without the program that draws it, which `make page` " +
        "bundles where Node and npm are. After that, `make report` adds it.";
    const old = "The replay needs a browser that can unpack its data (DecompressionStream): any of 2023 or later.";
    let content = el("p", {}, inline(absent));
    if (replay && !canUnpack) content = el("p", {}, old);
    else if (replay?.scenes.length > 0) content = el("div", { id: "replay-app" });
    else if (replay) content = el("p", {}, "No scenario of this run can be replayed.");
    const notes = replay?.notes ?? [];
    return section("replay", "Replay", content, notes.length > 0 &&
        el("details", {}, el("summary", {}, "Scenarios without a replay"),
            el("ul", {}, notes.map((note) => el("li", {}, note)))));
}

// --- figures: gnuplot draws them for white paper ---

// A colour for a dark page: light and dark are exchanged and the hue is kept; colours stay light enough
// to be visible.
function darkColour(r, g, b) {
    const [most, least] = [Math.max(r, g, b) / 255, Math.min(r, g, b) / 255];
    const lightness = (most + least) / 2;
    const spread = most - least;
    const saturation = spread === 0 ? 0 : spread / (1 - Math.abs(2 * lightness - 1));
    let hue = 0;
    if (spread > 0) {
        const [x, y, z] = [r, g, b].map((c) => c / 255);
        if (most === x) hue = 60 * (((y - z) / spread + 6) % 6);
        else if (most === y) hue = 60 * ((z - x) / spread + 2);
        else hue = 60 * ((x - y) / spread + 4);
    }
    const mirrored = 0.1 + 0.82 * (1 - lightness);
    const kept = saturation > 0.25 && spread > 0.12 ? Math.max(mirrored, 0.6) : mirrored;
    return `hsl(${hue.toFixed(0)} ${(saturation * 85).toFixed(0)}% ${(kept * 100).toFixed(1)}%)`;
}

// The drawing with every colour replaced. gnuplot writes #rrggbb, rgb(r, g, b), black and gray.
function darkDrawing(drawing) {
    const hex = (text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16));
    return drawing
        .replace(/(["'])(black|gray|white)\1/g, (all, quote, name) =>
            quote + darkColour(...{ black: [0, 0, 0], gray: [128, 128, 128], white: [255, 255, 255] }[name]) + quote)
        .replace(/rgb\( *(\d+), *(\d+), *(\d+) *\)/g, (all, r, g, b) => darkColour(+r, +g, +b))
        .replace(/#[0-9a-fA-F]{6}\b/g, (all) => darkColour(...hex(all)));
}

const dark = matchMedia("(prefers-color-scheme: dark)");

// A separate image: the names in different drawings cannot clash, and no script in one can run.
function figureElement(figure) {
    const address = pathAddress(figure.file);
    const caption = el("figcaption", {}, el("strong", {}, `${figure.title}.`), ` ${figure.caption}`);
    if (!figure.drawing || !canUnpack)
        return el("figure", {}, el("p", {}, el("a", { href: address },
            `${figure.animation ? "Animation" : "Drawing"}: ${figure.file}`)), caption);
    const image = el("img", { alt: figure.title });
    const drawing = unpack(figure.drawing);
    const draw = async () => {
        const plain = await drawing;
        image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(dark.matches ? darkDrawing(plain) : plain)}`;
    };
    dark.addEventListener("change", draw);
    draw();
    return el("figure", {}, el("a", { href: address }, image), caption);
}

// --- claims ---

function claimValue(value) {
    if (!isNumber(value.value)) return [NONE];
    const number = (x) => String(Number(x.toPrecision(4)));
    const unit = value.unit === "us" ? "µs" : textOf(value.unit);
    const parts = [number(value.value) + (unit ? NARROW + unit : "")];
    const ends = value.interval;
    if (Array.isArray(ends) && ends.length === 2 && ends.every(isNumber))
        parts.push(" ", el("small", {}, `${number(ends[0])} – ${number(ends[1])}`));
    return parts;
}

function thresholdText(threshold) {
    if (typeof threshold !== "object" || threshold === null) return "";
    const parts = [];
    if (isNumber(threshold.holds)) parts.push(`${threshold.holds}`);
    if (isNumber(threshold.limits)) parts.push(`${threshold.limits} within limits`);
    return `${textOf(threshold.bound)} ${parts.join(", ")}`.trim();
}

const VERDICTS = { holds: "good", "holds within limits": "fair" };

function claimElement(data, claim, file) {
    if (typeof claim !== "object" || claim === null) return null;
    const address = data.claims_folder + file;
    const rows = listOf(claim.values).map((value) => el("tr", {}, el("th", { scope: "row" }, textOf(value.name)),
        el("td", {}, el("a", { href: address }, claimValue(value))), el("td", {}, thresholdText(value.threshold))));
    const head = ["figure", "value", "threshold"].map((text) => el("th", { scope: "col" }, text));
    const verdict = textOf(claim.verdict);
    return el("details", { class: "claim" },
        el("summary", {}, el("span", { class: "id" }, textOf(claim.id)), el("span", { class: "what" }, textOf(claim.claim)),
            el("span", { class: `verdict ${VERDICTS[verdict] ?? "poor"}` }, verdict),
            el("span", { class: "headline" }, claimValue(claim))),
        el("p", {}, textOf(claim.section) && `Section ${claim.section}. `, `Measured: ${textOf(claim.measured)}.`),
        el("div", { class: "wide" }, el("table", { class: "values" }, el("thead", {}, el("tr", {}, head)),
            el("tbody", {}, rows))),
        textOf(claim.curve) && el("p", {}, "Curve: ", el("a", { href: data.claims_folder + pathAddress(claim.curve) }, claim.curve), "."));
}

function claimsSection(data) {
    const list = (claims, file) => claims.map((claim) => claimElement(data, claim, file));
    return section("claims", "Claims",
        data.claims && [el("p", {}, "What the paper claims, and what was measured of it. A verdict follows from the " +
            "figures and their thresholds alone."), list(data.claims, "claims.json")],
        data.requirements && [el("h3", {}, "Requirements"),
            el("p", {}, "What this implementation must show whatever the paper says."),
            list(data.requirements, "requirements.json")]);
}

// --- simulations ---

// A row a method: what `mote simulate` found. The figures are those of simulations.json.
function simulationsSection(data) {
    const columns = [
        ["replicates", (row) => wholeText(row.replicates)],
        ["time a step", (row) => [show("time", row.query_ns), isNumber(row.query_ns_low) &&
            ` (${intervalText("time", row.query_ns_low, row.query_ns_high)})`]],
        ["approaches", (row) => wholeText(row.approaches)],
        ["passes through", (row) => wholeText(row.passes_through)],
        ["missed steps", (row) => wholeText(row.missed_steps)],
        ["false steps", (row) => wholeText(row.false_steps)],
        ["penetration / L", (row) => show("error", row.max_penetration)],
    ];
    const head = ["scenario", "method", ...columns.map(([name]) => name)].map((text) => el("th", { scope: "col" }, text));
    const cells = (row) => row.steps === undefined
        ? el("td", { colspan: columns.length }, row.unsupported ? `unsupported: ${row.unsupported}` : "every replicate failed")
        : columns.map(([, value]) => el("td", {}, value(row)));
    return section("simulations", "Simulations",
        el("p", {}, "Bodies that move freely and collide where the method reports a contact. A pass is an approach to a " +
            "true contact that the method never reports. Counts are sums over the replicates; more figures are in ",
            el("a", { href: "simulations.json" }, "simulations.json"), "."),
        el("div", { class: "wide", tabindex: 0, role: "region", "aria-label": "Simulations" },
            el("table", {}, el("thead", {}, el("tr", {}, head)), el("tbody", {}, data.simulations.map((row) =>
                el("tr", {}, el("td", {}, textOf(row.scenario)), el("th", { scope: "row" }, labelElements(textOf(row.method))),
                    cells(row)))))));
}

// --- the end of the page ---

// The Markdown that the notes on defects use: headings, paragraphs, `code`, and indented code, which
// is folded.
function markdownElements(markdown) {
    const blocks = markdown.replace(/^# .*\n/m, "").split(/\n(?=#)|\n{2,}(?=\S)/);
    return blocks.flatMap((block) => {
        const heading = /^(#{2,5}) (.*)/.exec(block);
        const rest = (heading ? block.slice(heading[0].length) : block).replace(/^\n+|\s+$/g, "");
        const title = heading ? [el(`h${heading[1].length + 1}`, {}, inline(heading[2]))] : [];
        if (!rest) return title;
        if (rest.startsWith("    "))
            return [...title, el("details", {}, el("summary", {}, "Reproduction"),
                el("pre", {}, el("code", {}, rest.replace(/^ {4}/gm, ""))))];
        const [paragraph, ...code] = rest.split(/\n{2,}(?= {4})/);
        return [...title, el("p", {}, inline(paragraph)), ...(code.length ? markdownElements(code.join("\n\n")) : [])];
    });
}

function cellsSection(data) {
    const links = ([replicate, id, status]) => {
        const link = (kind) => el("a", { href: pathAddress(`cells/${id}.${kind}`) }, kind);
        return el("li", {}, `${replicate}: `, link("json"), " ", status === "ok" ? link("csv") : status);
    };
    const head = ["method", "scenario", "caches", "cells"].map((text) => el("th", { scope: "col" }, text));
    return section("cells", "Raw cells",
        el("p", {}, "A cell is one process: ", el("em", {}, "json"), " says what was measured, ", el("em", {}, "csv"),
            " has a row a frame. The numbers stand for the replicates."),
        el("div", { class: "wide", tabindex: 0, role: "region", "aria-label": "Raw cells" },
            el("table", { class: "cells" }, el("thead", {}, el("tr", {}, head)), el("tbody", {},
                data.rows.map((row, k) => el("tr", { id: `cells-${k + 1}` }, el("th", { scope: "row" }, labelElements(row.label)),
                    el("td", {}, row.scene), el("td", {}, row.cache), el("td", {}, el("ul", {}, row.cells.map(links)))))))));
}

// Name in the navigation, and the section; only sections for which the run has data.
function sections(data, replay) {
    const hasCells = data.rows.some((row) => row.cells.length > 0);
    const machine = () => section("machine", "The machine and the program", pairsList(data.machine),
        el("p", {}, "From ", el("a", { href: "manifest.json" }, "manifest.json"), "."));
    const defects = () => section("defects", "Known defects of the baselines",
        el("div", { class: "prose" }, markdownElements(data.defects)));
    return [
        ["Asked", true, () => askedSection(data)],
        ["Damaged", data.damaged.length > 0, () => damagedSection(data)],
        ["Results", data.rows.length > 0, () => resultsSection(data)],
        ["Replay", hasCells, () => replaySection(replay)],
        ["Figures", data.figures.length > 0, () => section("figures", "Figures", data.figures.map(figureElement))],
        ["Simulations", data.simulations, () => simulationsSection(data)],
        ["Claims", data.claims || data.requirements, () => claimsSection(data)],
        ["Machine", data.machine.length > 0, machine],
        ["Known defects", data.defects, defects],
        ["Raw cells", hasCells, () => cellsSection(data)],
    ];
}

function showReport() {
    const data = embedded("report-data");
    showSections(sections(data, embedded("replay-data")));
    if (data.missing.length > 0)
        document.querySelector("main").append(
            el("p", { class: "legend", id: "missing" }, "Not in this report: ", inline(`${data.missing.join("; ")}.`)));
}

showReport();
