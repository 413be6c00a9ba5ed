// The picture at rest: drawn beside the canvas, which shows the one before until this is complete.
import * as THREE from 'three';
import { type FullLines, type FullSurface, LineSlices, SurfaceSlices } from './full_detail';
import type { SlicedPicture } from './slices';

const VERTEX = 'varying vec2 at;\nvoid main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }';
const FRAGMENT =
  'uniform sampler2D picture;\nvarying vec2 at;\n' +
  'void main() { gl_FragColor = vec4(texture2D(picture, at).rgb, 1.0); }';

/** What there is to be drawn. */
export interface FullDetail {
  /** The surface, and what shows fewer triangles of it. */
  surface: FullSurface | null;
  surfaceObject: THREE.Object3D;
  lines: readonly FullLines[];
  /** Whether what is behind the surface is seen through it. */
  isClear: boolean;
}

type Phase = 'surface' | 'lines' | 'others';

export class RestPicture implements SlicedPicture {
  /** Triangles of the surface that the picture has so far. */
  triangles = 0;
  private readonly surface: SurfaceSlices;
  private readonly lines = new LineSlices();
  private readonly target = new THREE.WebGLRenderTarget(1, 1, {
    minFilter: THREE.NearestFilter,
    magFilter: THREE.NearestFilter,
  });
  private readonly size = new THREE.Vector2();
  private readonly sheet = new THREE.Mesh(
    new THREE.PlaneGeometry(2, 2),
    new THREE.ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: { picture: { value: this.target.texture } },
      depthTest: false,
      depthWrite: false,
    }),
  );
  private readonly sheetScene = new THREE.Scene();
  private phases: Phase[] = [];
  private detail: FullDetail | null = null;
  private sync: WebGLSync | null = null;

  constructor(
    private readonly renderer: THREE.WebGLRenderer,
    private readonly scene: THREE.Scene,
    private readonly camera: () => THREE.Camera,
    private readonly fullDetail: () => FullDetail | null,
    material: THREE.Material,
  ) {
    this.surface = new SurfaceSlices(material);
    // Asked once: the answer waits for all that is being drawn.
    this.target.samples = Number(this.gl.getParameter(this.gl.SAMPLES)); // of the canvas
    this.sheet.frustumCulled = false;
    this.sheetScene.add(this.sheet);
    scene.add(this.surface.mesh, this.lines.object);
  }

  begin(): boolean {
    this.detail = this.fullDetail();
    if (!this.detail) return false;
    this.triangles = 0;
    this.surface.begin(this.detail.surface);
    this.lines.begin(this.detail.lines);
    this.phases = this.detail.isClear ? ['lines', 'others', 'surface'] : ['surface', 'lines', 'others'];
    this.dropSync();
    this.clear();
    return true;
  }

  draw(count: number): number {
    for (; this.phases.length > 0; this.phases.shift()) {
      const drawn = this.drawOf(this.phases[0]!, count);
      if (drawn > 0) {
        this.setSync();
        return drawn;
      }
    }
    return 0;
  }

  private drawOf(phase: Phase, count: number): number {
    if (phase === 'surface') {
      const filled = this.surface.fill(count);
      if (filled > 0) this.render((object) => object === this.surface.mesh);
      this.triangles += filled;
      return filled;
    }
    if (phase === 'lines') {
      const filled = this.lines.fill(count);
      if (filled > 0) this.render((object) => object === this.lines.object);
      return filled;
    }
    this.phases.shift();
    this.renderOthers();
    return 1;
  }

  isDrawn(): boolean {
    const gl = this.gl;
    if (!this.sync || gl.isContextLost()) return true;
    if (gl.getSyncParameter(this.sync, gl.SYNC_STATUS) !== gl.SIGNALED) return false;
    this.dropSync();
    return true;
  }

  finish(): void {
    this.renderer.render(this.sheetScene, this.camera());
  }

  private get gl(): WebGL2RenderingContext {
    return this.renderer.getContext() as WebGL2RenderingContext;
  }

  private setSync(): void {
    this.dropSync();
    this.sync = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    this.gl.flush();
  }

  private dropSync(): void {
    if (this.sync) this.gl.deleteSync(this.sync);
    this.sync = null;
  }

  private clear(): void {
    const { renderer, target } = this;
    renderer.getDrawingBufferSize(this.size);
    target.setSize(this.size.x, this.size.y);
    const { background } = this.scene;
    renderer.setRenderTarget(target);
    renderer.setClearColor(background instanceof THREE.Color ? background : 0xffffff, 1);
    renderer.clear();
    renderer.setRenderTarget(null);
  }

  /** Adds the objects of the scene that are wanted; lights are always there. */
  private render(isWanted: (object: THREE.Object3D) => boolean): void {
    const { renderer, scene, surface, lines } = this;
    const hidden = scene.children.filter((object) => object.visible && !isLight(object) && !isWanted(object));
    const { background } = scene;
    for (const object of hidden) object.visible = false;
    surface.mesh.visible = isWanted(surface.mesh);
    lines.object.visible = isWanted(lines.object);
    scene.background = null;
    renderer.autoClear = false;
    renderer.setRenderTarget(this.target);
    try {
      renderer.render(scene, this.camera());
    } finally {
      renderer.setRenderTarget(null);
      renderer.autoClear = true;
      scene.background = background;
      surface.mesh.visible = false;
      lines.object.visible = false;
      for (const object of hidden) object.visible = true;
    }
  }

  /** All that is not drawn in slices. */
  private renderOthers(): void {
    const { surfaceObject, lines } = this.detail!;
    const sliced = lines.map((from) => from.lines).filter((object) => object.visible);
    for (const object of sliced) object.visible = false;
    this.render(
      (object) => object !== surfaceObject && object !== this.surface.mesh && object !== this.lines.object,
    );
    for (const object of sliced) object.visible = true;
  }
}

/** The camera carries a light. */
function isLight(object: THREE.Object3D): boolean {
  return object instanceof THREE.Light || object instanceof THREE.Camera;
}
