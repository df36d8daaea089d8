// The way that a point took, up to the time that is shown.

import * as THREE from "three";

import { put } from "./shapes";

const MOST = 4000; // points; then the older half goes

/** A line through where a point was, with gaps where time leapt. */
export class Trail {
  readonly lines: THREE.LineSegments;
  private times: number[] = [];
  private places: number[] = []; // x, y, z of each
  private gaps: boolean[] = []; // before each

  /** fine: what is nearer than that to the point before is the same point [m]. */
  constructor(
    color: string,
    private readonly fine: number,
  ) {
    const material = new THREE.LineBasicMaterial({ color, transparent: true, opacity: 0.7, depthTest: false });
    this.lines = new THREE.LineSegments(new THREE.BufferGeometry(), material);
    this.lines.frustumCulled = false;
    this.lines.renderOrder = 12;
    put(this.lines.geometry, new Float32Array(0));
  }

  get length(): number {
    return this.times.length;
  }

  /** Goes on to a place; what was later than its time is forgotten. leap: it did not come along the straight line. */
  add(time: number, x: number, y: number, z: number, leap: boolean): void {
    let count = this.times.length;
    while (count > 0 && this.times[count - 1]! >= time) --count;
    const back = count < this.times.length;
    this.cut(0, count);
    const before = 3 * (count - 1);
    const far =
      count === 0 ||
      Math.hypot(x - this.places[before]!, y - this.places[before + 1]!, z - this.places[before + 2]!) > this.fine;
    if (far || leap) {
      this.times.push(time);
      this.places.push(x, y, z);
      this.gaps.push(leap || count === 0);
    }
    if (this.times.length > MOST) this.cut(MOST / 2, this.times.length);
    if (far || leap || back) this.draw();
  }

  private cut(from: number, to: number): void {
    if (from === 0 && to === this.times.length) return;
    this.times = this.times.slice(from, to);
    this.places = this.places.slice(3 * from, 3 * to);
    this.gaps = this.gaps.slice(from, to);
    if (this.gaps.length > 0) this.gaps[0] = true;
  }

  private draw(): void {
    const pairs: number[] = [];
    for (let i = 1; i < this.times.length; ++i) {
      if (!this.gaps[i]) pairs.push(...this.places.slice(3 * i - 3, 3 * i + 3));
    }
    put(this.lines.geometry, new Float32Array(pairs));
  }
}
