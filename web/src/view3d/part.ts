// The surface of the part: one mesh per tile, coloured per triangle. While another instant than the end of
// the job is shown, tiles of that instant replace those of the finished part.
import * as THREE from 'three';
import { differenceColour, type Palette } from '../colours';
import type { MeshAnswer, TargetAnswer, Tile } from '../decode';
import { FINAL, NO_STEP, renumber } from '../decode';

const CUT_FACE = '0.969, 0.886, 0.361'; // as in the pictures of `kerf simulate`

export interface SurfaceHit {
  point: THREE.Vector3;
  distance: number;
  /** The step that made the surface; NO_STEP on faces of the stock and on the section. */
  step: number;
}

interface Shown {
  tile: Tile;
  mesh: THREE.Mesh;
}

export class PartView {
  readonly group = new THREE.Group();
  /** The instant that is shown: FINAL, or a number of steps. */
  shownStep = FINAL;
  private readonly finished = new Map<number, Tile>();
  private readonly instant = new Map<number, Tile>();
  private readonly shown = new Map<number, Shown>();
  /** The finished part with exact edges; shown instead of its tiles. */
  private exact: Shown | null = null;
  private readonly tiles = new THREE.Group();
  private readonly difference = new DifferenceMap();
  private readonly material = partMaterial(this.difference);
  private palette: Palette | null = null;
  private stepLimit = FINAL;

  constructor() {
    this.group.add(this.tiles);
  }

  private get showsExact(): boolean {
    return this.exact !== null && this.shownStep === FINAL;
  }

  /** The finished part with exact edges, until the next update. */
  setExact(answer: MeshAnswer): void {
    this.dropExact();
    const tile = answer.tiles[0];
    if (!tile || !this.palette) return;
    const mesh = new THREE.Mesh(geometryOf(tile), this.material);
    setColours(mesh.geometry, this.palette.paint(tile));
    this.exact = { tile, mesh };
    this.group.add(mesh);
    this.chooseSurface();
  }

  private dropExact(): void {
    if (!this.exact) return;
    this.group.remove(this.exact.mesh);
    this.exact.mesh.geometry.dispose();
    this.exact = null;
    this.chooseSurface();
  }

  private chooseSurface(): void {
    this.tiles.visible = !this.showsExact;
    if (this.exact) this.exact.mesh.visible = this.showsExact;
  }

  /** Tiles of the finished part; the finished part is shown afterwards. */
  update(answer: MeshAnswer, palette: Palette): void {
    this.palette = palette;
    this.dropExact();
    if (answer.reset) this.finished.clear();
    for (const table of answer.renumberings) {
      for (const tile of this.finished.values()) renumber(tile.step, table);
    }
    for (const tile of answer.tiles) this.finished.set(tile.id, tile);
    this.showFinished();
  }

  /** Tiles of the instant after answer.atStep steps. */
  updateInstant(answer: MeshAnswer): void {
    this.shownStep = answer.atStep;
    if (answer.atStep === FINAL) {
      this.showFinished();
      return;
    }
    for (const tile of answer.tiles) {
      this.instant.set(tile.id, tile);
      this.refresh(tile.id);
    }
    this.chooseSurface();
  }

  showFinished(): void {
    this.shownStep = FINAL;
    this.instant.clear();
    const ids = new Set([...this.finished.keys(), ...this.shown.keys()]);
    for (const id of ids) this.refresh(id);
    this.chooseSurface();
  }

  /** Colours the surface by its difference from the target instead of its steps; null: by its steps. */
  showDifference(target: TargetAnswer | null, full: number): void {
    this.difference.set(target, full);
  }

  /** Shows only triangles of the first `steps` steps: for prints, which only grow. */
  limit(steps: number): void {
    if (steps === this.stepLimit) return;
    this.stepLimit = steps;
    for (const shown of this.shown.values()) this.limitOne(shown);
  }

  recolour(palette: Palette): void {
    this.palette = palette;
    const all = [...this.shown.values(), ...(this.exact ? [this.exact] : [])];
    for (const { tile, mesh } of all) setColours(mesh.geometry, palette.paint(tile));
  }

  /** The first visible surface along a ray. */
  hit(
    caster: THREE.Raycaster,
    isHidden: (p: THREE.Vector3) => boolean,
    onSection: (ray: THREE.Ray) => THREE.Vector3 | null,
  ): SurfaceHit | null {
    if (!this.group.visible) return null;
    const drawn = this.showsExact ? this.exact!.mesh : this.tiles;
    for (const found of caster.intersectObject(drawn, true)) {
      if (isHidden(found.point)) continue;
      const shown = this.showsExact ? this.exact : this.shown.get(found.object.userData.tile as number);
      if (!shown) continue;
      const facesAway = (found.face?.normal.dot(caster.ray.direction) ?? 0) > 0;
      const section = facesAway ? onSection(caster.ray) : null;
      if (section) return { point: section, distance: caster.ray.origin.distanceTo(section), step: NO_STEP };
      const step = shown.tile.step[found.faceIndex ?? 0] ?? NO_STEP;
      return { point: found.point, distance: found.distance, step };
    }
    return null;
  }

