// The deformed surface of a body, computed in the page from its field: a displacement that is
// linear in a frame's weights, by basis functions: those of the page's data, or Wendland's C2 function of
// the distance to each centre at rest.

function wendland(r) {
    if (r >= 1) return 0;
    const q = (1 - r) * (1 - r);
    return q * q * (4 * r + 1);
}

export class Surface {
    constructor(body) {
        this.body = body;
        this.functions = body.functions;
        this.positions = new Float32Array(body.vertices);
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

    // Fills positions with the deformed vertices, in rest axes, at a frame counted from 0.
    deform(index) {
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
            this.positions[v] = vertices[v] + weightStep * x;
            this.positions[v + 1] = vertices[v + 1] + weightStep * y;
            this.positions[v + 2] = vertices[v + 2] + weightStep * z;
        }
    }

    // Rows of the rotation, then the translation, at a frame counted from 0.
    pose(index) {
        return this.body.poses.subarray(12 * index, 12 * index + 12);
    }

    // A vertex in the world as it is now, for the pose given.
    world(vertex, pose) {
        const p = this.positions.subarray(3 * vertex, 3 * vertex + 3);
        return [0, 3, 6].map(
            (row, k) => pose[row] * p[0] + pose[row + 1] * p[1] + pose[row + 2] * p[2] + pose[9 + k],
        );
    }
}
