// The robot in space: everything that three.js draws.

import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import { palette, table, type MapName } from "./colors";
import type { FrameMessage, SceneMessage, Vector } from "./message";

export interface Look {
  solids: string; // "", "displacement" or a field
  rods: string;
  map: MapName;
  opacity: number;
  edges: boolean;
  points: boolean;
  contacts: boolean;
  section: number; // 0: none, to 1
  sectionAxis: 0 | 1 | 2;
  sectionSide: 1 | -1; // what lies beyond it along the axis is cut away, or what lies before
}

export interface Range {
  least: number;
  most: number;
}

interface Solid {
  rest: Float32Array;
  nodes: Uint32Array;
  position: THREE.BufferAttribute;
  color: THREE.BufferAttribute;
  mesh: THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial>;
  edges: THREE.LineSegments<THREE.BufferGeometry, THREE.LineBasicMaterial>;
  smooth: boolean;
}

interface Rod {
  radius: Float32Array; // abscissa, radius
  samples: number;
  position: THREE.BufferAttribute;
  normal: THREE.BufferAttribute;
  color: THREE.BufferAttribute;
  mesh: THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial>;
}

export interface Hit {
  kind: "target" | "solid";
  number: number;
  node: number;
  point: THREE.Vector3;
}

const RING = 8;

/** Edges of triangles, each once. */
function edgesOf(triangles: Uint32Array): Uint32Array {
  const seen = new Set<number>();
  const all: number[] = [];
  for (let i = 0; i < triangles.length; i += 3) {
    for (let k = 0; k < 3; ++k) {
      const a = triangles[i + k]!;
      const b = triangles[i + ((k + 1) % 3)]!;
      const key = Math.min(a, b) * 4194304 + Math.max(a, b);
      if (seen.has(key)) continue;
      seen.add(key);
      all.push(a, b);
    }
  }
  return new Uint32Array(all);
}

function floats(count: number): THREE.BufferAttribute {
  const own = new THREE.BufferAttribute(new Float32Array(3 * count), 3);
  own.setUsage(THREE.DynamicDrawUsage);
  return own;
}

