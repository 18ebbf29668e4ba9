"use strict";
// The tables of results: each block of comparable rows is one table, which sorts by any column. The
// choices above the tables apply to all of them.

const COLOURS = 10; // classes c0 .. c9 of report.css
const SHAPES = ["circle", "square", "diamond"]; // of ten methods each

// The classes of the mark of the k-th method.
const markOf = (k) => `c${k % COLOURS} ${SHAPES[Math.floor(k / COLOURS) % SHAPES.length]}`;

const EXACTNESS = {
    any: ["any", () => true],
    exact: ["exact in every frame", (row) => row.right],
    contacts: ["no wrong contact", (row) => row.contacts_right],
    inexact: ["not exact", (row) => !row.right],
};

// Whether a row is as exact, and takes as little memory, as chosen: how much a crashed row takes is not known.
function passes(row, { exactness, memory }) {
    return (exactness === "any" || (row.status === "ok" && EXACTNESS[exactness][1](row))) &&
        (!memory || (isNumber(row.heap_peak_bytes) && row.heap_peak_bytes <= memory));
}

// Wrong contacts are marked.
const isOfContacts = (column) => column.group === "contacts";

class Block {
    constructor(data, block, choice, markOfRow) {
        this.data = data;
        this.choice = choice;
        this.rows = data.rows.slice(block.first, block.end);
        this.sorted = { column: 0, down: false };
        this.body = el("tbody");
        this.lines = new Map();
        this.heads = [];
        this.front = new Front(data, this.rows, markOfRow, (row, entered) =>
            this.lines.get(row)?.classList.toggle("pointed", entered));
        this.count = el("p", { class: "count" });
        this.wide = el("div", { class: "wide results", tabindex: 0, role: "region",
            "aria-label": `Results, ${this.rows[0].scene}` },
        el("table", {}, this.head(), this.body));
        const title = el("h3", {}, textOf(this.rows[0].scene), " ", el("span", { class: "aside" }, block.heading));
        this.element = el("div", { class: "block" }, title, block.caution && el("p", { class: "caution" }, block.caution),
            this.glance(block), this.front.element, this.count, this.wide);
        this.update();
    }

    columns() {
        return this.data.columns.filter((column) => this.choice.extra || !column.extra);
    }

    // The rows to mention first.
    glance(block) {
        const { rows, columns, time, error, best, engine } = this.data;
        const parts = [];
        const said = (row, column) => show(column.show, valueAt(row, column.path));
        const [right, fastest] = [rows[block.right], rows[block.fastest]];
        if (right) {
            parts.push("Fastest without a wrong answer in any frame: ", el("code", {}, right.label),
                `, ${said(right, time)} a ${right.bodies ? "frame" : "query"}`);
            // The best FCL is named beside the best engine only where it is another.
            const rivals = [[engine, "engine of others"], [best, "FCL"]].map(([column, kind]) =>
                ({ column, kind, to: valueAt(right, column.path.slice(0, -1))?.to }));
            for (const [i, { column, kind, to }] of rivals.entries())
                if (to && to !== right.label && to !== rivals[i - 1]?.to)
                    parts.push(`; the best ${kind}, `, el("code", {}, to), `, takes ${said(right, column)} times as long`);
            parts.push(". ");
        }
        if (fastest) {
            parts.push("Fastest of all: ", el("code", {}, fastest.label), `, ${said(fastest, time)}`);
            if (isNumber(valueAt(fastest, error.path)))
                parts.push(`, with an error of ${said(fastest, error)}${NARROW}L at the 99th percentile`);
            const wrong = columns.filter(isOfContacts).map((column) => `${said(fastest, column)} ${column.head}`);
            parts.push(`; contacts: ${wrong.join(", ")}.`);
        }
        return el("p", {}, parts);
    }

    // Two lines: the groups, and the columns, each a button that sorts.
    head() {
        this.headElement ??= el("thead");
        const columns = this.columns();
        const groups = [];
        for (const column of columns) {
            if (groups.at(-1)?.name === column.group) ++groups.at(-1).width;
            else groups.push({ name: column.group, width: 1 });
        }
        this.heads = columns.map((column) => this.headCell(column));
        this.headElement.replaceChildren(
            el("tr", {}, this.methodHead(), groups.map((group) =>
                el("th", { colspan: group.width, scope: "colgroup" }, group.name))),
            el("tr", {}, this.heads));
        return this.headElement;
    }

    methodHead() {
        const column = { path: ["label"], head: "method", meaning: "Method and the parameters that are not default" };
        this.method = this.headCell(column);
        this.method.setAttribute("rowspan", 2);
        return this.method;
    }

    headCell(column) {
        const index = this.data.columns.indexOf(column); // -1: the method
        const sorted = index === this.sorted.column;
        return el("th", { scope: "col", title: column.meaning,
            "aria-sort": sorted ? (this.sorted.down ? "descending" : "ascending") : undefined },
        el("button", { type: "button", onclick: () => this.sortBy(index) }, column.head));
    }

    sortBy(index) {
        this.sorted = { column: index, down: index === this.sorted.column && !this.sorted.down };
        const focus = this.heads.concat(this.method).findIndex((head) => head.contains(document.activeElement));
        this.head();
        this.update();
        this.heads.concat(this.method)[focus]?.querySelector("button").focus();
    }

    // Rows with positions given come after those charged for deformation: their times exclude it.
    order(rows) {
        const given = (row) => row.accounting === "given";
        return [...this.orderAlike(rows.filter((row) => !given(row))), ...this.orderAlike(rows.filter(given))];
    }

