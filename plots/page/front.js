"use strict";
// Time against error of one table's rows: a point per row, and the front of the rows that no other row
// beats in both. Points can be used with the pointer and the keyboard.

const EXACT = 1e-6; // errors up to here are drawn on the lowest line

function svg(name, attributes = {}, ...children) {
    const element = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.append(...children);
    return element;
}

// The text of a point: the columns that its table shows at first.
function pointLines(row, columns) {
    return columns.filter((column) => !column.extra).map((column) => {
        const interval = intervalOf(row, column);
        return `${column.group} ${column.head}: ${show(column.show, valueAt(row, column.path))}` +
            (interval ? ` (${interval})` : "");
    });
}

// "n 5, law log, ...": every parameter, including defaults.
const parametersText = (row) =>
    Object.entries(row.parameters ?? {}).map(([key, value]) => `${key} ${value}`).join(", ");

// The element of a point, by its shape; all shapes cover about the same area.
function outline(mark, x, y) {
    if (!/square|diamond/.test(mark)) return { name: "circle", cx: x, cy: y, r: 6 };
    const square = { name: "rect", x: x - 5.3, y: y - 5.3, width: 10.6, height: 10.6 };
    return mark.includes("diamond") ? { ...square, transform: `rotate(45 ${x} ${y})` } : square;
}

class Front {
    // data: the page's. markOf(row): the classes of its colour and shape. onPoint(row, entered): called
    // when the pointer moves.
    constructor(data, rows, markOf, onPoint) {
        this.columns = data.columns;
        this.timeOf = (row) => valueAt(row, data.time.path);
        this.errorOf = (row) => valueAt(row, data.error.path);
        this.rows = rows.filter((row) =>
            row.status === "ok" && isNumber(this.errorOf(row)) && this.timeOf(row) > 0);
        this.markOf = markOf;
        this.onPoint = onPoint;
        this.tip = el("div", { class: "tip", role: "status", hidden: true });
        this.canvas = el("div", { class: "front" });
        this.element = el("figure", { class: "front-figure" }, this.canvas, this.tip,
            el("figcaption", {}, `Median time of a query against the error that 99${NARROW}% of the frames do not ` +
                "exceed. The line joins the rows that no other row beats in both. Hollow points are given all vertices, " +
                "do not pay for deformation, and are not compared with the others. Point at one for its figures."));
        if (this.rows.length > 1)
            new ResizeObserver(([entry]) => this.draw(entry.contentRect.width)).observe(this.canvas);
        else this.element.hidden = true;
    }

    // Shows only the points of these rows.
    filter(visible) {
        this.visible = new Set(visible);
        if (this.width) this.draw(this.width);
    }

    draw(width) {
        if (width < 50) return;
        this.width = width;
        this.tip.hidden = true;
        const height = Math.round(Math.min(340, 200 + width / 6));
        const shown = this.rows.filter((row) => !this.visible || this.visible.has(row));
        this.scale(width, height);
        const points = shown.map((row) => this.point(row));
        this.canvas.replaceChildren(svg("svg", {
            viewBox: `0 0 ${width} ${height}`, width, height, role: "group",
            "aria-label": "Time against error, a point a configuration",
        }, ...this.axes(width, height), this.line(shown), ...points));
    }

    // Axes over all rows, so that filtering moves no point.
    scale(width, height) {
        const times = this.rows.map((row) => this.timeOf(row) / 1e3);
        const errors = this.rows.map((row) => Math.max(this.errorOf(row), EXACT));
        const decades = (values, low, high) =>
            [Math.log10(Math.min(...values)) - low, Math.log10(Math.max(...values)) + high];
        const [left, right] = decades(times, 0.15, 0.15);
        const [bottom, top] = decades([EXACT, ...errors], 0.25, 0.25);
        const box = { left: 70, right: width - 10, top: 8, bottom: height - 42 };
        this.box = box;
        this.range = { left, right, bottom, top };
        this.x = (us) => box.left + ((Math.log10(us) - left) / (right - left)) * (box.right - box.left);
        this.y = (error) => box.bottom -
            ((Math.log10(Math.max(error, EXACT)) - bottom) / (top - bottom)) * (box.bottom - box.top);
    }

    axes(width, height) {
        const { box, range } = this;
        const parts = [];
        const tick = (k) => (k >= 0 && k < 4 ? String(10 ** k) : `10${superscript(k)}`);
        for (let k = Math.ceil(range.left); k <= range.right; ++k) {
            const x = this.x(10 ** k);
            parts.push(svg("line", { class: "grid", x1: x, x2: x, y1: box.top, y2: box.bottom }),
                svg("text", { x, y: box.bottom + 17, "text-anchor": "middle" }, tick(k)));
        }
        for (let k = Math.log10(EXACT); k <= range.top; ++k) {
            const y = this.y(10 ** k);
            const text = 10 ** k <= EXACT ? `≤ 10${superscript(k)}` : tick(k);
            parts.push(svg("line", { class: "grid", x1: box.left, x2: box.right, y1: y, y2: y }),
                svg("text", { x: box.left - 8, y: y + 4, "text-anchor": "end" }, text));
        }
        parts.push(svg("text", { x: (box.left + box.right) / 2, y: height - 6, "text-anchor": "middle" },
            "median time of a query, µs"));
        parts.push(svg("text", {
            transform: `translate(13 ${(box.top + box.bottom) / 2}) rotate(-90)`, "text-anchor": "middle",
        }, "p99 error over L"));
        return parts;
    }

    // The steps of the front of these rows.
    line(rows) {
        const order = rows.filter((row) => row.accounting !== "given").sort((a, b) => this.timeOf(a) - this.timeOf(b));
        let least = Infinity;
        let path = "";
        for (const row of order) {
            const error = Math.max(this.errorOf(row), EXACT);
            if (error >= least) continue;
            const [x, y] = [this.x(this.timeOf(row) / 1e3), this.y(error)];
            path += path ? `H${x}V${y}` : `M${x} ${y}`;
            least = error;
        }
        if (path) path += `H${this.box.right}`;
        return svg("path", { class: "steps", d: path });
    }

    point(row) {
        const [x, y] = [this.x(this.timeOf(row) / 1e3), this.y(this.errorOf(row))];
        const text = [row.label, ...pointLines(row, this.columns)].join("; ");
        const mark = this.markOf(row);
        const { name, ...place } = outline(mark, x, y);
        const point = svg(name, {
            class: `point ${mark}${row.accounting === "given" ? " given" : ""}`, ...place, tabindex: 0, role: "img", "aria-label": text,
        });
        const enter = () => this.enter(row, x, y);
        const leave = () => this.leave(row);
        for (const [name, listener] of [["pointerenter", enter], ["focus", enter], ["pointerleave", leave],
            ["blur", leave]])
            point.addEventListener(name, listener);
        return point;
    }

    enter(row, x, y) {
        this.tip.replaceChildren(el("strong", {}, row.label),
            ...pointLines(row, this.columns).map((line) => el("span", {}, line)),
            el("span", { class: "parameters" }, parametersText(row)));
        this.tip.hidden = false;
        const room = this.canvas.clientWidth - this.tip.offsetWidth;
        this.tip.style.left = `${Math.max(0, Math.min(room, x + 14))}px`;
        this.tip.style.top = `${y + 14}px`;
        this.onPoint(row, true);
    }

    leave(row) {
        this.tip.hidden = true;
        this.onPoint(row, false);
    }
}

const superscript = (k) => String(k).replace(/./g, (c) => ({ "-": "⁻" })[c] ?? "⁰¹²³⁴⁵⁶⁷⁸⁹"[c]);
