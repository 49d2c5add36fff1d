// The bodies of a run in space, z up.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import { reader } from "./frames.js";

const palette = [0x2f6fde, 0xe4572e, 0x2a9d6f, 0x8e5bd0, 0xd9a514, 0x3aa6b9];

/** Squares in two shades, so that a turning surface is seen to turn. */
function checkers(color, across, down) {
  const canvas = document.createElement("canvas");
  canvas.width = 16 * across;
  canvas.height = 16 * down;
  const paint = canvas.getContext("2d");
  const light = new THREE.Color(color).lerp(new THREE.Color(0xffffff), 0.6);
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
        (white) => new THREE.MeshStandardMaterial({ color: new THREE.Color(color).lerp(new THREE.Color(0xffffff), white) }))),
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
      new THREE.MeshStandardMaterial({ map: checkers(color, 16, 16), side: THREE.DoubleSide, transparent: true, opacity: 0.45 })),
};

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
    this.group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), along.clone().normalize());
    this.mesh.scale.z = length / this.length;
    this.mesh.position.z = length / 2;
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

/** The stage: everything that moves, light, camera. */
export class Stage {
  constructor(canvas, run) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(0xf7f9fc);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0xb8c0cc, 2.2));
    this.bodies = run.shapes.map((shape, i) => new Body(run, shape, palette[i % palette.length]));
    for (const { group, trail } of this.bodies) {
      this.scene.add(group);
      if (trail) this.scene.add(trail);
    }
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.01, 1000);
    this.camera.up.set(0, 0, 1);
    const sun = new THREE.DirectionalLight(0xffffff, 2);
    sun.position.set(1, -1, 3);
    this.camera.add(sun);
    this.scene.add(this.camera);
    this.controls = new OrbitControls(this.camera, canvas);
    const plates = this.bodies.filter(({ kind }) => kind === "plate");
    this.bounds = this.measure(this.bodies.filter(({ kind }) => kind !== "plate"), run.time.length);
    for (const { group } of plates) {
      const { min, max } = this.bounds;
      group.scale.setScalar(1.1 * Math.hypot(Math.max(-min.x, max.x), Math.max(-min.y, max.y)));
    }
    this.bounds.union(this.measure(plates, 1));
    this.lookAtAll();
  }

  /** The box that holds these bodies at every row (at most a few hundred of them). */
  measure(bodies, rows) {
    const bounds = new THREE.Box3();
    const stride = Math.max(1, Math.floor(rows / 200));
    for (let row = 0; row < rows; row += stride)
      for (const body of bodies) {
        body.place(row);
        body.group.updateMatrixWorld(true);
        bounds.expandByObject(body.group);
      }
    return bounds;
  }

  lookAtAll() {
    const sphere = this.bounds.getBoundingSphere(new THREE.Sphere());
    const distance = (0.8 * sphere.radius) / Math.sin((this.camera.fov * Math.PI) / 360);
    this.camera.position.copy(sphere.center).add(new THREE.Vector3(0.45, -0.8, 0.4).normalize().multiplyScalar(distance));
    this.camera.near = distance / 100;
    this.camera.far = distance * 20;
    this.controls.target.copy(sphere.center);
    this.controls.update();
  }

  showTrails(visible) {
    for (const { trail } of this.bodies) if (trail) trail.visible = visible;
  }

  draw(row) {
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement;
    const size = this.renderer.getSize(new THREE.Vector2());
    if (size.x !== width || size.y !== height) {
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / Math.max(1, height);
      this.camera.updateProjectionMatrix();
    }
    for (const body of this.bodies) body.place(row);
    this.renderer.render(this.scene, this.camera);
  }
}
