"use strict";
// Unpacks the data of harness/report/packed.c: base 64 of deflated bytes.

// Every browser since 2023 supports this; without it the page has its tables, and links instead of
// drawings.
const canUnpack = typeof DecompressionStream === "function";

// The unpacked text.
async function unpack(packed) {
    const bytes = Uint8Array.from(atob(packed), (letter) => letter.charCodeAt(0));
    const plain = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    return new Response(plain).text();
}
