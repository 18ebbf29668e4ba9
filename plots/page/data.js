/* global unpack */ // of packed.js, which the page has before this program
// Unpacks the scenes that harness/report/replay_write.c put into the page: texts into arrays,
// differences and grid positions into coordinates, and looks them up frame by frame.

// Undoes differences from the value `columns` before, taken `times` times.
function sums(differences, columns, Kind, times = 1) {
    const values = Kind.from(differences);
    for (let k = 0; k < times; ++k)
        for (let i = columns; i < values.length; ++i) values[i] += values[i - columns];
    return values;
}

// The points in a text: three numbers each, or null for a missing one. A point is stored relative to
// the reference's point of the same index, otherwise to the last one in its column.
class GridPoints {
    constructor(numbers, grid, columns, reference = null) {
        this.low = grid.low;
        this.step = grid.step;
        this.places = [];
        const last = Array.from({ length: columns }, () => [0, 0, 0]);
        for (let at = 0, index = 0; at < numbers.length; ++index) {
            if (numbers[at] === null) {
                this.places.push(null);
                ++at;
                continue;
            }
            const base = reference?.(index) ?? last[index % columns];
            const place = [0, 1, 2].map((k) => base[k] + numbers[at + k]);
            last[index % columns] = place;
            this.places.push(place);
            at += 3;
        }
    }

    get count() {
        return this.places.length;
    }

    // Writes the point to out[at .. at + 2]; false if there is none.
    read(index, out, at = 0) {
        const place = this.places[index];
        if (!place) return false;
        for (let k = 0; k < 3; ++k) out[at + k] = this.low[k] + this.step * place[k];
        return true;
    }
}

// The start of each vertex's entries, and the end of the last one's.
function starts(counts) {
    const start = new Uint32Array(counts.length + 1);
    for (let i = 0; i < counts.length; ++i) start[i + 1] = start[i] + counts[i];
    return start;
}

// Bones and morph targets of the vertices.
function skin(data) {
    return {
        bones: data.boneCount,
        origin: data.origin,
        unit: data.unit,
        start: starts(data.counts),
        bone: sums(data.bones, 1, Int32Array),
        weight: Float64Array.from(data.weights, (steps) => steps * data.weightStep),
        targets: data.targetCount,
        moveStart: starts(data.moveCounts),
        target: Uint16Array.from(data.targets),
        move: Float64Array.from(data.moves, (steps) => steps * data.moveStep),
    };
}

// A control's or a bone's vectors in each frame, three numbers each.
function weights(data, width) {
    return { weights: sums(data.weights, width, Int32Array, 2), weightStep: data.weightStep };
}

// What deforms a body: a skin, or basis functions.
function field(data) {
    if (data.skin) {
        const own = skin(data.skin);
        const amounts = sums(data.amounts, own.targets, Int32Array, 2);
        return {
            skin: own,
            amounts: Float64Array.from(amounts, (steps) => steps * data.amountStep),
            ...weights(data, 12 * own.bones),
        };
    }
    const functions = data.functions ?? data.centreX.length;
    return {
        functions,
        // CSRBFs are stored by their centres; other fields function by function, vertex by vertex.
        centres: data.centreX && Float64Array.from({ length: 3 * functions }, (_, k) =>
            [data.centreX, data.centreY, data.centreZ][k % 3][Math.floor(k / 3)]),
        support: data.support,
        basis: data.basis && Float32Array.from(data.basis, (steps) => steps * data.basisStep),
        ...weights(data, 3 * functions),
    };
}

function body(data, length) {
    const points = new GridPoints(data.vertices, data, 1);
    const vertices = new Float32Array(3 * points.count);
    for (let i = 0; i < points.count; ++i) points.read(i, vertices, 3 * i);
    const scale = Float32Array.from({ length: 12 }, (_, c) => data.poseStep * (c < 9 ? 1 : length));
    return {
        vertices,
        triangles: sums(data.triangles, 3, Uint16Array),
        poses: Float32Array.from(sums(data.poses, 12, Int32Array, 2), (steps, k) => steps * scale[k % 12]),
        ...field(data),
    };
}

const numberOrNaN = (value) => value ?? NaN;

// "particle-paper:n=5,refine=no" without n: the family whose n can be chosen.
function family(label) {
    return label.replace(/([:,])n=[^,]*(,|$)/, (all, before, after) => (after ? before : ""));
}

// The answers of one configuration, unpacked when first shown.
class Track {
    constructor(data, scene) {
        const { label, n, cell, first, stride, replicate, replicates } = data;
        Object.assign(this, { label, n, cell, first, stride, replicate, replicates, data, scene });
        this.family = family(label);
        this.hasParticles = data.particles in scene.particleSets;
    }

    async open() {
        this.opened ??= this.unpack();
        await this.opened;
        return this;
    }

    async unpack() {
        const { scene, data } = this;
        const answers = JSON.parse(await unpack(data.answers));
        this.errors = Float64Array.from(answers.error, numberOrNaN);
        this.contacts = Int8Array.from(answers.contact);
        this.distances = this.errors.map((error, row) => scene.truthAt(this.frameOf(row)) + error * scene.length);
        const truth = (index) => scene.pairs.places[2 * (this.frameOf(Math.floor(index / 2)) - scene.first) + (index % 2)];
        this.pairs = new GridPoints(answers.pair, scene.grid, 2, truth);
        this.particles = null;
        this.perBody = 0;
        if (!this.hasParticles) return;
        const set = JSON.parse(await unpack(scene.particleSets[data.particles]));
        this.perBody = set.perBody;
        this.particles = new GridPoints(set.places, scene.grid, 2 * set.perBody);
    }

    // The row that answers a frame, otherwise the last one before it; -1 if there is none.
    row(frame) {
        const row = Math.floor((frame - this.first) / this.stride);
        return row < 0 ? -1 : Math.min(row, this.distances.length - 1);
    }

    frameOf(row) {
        return this.first + row * this.stride;
    }

    // Signed, divided by L; NaN if there is no distance.
    error(row) {
        return this.errors[row];
    }

    // "right", "missed", "false", or "" if the method gives no contact.
    verdict(row) {
        if (this.contacts[row] < 0) return "";
        const truth = this.scene.inContact(this.frameOf(row));
        if (truth === (this.contacts[row] === 1)) return "right";
        return truth ? "missed" : "false";
    }

    // The frame of the largest error; without distances, of the first wrong contact; 0: none.
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
        const { name, length, tolerance, first, last, active, notes } = data;
        Object.assign(this, { name, length, tolerance, first, last, active, notes });
        this.grid = { low: data.low, step: data.step };
        this.particleSets = data.particles;
        this.tracks = data.tracks.map((track) => new Track(track, this));
    }

    static async read(data) {
        const scene = new Scene(data);
        const world = JSON.parse(await unpack(data.world));
        scene.bodies = world.bodies.map((one) => body(one, scene.length));
        scene.truth = Float64Array.from(world.truth, numberOrNaN);
        scene.pairs = new GridPoints(world.pair, scene.grid, 2);
        return scene;
    }

    truthAt(frame) {
        return this.truth[frame - this.first];
    }

    inContact(frame) {
        return this.truthAt(frame) <= this.tolerance;
    }
}

// The scenes of the page; read(index) unpacks one at its first use.
export function readScenes(json) {
    const { scenes } = JSON.parse(json);
    const ready = new Map();
    return {
        names: scenes.map((data) => data.name),
        read(index) {
            if (!ready.has(index)) ready.set(index, Scene.read(scenes[index]));
            return ready.get(index);
        },
    };
}
