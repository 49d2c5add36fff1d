// The bodies of a run in space, z up.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import { reader } from "./frames.js";

const palette = [0x2f6fde, 0xe4572e, 0x2a9d6f, 0x8e5bd0, 0xd9a514, 0x3aa6b9];
const white = new THREE.Color(0xffffff);

/** Squares in two shades, so that a turning surface is seen to turn. */
function checkers(color, across, down) {
  const canvas = document.createElement("canvas");
  canvas.width = 16 * across;
  canvas.height = 16 * down;
  const paint = canvas.getContext("2d");
  const light = new THREE.Color(color).lerp(white, 0.6);
  for (let i = 0; i < across; ++i)
    for (let j = 0; j < down; ++j) {
      paint.fillStyle = `#${((i + j) % 2 ? light : new THREE.Color(color)).getHexString()}`;
      paint.fillRect(16 * i, 16 * j, 16, 16);
    }
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  texture.magFilter = THREE.NearestFilter;
  return texture;
}

const upwards = new THREE.Vector3(0, 0, 1);
const turnedUp = (geometry) => geometry.rotateX(Math.PI / 2);  // three's cylinders stand on y

/** Kind of shape -> mesh, its third axis the one of symmetry. */
const kinds = {
  sphere: ([radius], color) =>
    new THREE.Mesh(
      turnedUp(new THREE.SphereGeometry(radius, 48, 24)),
      new THREE.MeshStandardMaterial({ map: checkers(color, 8, 4), roughness: 0.5 })),
  box: ([x, y, z], color) =>
    new THREE.Mesh(
      new THREE.BoxGeometry(x, y, z),
      [0, 0.25, 0.5, 0.1, 0.35, 0.6].map(
        (share) => new THREE.MeshStandardMaterial({ color: new THREE.Color(color).lerp(white, share) }))),
  disk: ([radius, thickness], color) =>
    new THREE.Mesh(
      turnedUp(new THREE.CylinderGeometry(radius, radius, thickness, 64)),
      [checkers(color, 16, 1), checkers(color, 2, 2), checkers(color, 2, 2)].map(
        (map) => new THREE.MeshStandardMaterial({ map, roughness: 0.6 }))),
  rod: ([length, radius]) =>
    new THREE.Mesh(
      turnedUp(new THREE.CylinderGeometry(radius, radius, length, 16)),
      new THREE.MeshStandardMaterial({ color: 0x8a94a6 })),
  cone: ([height, radius], color) => {
    const geometry = turnedUp(new THREE.ConeGeometry(radius, height, 48)).rotateX(Math.PI).translate(0, 0, height / 2);
    return new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ map: checkers(color, 8, 1) }));
  },
  plate: (_, color) =>
    new THREE.Mesh(
      new THREE.CircleGeometry(1, 96),
      new THREE.MeshStandardMaterial({
        map: checkers(color, 16, 16), side: THREE.DoubleSide, transparent: true, opacity: 0.45 })),
};

/** Points on the circle of radius 1. */
function rim() {
  const at = (i) => new THREE.Vector3(1, 0, 0).applyAxisAngle(upwards, (i * Math.PI) / 8);
  return Array.from({ length: 16 }, (_, i) => at(i));
}

/** The corners of a box around a geometry. */
function corners(geometry) {
  if (!geometry.boundingBox) geometry.computeBoundingBox();
  const ends = [geometry.boundingBox.min, geometry.boundingBox.max];
  return ends.flatMap(({ x }) => ends.flatMap(({ y }) => ends.map(({ z }) => new THREE.Vector3(x, y, z))));
}

