// The canvas: renderer, camera, light, standard views and the section plane. Draws only when something
// changed.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { Vec3 } from '../protocol';
import type { SavedView } from '../settings';
import { type SlicedPicture, Slices } from './slices';

export const VIEWS = ['iso', 'top', 'front', 'right', 'back', 'left', 'bottom'] as const;
export type ViewName = (typeof VIEWS)[number];

// From the target to the camera. The small Y makes X point right where the camera is above or below.
const DIRECTIONS: Record<ViewName, Vec3> = {
  iso: [-0.369, -0.527, 0.766], // as the picture "iso" of `kerf simulate`
  top: [0, -1e-4, 1],
  front: [0, -1, 0],
  right: [1, 0, 0],
  back: [0, 1, 0],
  left: [-1, 0, 0],
  bottom: [0, -1e-4, -1],
};
const MARGIN = 1.12;
const FIELD = 30; // degrees, of the perspective view from bottom to top
const MIN_SECTION_SINE = 0.02; // of the angle between view and plane: about a degree

export interface Section {
  axis: 0 | 1 | 2;
  /** mm along the axis. */
  at: number;
  /** The side that is hidden: the viewer's, however the view is turned, or always the lower or upper one. */
  hides: 'near' | 'low' | 'high';
}

export class NoWebGl extends Error {}

