// Distances over all frames, on a flat canvas: the truth, the method's, contacts, wrong answers, and
// the current frame of the replay.

export class Timeline {
    constructor(canvas) {
        this.canvas = canvas;
        this.base = document.createElement("canvas");
    }

    // Draws a track once; show() only adds the cursor.
    open(scene, track, colours) {
        Object.assign(this, { scene, track, colours });
        const ratio = Math.min(window.devicePixelRatio, 2);
        this.width = this.canvas.clientWidth;
        this.height = this.canvas.clientHeight;
        for (const canvas of [this.canvas, this.base]) {
            canvas.width = Math.round(this.width * ratio);
            canvas.height = Math.round(this.height * ratio);
            canvas.getContext("2d").setTransform(ratio, 0, 0, ratio, 0, 0);
        }
        this.most = Math.max(...this.distances().filter(Number.isFinite), scene.length * 1e-9);
        this.drawBase();
    }

    // Every displayed distance.
    distances() {
        return [...this.scene.truth, ...this.track.distances];
    }

    x(frame) {
        const { first, last } = this.scene;
        return 8 + ((this.width - 16) * (frame - first)) / Math.max(1, last - first);
    }

    frameAt(x) {
        const { first, last } = this.scene;
        const share = (x - 8) / (this.width - 16);
        return Math.round(first + Math.min(1, Math.max(0, share)) * (last - first));
    }

    y(distance) {
        return this.height - 9 - (this.height - 14) * (distance / this.most);
    }

    drawBase() {
        const pen = this.base.getContext("2d");
        const { scene, track, colours } = this;
        pen.clearRect(0, 0, this.width, this.height);
        const step = this.x(scene.first + 1) - this.x(scene.first);
        for (let frame = scene.first; frame <= scene.last; ++frame) {
            if (!scene.inContact(frame)) continue;
            pen.fillStyle = colours.line;
            pen.fillRect(this.x(frame) - step / 2, 0, Math.max(step, 1), this.height - 6);
        }
        this.drawLine(pen, colours.method, 1.6, track.distances.length, (row) => [
            track.frameOf(row),
            track.distances[row],
        ]);
        this.drawLine(pen, colours.ink, 1, scene.truth.length, (k) => [scene.first + k, scene.truth[k]]);
        for (let row = 0; row < track.distances.length; ++row) {
            const verdict = track.verdict(row);
            if (verdict !== "missed" && verdict !== "false") continue;
            pen.fillStyle = verdict === "missed" ? colours.poor : colours.fair;
            pen.fillRect(this.x(track.frameOf(row)) - 0.75, this.height - 5, 1.5, 5);
        }
    }

    drawLine(pen, colour, width, count, point) {
        pen.strokeStyle = colour;
        pen.lineWidth = width;
        pen.beginPath();
        let drawing = false;
        for (let k = 0; k < count; ++k) {
            const [frame, distance] = point(k);
            if (!Number.isFinite(distance)) {
                drawing = false;
                continue;
            }
            if (drawing) pen.lineTo(this.x(frame), this.y(distance));
            else pen.moveTo(this.x(frame), this.y(distance));
            drawing = true;
        }
        pen.stroke();
    }

    show(frame) {
        if (!(this.base.width > 0 && this.base.height > 0)) return; // not laid out
        const pen = this.canvas.getContext("2d");
        pen.clearRect(0, 0, this.width, this.height);
        pen.drawImage(this.base, 0, 0, this.width, this.height);
        pen.fillStyle = this.colours.link;
        pen.fillRect(this.x(frame) - 1, 0, 2, this.height);
    }
}
