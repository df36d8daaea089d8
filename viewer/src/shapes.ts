// What there is to see, as three.js wants it: made once for a scene, moved with every frame.

import * as THREE from "three";

import type { SceneMessage } from "./message";

export interface Solid {
  rest: Float32Array;
  nodes: Uint32Array;
  position: THREE.BufferAttribute;
  color: THREE.BufferAttribute;
  mesh: THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial>;
  edges: THREE.LineSegments<THREE.BufferGeometry, THREE.LineBasicMaterial>;
  cut: [THREE.Mesh, THREE.Mesh, THREE.Mesh]; // its back, its front, and the face of a section through it
  smooth: boolean;
}

export interface Rod {
  radius: Float32Array; // abscissa, radius
  samples: number;
  position: THREE.BufferAttribute;
  normal: THREE.BufferAttribute;
  color: THREE.BufferAttribute;
  mesh: THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial>;
}

/** Corners of a tube. */
export const RING = 8;

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
export function label(text: string): THREE.Sprite {
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

/** A solid's surface at rest. */
export function solidShape(scene: SceneMessage, number: number): Solid {
  const rest = scene.floats(`solid${number}.rest`);
  const triangles = scene.whole(`solid${number}.triangles`);
  const count = rest.length / 3;
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
  return { rest, nodes: scene.whole(`solid${number}.nodes`), position, color, mesh, edges, cut: cutShape(geometry), smooth };
}

/** What fills a section: the pixels behind which the solid has more backs than fronts, counted by the stencil. */
function cutShape(geometry: THREE.BufferGeometry): Solid["cut"] {
  const counting = (side: THREE.Side, step: THREE.StencilOp): THREE.Mesh => {
    const material = new THREE.MeshBasicMaterial({ side, colorWrite: false, depthWrite: false, depthTest: false, stencilWrite: true });
    material.stencilFail = material.stencilZFail = material.stencilZPass = step;
    return new THREE.Mesh(geometry, material);
  };
  const face = new THREE.MeshStandardMaterial({ color: "#c3ccd6", roughness: 0.9, side: THREE.DoubleSide, stencilWrite: true });
  face.stencilFunc = THREE.NotEqualStencilFunc;
  face.stencilFail = face.stencilZFail = face.stencilZPass = THREE.ReplaceStencilOp;
  const own: Solid["cut"] = [
    counting(THREE.BackSide, THREE.IncrementWrapStencilOp),
    counting(THREE.FrontSide, THREE.DecrementWrapStencilOp),
    new THREE.Mesh(new THREE.PlaneGeometry(1, 1), face),
  ];
  own[2].onAfterRender = (renderer) => renderer.clearStencil();
  own.forEach((one, i) => {
    one.frustumCulled = one.visible = false;
    one.renderOrder = 1.2 + 0.1 * i; // after rods, before solids
  });
  return own;
}

/** Where a plane cuts a solid, in a scene of a size; undefined: nowhere. */
export function placeCut({ cut, position }: Solid, plane: THREE.Plane | undefined, size: number): void {
  const [back, front, face] = cut;
  for (const one of cut) one.visible = plane !== undefined;
  if (!plane) return;
  for (const one of [back, front]) (one.material as THREE.Material).clippingPlanes = [plane];
  const middle = new THREE.Box3().setFromBufferAttribute(position).getCenter(new THREE.Vector3());
  plane.projectPoint(middle, face.position);
  face.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), plane.normal);
  face.scale.setScalar(6 * size);
}

/** A rod's tube, which is nowhere yet. */
export function rodShape(scene: SceneMessage, number: number): Rod {
  const { samples } = scene.head.rods[number]!;
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
  let radius = scene.floats(`rod${number}.radius`);
  if (radius.length === 0) {
    radius = new Float32Array(2 * samples); // a cable has none: drawn as a thread
    for (let j = 0; j < samples; ++j) radius[2 * j + 1] = 0.0015 * scene.head.size;
  }
  return { radius, samples, position, normal, color, mesh };
}

export function bodyShape(scene: SceneMessage, number: number): THREE.Group {
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
  return group;
}

/** A red ball, and a line to what is to come there. */
export function targetShape(): THREE.Group {
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
  return group;
}

/** A tube around the points; its rings do not turn about it. */
export function bend(rod: Rod, points: Float32Array): void {
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

/** Where forces act, and arrows along them, the largest of a length: pairs of points of lines. */
export function arrowsOf(contacts: Float32Array, length: number): { points: Float32Array; lines: Float32Array } {
  let most = 0;
  for (let i = 0; i < contacts.length; i += 6) {
    most = Math.max(most, Math.hypot(contacts[i + 3]!, contacts[i + 4]!, contacts[i + 5]!));
  }
  const scale = most > 0 ? length / most : 0;
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
  return { points, lines };
}

/** Three axes of a length, and their names. */
export function axesShape(length: number): { axes: THREE.AxesHelper; names: THREE.Sprite[] } {
  const axes = new THREE.AxesHelper(length);
  axes.setColors("#d55e00", "#009e73", "#0072b2");
  const names = ["x", "y", "z"].map((name, i) => {
    const own = label(name);
    own.position.setComponent(i, length);
    return own;
  });
  return { axes, names };
}

/** Points of a size [px] that nothing hides. */
export function pointsShape(color: string, size: number): THREE.Points {
  return new THREE.Points(new THREE.BufferGeometry(), new THREE.PointsMaterial({ color, size, sizeAttenuation: false, depthTest: false }));
}

/** Points or lines of a number that changes; there is room for twice as many as were needed. */
export function put(geometry: THREE.BufferGeometry, numbers: Float32Array): void {
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
