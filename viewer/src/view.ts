// The robot in space: everything that three.js draws.

import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import { palette, table, type MapName } from "./colors";
import type { FrameMessage, SceneMessage, Vector } from "./message";
import { RING, arrowsOf, axesShape, bend, bodyShape, label, pointsShape, put, rodShape, solidShape, targetShape, placeCut, type Rod, type Solid } from "./shapes";
import { Trail } from "./trail";

export interface Look {
  solids: string; // "", "displacement" or a field
  rods: string;
  map: MapName;
  opacity: number;
  edges: boolean;
  points: boolean;
  contacts: boolean;
  trails: boolean; // the ways of outputs and targets
  section: number; // 0: none, to 1
  sectionAxis: 0 | 1 | 2;
  sectionSide: 1 | -1; // what lies beyond it along the axis is cut away, or what lies before
}

export interface Range {
  least: number;
  most: number;
}

export interface Hit {
  kind: "target" | "solid";
  number: number;
  node: number;
  point: THREE.Vector3;
}

export class View {
  readonly renderer: THREE.WebGLRenderer;
  readonly camera: THREE.PerspectiveCamera;
  controls: OrbitControls;
  look: Look = {
    solids: "displacement",
    rods: "",
    map: "viridis",
    opacity: 0.55,
    edges: true,
    points: true,
    contacts: true,
    trails: true,
    section: 0,
    sectionAxis: 1,
    sectionSide: -1,
  };
  /** Of what is coloured; null: nothing is. */
  ranges: { solids: Range | null; rods: Range | null } = { solids: null, rods: null };
  private readonly world = new THREE.Scene();
  private own = new THREE.Group();
  private scene: SceneMessage | null = null;
  private frame: FrameMessage | null = null;
  private solids: Solid[] = [];
  private rods: Rod[] = [];
  private bodies: THREE.Group[] = [];
  private targets: THREE.Group[] = [];
  private outputs: THREE.Sprite[] = [];
  private trails: { outputs: Trail[]; targets: Trail[] } = { outputs: [], targets: [] };
  private letters: THREE.Sprite[] = [];
  private marks = new THREE.Points();
  private arrows = new THREE.LineSegments();
  private touches = new THREE.Points();
  private hand = new THREE.Line();
  private box = new THREE.Box3();
  private size = 1;
  private colors = table("viridis");
  private moved = true;
  private placed = false; // the camera, for what the first frame shows
  private besides = 0;

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, stencil: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.localClippingEnabled = true;
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.001, 100);
    this.controls = this.orbit();
    this.world.add(this.camera, this.own);
    const sun = new THREE.DirectionalLight("#ffffff", 1.6);
    sun.position.set(0.4, 0.8, 1);
    this.camera.add(sun);
    this.world.add(new THREE.AmbientLight("#ffffff", 1.3));
    const dark = matchMedia("(prefers-color-scheme: dark)");
    const paint = (): void => {
      this.world.background = new THREE.Color(dark.matches ? "#1b1f27" : "#f2f4f7");
      this.moved = true;
    };
    dark.addEventListener("change", paint);
    paint();
    new ResizeObserver(() => this.resize()).observe(canvas);
  }

  /** It turns about the way that is up for the camera when it is made. */
  private orbit(): OrbitControls {
    const own = new OrbitControls(this.camera, this.canvas);
    own.addEventListener("change", () => (this.moved = true));
    return own;
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    // The middle of what the panel and the plots leave free.
    const aside = width > 700 ? 130 - this.besides / 2 : 0;
    this.camera.setViewOffset(width, height, -aside, 0, width, height);
    this.moved = true;
  }

  /** How much at the right is taken [px]. */
  leave(width: number): void {
    this.besides = width;
    this.resize();
  }

  /** Whether anything has changed since the last time it was drawn. */
  draw(): boolean {
    this.controls.update();
    if (!this.moved) return false;
    this.moved = false;
    const distance = this.camera.position.distanceTo(this.controls.target);
    for (const own of this.targets) own.children[0]!.scale.setScalar(0.018 * distance);
    for (const own of [...this.outputs, ...this.letters]) {
      own.scale.set((0.016 * distance * own.userData.aspect) as number, 0.016 * distance, 1);
    }
    this.renderer.render(this.world, this.camera);
    return true;
  }

  // What there is.

  build(scene: SceneMessage): void {
    const same = this.scene !== null && JSON.stringify(this.scene.head.middle) === JSON.stringify(scene.head.middle);
    this.scene = scene;
    this.frame = null;
    this.own.traverse((one) => {
      if (one instanceof THREE.Sprite) {
        one.material.map?.dispose();
        one.material.dispose();
      } else if (one instanceof THREE.Mesh || one instanceof THREE.Line || one instanceof THREE.Points) {
        one.geometry.dispose();
        (Array.isArray(one.material) ? one.material : [one.material]).forEach((material) => material.dispose());
      }
    });
    this.world.remove(this.own);
    this.own = new THREE.Group();
    this.world.add(this.own);
    this.size = scene.head.size;
    this.box.makeEmpty();
    if (scene.head.solids.length === 0) this.look.solids = "";
    if (scene.head.rods.length === 0) this.look.rods = "";
    this.solids = scene.head.solids.map((_, i) => solidShape(scene, i));
    for (const { rest } of this.solids) {
      for (let i = 0; i < rest.length; i += 3) this.box.expandByPoint(new THREE.Vector3().fromArray(rest, i));
    }
    this.rods = scene.head.rods.map((_, i) => rodShape(scene, i));
    this.bodies = scene.head.bodies.map((_, i) => bodyShape(scene, i));
    this.targets = scene.head.targets.filter((one) => one.position).map(targetShape);
    this.outputs = scene.head.outputs.map(label);
    this.trails = {
      outputs: this.outputs.map(() => new Trail("#2f6db3", 1e-3 * this.size)),
      targets: this.targets.map(() => new Trail("#d62728", 1e-3 * this.size)),
    };
    const { axes, names } = axesShape(0.12 * this.size);
    this.letters = names;
    this.marks = pointsShape("#e6e6e6", 4);
    this.arrows = new THREE.LineSegments(
      new THREE.BufferGeometry(),
      new THREE.LineBasicMaterial({ color: "#d62728", depthTest: false, linewidth: 2 }),
    );
    this.touches = pointsShape("#d62728", 5);
    this.hand = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: "#d62728" }));
    for (const one of [this.marks, this.arrows, this.touches, this.hand]) {
      one.frustumCulled = false;
      one.renderOrder = 10;
    }
    for (const { mesh, edges, cut } of this.solids) this.own.add(mesh, edges, ...cut);
    for (const { mesh } of this.rods) this.own.add(mesh);
    this.own.add(axes, ...this.bodies, ...this.targets, ...this.outputs, ...names);
    this.own.add(...this.allTrails.map((one) => one.lines));
    this.own.add(this.marks, this.arrows, this.touches, this.hand);
    this.hand.visible = false;
    if (this.box.isEmpty()) this.box.expandByPoint(new THREE.Vector3(...scene.head.middle)).expandByScalar(this.size / 2);
    this.camera.up.set(...scene.head.up);
    if (!same) {
      this.controls.dispose();
      this.controls = this.orbit();
      this.placed = false;
    }
    this.apply();
  }

  // Where it is.

  show(frame: FrameMessage): void {
    const leap = this.leaps(frame);
    this.frame = frame;
    this.solids.forEach((one, i) => {
      const shorts = frame.shorts(`solid${i}`);
      const scale = frame.head.scales[i]!;
      const array = one.position.array as Float32Array;
      for (let k = 0; k < array.length; ++k) array[k] = one.rest[k]! + scale * shorts[k]!;
      one.position.needsUpdate = true;
      if (one.smooth) one.mesh.geometry.computeVertexNormals();
    });
    this.rods.forEach((one, i) => bend(one, frame.floats(`rod${i}`)));
    const poses = frame.floats("bodies");
    this.bodies.forEach((one, i) => {
      one.position.set(poses[7 * i]!, poses[7 * i + 1]!, poses[7 * i + 2]!);
      one.quaternion.set(poses[7 * i + 3]!, poses[7 * i + 4]!, poses[7 * i + 5]!, poses[7 * i + 6]!);
    });
    const outputs = frame.floats("outputs");
    this.outputs.forEach((one, i) => one.position.set(outputs[3 * i]!, outputs[3 * i + 1]!, outputs[3 * i + 2]!));
    this.placeTargets();
    const follow = (trails: Trail[], at: (i: number) => THREE.Vector3): void =>
      trails.forEach((one, i) => one.add(frame.head.time, ...at(i).toArray(), leap));
    follow(this.trails.outputs, (i) => this.outputs[i]!.position);
    follow(this.trails.targets, (i) => this.goalPosition(i));
    put(this.marks.geometry, frame.floats("points"));
    const { points, lines } = arrowsOf(frame.floats("contacts"), 0.2 * this.size);
    put(this.touches.geometry, points);
    put(this.arrows.geometry, lines);
    this.paint();
    if (!this.placed) this.preset("corner");
    this.placed = true;
    this.moved = true;
  }

  private get allTrails(): Trail[] {
    return [...this.trails.outputs, ...this.trails.targets];
  }

  /** Points of the trails of outputs, and of targets. */
  trailLengths(): { outputs: number[]; targets: number[] } {
    return { outputs: this.trails.outputs.map((one) => one.length), targets: this.trails.targets.map((one) => one.length) };
  }

  /** Whether somebody has moved the time of a recorded run on: by more than 3 % of its steps, and three of them. */
  private leaps(frame: FrameMessage): boolean {
    const times = this.scene!.head.times;
    if (!times || !this.frame) return false;
    return Math.abs(frame.head.frame - this.frame.head.frame) > Math.max(3, 0.03 * times.length);
  }

  private placeTargets(): void {
    const frame = this.frame!;
    const goals = frame.doubles("goals");
    const outputs = frame.floats("outputs");
    let number = 0;
    for (const target of this.scene!.head.targets) {
      if (!target.position) continue;
      const own = this.targets[number++]!;
      const at = this.scene!.head.outputs.indexOf(target.name);
      // Where it is free, it is where the output is.
      const [x, y, z] = target.weights.map((weight, k) => (weight === 0 ? outputs[3 * at + k]! : goals[target.first + k]!));
      own.children[0]!.position.set(x!, y!, z!);
      const line = (own.children[1] as THREE.Line).geometry.getAttribute("position") as THREE.BufferAttribute;
      line.setXYZ(0, x!, y!, z!);
      line.setXYZ(1, outputs[3 * at]!, outputs[3 * at + 1]!, outputs[3 * at + 2]!);
      line.needsUpdate = true;
    }
  }

  // How it looks.

  /** What of the look is not painted anew with every frame. */
  apply(): void {
    const { look } = this;
    this.colors = table(look.map);
    const planes: THREE.Plane[] = [];
    if (look.section > 0) {
      const normal = new THREE.Vector3().setComponent(look.sectionAxis, -look.sectionSide);
      const least = this.box.min.getComponent(look.sectionAxis);
      const most = this.box.max.getComponent(look.sectionAxis);
      const depth = look.section * (most - least);
      planes.push(new THREE.Plane(normal, look.sectionSide > 0 ? most - depth : -(least + depth)));
    }
    for (const one of this.solids) {
      const { material } = one.mesh;
      material.opacity = look.opacity;
      material.transparent = look.opacity < 1;
      material.depthWrite = look.opacity >= 1;
      material.clippingPlanes = planes;
      one.edges.material.clippingPlanes = planes;
      placeCut(one, planes[0], this.size);
      one.edges.visible = look.edges;
      material.needsUpdate = true;
    }
    this.marks.visible = look.points;
    this.arrows.visible = this.touches.visible = look.contacts;
    for (const one of this.allTrails) one.lines.visible = look.trails;
    if (this.frame) this.paint();
    this.moved = true;
  }

  private paint(): void {
    const { look } = this;
    const values = this.solids.map((one, i) => this.valuesOf(one, i));
    const rods = this.rods.map((_, i) => this.frame!.floats(`rod${i}.${look.rods}`));
    this.ranges = { solids: look.solids ? rangeOf(values, look.solids) : null, rods: look.rods ? rangeOf(rods, look.rods) : null };
    if (this.ranges.solids && look.solids === "displacement") this.ranges.solids.least = 0;
    this.solids.forEach((one, i) => this.fill(one.color, values[i]!, 1, this.ranges.solids, [0.42, 0.6, 0.75]));
    this.rods.forEach((one, i) => {
      const plain = new THREE.Color(palette[(i + 1) % palette.length]);
      this.fill(one.color, rods[i]!, RING, this.ranges.rods, [plain.r, plain.g, plain.b]);
    });
  }

  private valuesOf(one: Solid, number: number): Float32Array {
    if (this.look.solids !== "displacement") return this.frame!.floats(`solid${number}.${this.look.solids}`);
    const shorts = this.frame!.shorts(`solid${number}`);
    const scale = this.frame!.head.scales[number]!;
    const all = new Float32Array(one.rest.length / 3);
    for (let i = 0; i < all.length; ++i) {
      all[i] = scale * Math.hypot(shorts[3 * i]!, shorts[3 * i + 1]!, shorts[3 * i + 2]!);
    }
    return all;
  }

  private fill(color: THREE.BufferAttribute, values: Float32Array, repeat: number, range: Range | null, plain: Vector): void {
    const array = color.array as Float32Array;
    for (let i = 0; 3 * i < array.length; ++i) {
      const value = values[Math.floor(i / repeat)];
      if (range === null || value === undefined) {
        array.set(plain, 3 * i);
        continue;
      }
      const part = range.most > range.least ? Math.min(Math.max((value - range.least) / (range.most - range.least), 0), 1) : 0;
      const at = 3 * Math.round(255 * (Number.isNaN(part) ? 0 : part));
      for (let k = 0; k < 3; ++k) array[3 * i + k] = this.colors[at + k]!;
    }
    color.needsUpdate = true;
  }

  // Where it is seen from.

  preset(name: "corner" | "front" | "side" | "top"): void {
    const up = new THREE.Vector3(...(this.scene?.head.up ?? ([0, 0, 1] as Vector)));
    const aside = new THREE.Vector3(1, 0, 0);
    if (Math.abs(up.x) > 0.9) aside.set(0, 1, 0);
    aside.addScaledVector(up, -aside.dot(up)).normalize();
    const front = new THREE.Vector3().crossVectors(aside, up);
    const from = {
      corner: front.clone().addScaledVector(aside, 0.7).addScaledVector(up, 0.45),
      front,
      side: aside,
      top: up.clone().addScaledVector(front, 1e-3),
    }[name];
    const box = this.seen();
    const middle = box.getCenter(new THREE.Vector3());
    const radius = Math.max(box.getSize(new THREE.Vector3()).length() / 2, 1e-3);
    const angle = (this.camera.fov / 2) * (Math.PI / 180) * Math.min(1, this.camera.aspect);
    this.camera.up.copy(up);
    this.camera.position.copy(middle).addScaledVector(from.normalize(), (1.1 * radius) / Math.sin(angle));
    this.camera.near = radius / 200;
    this.camera.far = radius * 200;
    this.controls.minDistance = radius / 20;
    this.controls.maxDistance = radius * 50;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(middle);
    this.controls.update();
    this.moved = true;
  }

  /** What there is to be seen now; grounds do not count. */
  private seen(): THREE.Box3 {
    const box = this.box.clone();
    if (!this.frame) return box;
    for (const one of this.solids) box.union(new THREE.Box3().setFromBufferAttribute(one.position));
    for (const one of this.rods) box.union(new THREE.Box3().setFromBufferAttribute(one.position));
    this.bodies.forEach((one, i) => {
      if (!this.scene!.head.bodies[i]!.ground) box.expandByObject(one);
    });
    return box;
  }

  // Hands.

  /** Where a point is on the canvas [px]. */
  project(point: THREE.Vector3): { x: number; y: number } {
    const own = point.clone().project(this.camera);
    return { x: ((own.x + 1) / 2) * this.canvas.clientWidth, y: ((1 - own.y) / 2) * this.canvas.clientHeight };
  }

  private ray(x: number, y: number): THREE.Raycaster {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.camera);
    return ray;
  }

  /** What is under the pointer and not cut away: a target within 16 px, else a solid that nothing hides. */
  pick(x: number, y: number): Hit | null {
    for (const [number, one] of this.targets.entries()) {
      const point = one.children[0]!.position.clone();
      const at = this.project(point);
      const before = point.clone().sub(this.camera.position).dot(this.camera.getWorldDirection(new THREE.Vector3())) > 0;
      if (before && Math.hypot(at.x - x, at.y - y) < 16) return { kind: "target", number, node: -1, point };
    }
    const ray = this.ray(x, y);
    const hidden = this.bodies.filter((_, i) => !this.scene!.head.bodies[i]!.ground).map((one) => ray.intersectObject(one.children[0]!, false)[0]?.distance ?? Infinity);
    ray.far = Math.min(Infinity, ...hidden);
    let best: { distance: number; hit: Hit } | null = null;
    this.solids.forEach((one, number) => {
      one.mesh.geometry.computeBoundingSphere();
      const planes = one.mesh.material.clippingPlanes ?? [];
      const found = ray.intersectObject(one.mesh, false).find((hit) => planes.every((plane) => plane.distanceToPoint(hit.point) >= 0));
      if (!found || !found.face || (best && found.distance >= best.distance)) return;
      const corners = [found.face.a, found.face.b, found.face.c];
      const at = new THREE.Vector3();
      const near = corners.reduce((a, b) =>
        at.fromBufferAttribute(one.position, a).distanceTo(found.point) <=
        new THREE.Vector3().fromBufferAttribute(one.position, b).distanceTo(found.point)
          ? a
          : b,
      );
      const point = new THREE.Vector3().fromBufferAttribute(one.position, near);
      best = { distance: found.distance, hit: { kind: "solid", number, node: near, point } };
    });
    return (best as { distance: number; hit: Hit } | null)?.hit ?? null;
  }

  /** The point under the pointer in the plane through `through` that faces the camera. */
  under(x: number, y: number, through: THREE.Vector3): THREE.Vector3 {
    const normal = this.camera.getWorldDirection(new THREE.Vector3());
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(normal, through);
    return this.ray(x, y).ray.intersectPlane(plane, new THREE.Vector3()) ?? through.clone();
  }

  /** Where the red ball of a target is. */
  goalPosition(target: number): THREE.Vector3 {
    return this.targets[target]!.children[0]!.position;
  }

  meshNode(solid: number, corner: number): number {
    return this.solids[solid]!.nodes[corner]!;
  }

  cornerPosition(solid: number, corner: number): THREE.Vector3 {
    return new THREE.Vector3().fromBufferAttribute(this.solids[solid]!.position, corner);
  }

  /** The spring between the hand and what it holds; null: none. */
  showHand(ends: [THREE.Vector3, THREE.Vector3] | null): void {
    this.hand.visible = ends !== null;
    if (ends) this.hand.geometry.setFromPoints(ends);
    this.moved = true;
  }
}

/** Null: there are no values. Stresses that are nothing but rounding are 0. */
function rangeOf(all: Float32Array[], name: string): Range | null {
  let least = Infinity;
  let most = -Infinity;
  for (const own of all) {
    for (const value of own) {
      if (value < least) least = value;
      if (value > most) most = value;
    }
  }
  if (!(most >= least)) return null;
  const rounding = /stress|von_mises/.test(name) && Math.max(most, -least) < 1e-3; // [Pa]
  return rounding ? { least: 0, most: 0 } : { least, most };
}
