// The tool, as turned bodies of flutes, neck, shank and holder, at the position of its tip.
import * as THREE from 'three';
import type { Tool, Vec3 } from '../protocol';

const SIDES = 32;
const COLOURS: Record<string, number> = { neck: 0xa8adb5, shank: 0x8d939c, holder: 0x4c525c };

export class ToolBody {
  readonly group = new THREE.Group();
  private shown: Tool | null = null;

  /** Replaces the body; null: no tool. */
  setTool(tool: Tool | null): void {
    if (tool === this.shown) return;
    this.shown = tool;
    for (const child of [...this.group.children]) {
      (child as THREE.Mesh).geometry.dispose();
      this.group.remove(child);
    }
    for (const profile of tool?.profiles ?? []) {
      if (profile.points.length < 2) continue;
      const points = profile.points.map(([r, z]) => new THREE.Vector2(Math.max(r, 0), z));
      const geometry = new THREE.LatheGeometry(points, SIDES);
      geometry.rotateX(Math.PI / 2);
      const own = tool!.colour.map((c) => c / 255) as Vec3;
      const colour = COLOURS[profile.part] ?? new THREE.Color(...own);
      const material = new THREE.MeshLambertMaterial({
        color: colour,
        transparent: true,
        opacity: 0.8,
        side: THREE.DoubleSide,
      });
      this.group.add(new THREE.Mesh(geometry, material));
    }
  }

  /** mm from the tip to the upper end of all that is known of the tool. */
  get height(): number {
    const ends = this.shown?.profiles.flatMap((profile) => profile.points.map(([, z]) => z)) ?? [];
    return Math.max(0, ...ends);
  }

  moveTo(tip: Vec3 | null): void {
    this.group.visible = tip !== null;
    if (tip) this.group.position.set(...tip);
  }
}
