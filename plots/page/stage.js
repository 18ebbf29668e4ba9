// The scene in three dimensions: two surfaces, particles on them, the closest points of the truth and
// of a method, and the place of a contact.
import {
    Color,
    BufferAttribute,
    BufferGeometry,
    CylinderGeometry,
    DirectionalLight,
    DynamicDrawUsage,
    Group,
    HemisphereLight,
    InstancedMesh,
    Matrix4,
    Mesh,
    MeshBasicMaterial,
    MeshLambertMaterial,
    PerspectiveCamera,
    Scene,
    SphereGeometry,
    Vector3,
    WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const PARTICLES_MAX = 64;
const SURFACES = ["#a9c3dd", "#e3c9a0"];
const PARTICLES = ["#c4122f", "#1746c7"];
const CONTACT = "#e0202c";
const UP = new Vector3(0, 1, 0);

// A surface with a coloured region around a point in the world.
function surfaceMaterial(colour, glow) {
    const material = new MeshLambertMaterial({ color: colour, flatShading: true });
    material.onBeforeCompile = (shader) => {
        Object.assign(shader.uniforms, glow);
        shader.vertexShader = shader.vertexShader
            .replace("#include <common>", "#include <common>\nvarying vec3 vPlace;")
            .replace(
                "#include <project_vertex>",
                "#include <project_vertex>\nvPlace = (modelMatrix * vec4(transformed, 1.0)).xyz;",
            );
        shader.fragmentShader = shader.fragmentShader
            .replace(
                "#include <common>",
                `#include <common>
                varying vec3 vPlace;
                uniform vec3 glowAt, glowColour;
                uniform float glowRadius;`,
            )
            .replace(
                "#include <opaque_fragment>",
                `#include <opaque_fragment>
                float glow = 1.0 - smoothstep(0.3, 1.0, distance(vPlace, glowAt) / glowRadius);
                gl_FragColor.rgb = mix(gl_FragColor.rgb, glowColour, 0.85 * glow);`,
            );
    };
    return material;
}

// Two points and the line between them, drawn on top of everything.
class Pair {
    constructor(parent, radius, opacity, order) {
        this.material = new MeshBasicMaterial({
            depthTest: false,
            transparent: true,
            opacity,
        });
        this.group = new Group();
        this.ends = [0, 1].map(() => new Mesh(new SphereGeometry(radius, 20, 14), this.material));
        this.line = new Mesh(new CylinderGeometry(radius / 3, radius / 3, 1, 12), this.material);
        this.group.add(...this.ends, this.line);
        for (const part of this.group.children) part.renderOrder = order;
        parent.add(this.group);
    }

    // points: six coordinates, or null.
    show(points) {
        this.group.visible = points !== null;
        if (!points) return;
        const [a, b] = this.ends.map((end, k) => end.position.fromArray(points, 3 * k));
        const along = b.clone().sub(a);
        const length = along.length();
        this.line.visible = length > 0;
        this.line.position.addVectors(a, b).multiplyScalar(0.5);
        this.line.scale.set(1, Math.max(length, 1e-12), 1);
        if (length > 0) this.line.quaternion.setFromUnitVectors(UP, along.divideScalar(length));
    }
}

export class Stage {
    // Throws if the browser has no WebGL.
    constructor(canvas) {
        this.canvas = canvas;
        this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
        this.camera = new PerspectiveCamera(35, 1, 0.01, 100);
        this.controls = new OrbitControls(this.camera, canvas);
        this.controls.enableZoom = false;
        canvas.style.touchAction = "pan-y";
        // The wheel scrolls the page until the picture has the focus.
        canvas.addEventListener("focus", () => (this.controls.enableZoom = true));
        canvas.addEventListener("blur", () => (this.controls.enableZoom = false));
        this.controls.addEventListener("change", () => this.render());
    }

    // Makes all objects for a scene's surfaces.
    open(surfaces, length) {
        this.length = length;
        this.surfaces = surfaces;
        this.scene = new Scene();
        this.glow = {
            glowAt: { value: new Vector3() },
            glowRadius: { value: 1e-9 },
            glowColour: { value: new Color(CONTACT) },
        };
        this.meshes = surfaces.map((surface, k) => this.addSurface(surface, k));
        this.particles = PARTICLES.map((colour) => this.addParticles(colour));
        this.methodPair = new Pair(this.scene, 0.016 * length, 0.55, 3);
        this.truthPair = new Pair(this.scene, 0.008 * length, 1, 4);
        this.scene.add(this.camera, new HemisphereLight("#ffffff", "#8d94a3", 2.1));
        const lamp = new DirectionalLight("#ffffff", 1.5);
        lamp.position.set(0.4, 0.7, 1);
        this.camera.clear();
        this.camera.add(lamp);
        this.camera.near = length / 200;
        this.camera.far = length * 60;
        this.aimed = false;
    }

    addSurface(surface, k) {
        const geometry = new BufferGeometry();
        const positions = new BufferAttribute(surface.positions, 3).setUsage(DynamicDrawUsage);
        geometry.setAttribute("position", positions);
        geometry.setIndex(new BufferAttribute(surface.body.triangles, 1));
        const mesh = new Mesh(geometry, surfaceMaterial(SURFACES[k], this.glow));
        mesh.frustumCulled = false;
        mesh.matrixAutoUpdate = false;
        this.scene.add(mesh);
        return mesh;
    }

    addParticles(colour) {
        const ball = new SphereGeometry(0.014 * this.length, 16, 12);
        const material = new MeshBasicMaterial({ color: colour, depthTest: false, transparent: true });
        const balls = new InstancedMesh(ball, material, PARTICLES_MAX);
        balls.frustumCulled = false;
        balls.count = 0;
        balls.renderOrder = 2;
        this.scene.add(balls);
        return balls;
    }

    // Ink for the truth, another colour for the method, as in the page's theme.
    paint(truth, method) {
        this.truthPair.material.color.set(truth);
        this.methodPair.material.color.set(method);
    }

    resize() {
        const { clientWidth: width, clientHeight: height } = this.canvas;
        if (!width || !height) return;
        this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
        this.renderer.setSize(width, height, false);
        this.camera.aspect = width / height;
        this.camera.updateProjectionMatrix();
    }

    // Looks at a point from a distance. Keeps the direction, and the user's zoom relative to the
    // distance of the previous frame.
    aim(point, distance) {
        const direction = this.aimed
            ? this.camera.position.clone().sub(this.controls.target)
            : new Vector3(0.35, 0.35, 1).normalize().multiplyScalar(distance);
        if (this.aimed) direction.multiplyScalar(distance / this.distance);
        this.controls.target.copy(point);
        this.camera.position.copy(point).add(direction);
        this.distance = distance;
        this.aimed = true;
    }

    // Shows a frame. view: {index, truth, method, particles, contact, close}; truth and method: six
    // coordinates or null; particles: [coordinates of body 0, of body 1]; contact: a point or null;
    // close: whether to follow the closest points.
    show(view) {
        const centres = [];
        this.surfaces.forEach((surface, k) => {
            const p = surface.pose(view.index);
            surface.deform(view.index);
            this.meshes[k].geometry.attributes.position.needsUpdate = true;
            this.meshes[k].matrix.set(
                p[0], p[1], p[2], p[9], p[3], p[4], p[5], p[10], p[6], p[7], p[8], p[11], 0, 0, 0, 1,
            );
            centres.push(this.centre(surface).applyMatrix4(this.meshes[k].matrix));
        });
        this.truthPair.show(view.truth);
        this.methodPair.show(view.method);
        view.particles.forEach((places, k) => this.place(this.particles[k], places));
        this.glow.glowRadius.value = view.contact ? 0.09 * this.length : 1e-9;
        if (view.contact) this.glow.glowAt.value.fromArray(view.contact);
        const [a, b] = centres;
        this.look(view, a.clone().add(b).multiplyScalar(0.5), a.distanceTo(b));
    }

    centre(surface) {
        if (!surface.centre) {
            const geometry = new BufferGeometry();
            geometry.setAttribute("position", new BufferAttribute(surface.body.vertices, 3));
            geometry.computeBoundingBox();
            surface.centre = geometry.boundingBox.getCenter(new Vector3());
        }
        return surface.centre.clone();
    }

    place(balls, places) {
        const matrix = new Matrix4();
        balls.count = Math.min(places.length / 3, PARTICLES_MAX);
        for (let i = 0; i < balls.count; ++i)
            balls.setMatrixAt(i, matrix.setPosition(places[3 * i], places[3 * i + 1], places[3 * i + 2]));
        balls.instanceMatrix.needsUpdate = true;
    }

    // The distance of the eye at which both bodies, or the closest points, are fully visible.
    look(view, middle, apart) {
        const pair = view.truth ?? view.method;
        const near = view.close && pair !== null;
        let seen = apart + 1.05 * this.length;
        if (near) {
            middle.fromArray(pair).add(new Vector3().fromArray(pair, 3)).multiplyScalar(0.5);
            seen = 0.5 * this.length;
        }
        const half = Math.tan((this.camera.fov * Math.PI) / 360) * Math.min(1.5, this.camera.aspect);
        this.aim(middle, seen / (2 * half) + 0.4 * this.length);
        this.controls.update();
        this.render();
    }

    render() {
        if (this.scene) this.renderer.render(this.scene, this.camera);
    }
}
