"use strict";
// Data that harness/report/packed.c made small: base 64 of deflated bytes.

// Every browser since 2023 can; without it the page has its tables, and links where drawings were.
const canUnpack = typeof DecompressionStream === "function";

// The text that was packed.
async function unpack(packed) {
    const bytes = Uint8Array.from(atob(packed), (letter) => letter.charCodeAt(0));
    const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    return new Response(plain).text();
}
