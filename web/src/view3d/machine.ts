// The machine as far as its profile says where it is: the limits of its travel, and a spindle on a gantry
// that follow the tool. Their sizes are those of no machine; only the travel is known.
import * as THREE from 'three';
import type { Vec3 } from '../protocol';

const COLOUR = 0x6b7480;
const THICKNESS = 0.04; // of gantry and spindle, as a part of the longest travel

export class MachineBody {
  readonly group = new THREE.Group();
  private readonly gantry = new THREE.Group();
  private readonly spindle = new THREE.Group();
  private shown = '';
  private low: Vec3 = [0, 0, 0];

  /** The travel in work coordinates; null: not known, so that nothing is shown. */
  set(travel: readonly [Vec3, Vec3] | null): void {
    const all = JSON.stringify(travel);
    if (all === this.shown) return;
    this.shown = all;
    this.group.clear();
    this.gantry.clear();
    this.spindle.clear();
    if (!travel) return;
    const [low, high] = travel;
    this.low = low;
    const size = high.map((v, i) => v - low[i]!) as Vec3;
    const thick = THICKNESS * Math.max(...size);
    const edges = new THREE.EdgesGeometry(new THREE.BoxGeometry(...size));
    const limits = new THREE.LineSegments(edges, new THREE.LineBasicMaterial({ color: COLOUR }));
    limits.position.set(...(low.map((v, i) => v + size[i]! / 2) as Vec3));
    this.group.add(limits, this.gantry, this.spindle);
    // In the frame of the tool's upper end: the beam reaches over all of X.
    this.gantry.add(bar([size[0] + 2 * thick, thick, thick], [size[0] / 2, 1.5 * thick, thick]));
    this.spindle.add(bar([thick, thick, 2 * thick], [0, 0, thick]));
    this.moveTo(null, 0);
  }

  /** The tip of the tool, and its length to the spindle. */
  moveTo(tip: Vec3 | null, length: number): void {
    this.gantry.visible = this.spindle.visible = tip !== null;
    if (!tip) return;
    this.gantry.position.set(this.low[0], tip[1], tip[2] + length);
    this.spindle.position.set(tip[0], tip[1], tip[2] + length);
  }
}

function bar(size: Vec3, centre: Vec3): THREE.Mesh {
  const material = new THREE.MeshLambertMaterial({ color: COLOUR, transparent: true, opacity: 0.45 });
  const mesh = new THREE.Mesh(new THREE.BoxGeometry(...size), material);
  mesh.position.set(...centre);
  return mesh;
}
