// How much is drawn in one frame.
import type * as THREE from 'three';

/** Triangles, or segments of lines, that are drawn at most; more are replaced by coarser ones. */
export interface Detail {
  triangles: number;
  segments: number;
}

const BY_HARDWARE: Detail = { triangles: 8_000_000, segments: 8_000_000 };
const BY_SOFTWARE: Detail = { triangles: 60_000, segments: 60_000 }; // in about 50 ms
const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;

export function detailOf(renderer: THREE.WebGLRenderer): Detail {
  const gl = renderer.getContext();
  const names = gl.getExtension('WEBGL_debug_renderer_info');
  const name = String(gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  return SOFTWARE.test(name) ? BY_SOFTWARE : BY_HARDWARE;
}