/** One shape: a mesh that `place(row)` moves, and the line its centre draws. */
class Body {
  constructor(run, shape, color) {
    const make = kinds[shape.kind];
    if (!make) throw new Error(`no shape "${shape.kind}"`);
    this.kind = shape.kind;
    this.group = new THREE.Group();
    this.mesh = make(shape.size, color);
    this.mesh.position.set(...shape.offset);
    this.group.add(this.mesh);
    this.position = shape.position.map((coordinate) => reader(run, coordinate));
    this.attitude = shape.attitude.map((column) => reader(run, column));
    this.transposed = shape.transposed;
    this.turns = shape.turns.map(({ axis, angle, rate }) => ({
      axis: new THREE.Vector3(...axis), angle: reader(run, angle), rate }));
    this.to = shape.to.length ? shape.to.map((coordinate) => reader(run, coordinate)) : null;
    this.length = shape.size[0];
    this.trail = shape.trail ? this.drawTrail(run, color) : null;
  }

  place(row) {
    this.group.position.set(...this.position.map((read) => read(row)));
    const k = Math.floor(row);
    this.group.quaternion.copy(this.attitudeAt(k)).slerp(this.attitudeAt(Math.ceil(row)), row - k);
    if (this.to) this.stretch(new THREE.Vector3(...this.to.map((read) => read(row))));
    if (this.trail) this.trail.geometry.setDrawRange(0, Math.floor(row) + 1);
  }

  /** At a recorded row. Between rows the shorter way is taken, whatever the signs of quaternions and full turns. */
  attitudeAt(row) {
    const attitude = new THREE.Quaternion();
    if (this.attitude.length) {
      const [w, x, y, z] = this.attitude.map((read) => read(row));
      attitude.set(x, y, z, w).normalize();
      if (this.transposed) attitude.conjugate();
    }
    for (const { axis, angle, rate } of this.turns)
      attitude.multiply(new THREE.Quaternion().setFromAxisAngle(axis, rate * angle(row)));
    return attitude;
  }

  /** A rod from its position to another point. */
  stretch(end) {
    const along = end.sub(this.group.position);
    const length = along.length();
    this.mesh.visible = length > 0;  // what is switched off ends where it begins
    if (length === 0) return;
    this.group.quaternion.setFromUnitVectors(upwards, along.clone().normalize());
    this.mesh.scale.z = length / this.length;
    this.mesh.position.z = length / 2;
  }

  /** Points of its outline where it is: the corners of a box around it, or the rim of a plate. */
  outline() {
    if (!this.mesh.visible) return [];
    this.group.updateMatrixWorld(true);
    const points = this.kind === "plate" ? rim() : corners(this.mesh.geometry);
    return points.map((point) => point.applyMatrix4(this.mesh.matrixWorld));
  }

  centre() {
    this.group.updateMatrixWorld(true);
    return this.mesh.getWorldPosition(new THREE.Vector3());
  }

  drawTrail(run, color) {
    const points = run.time.map((_, row) => {
      this.place(row);
      return this.centre();
    });
    const geometry = new THREE.BufferGeometry().setFromPoints(points);
    return new THREE.Line(geometry, new THREE.LineBasicMaterial({ color }));
  }
}

/** Where the camera stands at first, seen from what it looks at. */
const outlook = new THREE.Vector3(0.45, -0.8, 0.4).normalize();

/** three would fill the console and throw a word of its own: what is missing is said in a sentence. */
function webgl(canvas) {
  const context = canvas.getContext("webgl2", { alpha: false, antialias: true, preserveDrawingBuffer: true });
  if (!context) throw new Error("this browser has no WebGL 2, or has it switched off");
  return context;
}

