"use strict";
// Numbers for reading: three digits and a unit, as harness/base/number_text.c prints them on a
// terminal; and helpers that make the page's elements.

const NONE = "–";
const NARROW = "\u202f"; // a narrow blank, which does not break

// Digits after the decimal point for three significant digits.
function fixed(value) {
    const digits = value < 9.995 ? 2 : value < 99.95 ? 1 : 0;
    return value.toFixed(digits);
}

function timeText(ns) {
    const units = [[1e9, "s"], [1e6, "ms"], [1e3, "µs"]];
    const [scale, unit] = units.find(([least]) => ns >= least * 0.9995) ?? [1, "ns"];
    return `${ns === 0 ? "0" : fixed(ns / scale)}${NARROW}${unit}`;
}

function bytesText(bytes) {
    if (bytes < 10e3) return `${bytes.toFixed(0)}${NARROW}B`;
    const [scale, unit] = bytes < 10e6 ? [1e3, "kB"] : [1e6, "MB"];
    return `${(bytes / scale).toFixed(1)}${NARROW}${unit}`;
}

// "1.2e-3", "0.46", "1.1"; 0 unchanged.
function errorText(error) {
    if (error === 0) return "0";
    if (error < 0.095) return error.toExponential(1);
    return error.toFixed(error < 0.995 ? 2 : 1);
}

const countText = (value) => String(Number(value.toPrecision(4)));

// A share just below 1 must not be shown as 100 %.
function percentText(share) {
    const percent = 100 * share;
    const text = percent < 100 && percent >= 99.95 ? ">99.9" : percent.toFixed(1);
    return `${share === 1 ? "100" : text}${NARROW}%`;
}

const shows = {
    time: timeText,
    ratio: fixed,
    error: errorText,
    percent: percentText,
    count: countText,
    bytes: bytesText,
};

const isNumber = (value) => typeof value === "number" && Number.isFinite(value);
const show = (kind, value) => (isNumber(value) ? shows[kind](value) : NONE);
// Invalid values in a file from elsewhere are shown as nothing.
const listOf = (value) => (Array.isArray(value) ? value : []);
const textOf = (value) => (typeof value === "string" ? value : "");
const wholeText = (value) => (isNumber(value) ? value.toLocaleString("en") : NONE);

// "11.5 – 11.6 µs": the unit once if both ends have the same.
function intervalText(kind, low, high) {
    const [from, to] = [show(kind, low), show(kind, high)];
    const [unit, other] = [from, to].map((text) => text.split(NARROW)[1]);
    return `${unit && unit === other ? from.split(NARROW)[0] : from} – ${to}`;
}

// row[path[0]][path[1]]...; undefined if it does not exist.
const valueAt = (row, path) => path.reduce((value, key) => value?.[key], row);

// The interval of a column's value in a row; "" if it has none.
function intervalOf(row, column) {
    if (!column.interval || valueAt(row, column.path) === 0) return "";
    const { ci_low: low, ci_high: high } = valueAt(row, column.path.slice(0, -1)) ?? {};
    return isNumber(low) && isNumber(high) ? intervalText(column.show, low, high) : "";
}

// An element with attributes, texts and elements. Texts are never parsed as HTML.
function el(name, attributes = {}, ...children) {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) {
        if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
        else if (value === true) element.setAttribute(key, "");
        else if (value !== false && value !== undefined) element.setAttribute(key, value);
    }
    const wanted = children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false && child !== "");
    element.append(...wanted);
    return element;
}

// A configuration that may wrap after its colon and its commas.
const labelElements = (label) => label.split(/(?<=[:,])/).flatMap((part, k) => (k ? [el("wbr"), part] : [part]));

// A relative path as a URL: colons are escaped, too, or a path could be read as a scheme.
const pathAddress = (path) => path.split("/").map(encodeURIComponent).join("/");

// Text with `code` parts as elements.
function inline(text) {
    return text.split("`").map((part, k) => (k % 2 ? el("code", {}, part) : part));
}
