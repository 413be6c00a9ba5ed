// The surface of the part: one mesh per tile, coloured per triangle. While another instant than the end of
// the job is shown, tiles of that instant replace those of the finished part.
import * as THREE from 'three';
import { differenceColour, type Palette } from '../colours';
import type { MeshAnswer, Renumbering, Surface, TargetAnswer, Tile } from '../decode';
import { FINAL, NO_STEP, renumber } from '../decode';
import type { Vec3 } from '../protocol';
import { type Change, changeBetween } from '../change';
import { CHANGE_COLOUR, CHANGE_UNIFORMS, ChangeMap } from './change_map';
import { coarser } from './coarse';
import type { FullSurface } from './full_detail';
import { type RayHit, rayHits } from './ray_hits';

const COARSEST = 6; // levels; 4096 triangles become about one
const CUT_FACE = '0.969, 0.886, 0.361'; // as in the pictures of `kerf simulate`

export interface SurfaceHit {
  point: THREE.Vector3;
  distance: number;
  /** The step that made the surface; NO_STEP on faces of the stock and on the section. */
  step: number;
}

export class PartView {
  readonly group = new THREE.Group();
  /** The instant that is shown: FINAL, or a number of steps. */
  shownStep = FINAL;
  private readonly finished = new Map<number, Tile>();
  private readonly instant = new Map<number, Tile>();
  private readonly shown = new Map<number, ShownTile>();
  /** The finished part with exact edges; shown instead of its tiles. */
  private exact: ShownTile | null = null;
  private readonly tiles = new THREE.Group();
  private readonly difference = new DifferenceMap();
  private readonly changes = new ChangeMap();
  readonly material = partMaterial(this.difference, this.changes);
  private palette: Palette | null = null;
  private level = 0; // of what is drawn now
  private filter: StepFilter = { limit: FINAL, hidden: null };
  /** The finished part before the last update; null: there was none. */
  private earlier: Map<number, Tile> | null = null;

  constructor() {
    this.group.add(this.tiles);
  }

  private get showsExact(): boolean {
    return this.exact !== null && this.shownStep === FINAL;
  }

  private get drawn(): ShownTile[] {
    return this.showsExact ? [this.exact!] : [...this.shown.values()];
  }

  /**
   * Makes the tiles inside the picture so coarse that at most about `limit` triangles are drawn; 0 is their
   * own detail, each further level doubles the size of cells. `cell`: mm, of the columns.
   */
  chooseDetail(view: THREE.Frustum, limit: number, cell: number): void {
    this.level = 0;
    if (!this.palette || !this.group.visible) return;
    const visible = this.visibleIn(view);
    let count = visible.reduce((sum, shown) => sum + shown.tile.step.length, 0);
    let level = 0;
    for (; count > limit && level < COARSEST; ++level) count /= 4;
    for (const shown of visible) shown.setLevel(level, cell, this.palette, this.filter);
    this.level = level;
  }

  private visibleIn(view: THREE.Frustum): ShownTile[] {
    return this.drawn.filter((shown) => view.intersectsSphere(shown.sphere));
  }

  /** Whether fewer triangles are drawn than the part has. */
  get isCoarse(): boolean {
    return this.level > 0;
  }

  /** What is inside the picture in its own detail; null: nothing. */
  full(view: THREE.Frustum): FullSurface | null {
    if (!this.palette || !this.group.visible) return null;
    const { limit, hidden } = this.filter;
    const surfaces = this.visibleIn(view).map(({ tile }) => tile);
    const shows = (step: number) => (step < limit || limit === FINAL) && hidden?.[step] !== 1;
    return { surfaces, palette: this.palette, shows: limit === FINAL && !hidden ? null : shows };
  }

  /** Triangles that are drawn of what is inside the picture. */
  triangles(view: THREE.Frustum): number {
    if (!this.group.visible) return 0;
    return this.visibleIn(view).reduce((sum, shown) => sum + shown.triangles, 0);
  }

  /** The box of the finished part; null: there is none. */
  bounds(): [Vec3, Vec3] | null {
    const box = new THREE.Box3();
    const one = new THREE.Box3();
    const tiles = this.exact ? [this.exact.tile] : this.finished.values();
    for (const tile of tiles)
      if (tile.step.length > 0) box.union(one.setFromArray(tile.positions));
    return box.isEmpty() ? null : [box.min.toArray() as Vec3, box.max.toArray() as Vec3];
  }

