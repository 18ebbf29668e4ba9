// The scenes that harness/report/replay_write.c put into the page: base 64 into typed arrays, numbers on
// grids into coordinates, and what is asked of them frame by frame.

const NONE = 65535; // on a grid: there is no point

function bytes(text) {
    const raw = atob(text);
    const array = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; ++i) array[i] = raw.charCodeAt(i);
    return array.buffer;
}

// Points on a grid, read one at a time.
class GridPoints {
    constructor(text, grid) {
        this.places = new Uint16Array(bytes(text));
        this.low = grid.low;
        this.step = grid.step;
    }

    get count() {
        return this.places.length / 3;
    }

    // The point into out[at .. at + 2]; false where there is none.
    read(index, out, at = 0) {
        const place = 3 * index;
        if (this.places[place] === NONE) return false;
        for (let k = 0; k < 3; ++k) out[at + k] = this.low[k] + this.step * this.places[place + k];
        return true;
    }
}

function body(data) {
    const points = new GridPoints(data.vertices, data);
    const vertices = new Float32Array(3 * points.count);
    for (let i = 0; i < points.count; ++i) points.read(i, vertices, 3 * i);
    return {
        vertices,
        triangles: new Uint16Array(bytes(data.triangles)),
        centres: new Float64Array(bytes(data.centres)),
        support: data.support,
        poses: new Float32Array(bytes(data.poses)),
        weights: new Int16Array(bytes(data.weights)),
        weightStep: data.weightStep,
    };
}

// "particle-paper:n=5,refine=no" without n: what its n can be chosen of.
function family(label) {
    return label.replace(/([:,])n=[^,]*(,|$)/, (all, before, after) => (after ? before : ""));
}

// The answers of one configuration.
class Track {
    constructor(data, scene) {
        Object.assign(this, { label: data.label, n: data.n, cell: data.cell });
        this.scene = scene;
        this.first = data.first;
        this.stride = data.stride;
        this.family = family(data.label);
        this.distances = new Float64Array(bytes(data.distance));
        this.contacts = new Int8Array(bytes(data.contact));
        this.pairs = new GridPoints(data.pair, scene.grid);
        const particles = scene.particleSets[data.particles];
        this.particles = particles ? new GridPoints(particles, scene.grid) : null;
        this.perBody = particles ? this.particles.count / (2 * this.distances.length) : 0;
    }

    // The row that answers a frame, or the last one before it; -1 where there is none.
    row(frame) {
        const row = Math.floor((frame - this.first) / this.stride);
        return row < 0 ? -1 : Math.min(row, this.distances.length - 1);
    }

    frameOf(row) {
        return this.first + row * this.stride;
    }

    // Signed, over L; NaN where there is no distance.
    error(row) {
        return (this.distances[row] - this.scene.truthAt(this.frameOf(row))) / this.scene.length;
    }

    // "right", "missed", "false", or "" where the method does not say.
    verdict(row) {
        if (this.contacts[row] < 0) return "";
        const truth = this.scene.inContact(this.frameOf(row));
        if (truth === (this.contacts[row] === 1)) return "right";
        return truth ? "missed" : "false";
    }

    // The frame of the largest error; without distances the first wrong contact; 0: none.
    worst() {
        let worst = 0;
        let most = -1;
        for (let row = 0; row < this.distances.length; ++row) {
            const verdict = this.verdict(row);
            const wrong = verdict === "missed" || verdict === "false" ? 0 : -1;
            const error = Math.abs(this.error(row));
            const badness = Number.isNaN(error) ? wrong : error;
            if (badness > most) {
                most = badness;
                worst = this.frameOf(row);
            }
        }
        return worst;
    }
}

class Scene {
    constructor(data) {
        this.name = data.name;
        this.length = data.length;
        this.tolerance = data.tolerance;
        this.first = data.first;
        this.last = data.last;
        this.active = data.active;
        this.notes = data.notes;
        this.grid = { low: data.low, step: data.step };
        this.bodies = data.bodies.map(body);
        this.truth = new Float64Array(bytes(data.truth));
        this.pairs = new GridPoints(data.pair, this.grid);
        this.particleSets = data.particles;
        this.tracks = data.tracks.map((track) => new Track(track, this));
    }

    truthAt(frame) {
        return this.truth[frame - this.first];
    }

    inContact(frame) {
        return this.truthAt(frame) <= this.tolerance;
    }
}

// The scenes of the page, ready to use; each is read when it is first asked for.
export function readScenes(json) {
    const { scenes } = JSON.parse(json);
    const ready = new Map();
    return scenes.map((data, index) => ({
        name: data.name,
        get scene() {
            if (!ready.has(index)) ready.set(index, new Scene(data));
            return ready.get(index);
        },
    }));
}
