// The replay of a run's report: choices, display and keys.
import { readScenes } from "./data.js";
import { Stage } from "./stage.js";
import { Surface } from "./surface.js";
import { Timeline } from "./timeline.js";

const MARKUP = `
<div class="stage">
  <canvas tabindex="0" role="img" aria-label="The two bodies in three dimensions. Drag to turn. Space plays
    and pauses, arrow keys step."></canvas>
  <p class="badge" id="replay-contact"></p>
</div>
<canvas class="timeline" aria-hidden="true"></canvas>
<input type="range" id="replay-slider" aria-label="Frame">
<div class="bar">
  <button type="button" id="replay-play">Play</button>
  <button type="button" id="replay-worst">Worst frame</button>
  <label>Frame <input type="number" id="replay-frame"></label>
  <label>Frames a second <select id="replay-speed"><option>10<option selected>30<option>60<option>120
    </select></label>
  <label><input type="checkbox" id="replay-close"> Follow the closest points</label>
</div>
<div class="bar">
  <label id="replay-scenes">Scenario <select id="replay-scene"></select></label>
  <label>Method <select id="replay-method"></select></label>
  <label>n <select id="replay-n"></select></label>
</div>
<dl class="readout">
  <div><dt><span class="mark truth"></span>True distance</dt><dd><output id="replay-truth"></output></dd></div>
  <div><dt><span class="mark method"></span>Method's distance</dt><dd><output id="replay-distance"></output></dd></div>
  <div><dt>Error over L</dt><dd><output id="replay-error"></output></dd></div>
  <div><dt>Answered at</dt><dd><output id="replay-answered"></output></dd></div>
</dl>
<p class="legend">Particles <span class="mark first"></span> and <span class="mark second"></span>,
closest points and the place of a contact are drawn over the surfaces. The strip shows distances over
frames: contacts shaded, missed ones marked below in red, false ones in yellow. Space plays and pauses,
← → step, with Shift by ten, Home and End go to the ends, W to the worst frame.
<span id="replay-origin"></span></p>
<details id="replay-notes"><summary>What is not shown</summary><ul></ul></details>`;

const root = document.getElementById("replay-app");
const scenes = readScenes(document.getElementById("replay-data").textContent);
root.innerHTML = MARKUP;
const part = (id) => document.getElementById(`replay-${id}`);
const parts = Object.fromEntries(
    ["play", "slider", "frame", "scenes", "scene", "method", "n", "speed", "close", "worst", "truth",
        "distance", "error", "answered", "contact", "notes", "origin"].map((id) => [id, part(id)]),
);

const timeline = new Timeline(root.querySelector(".timeline"));
let stage = null;
let scene = null;
let track = null;
let wanted = null;
let chosen = -1;
let surfaces = [];
let frame = 0;
let playing = false;
let started = { time: 0, frame: 0 };

function openStage() {
    try {
        stage = new Stage(root.querySelector(".stage canvas"));
    } catch (error) {
        root.querySelector(".stage").innerHTML =
            "<p class=\"empty\">This browser gives no WebGL: distances only.</p>";
    }
}

