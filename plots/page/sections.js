"use strict";
// The frame of a page: its sections and the navigation to them.

function section(id, title, ...children) {
    return el("section", { "aria-labelledby": id }, el("h2", { id }, title), children);
}

const pairsList = (pairs) =>
    el("dl", {}, pairs.flatMap(([key, value]) => [el("dt", {}, key), el("dd", {}, value)]));

// A section that fails because a file is not what mote writes does not affect the others.
function made(name, make) {
    try {
        return [name, make()];
    } catch (error) {
        return [name, section(name.toLowerCase(), name, el("p", {}, `This section could not be made: ${error.message}.`))];
    }
}

function embedded(id) {
    const text = document.getElementById(id)?.textContent;
    return text ? JSON.parse(text) : null;
}

// sections: [name in the navigation, whether there is data for it, a function that makes it].
function showSections(sections) {
    const parts = sections.filter(([, wanted]) => wanted).map(([name, , make]) => made(name, make));
    document.querySelector("main").append(...parts.map(([, content]) => content));
    document.querySelector("nav").append(...parts.map(([name, content]) =>
        el("a", { href: `#${content.getAttribute("aria-labelledby")}` }, name)));
    // The target did not exist yet when the page was opened.
    if (location.hash) document.getElementById(decodeURIComponent(location.hash.slice(1)))?.scrollIntoView();
}