  /** The finished part with exact edges, until the next update. */
  setExact(answer: MeshAnswer): void {
    this.dropExact();
    const tile = answer.tiles[0];
    if (!tile) return;
    this.exact = new ShownTile(tile, this.material);
    this.group.add(this.exact.mesh);
    this.chooseSurface();
  }

  private dropExact(): void {
    if (!this.exact) return;
    this.group.remove(this.exact.mesh);
    this.exact.dispose();
    this.exact = null;
    this.chooseSurface();
  }

  private chooseSurface(): void {
    this.tiles.visible = !this.showsExact;
    if (this.exact) this.exact.mesh.visible = this.showsExact;
  }

  get hasEarlier(): boolean {
    return this.earlier !== null;
  }

  /** What the last save has changed; `cell`: mm between columns. */
  change(bounds: readonly [Vec3, Vec3], cell: number): Change | null {
    return this.earlier ? changeBetween(this.earlier, this.finished, bounds, cell) : null;
  }

  /**
   * Tiles of the finished part; the finished part is shown afterwards. `origin`: whether a save has changed
   * the program, or another program is shown.
   */
  update(answer: MeshAnswer, palette: Palette, origin: 'save' | 'same' | 'other'): void {
    this.palette = palette;
    if (origin === 'save') this.earlier = new Map(this.finished);
    if (origin === 'other') this.earlier = null;
    this.dropExact();
    if (answer.reset) this.finished.clear();
    for (const table of answer.renumberings) {
      for (const tile of this.finished.values()) renumber(tile.step, table);
      for (const shown of this.shown.values()) shown.renumberCoarse(table);
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

  /** Colours the surface by what has changed on it; null: not. */
  showChange(change: Change | null): void {
    this.changes.set(change);
  }

  /** Shows only triangles of the first `steps` steps: for prints, which only grow. */
  limit(steps: number): void {
    if (steps === this.filter.limit) return;
    this.filter = { ...this.filter, limit: steps };
    for (const shown of this.shown.values()) shown.show(this.filter);
  }

  /** 1 for each step whose triangles are not shown; null: all are. */
  hide(hidden: Uint8Array | null): void {
    if (hidden === this.filter.hidden) return;
    this.filter = { ...this.filter, hidden };
    for (const shown of this.shown.values()) shown.show(this.filter);
  }

  get isClear(): boolean {
    return this.material.transparent;
  }

  /** Lets lines and walls be seen through the surface. */
  setClear(isClear: boolean): void {
    if (this.material.transparent === isClear) return;
    this.material.transparent = isClear;
    this.material.opacity = isClear ? 0.35 : 1;
    this.material.depthWrite = !isClear;
    this.material.needsUpdate = true;
  }

  recolour(palette: Palette): void {
    this.palette = palette;
    for (const shown of this.shown.values()) shown.recolour(palette);
    this.exact?.recolour(palette);
  }

  /** What is drawn, in its own detail, near a point. */
  surfacesNear(point: THREE.Vector3, reach: number): Surface[] {
    const near = this.drawn.filter(({ sphere }) => sphere.distanceToPoint(point) <= reach);
    return near.map(({ tile }) => tile);
  }

  /** The first visible surface along a ray, of the part in its own detail. */
  hit(
    caster: THREE.Raycaster,
    isHidden: (p: THREE.Vector3) => boolean,
    onSection: (ray: THREE.Ray) => THREE.Vector3 | null,
  ): SurfaceHit | null {
    if (!this.group.visible) return null;
    const { ray } = caster;
    let nearest: (RayHit & { step: number }) | null = null;
    for (const { tile, sphere } of this.drawn) {
      if (!ray.intersectsSphere(sphere)) continue;
      const found = rayHits(tile, ray).find(({ point }) => !isHidden(point));
      if (found && !(nearest && nearest.distance <= found.distance))
        nearest = { ...found, step: tile.step[found.triangle]! };
    }
    const section = nearest?.facesAway ? onSection(ray) : null;
    if (section) return { point: section, distance: ray.origin.distanceTo(section), step: NO_STEP };
    return nearest;
  }

  private refresh(id: number): void {
    const tile = this.instant.get(id) ?? this.finished.get(id);
    const old = this.shown.get(id);
    if (old?.tile === tile) return;
    if (old) {
      this.tiles.remove(old.mesh);
      old.dispose();
      this.shown.delete(id);
    }
    if (!tile || tile.step.length === 0) return;
    const shown = new ShownTile(tile, this.material);
    this.shown.set(id, shown);
    this.tiles.add(shown.mesh);
  }
}

/** Which triangles are shown: those of the first `limit` steps that are not hidden. */
interface StepFilter {
  limit: number;
  hidden: Uint8Array | null;
}

/** A tile as it is drawn: with its own triangles, or with fewer. */
class ShownTile {
  readonly mesh: THREE.Mesh;
  readonly sphere: THREE.Sphere;
  private surface: Surface | null = null;
  private level = -1;

  constructor(
    readonly tile: Tile,
    material: THREE.Material,
  ) {
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.sphere = sphereAround(tile.positions);
    this.mesh.geometry.boundingSphere = this.sphere;
  }

  get triangles(): number {
    return this.surface?.step.length ?? 0;
  }

  setLevel(level: number, cell: number, palette: Palette, filter: StepFilter): void {
    if (level === this.level) return;
    this.level = level;
    this.surface = level === 0 ? this.tile : coarser(this.tile, cell * 2 ** level);
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometryOf(this.surface);
    this.mesh.geometry.boundingSphere = this.sphere;
    this.recolour(palette);
    this.show(filter);
  }

  recolour(palette: Palette): void {
    if (this.surface) setColours(this.mesh.geometry, palette.paint(this.surface));
  }

  /** The tile's own steps are renumbered with all tiles. */
  renumberCoarse(table: Renumbering): void {
    if (this.surface && this.surface !== this.tile) renumber(this.surface.step, table);
  }

  show({ limit, hidden }: StepFilter): void {
    if (!this.surface) return;
    const { geometry } = this.mesh;
    if (limit === FINAL && !hidden) {
      geometry.setIndex(null);
      return;
    }
    const kept: number[] = [];
    this.surface.step.forEach((step, t) => {
      if ((step < limit || limit === FINAL) && hidden?.[step] !== 1) kept.push(3 * t, 3 * t + 1, 3 * t + 2);
    });
    geometry.setIndex(kept);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
  }
}

/** Around the box of the positions. */
function sphereAround(positions: Float32Array): THREE.Sphere {
  return new THREE.Box3().setFromArray(positions).getBoundingSphere(new THREE.Sphere());
}

/** Corners are not shared between triangles, so that each triangle has its own colour. */
function geometryOf({ positions, index }: Surface): THREE.BufferGeometry {
  const corners = new Float32Array(3 * index.length);
  for (let i = 0; i < index.length; ++i) {
    const v = 3 * index[i]!;
    corners[3 * i] = positions[v]!;
    corners[3 * i + 1] = positions[v + 1]!;
    corners[3 * i + 2] = positions[v + 2]!;
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(corners, 3));
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
    pitch: { value: 1 },
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
    this.uniforms.pitch.value = pitch;
  }
}

/**
 * Faces seen from inside are those that the section plane has opened: one flat colour, which looks like a
 * cap.
 */
function partMaterial(difference: DifferenceMap, changes: ChangeMap): THREE.Material {
  const material = new THREE.MeshLambertMaterial({
    vertexColors: true,
    flatShading: true,
    side: THREE.DoubleSide,
    polygonOffset: true, // lines on the surface stay visible
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, difference.uniforms, changes.uniforms);
    // The position before rotation is that of the work coordinates: tiles are not moved.
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', '#include <common>\nvarying vec3 vPosition;')
      .replace('#include <project_vertex>', '#include <project_vertex>\nvPosition = position;');
    shader.fragmentShader = shader.fragmentShader
      .replace(
        '#include <common>',
        '#include <common>\nvarying vec3 vPosition;\nuniform sampler2D differences;\n' +
          `uniform vec4 columns;\nuniform float pitch;\n${CHANGE_UNIFORMS}`,
      )
      .replace(
        '#include <color_fragment>',
        `#include <color_fragment>
vec3 outward = normalize(cross(dFdx(vPosition), dFdy(vPosition)));
if (columns.z > 0.0) {
  // A wall has the colour of the column in front of it, which made the wall.
  vec2 plan = vPosition.xy + 0.75 * pitch * outward.xy;
  diffuseColor.rgb = texture2D(differences, (plan - columns.xy) / columns.zw).rgb;
}
${CHANGE_COLOUR}`,
      )
      .replace(
        '#include <opaque_fragment>',
        `#include <opaque_fragment>\n if (!gl_FrontFacing) gl_FragColor = vec4(${CUT_FACE}, 1.0);`,
      );
  };
  return material;
}
