// Outlines and marks in the view: the stock, a marked position, the measured distance.
import * as THREE from 'three';
import type { Vec3 } from '../protocol';

export class Marks {
  readonly group = new THREE.Group();
  readonly stock = wire(0x7a8290);
  private readonly distance = wire(0x0a7cff);
  private readonly point: THREE.Points;

  constructor() {
    const dot = new THREE.BufferGeometry();
    dot.setAttribute('position', new THREE.Float32BufferAttribute([0, 0, 0], 3));
    const look = { color: 0xff2d95, size: 11, sizeAttenuation: false, depthTest: false };
    this.point = new THREE.Points(dot, new THREE.PointsMaterial(look));
    this.point.renderOrder = 11;
    this.point.visible = false;
    this.distance.material.depthTest = false;
    this.distance.renderOrder = 12;
    this.group.add(this.stock, this.distance, this.point);
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

  setDistance(points: readonly Vec3[]): void {
    setPoints(this.distance, points.length === 2 ? points : []);
    if (points.length > 0) this.setPoint(points[points.length - 1]!);
  }
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