export class Stage {
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1000, 1000);
  readonly renderer: THREE.WebGLRenderer;
  /** Number of frames drawn; the tests wait for it. */
  frames = 0;
  onViewChanged: () => void = () => {};
  /** Called before each frame: what is drawn can be fitted to the view. */
  beforeFrame: () => void = () => {};
  /** Draws what the frames leave out, once nothing changes; null: they leave out nothing. */
  slices: Slices | null = null;
  private readonly controls: OrbitControls;
  /** Follows the other camera, which keeps the view; null: the view is orthographic. */
  private eye: THREE.PerspectiveCamera | null = null;
  private bounds = new THREE.Box3(new THREE.Vector3(-50, -50, -10), new THREE.Vector3(50, 50, 10));
  private section: Section | null = null;
  private plane: THREE.Plane | null = null;
  private drawPending = false;

  constructor(readonly canvas: HTMLCanvasElement) {
    THREE.ColorManagement.enabled = false;
    try {
      this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    } catch (error) {
      throw new NoWebGl(String(error));
    }
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.camera.up.set(0, 0, 1);
    this.addLight();
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => {
      this.draw();
      this.onViewChanged();
    });
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement ?? canvas);
    canvas.addEventListener('webglcontextrestored', () => this.draw());
    this.resize();
    this.show('iso');
  }

  private addLight(): void {
    const sun = new THREE.DirectionalLight(0xffffff, 1.9);
    sun.position.set(-0.5, 0.9, 1.2);
    this.camera.add(sun);
    this.scene.add(this.camera, new THREE.HemisphereLight(0xffffff, 0x9aa0a8, 2.2));
  }

  /** Requests a frame; several requests before it give one. */
  draw(): void {
    if (this.drawPending) return;
    this.slices?.stop();
    this.drawPending = true;
    requestAnimationFrame(() => {
      this.drawPending = false;
      this.render();
      ++this.frames;
      this.slices?.start();
    });
  }

  setRestPicture(picture: SlicedPicture): Slices {
    this.slices = new Slices(picture);
    return this.slices;
  }

  private render(): void {
    this.turnSection();
    this.camera.updateMatrixWorld();
    this.moveEye();
    this.beforeFrame();
    this.renderer.render(this.scene, this.drawing);
  }

  get drawing(): THREE.Camera {
    return this.eye ?? this.camera;
  }

  setPerspective(isOn: boolean): void {
    if (isOn === (this.eye !== null)) return;
    this.eye = isOn ? new THREE.PerspectiveCamera(FIELD) : null;
    this.draw();
  }

  /** At the target both cameras have the same scale. */
  private moveEye(): void {
    if (!this.eye) return;
    const { camera, eye } = this;
    const height = (camera.top - camera.bottom) / camera.zoom;
    const away = height / 2 / Math.tan(((FIELD / 2) * Math.PI) / 180);
    const towards = camera.position.clone().sub(this.controls.target).normalize();
    eye.position.copy(this.controls.target).addScaledVector(towards, away);
    eye.quaternion.copy(camera.quaternion);
    eye.aspect = (camera.right - camera.left) / (camera.top - camera.bottom);
    eye.near = Math.max(away / 1000, away - 8 * this.radius());
    eye.far = away + 8 * this.radius();
    eye.updateProjectionMatrix();
    eye.updateMatrixWorld();
  }

  /** The space that is inside the picture. */
  visibleSpace(): THREE.Frustum {
    const { projectionMatrix, matrixWorldInverse } = this.drawing;
    return new THREE.Frustum().setFromProjectionMatrix(
      new THREE.Matrix4().multiplyMatrices(projectionMatrix, matrixWorldInverse),
    );
  }

  /** mm of a CSS pixel. */
  pixelSize(): number {
    const { top, bottom, zoom } = this.camera;
    return (top - bottom) / zoom / Math.max(this.canvas.clientHeight, 1);
  }

  /** The picture as it is now, in full detail, as a data address. */
  picture(): string {
    // Drawn here, because what is drawn is gone after the frame.
    this.render();
    this.slices?.drawAll();
    return this.canvas.toDataURL('image/png');
  }

  setBackground(css: string): void {
    this.scene.background = new THREE.Color(css);
    this.draw();
  }

  /** The box that the standard views show, mm. The view itself does not change. */
  setBounds(bounds: readonly [Vec3, Vec3]): void {
    this.bounds = new THREE.Box3(new THREE.Vector3(...bounds[0]), new THREE.Vector3(...bounds[1]));
    this.setDepthRange();
  }

  /** Turns to a standard view in which the whole part is visible. */
  show(view: ViewName): void {
    this.fit(new THREE.Vector3(...DIRECTIONS[view]));
  }

  /** Shows the whole part from the present direction. */
  fit(direction = this.camera.position.clone().sub(this.controls.target)): void {
    const target = this.bounds.getCenter(new THREE.Vector3());
    const radius = this.radius();
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(direction.normalize(), 2 * radius);
    this.camera.lookAt(target);
    this.camera.updateMatrixWorld();
    this.camera.zoom = this.zoomFor();
    this.setDepthRange();
    this.controls.update();
    this.draw();
    this.onViewChanged();
  }

  /** The zoom at which all corners of the bounds are inside the picture. */
  private zoomFor(): number {
    const inverse = this.camera.matrixWorldInverse.copy(this.camera.matrixWorld).invert();
    let x = 1e-3;
    let y = 1e-3;
    for (let i = 0; i < 8; ++i) {
      const corner = this.corner(i).applyMatrix4(inverse);
      x = Math.max(x, Math.abs(corner.x));
      y = Math.max(y, Math.abs(corner.y));
    }
    return Math.min(this.camera.right / x, this.camera.top / y) / MARGIN;
  }

  private corner(i: number): THREE.Vector3 {
    const { min, max } = this.bounds;
    return new THREE.Vector3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z);
  }

  private radius(): number {
    return Math.max(this.bounds.getSize(new THREE.Vector3()).length() / 2, 1);
  }

  private setDepthRange(): void {
    // The camera is orthographic, so a wide range costs only depth resolution; tools and rapids are above
    // the part.
    const range = 8 * this.radius() + this.camera.position.distanceTo(this.controls.target);
    this.camera.near = -range;
    this.camera.far = range;
    this.camera.updateProjectionMatrix();
  }

  view(): SavedView {
    return {
      position: this.camera.position.toArray() as Vec3,
      target: this.controls.target.toArray() as Vec3,
      zoom: this.camera.zoom,
    };
  }

  setView(view: SavedView): void {
    this.camera.position.set(...view.position);
    this.controls.target.set(...view.target);
    this.camera.zoom = view.zoom;
    this.camera.lookAt(this.controls.target);
    this.setDepthRange();
    this.controls.update();
    this.draw();
  }

  /** Turns by angles in radians around the vertical and the horizontal axis of the picture. */
  orbit(horizontal: number, vertical: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const spherical = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y));
    spherical.theta += horizontal;
    spherical.phi = Math.min(Math.max(spherical.phi + vertical, 1e-4), Math.PI - 1e-4);
    const turned = new THREE.Vector3().setFromSpherical(spherical);
    this.camera.position.copy(this.controls.target).add(new THREE.Vector3(turned.x, -turned.z, turned.y));
    this.controls.update();
    this.draw();
  }

  /** Moves the picture by fractions of its size. */
  pan(x: number, y: number): void {
    const step = new THREE.Vector3(
      (x * (this.camera.right - this.camera.left)) / this.camera.zoom,
      (y * (this.camera.top - this.camera.bottom)) / this.camera.zoom,
      0,
    ).applyQuaternion(this.camera.quaternion);
    this.camera.position.add(step);
    this.controls.target.add(step);
    this.controls.update();
    this.draw();
  }

  zoom(factor: number): void {
    this.camera.zoom *= factor;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
    this.onViewChanged();
  }

  setSection(section: Section | null): void {
    this.section = section;
    this.plane = section
      ? new THREE.Plane(new THREE.Vector3().setComponent(section.axis, -1), section.at)
      : null;
    this.renderer.clippingPlanes = this.plane ? [this.plane] : [];
    this.draw();
  }

  /** Hides a side of the section. In a view along the plane the viewer's side stays as it was. */
  private turnSection(): void {
    if (!this.section || !this.plane) return;
    const { axis, at, hides } = this.section;
    if (hides !== 'near') return this.hideSide(axis, at, hides === 'low' ? -1 : 1);
    const towards = this.camera.position.clone().sub(this.controls.target).normalize().getComponent(axis);
    if (Math.abs(towards) < MIN_SECTION_SINE) return;
    this.hideSide(axis, at, Math.sign(towards));
  }

  private hideSide(axis: number, at: number, side: number): void {
    this.plane?.normal.set(0, 0, 0).setComponent(axis, -side);
    if (this.plane) this.plane.constant = side * at;
  }

  /** The side of the section that is hidden now; null without a section. */
  get hiddenSide(): 'low' | 'high' | null {
    if (!this.plane || !this.section) return null;
    this.turnSection();
    return this.plane.normal.getComponent(this.section.axis) < 0 ? 'high' : 'low';
  }

  /** Whether the section plane hides a point. */
  isHidden(point: THREE.Vector3): boolean {
    return this.plane !== null && this.plane.distanceToPoint(point) < 0;
  }

  /** Where a ray crosses the section plane, or null. */
  onSection(ray: THREE.Ray): THREE.Vector3 | null {
    return this.plane ? ray.intersectPlane(this.plane, new THREE.Vector3()) : null;
  }

  /** The ray below a point of the canvas, in CSS pixels from its upper left corner. */
  rayAt(x: number, y: number): THREE.Raycaster {
    const { clientWidth, clientHeight } = this.canvas;
    const ndc = new THREE.Vector2((2 * x) / clientWidth - 1, 1 - (2 * y) / clientHeight);
    const caster = new THREE.Raycaster();
    this.moveEye();
    caster.setFromCamera(ndc, this.drawing);
    if (this.eye) return caster;
    // What is behind an orthographic camera is drawn as well, so the ray starts at the near plane.
    caster.ray.origin.addScaledVector(caster.ray.direction, this.camera.near);
    return caster;
  }

  /** The point of the canvas, in CSS pixels, at which a position is drawn. */
  project(point: Vec3): [number, number] {
    const ndc = new THREE.Vector3(...point).project(this.drawing);
    return [((ndc.x + 1) / 2) * this.canvas.clientWidth, ((1 - ndc.y) / 2) * this.canvas.clientHeight];
  }

  /**
   * From positions to pixels of the canvas: the rows of a matrix, four numbers each. X and Y are those of the
   * first two rows divided by that of the last one, which is not above 0 behind the eye.
   */
  toPixels(): number[] {
    const { clientWidth: w, clientHeight: h } = this.canvas;
    const m = new THREE.Matrix4().multiplyMatrices(
      this.drawing.projectionMatrix,
      this.drawing.matrixWorldInverse,
    );
    const screen = new THREE.Matrix4().set(w / 2, 0, 0, w / 2, 0, -h / 2, 0, h / 2, 0, 0, 1, 0, 0, 0, 0, 1);
    const e = screen.multiply(m).transpose().elements;
    return Array.from(e);
  }

  private resize(): void {
    const holder = this.canvas.parentElement ?? this.canvas;
    const width = Math.max(holder.clientWidth, 1);
    const height = Math.max(holder.clientHeight, 1);
    this.renderer.setSize(width, height, true);
    // The unit square is as large as the smaller side, so that the zoom keeps its meaning.
    const aspect = width / height;
    this.camera.left = -Math.max(aspect, 1);
    this.camera.right = Math.max(aspect, 1);
    this.camera.top = Math.max(1 / aspect, 1);
    this.camera.bottom = -this.camera.top;
    this.camera.updateProjectionMatrix();
    this.draw();
  }
}
