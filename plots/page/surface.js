// The deformed surface of a body, computed in the page from its field: by basis functions, either
// stored or Wendland's C2 function of the distance to each centre at rest; or by morph targets and
// bones (core/skin/skin.h). Both give displacements in rest axes.

function wendland(r) {
    if (r >= 1) return 0;
    const q = (1 - r) * (1 - r);
    return q * q * (4 * r + 1);
}

// A displacement that is linear in a frame's weights.
class Functions {
    constructor(body) {
        this.body = body;
        this.functions = body.functions;
        this.basis = body.basis ?? this.tabulate();
    }

    // basis[i * functions + j] = phi_j at rest vertex i.
    tabulate() {
        const { vertices, centres, support } = this.body;
        const count = vertices.length / 3;
        const basis = new Float32Array(count * this.functions);
        for (let i = 0; i < count; ++i) {
            for (let j = 0; j < this.functions; ++j) {
                const x = vertices[3 * i] - centres[3 * j];
                const y = vertices[3 * i + 1] - centres[3 * j + 1];
                const z = vertices[3 * i + 2] - centres[3 * j + 2];
                basis[i * this.functions + j] = wendland(Math.hypot(x, y, z) / support);
            }
        }
        return basis;
    }

    deform(index, positions) {
        const { vertices, weights, weightStep } = this.body;
        const width = 3 * this.functions;
        const start = index * width;
        for (let i = 0, v = 0, b = 0; v < vertices.length; ++i, v += 3) {
            let x = 0;
            let y = 0;
            let z = 0;
            for (let j = start; j < start + width; j += 3, ++b) {
                const phi = this.basis[b];
                if (phi === 0) continue;
                x += phi * weights[j];
                y += phi * weights[j + 1];
                z += phi * weights[j + 2];
            }
            positions[v] = vertices[v] + weightStep * x;
            positions[v + 1] = vertices[v + 1] + weightStep * y;
            positions[v + 2] = vertices[v + 2] + weightStep * z;
        }
    }
}

// Morph targets, then bones: four vectors each, the columns of its matrix.
class Bones {
    constructor(body) {
        this.body = body;
        this.columns = new Float64Array(12 * body.skin.bones);
        this.place = new Float64Array(3);
    }

    // Sets place to a vertex moved by its morph targets.
    morph(i, index) {
        const { vertices, skin, amounts } = this.body;
        const place = this.place;
        for (let c = 0; c < 3; ++c) place[c] = vertices[3 * i + c];
        if (skin.targets === 0) return;
        for (let k = skin.moveStart[i]; k < skin.moveStart[i + 1]; ++k) {
            const amount = amounts[index * skin.targets + skin.target[k]];
            for (let c = 0; c < 3; ++c) place[c] += amount * skin.move[3 * k + c];
        }
    }

    deform(index, positions) {
        const { skin, weights, weightStep } = this.body;
        const { columns, place } = this;
        const q = [0, 0, 0, 1];
        for (let k = 0; k < columns.length; ++k) columns[k] = weightStep * weights[index * columns.length + k];
        for (let i = 0; i + 1 < skin.start.length; ++i) {
            this.morph(i, index);
            for (let c = 0; c < 3; ++c) {
                positions[3 * i + c] = place[c];
                q[c] = (place[c] - skin.origin[c]) / skin.unit;
            }
            for (let k = skin.start[i]; k < skin.start[i + 1]; ++k) {
                for (let j = 0; j < 12; ++j)
                    positions[3 * i + (j % 3)] +=
                        skin.weight[k] * q[Math.floor(j / 3)] * columns[12 * skin.bone[k] + j];
            }
        }
    }
}

export class Surface {
    constructor(body) {
        this.body = body;
        this.field = body.skin ? new Bones(body) : new Functions(body);
        this.positions = new Float32Array(body.vertices);
    }

    // Sets positions to the deformed vertices, in rest axes, at a frame counted from 0.
    deform(index) {
        this.field.deform(index, this.positions);
    }

    // Rows of the rotation, then the translation, at a frame counted from 0.
    pose(index) {
        return this.body.poses.subarray(12 * index, 12 * index + 12);
    }

    // A vertex in world coordinates for the given pose.
    world(vertex, pose) {
        const p = this.positions.subarray(3 * vertex, 3 * vertex + 3);
        return [0, 3, 6].map(
            (row, k) => pose[row] * p[0] + pose[row + 1] * p[1] + pose[row + 2] * p[2] + pose[9 + k],
        );
    }
}
