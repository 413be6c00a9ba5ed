// Outlines and marks in the view: the stock, a marked position, the measured distance.
import * as THREE from 'three';
import type { Vec3 } from '../protocol';
import type { Circle } from './snap';

const ROUND = 96; // lines of a circle

export class Marks {
  readonly group = new THREE.Group();
  readonly stock = wire(0x7a8290);
  private readonly distance = wire(0x0a7cff);
  private readonly circles = wire(0x0a7cff);
  private readonly point = dot(0xff2d95);
  private readonly hint = dot(0x0a7cff);
  private readonly hintLines = wire(0x0a7cff);
  private arm = 1; // mm, of a centre's cross

  constructor() {
    for (const line of [this.distance, this.circles, this.hintLines]) {
      line.material.depthTest = false;
      line.renderOrder = 12;
    }
    this.group.add(this.stock, this.distance, this.circles, this.hintLines, this.hint, this.point);
  }

  setStock(block: readonly [Vec3, Vec3] | null): void {
    if (!block) {
      setPoints(this.stock, []);
      return;
    }
    const end = (i: number, axis: number) => block[(i >> axis) & 1]![axis]!;
    const corner = (i: number): Vec3 => [end(i, 0), end(i, 1), end(i, 2)];
    const edges: Vec3[] = [];
    for (let i = 0; i < 8; ++i) {
      for (const bit of [1, 2, 4]) if (!(i & bit)) edges.push(corner(i), corner(i | bit));
    }
    setPoints(this.stock, edges);
  }

  setPoint(at: Vec3 | null): void {
    this.point.visible = at !== null;
    if (at) this.point.position.set(...at);
  }

  /** Where a click would measure from, and the circle there. */
  setHint(at: Vec3 | null, circle: Circle | null): void {
    this.hint.visible = at !== null;
    if (at) this.hint.position.set(...at);
    setPoints(this.hintLines, circle ? roundLine(circle) : []);
  }

  /** Circles as lines, and the centres of these and others as crosses along the axes. */
  setCircles(circles: readonly Circle[], centres: readonly Vec3[]): void {
    const all = circles.flatMap(roundLine);
    const arm = Math.max(...circles.map(({ radius }) => radius / 4), 0) || this.arm;
    this.arm = arm;
    for (const [x, y, z] of centres)
      all.push([x - arm, y, z], [x + arm, y, z], [x, y - arm, z], [x, y + arm, z]);
    setPoints(this.circles, all);
  }

  setDistance(points: readonly Vec3[]): void {
    setPoints(this.distance, points.length >= 2 ? points.slice(1).flatMap((p, i) => [points[i]!, p]) : []);
    if (points.length > 0) this.setPoint(points[points.length - 1]!);
  }
}

/** A circle as pairs of points. */
function roundLine({ centre, radius, normal }: Circle): Vec3[] {
  const up = new THREE.Vector3(0, 0, 1);
  const turn = new THREE.Quaternion().setFromUnitVectors(up, new THREE.Vector3(...normal));
  const at = (k: number): Vec3 => {
    const angle = (2 * Math.PI * k) / ROUND;
    const p = new THREE.Vector3(radius * Math.cos(angle), radius * Math.sin(angle), 0).applyQuaternion(turn);
    return p.add(new THREE.Vector3(...centre)).toArray() as Vec3;
  };
  return Array.from({ length: ROUND }, (_, k) => [at(k), at(k + 1)]).flat();
}

/** A round mark of constant size, not shown yet. */
function dot(color: number): THREE.Points {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute([0, 0, 0], 3));
  const look = { color, size: 11, sizeAttenuation: false, depthTest: false };
  const point = new THREE.Points(geometry, new THREE.PointsMaterial(look));
  point.renderOrder = 11;
  point.visible = false;
  return point;
}

function wire(color: number): THREE.LineSegments<THREE.BufferGeometry, THREE.LineBasicMaterial> {
  const object = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color }));
  object.frustumCulled = false;
  return object;
}

function setPoints(object: THREE.LineSegments, points: readonly Vec3[]): void {
  object.geometry.dispose();
  object.geometry = new THREE.BufferGeometry();
  object.geometry.setAttribute('position', new THREE.Float32BufferAttribute(points.flat(), 3));
  object.visible = points.length > 0;
}