  private refresh(id: number): void {
    const tile = this.instant.get(id) ?? this.finished.get(id);
    const old = this.shown.get(id);
    if (old?.tile === tile) return;
    if (old) {
      this.tiles.remove(old.mesh);
      old.mesh.geometry.dispose();
      this.shown.delete(id);
    }
    if (!tile || tile.step.length === 0 || !this.palette) return;
    const mesh = new THREE.Mesh(geometryOf(tile), this.material);
    mesh.userData.tile = id;
    setColours(mesh.geometry, this.palette.paint(tile));
    const shown = { tile, mesh };
    this.shown.set(id, shown);
    this.limitOne(shown);
    this.tiles.add(mesh);
  }

  private limitOne({ tile, mesh }: Shown): void {
    if (this.stepLimit === FINAL) {
      mesh.geometry.setIndex(null);
      return;
    }
    const kept: number[] = [];
    for (let t = 0; t < tile.step.length; ++t) {
      if (tile.step[t]! < this.stepLimit) kept.push(3 * t, 3 * t + 1, 3 * t + 2);
    }
    mesh.geometry.setIndex(kept);
  }
}

/** Corners are not shared between triangles, so that each triangle has its own colour. */
function geometryOf(tile: Tile): THREE.BufferGeometry {
  const positions = new Float32Array(3 * tile.index.length);
  for (let i = 0; i < tile.index.length; ++i) {
    const v = 3 * tile.index[i]!;
    positions[3 * i] = tile.positions[v]!;
    positions[3 * i + 1] = tile.positions[v + 1]!;
    positions[3 * i + 2] = tile.positions[v + 2]!;
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  geometry.computeBoundingSphere();
  return geometry;
}

function setColours(geometry: THREE.BufferGeometry, colours: Uint8Array): void {
  geometry.setAttribute('color', new THREE.BufferAttribute(colours, 4, true));
}

/** The colours of all columns as a texture that is projected on the part from above. */
class DifferenceMap {
  /** columns: x and y of the lower left corner and the size, mm; size 0: not shown. */
  readonly uniforms = {
    differences: { value: new THREE.DataTexture(new Uint8Array(4), 1, 1) },
    columns: { value: new THREE.Vector4() },
  };
  private shown: TargetAnswer | null = null;

  set(target: TargetAnswer | null, full: number): void {
    if (target === this.shown) return;
    this.shown = target;
    this.uniforms.differences.value.dispose();
    if (!target || target.nx * target.ny === 0) {
      this.uniforms.columns.value.set(0, 0, 0, 0);
      return;
    }
    const { nx, ny, depth, x, y, pitch } = target;
    const colours = new Uint8Array(4 * nx * ny);
    for (let k = 0; k < nx * ny; ++k) {
      colours.set(differenceColour(depth[k]!, full), 4 * k);
      colours[4 * k + 3] = 255;
    }
    const texture = new THREE.DataTexture(colours, nx, ny);
    texture.needsUpdate = true;
    this.uniforms.differences.value = texture;
    this.uniforms.columns.value.set(x, y, nx * pitch, ny * pitch);
  }
}

/**
 * Faces seen from inside are those that the section plane has opened: one flat colour, which looks like a
 * cap.
 */
function partMaterial(difference: DifferenceMap): THREE.Material {
  const material = new THREE.MeshLambertMaterial({
    vertexColors: true,
    flatShading: true,
    side: THREE.DoubleSide,
    polygonOffset: true, // lines on the surface stay visible
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, difference.uniforms);
    // The position before rotation is that of the work coordinates: tiles are not moved.
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', '#include <common>\nvarying vec2 vPlan;')
      .replace('#include <project_vertex>', '#include <project_vertex>\nvPlan = position.xy;');
    shader.fragmentShader = shader.fragmentShader
      .replace(
        '#include <common>',
        '#include <common>\nvarying vec2 vPlan;\nuniform sampler2D differences;\nuniform vec4 columns;',
      )
      .replace(
        '#include <color_fragment>',
        `#include <color_fragment>
if (columns.z > 0.0) diffuseColor.rgb = texture2D(differences, (vPlan - columns.xy) / columns.zw).rgb;`,
      )
      .replace(
        '#include <opaque_fragment>',
        `#include <opaque_fragment>\n if (!gl_FrontFacing) gl_FragColor = vec4(${CUT_FACE}, 1.0);`,
      );
  };
  return material;
}
