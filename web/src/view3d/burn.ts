// The board below a laser, darker with the energy per area that its beam leaves.
import * as THREE from 'three';
import { burnColour } from '../colours';
import type { BurnAnswer } from '../decode';

export class BurnBoard extends THREE.Mesh<THREE.BufferGeometry, THREE.MeshBasicMaterial> {
  private burn: BurnAnswer | null = null;

  constructor() {
    super(
      new THREE.BufferGeometry(),
      new THREE.MeshBasicMaterial({ side: THREE.DoubleSide, polygonOffset: true, polygonOffsetFactor: 1 }),
    );
    this.visible = false;
  }

  /** `z`: mm, of the board's top. */
  set(burn: BurnAnswer | null, z: number): void {
    this.visible = burn !== null;
    if (burn === this.burn) return;
    this.burn = burn;
    this.geometry.dispose();
    this.material.map?.dispose();
    if (!burn) return;
    const { nx, ny, x, y, cell, energy, black } = burn;
    const colours = new Uint8Array(4 * nx * ny);
    for (let k = 0; k < nx * ny; ++k) {
      colours.set(burnColour(black > 0 ? energy[k]! / black : 0), 4 * k);
      colours[4 * k + 3] = 255;
    }
    const texture = new THREE.DataTexture(colours, nx, ny);
    texture.magFilter = THREE.NearestFilter;
    texture.minFilter = THREE.LinearMipmapLinearFilter;
    texture.generateMipmaps = true;
    texture.needsUpdate = true;
    this.material.map = texture;
    this.material.needsUpdate = true;
    this.geometry = new THREE.PlaneGeometry(nx * cell, ny * cell);
    this.position.set(x + (nx * cell) / 2, y + (ny * cell) / 2, z);
  }

  /** J/mm2 where a ray meets the board, and the point; null beside it. */
  energyAt(ray: THREE.Ray): { point: THREE.Vector3; energy: number } | null {
    const { burn } = this;
    if (!burn || !this.visible) return null;
    const plane = new THREE.Plane(new THREE.Vector3(0, 0, 1), -this.position.z);
    const point = ray.intersectPlane(plane, new THREE.Vector3());
    if (!point) return null;
    const i = Math.floor((point.x - burn.x) / burn.cell);
    const j = Math.floor((point.y - burn.y) / burn.cell);
    if (i < 0 || j < 0 || i >= burn.nx || j >= burn.ny) return null;
    return { point, energy: burn.energy[j * burn.nx + i]! };
  }
}