function colours() {
    const style = getComputedStyle(document.documentElement);
    const names = ["ink", "line", "link", "poor", "fair", "method"];
    return Object.fromEntries(names.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}

function fill(select, values, texts = values) {
    select.replaceChildren(...values.map((value, k) => new Option(texts[k], value)));
    select.disabled = values.length < 2;
}

// Sizes and colours may have changed.
function redraw() {
    if (!track) return;
    const theme = colours();
    if (stage) {
        stage.resize();
        stage.paint(theme.ink, theme.method);
    }
    timeline.open(scene, track, theme);
    show();
}

// A choice is shown when its data are unpacked, unless another one was made in the meantime.
async function chooseTrack(next) {
    root.setAttribute("aria-busy", "true");
    wanted = next;
    await next.open();
    if (wanted !== next) return;
    track = next;
    parts.method.value = track.family;
    const family = scene.tracks.filter((other) => other.family === track.family);
    const ns = family.map((other) => (other.n === undefined ? "–" : String(other.n)));
    fill(parts.n, family.map((other) => other.label), ns);
    parts.n.value = track.label;
    const file = `cells/${encodeURIComponent(track.cell)}.csv`;
    const link = Object.assign(document.createElement("a"), { href: file, textContent: "its cell" });
    parts.origin.replaceChildren("Answers as stored in ", link, ", to six digits.");
    if (track.replicates > 1)
        parts.origin.append(` Replicate ${track.replicate} is shown: its worst frame is that of all ${track.replicates}.`);
    if (track.particles) parts.origin.append(" Particles from asking the method again, with the same answers.");
    redraw();
    root.setAttribute("aria-busy", "false");
}

// When the method changes, n stays the same if possible.
function chooseFamily(family) {
    const same = scene.tracks.filter((other) => other.family === family);
    chooseTrack(same.find((other) => other.n === track?.n) ?? same[0]);
}

// The paper's W-W has 5 particles; of several such configurations, take the one with the fewest
// options.
function firstTrack() {
    const particles = scene.tracks.filter((other) => other.hasParticles);
    const five = particles.filter((other) => other.n === 5);
    const choice = [five, particles, scene.tracks].find((list) => list.length > 0);
    return choice.reduce((a, b) => (b.label.length < a.label.length ? b : a));
}

async function chooseScene(index) {
    root.setAttribute("aria-busy", "true");
    chosen = index;
    const next = await scenes.read(index);
    if (chosen !== index) return;
    scene = next;
    track = null;
    surfaces = scene.bodies.map((body) => new Surface(body));
    stage?.open(surfaces, scene.length);
    fill(parts.method, [...new Set(scene.tracks.map((other) => other.family))]);
    for (const input of [parts.slider, parts.frame])
        Object.assign(input, { min: scene.first, max: scene.last, step: 1 });
    parts.notes.hidden = scene.notes.length === 0;
    parts.notes.querySelector("ul").replaceChildren(
        ...scene.notes.map((note) => Object.assign(document.createElement("li"), { textContent: note })),
    );
    const [begins] = scene.active; // the run may have measured other frames only
    frame = begins >= scene.first && begins <= scene.last ? begins : scene.first;
    await chooseTrack(firstTrack());
}

function number(output, value) {
    output.value = Number.isFinite(value) ? String(Number(value.toPrecision(6))) : "not asked";
}

function pairOf(points, index) {
    const pair = new Float64Array(6);
    return points.read(2 * index, pair, 0) && points.read(2 * index + 1, pair, 3) ? pair : null;
}

// Coordinates of the particles on each body.
function particlesOf(row) {
    if (!track.particles || row < 0) return [[], []];
    return [0, 1].map((body) => {
        const places = [];
        const place = [0, 0, 0];
        const start = (2 * row + body) * track.perBody;
        for (let i = 0; i < track.perBody; ++i)
            if (track.particles.read(start + i, place)) places.push(...place);
        return places;
    });
}

function showContact(row) {
    const verdict = row < 0 ? "" : track.verdict(row);
    const truth = scene.inContact(row < 0 ? frame : track.frameOf(row));
    const texts = {
        right: truth ? "Contact" : "Apart",
        missed: "Contact missed",
        false: "False contact",
        "": truth ? "Contact; no answer" : "Apart; no answer",
    };
    parts.contact.textContent = texts[verdict];
    parts.contact.dataset.verdict = verdict === "right" && truth ? "contact" : verdict;
}

function show() {
    if (!track) return;
    const row = track.row(frame);
    const index = frame - scene.first;
    const truth = pairOf(scene.pairs, index);
    const method = row < 0 ? null : pairOf(track.pairs, row);
    const contact = scene.inContact(frame);
    number(parts.truth, scene.truthAt(frame));
    number(parts.distance, row < 0 ? NaN : track.distances[row]);
    parts.error.value = row < 0 || Number.isNaN(track.error(row)) ? "–" : track.error(row).toExponential(2);
    parts.answered.value = row < 0 ? "–" : `frame ${track.frameOf(row)}`;
    parts.slider.value = frame;
    if (document.activeElement !== parts.frame) parts.frame.value = frame;
    showContact(row);
    timeline.show(frame);
    const place = truth ?? method;
    stage?.show({
        index,
        truth,
        method,
        particles: particlesOf(row),
        contact: contact && place ? [0, 1, 2].map((k) => (place[k] + place[k + 3]) / 2) : null,
        close: parts.close.checked,
    });
}

function go(to) {
    const wanted = Math.round(Number(to));
    if (!Number.isFinite(wanted)) return;
    frame = Math.min(scene.last, Math.max(scene.first, wanted));
    started = { time: performance.now(), frame };
    show();
}

function play(on) {
    playing = on;
    parts.play.textContent = on ? "Pause" : "Play";
    if (!on) return;
    if (frame >= scene.last) frame = scene.first;
    started = { time: performance.now(), frame };
    requestAnimationFrame(tick);
}

function tick(now) {
    if (!playing) return;
    const passed = Math.max(0, Math.floor(((now - started.time) / 1000) * Number(parts.speed.value)));
    const next = Math.min(scene.last, started.frame + passed);
    if (next !== frame) {
        frame = next;
        show();
    }
    if (frame >= scene.last) play(false);
    else requestAnimationFrame(tick);
}

function goToWorst() {
    const worst = track.worst();
    play(false);
    if (worst > 0) go(worst);
}

function onKey(event) {
    const target = event.target;
    const typing = target.tagName === "SELECT" || target.type === "number" || target.tagName === "SUMMARY";
    if (typing || event.ctrlKey || event.metaKey || event.altKey) return;
    const step = event.shiftKey ? 10 : 1;
    const actions = {
        ArrowLeft: () => go(frame - step),
        ArrowRight: () => go(frame + step),
        Home: () => go(scene.first),
        End: () => go(scene.last),
        w: goToWorst,
        W: goToWorst,
    };
    const pressed = target.tagName === "BUTTON" || target.tagName === "A" || target.type === "checkbox";
    if (!pressed) actions[" "] = () => play(!playing);
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
}

function listen() {
    parts.play.addEventListener("click", () => play(!playing));
    parts.slider.addEventListener("input", () => go(parts.slider.value));
    parts.frame.addEventListener("change", () => go(parts.frame.value));
    parts.scene.addEventListener("change", () => chooseScene(Number(parts.scene.value)));
    parts.method.addEventListener("change", () => chooseFamily(parts.method.value));
    parts.n.addEventListener("change", () =>
        chooseTrack(scene.tracks.find((other) => other.label === parts.n.value)));
    parts.speed.addEventListener("change", () => go(frame));
    parts.close.addEventListener("change", show);
    parts.worst.addEventListener("click", goToWorst);
    root.addEventListener("keydown", onKey);
    timeline.canvas.addEventListener("pointerdown", (event) => go(timeline.frameAt(event.offsetX)));
    timeline.canvas.addEventListener("pointermove", (event) => {
        if (event.buttons === 1) go(timeline.frameAt(event.offsetX));
    });
    window.addEventListener("resize", redraw);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
}

fill(parts.scene, scenes.names.map((_, k) => String(k)), scenes.names);
parts.scenes.hidden = scenes.names.length < 2;
openStage();
listen();
const first = Math.max(0, scenes.names.indexOf("ww"));
parts.scene.value = String(first);
chooseScene(first);

// For tests and the console: a displayed, deformed vertex in world coordinates.
window.moteReplay = {
    vertex: (body, index) => surfaces[body].world(index, surfaces[body].pose(frame - scene.first)),
    vertexCount: (body) => surfaces[body].body.vertices.length / 3,
    drawn: () => stage?.renderer.info.render.triangles ?? 0,
};