    // Rows without a value come last in either order.
    orderAlike(rows) {
        const { column, down } = this.sorted;
        const path = column < 0 ? ["label"] : this.data.columns[column].path;
        const key = (row) => (row.status === "ok" || column < 0 ? valueAt(row, path) : undefined);
        const compare = (a, b) => (typeof a === "string" ? a.localeCompare(b, "en", { numeric: true }) : a - b);
        const known = rows.filter((row) => (key(row) ?? null) !== null);
        const unknown = rows.filter((row) => (key(row) ?? null) === null);
        known.sort((a, b) => (down ? -1 : 1) * compare(key(a), key(b)));
        return [...known, ...unknown];
    }

    // The filtered rows; the table may show one of them per method, the front all.
    filtered() {
        const { method } = this.choice;
        return this.rows.filter((row) => (!method || row.method === method) && passes(row, this.choice));
    }

    update() {
        const filtered = this.filtered();
        const visible = filtered.filter((row) => this.choice.all || row.stands_for_method);
        this.lines.clear();
        this.body.replaceChildren(...this.order(visible).map((row) => this.line(row)));
        if (visible.length === 0)
            this.body.append(el("tr", {}, el("td", { class: "ended", colspan: this.columns().length + 1 },
                "No row matches.")));
        this.count.textContent = `${visible.length} of ${this.rows.length} configurations`;
        this.front.filter(filtered);
    }

    // Redraws with other columns.
    redraw() {
        this.head();
        this.wide.classList.toggle("all", this.choice.extra);
        this.update();
    }

    line(row) {
        const target = this.data.rows.indexOf(row) + 1;
        const address = row.address ?? (row.cells.length > 0 ? `#cells-${target}` : "summary.json");
        const notes = row.notes.map((note) => el("small", {}, note));
        const columns = this.columns();
        const cells = row.status === "ok"
            ? columns.map((column) => this.cell(row, column, address))
            : [el("td", { class: "ended", colspan: columns.length }, `${textOf(row.status)}: ${textOf(row.reason)}`)];
        const line = el("tr", {}, el("th", { scope: "row" }, el("a", { href: address }, labelElements(textOf(row.label))), notes), cells);
        this.lines.set(row, line);
        return line;
    }

    cell(row, column, address) {
        const value = valueAt(row, column.path);
        if (!isNumber(value)) return el("td", {}, NONE);
        const interval = intervalOf(row, column);
        return el("td", { class: value > 0 && isOfContacts(column) ? "wrong" : undefined },
            el("a", { tabindex: -1, href: address }, show(column.show, value)), interval && el("small", {}, interval));
    }
}

// What every table shows. more: [label, key, [value, text]...] of further choices.
function choices(methods, choice, changed, more = []) {
    const select = (label, key, options) => el("label", {}, `${label} `,
        el("select", { id: `choice-${key}`, onchange: (event) => {
            choice[key] = event.target.value;
            changed();
        } }, options.map(([value, text]) => el("option", { value, selected: value === choice[key] }, text))));
    return el("div", { class: "bar choices", role: "group", "aria-label": "What the tables show" },
        el("label", {}, "Rows ", el("select", { id: "choice-rows", onchange: (event) => {
            choice.all = event.target.value === "all";
            changed();
        } }, el("option", { value: "one" }, "one a method"), el("option", { value: "all" }, "all"))),
        select("Method", "method", [["", "all"], ...methods.map((method) => [method, method])]),
        select("Exactness", "exactness", Object.entries(EXACTNESS).map(([key, [text]]) => [key, text])),
        more.map(([label, key, ...options]) => select(label, key, options)),
        el("label", {}, el("input", { type: "checkbox", id: "choice-extra", onchange: (event) => {
            choice.extra = event.target.checked;
            changed();
        } }), " All columns"));
}

const methodsOf = (data) => [...new Set(data.rows.map((row) => textOf(row.method)))].sort();

const coloursLegend = (methods) => el("p", { class: "legend colours" }, methods.map((method, k) =>
    el("span", {}, el("span", { class: `swatch ${markOf(k)}` }), method)));

function blocksOf(data, choice) {
    const methods = methodsOf(data);
    const markOfRow = (row) => markOf(methods.indexOf(textOf(row.method)));
    return data.blocks.map((block) => new Block(data, block, choice, markOfRow));
}

// The section of results.
function resultsSection(data) {
    const choice = { all: false, method: "", exactness: "any", extra: false };
    const methods = methodsOf(data);
    const blocks = blocksOf(data, choice);
    const floor = isNumber(data.noise_floor)
        ? [" Measured twice, nine rows in ten differ from themselves by at most ", el("a", { href: "summary.json" },
            `${(100 * data.noise_floor).toFixed(1)}${NARROW}%`), " (the noise floor of this run)."] : [];
    return section("results", "Results",
        el("p", {}, "A row is one configuration, the fastest first. Times are medians over frames and replicates, with " +
            "95 % intervals below; errors are absolute, over the larger body's size L. Every number links to the " +
            "cells that it was computed from.", floor),
        el("p", {}, "“One a method” is the method's fastest configuration without a wrong contact and with a " +
            "p99 error of at most 0.01 L, or else its most accurate one."),
        choices(methods, choice, () => blocks.forEach((block) => block.redraw())), coloursLegend(methods),
        blocks.map((block) => block.element));
}