/** White text on a dark label, always turned to who looks. */
function label(text: string): THREE.Sprite {
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("2d")!;
  const font = "600 28px system-ui, sans-serif";
  context.font = font;
  const width = Math.ceil(context.measureText(text).width) + 16;
  canvas.width = width;
  canvas.height = 40;
  context.font = font;
  context.fillStyle = "rgba(20, 24, 32, 0.7)";
  context.fillRect(0, 0, width, 40);
  context.fillStyle = "#fff";
  context.fillText(text, 8, 29);
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map: texture, depthTest: false, transparent: true }));
  sprite.userData.aspect = width / 40;
  sprite.center.set(-0.15, -0.3);
  sprite.renderOrder = 20;
  return sprite;
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
    section: 0,
    sectionAxis: 1,
    sectionSide: 1,
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
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
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
    this.solids = scene.head.solids.map((_, i) => this.addSolid(i));
    this.rods = scene.head.rods.map((one, i) => this.addRod(i, one.samples));
    this.bodies = scene.head.bodies.map((_, i) => this.addBody(i));
    this.targets = scene.head.targets.filter((one) => one.position).map(() => this.addTarget());
    this.outputs = scene.head.outputs.map((name) => {
      const own = label(name);
      this.own.add(own);
      return own;
    });
    this.marks = new THREE.Points(
      new THREE.BufferGeometry(),
      new THREE.PointsMaterial({ color: "#e6e6e6", size: 4, sizeAttenuation: false, depthTest: false }),
    );
    this.arrows = new THREE.LineSegments(
      new THREE.BufferGeometry(),
      new THREE.LineBasicMaterial({ color: "#d62728", depthTest: false, linewidth: 2 }),
    );
    this.touches = new THREE.Points(
      new THREE.BufferGeometry(),
      new THREE.PointsMaterial({ color: "#d62728", size: 5, sizeAttenuation: false, depthTest: false }),
    );
    this.hand = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: "#d62728" }));
    for (const one of [this.marks, this.arrows, this.touches, this.hand]) {
      one.frustumCulled = false;
      one.renderOrder = 10;
      this.own.add(one);
    }
    this.hand.visible = false;
    this.axes();
    if (this.box.isEmpty()) this.box.expandByPoint(new THREE.Vector3(...scene.head.middle)).expandByScalar(this.size / 2);
    this.camera.up.set(...scene.head.up);
    if (!same) {
      this.controls.dispose();
      this.controls = this.orbit();
      this.placed = false;
    }
    this.apply();
  }

  private axes(): void {
    const length = 0.12 * this.size;
    this.letters = [];
    const axes = new THREE.AxesHelper(length);
    axes.setColors("#d55e00", "#009e73", "#0072b2");
    this.own.add(axes);
    ["x", "y", "z"].forEach((name, i) => {
      const own = label(name);
      own.position.setComponent(i, length);
      this.letters.push(own);
      this.own.add(own);
    });
  }

  private addSolid(number: number): Solid {
    const scene = this.scene!;
    const rest = scene.floats(`solid${number}.rest`);
    const triangles = scene.whole(`solid${number}.triangles`);
    const count = rest.length / 3;
    for (let i = 0; i < rest.length; i += 3) this.box.expandByPoint(new THREE.Vector3(rest[i], rest[i + 1], rest[i + 2]));
    const position = floats(count);
    position.array.set(rest);
    const color = floats(count);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", position);
    geometry.setAttribute("color", color);
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(triangles), 1));
    const smooth = triangles.length < 3 * 20000;
    if (smooth) geometry.computeVertexNormals();
    const material = new THREE.MeshStandardMaterial({
      vertexColors: true,
      side: THREE.DoubleSide,
      roughness: 0.75,
      flatShading: !smooth,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    const mesh = new THREE.Mesh(geometry, material);
    const lines = new THREE.BufferGeometry();
    lines.setAttribute("position", position);
    lines.setIndex(new THREE.BufferAttribute(edgesOf(triangles), 1));
    const edges = new THREE.LineSegments(lines, new THREE.LineBasicMaterial({ color: "#101418", transparent: true, opacity: 0.25 }));
    mesh.frustumCulled = edges.frustumCulled = false;
    mesh.renderOrder = 2;
    edges.renderOrder = 3;
    this.own.add(mesh, edges);
    return { rest, nodes: scene.whole(`solid${number}.nodes`), position, color, mesh, edges, smooth };
  }

  private addRod(number: number, samples: number): Rod {
    const count = samples * RING;
    const geometry = new THREE.BufferGeometry();
    const position = floats(count);
    const normal = floats(count);
    const color = floats(count);
    const index: number[] = [];
    for (let j = 0; j + 1 < samples; ++j) {
      for (let k = 0; k < RING; ++k) {
        const a = j * RING + k;
        const b = j * RING + ((k + 1) % RING);
        index.push(a, b, a + RING, b, b + RING, a + RING);
      }
    }
    geometry.setIndex(index);
    geometry.setAttribute("position", position);
    geometry.setAttribute("normal", normal);
    geometry.setAttribute("color", color);
    const mesh = new THREE.Mesh(
      geometry,
      new THREE.MeshStandardMaterial({ vertexColors: true, roughness: 0.4, side: THREE.DoubleSide }),
    );
    mesh.frustumCulled = false;
    mesh.renderOrder = 1;
    this.own.add(mesh);
    let radius = this.scene!.floats(`rod${number}.radius`);
    if (radius.length === 0) {
      radius = new Float32Array(2 * samples); // a cable has none: drawn as a thread
      for (let j = 0; j < samples; ++j) radius[2 * j + 1] = 0.0015 * this.size;
    }
    return { radius, samples, position, normal, color, mesh };
  }

  private addBody(number: number): THREE.Group {
    const scene = this.scene!;
    const head = scene.head.bodies[number]!;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(scene.floats(`body${number}.points`)), 3));
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(scene.whole(`body${number}.triangles`)), 1));
    if (head.round) geometry.computeVertexNormals();
    const material = new THREE.MeshStandardMaterial({
      color: head.ground ? "#a9b1bd" : head.fixed ? "#8a93a0" : "#c98a3a",
      flatShading: !head.round,
      roughness: 0.9,
      transparent: head.ground,
      opacity: head.ground ? 0.35 : 1,
      side: THREE.DoubleSide,
      depthWrite: !head.ground,
    });
    const group = new THREE.Group();
    group.add(new THREE.Mesh(geometry, material));
    if (!head.round && !head.ground) {
      group.add(
        new THREE.LineSegments(new THREE.EdgesGeometry(geometry, 25), new THREE.LineBasicMaterial({ color: "#303030" })),
      );
    }
    this.own.add(group);
    return group;
  }

  private addTarget(): THREE.Group {
    const group = new THREE.Group();
    const ball = new THREE.Mesh(
      new THREE.SphereGeometry(0.5, 24, 16),
      new THREE.MeshBasicMaterial({ color: "#d62728", transparent: true, opacity: 0.85, depthTest: false }),
    );
    ball.renderOrder = 15;
    const line = new THREE.Line(
      new THREE.BufferGeometry().setAttribute("position", floats(2)),
      new THREE.LineBasicMaterial({ color: "#d62728", depthTest: false }),
    );
    line.frustumCulled = false;
    line.renderOrder = 14;
    group.add(ball, line);
    this.own.add(group);
    return group;
  }

  // Where it is.

  show(frame: FrameMessage): void {
    this.frame = frame;
    this.solids.forEach((one, i) => {
      const shorts = frame.shorts(`solid${i}`);
      const scale = frame.head.scales[i]!;
      const array = one.position.array as Float32Array;
      for (let k = 0; k < array.length; ++k) array[k] = one.rest[k]! + scale * shorts[k]!;
      one.position.needsUpdate = true;
      if (one.smooth) one.mesh.geometry.computeVertexNormals();
    });
    this.rods.forEach((one, i) => this.bend(one, frame.floats(`rod${i}`)));
    const poses = frame.floats("bodies");
    this.bodies.forEach((one, i) => {
      one.position.set(poses[7 * i]!, poses[7 * i + 1]!, poses[7 * i + 2]!);
      one.quaternion.set(poses[7 * i + 3]!, poses[7 * i + 4]!, poses[7 * i + 5]!, poses[7 * i + 6]!);
    });
    const outputs = frame.floats("outputs");
    this.outputs.forEach((one, i) => one.position.set(outputs[3 * i]!, outputs[3 * i + 1]!, outputs[3 * i + 2]!));
    this.placeTargets();
    put(this.marks.geometry, frame.floats("points"));
    this.placeArrows(frame.floats("contacts"));
    this.paint();
    if (!this.placed) this.preset("corner");
    this.placed = true;
    this.moved = true;
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
      own.children[0]!.position.set(goals[target.first]!, goals[target.first + 1]!, goals[target.first + 2]!);
      const line = (own.children[1] as THREE.Line).geometry.getAttribute("position") as THREE.BufferAttribute;
      line.setXYZ(0, goals[target.first]!, goals[target.first + 1]!, goals[target.first + 2]!);
      line.setXYZ(1, outputs[3 * at]!, outputs[3 * at + 1]!, outputs[3 * at + 2]!);
      line.needsUpdate = true;
    }
  }

  /** Where forces act, and arrows along them, the largest a fifth of the scene long. */
  private placeArrows(contacts: Float32Array): void {
    let most = 0;
    for (let i = 0; i < contacts.length; i += 6) {
      most = Math.max(most, Math.hypot(contacts[i + 3]!, contacts[i + 4]!, contacts[i + 5]!));
    }
    const scale = most > 0 ? (0.2 * this.size) / most : 0;
    const points = new Float32Array(contacts.length / 2);
    const lines = new Float32Array(3 * contacts.length); // a shaft and two barbs
    const from = new THREE.Vector3();
    const along = new THREE.Vector3();
    const aside = new THREE.Vector3();
    for (let i = 0; i < contacts.length; i += 6) {
      from.fromArray(contacts, i).toArray(points, i / 2);
      along.fromArray(contacts, i + 3).multiplyScalar(scale);
      aside.set(along.z, along.x, along.y).cross(along);
      if (aside.lengthSq() > 0) aside.setLength(0.07 * along.length());
      const end = from.clone().add(along);
      const back = from.clone().addScaledVector(along, 0.85);
      [from, end, end, back.clone().add(aside), end, back.clone().sub(aside)].forEach((one, k) => one.toArray(lines, 3 * i + 3 * k));
    }
    put(this.touches.geometry, points);
    put(this.arrows.geometry, lines);
  }

  /** A tube around the points; its rings do not turn about it. */
  private bend(rod: Rod, points: Float32Array): void {
    const position = rod.position.array as Float32Array;
    const normal = rod.normal.array as Float32Array;
    const tangent = new THREE.Vector3();
    const before = new THREE.Vector3();
    const u = new THREE.Vector3();
    const v = new THREE.Vector3();
    const turn = new THREE.Quaternion();
    for (let j = 0; j < rod.samples; ++j) {
      const from = Math.max(j - 1, 0);
      const to = Math.min(j + 1, rod.samples - 1);
      tangent.set(
        points[3 * to]! - points[3 * from]!,
        points[3 * to + 1]! - points[3 * from + 1]!,
        points[3 * to + 2]! - points[3 * from + 2]!,
      );
      if (tangent.lengthSq() === 0) tangent.copy(j > 0 ? before : new THREE.Vector3(1, 0, 0));
      tangent.normalize();
      if (j === 0) {
        u.set(Math.abs(tangent.x) < 0.9 ? 1 : 0, Math.abs(tangent.x) < 0.9 ? 0 : 1, 0);
      } else {
        u.applyQuaternion(turn.setFromUnitVectors(before, tangent));
      }
      u.addScaledVector(tangent, -u.dot(tangent)).normalize();
      v.crossVectors(tangent, u);
      before.copy(tangent);
      const radius = rod.radius[2 * j + 1]!;
      for (let k = 0; k < RING; ++k) {
        const c = Math.cos((2 * Math.PI * k) / RING);
        const s = Math.sin((2 * Math.PI * k) / RING);
        const at = 3 * (j * RING + k);
        for (let axis = 0; axis < 3; ++axis) {
          const out = c * u.getComponent(axis) + s * v.getComponent(axis);
          normal[at + axis] = out;
          position[at + axis] = points[3 * j + axis]! + radius * out;
        }
      }
    }
    rod.position.needsUpdate = rod.normal.needsUpdate = true;
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
      one.edges.visible = look.edges;
      material.needsUpdate = true;
    }
    this.marks.visible = look.points;
    this.arrows.visible = this.touches.visible = look.contacts;
    if (this.frame) this.paint();
    this.moved = true;
  }

  private paint(): void {
    const { look } = this;
    const values = this.solids.map((one, i) => this.valuesOf(one, i));
    const rods = this.rods.map((_, i) => this.frame!.floats(`rod${i}.${look.rods}`));
    this.ranges = { solids: look.solids ? rangeOf(values) : null, rods: look.rods ? rangeOf(rods) : null };
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
    const hidden = this.bodies.filter((_, i) => !this.scene!.head.bodies[i]!.ground).map((one) => ray.intersectObject(one)[0]?.distance ?? Infinity);
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

/** Null: there are no values. */
function rangeOf(all: Float32Array[]): Range | null {
  let least = Infinity;
  let most = -Infinity;
  for (const own of all) {
    for (const value of own) {
      if (value < least) least = value;
      if (value > most) most = value;
    }
  }
  return most >= least ? { least, most } : null;
}

/** Points or lines of a number that changes; there is room for twice as many as were needed. */
function put(geometry: THREE.BufferGeometry, numbers: Float32Array): void {
  let own = geometry.getAttribute("position") as THREE.BufferAttribute | undefined;
  if (!own || own.array.length < numbers.length) {
    geometry.dispose(); // with the buffer of before
    own = floats(Math.max((2 * numbers.length) / 3, 16));
    geometry.setAttribute("position", own);
  }
  (own.array as Float32Array).set(numbers);
  own.needsUpdate = true;
  geometry.setDrawRange(0, numbers.length / 3);
}