/** The stage: everything that moves, light, camera. Throws where it cannot be drawn. */
export class Stage {
  constructor(canvas, run) {
    this.renderer = new THREE.WebGLRenderer({ canvas, context: webgl(canvas) });
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(0xf7f9fc);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0xb8c0cc, 2.2));
    this.bodies = run.shapes.map((shape, i) => new Body(run, shape, palette[i % palette.length]));
    for (const { group, trail } of this.bodies) {
      this.scene.add(group);
      if (trail) this.scene.add(trail);
    }
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.01, 1000);
    this.camera.up.copy(upwards);
    const sun = new THREE.DirectionalLight(0xffffff, 2);
    sun.position.set(1, -1, 3);
    this.camera.add(sun);
    this.scene.add(this.camera);
    this.controls = new OrbitControls(this.camera, canvas);
    canvas.addEventListener("keydown", (event) => this.turnBy(event));
    const plates = this.bodies.filter(({ kind }) => kind === "plate");
    this.points = this.measure(this.bodies.filter(({ kind }) => kind !== "plate"), run.time.length);
    const { min, max } = new THREE.Box3().setFromPoints(this.points);
    for (const { group } of this.points.length > 0 ? plates : [])
      group.scale.setScalar(1.1 * Math.hypot(Math.max(-min.x, max.x), Math.max(-min.y, max.y)));
    this.points.push(...this.measure(plates, 1));
    this.centre = new THREE.Box3().setFromPoints(this.points).getCenter(new THREE.Vector3());
    this.takeShape();
    this.lookAtAll();
  }

  /** The outlines of these bodies at every row (at most a few hundred of them). */
  measure(bodies, rows) {
    const points = [];
    const stride = Math.max(1, Math.floor(rows / 200));
    for (let row = 0; row < rows; row += stride)
      for (const body of bodies) {
        body.place(row);
        points.push(...body.outline());
      }
    return points;
  }

  /** From how far all is seen, with a margin: the narrower of width and height decides. */
  distanceToAll() {
    const right = new THREE.Vector3().crossVectors(this.camera.up, outlook).normalize();
    const above = new THREE.Vector3().crossVectors(outlook, right);
    const high = Math.tan((this.camera.fov * Math.PI) / 360) / 1.1;
    const wide = high * this.camera.aspect;
    let distance = 0;
    const from = new THREE.Vector3();
    for (const point of this.points) {
      from.subVectors(point, this.centre);
      const aside = Math.max(Math.abs(from.dot(right)) / wide, Math.abs(from.dot(above)) / high);
      distance = Math.max(distance, aside + from.dot(outlook));
    }
    return distance || 1;
  }

  lookAtAll() {
    this.controls.target.copy(this.centre);
    this.distance = this.distanceToAll();
    this.stand(outlook.clone().multiplyScalar(this.distance));
  }

  /** Puts the camera there, seen from what it looks at. */
  stand(offset) {
    this.camera.position.copy(this.controls.target).add(offset);
    this.camera.near = this.distance / 100;
    this.camera.far = this.distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  /** By keys what the mouse does: arrows turn the picture, plus and minus bring it nearer and away. */
  turnBy(event) {
    const by = {
      ArrowLeft: () => this.controls.rotateLeft(-0.1),
      ArrowRight: () => this.controls.rotateLeft(0.1),
      ArrowUp: () => this.controls.rotateUp(-0.1),
      ArrowDown: () => this.controls.rotateUp(0.1),
      "+": () => this.controls.dollyIn(0.9),
      "-": () => this.controls.dollyOut(0.9),
    };
    if (!by[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    by[event.key]();
  }

  /** The canvas has the shape of its box, whatever the window's; whether that changed. */
  takeShape() {
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement;
    const size = this.renderer.getSize(new THREE.Vector2());
    const ratio = window.devicePixelRatio || 1;
    if (width === 0 || height === 0) return false;
    if (size.x === width && size.y === height && this.renderer.getPixelRatio() === ratio) return false;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    return true;
  }

  /** Keeps all in sight that was, from the side from which somebody looks. */
  keepInSight() {
    const before = this.distance;
    this.distance = this.distanceToAll();
    this.stand(this.camera.position.clone().sub(this.controls.target).multiplyScalar(this.distance / before));
  }

  showTrails(visible) {
    for (const { trail } of this.bodies) if (trail) trail.visible = visible;
  }

  draw(row) {
    if (this.takeShape()) this.keepInSight();
    for (const body of this.bodies) body.place(row);
    this.renderer.render(this.scene, this.camera);
  }
}
