// The colours of what the last save has changed, on the surface of the part: a texture of the changed spans
// of all columns, and the part of the shader that looks them up. It does what `changeAt` does.
import * as THREE from 'three';
import { AT_WALLS, BESIDE, type Change, SMALLEST, STEEP } from '../change';
import { differenceColour } from '../colours';

const SHADES = 256;

export class ChangeMap {
  /** corner: x and y of the lower left corner, mm, and the distance of columns; spanCount 0: not shown. */
  readonly uniforms = {
    spans: { value: emptySpans() },
    spanCount: { value: 0 },
    corner: { value: new THREE.Vector3(0, 0, 1) },
    shades: { value: new THREE.DataTexture(new Uint8Array(4), 1, 1) },
    changeFull: { value: 1 },
    isCompared: { value: false },
  };
  private shown: Change | null = null;

  set(change: Change | null): void {
    if (change === this.shown) return;
    this.shown = change;
    const { uniforms } = this;
    uniforms.spans.value.dispose();
    uniforms.shades.value.dispose();
    uniforms.isCompared.value = change !== null;
    uniforms.spanCount.value = change?.spans ?? 0;
    if (!change) return;
    const { map, heights, spans, highest } = change;
    if (spans > 0) {
      const texture = new THREE.DataArrayTexture(heights, map.nx, map.ny, spans);
      texture.format = THREE.RGFormat;
      texture.type = THREE.FloatType;
      texture.needsUpdate = true;
      uniforms.spans.value = texture;
    }
    uniforms.corner.value.set(map.x, map.y, map.pitch);
    uniforms.changeFull.value = Math.max(highest, 1e-9);
    uniforms.shades.value = shades();
  }
}

function emptySpans(): THREE.DataArrayTexture {
  const texture = new THREE.DataArrayTexture(new Float32Array(2), 1, 1, 1);
  texture.format = THREE.RGFormat;
  texture.type = THREE.FloatType;
  texture.needsUpdate = true;
  return texture;
}

/** The colours of changes from the largest that is removed more to the largest that is removed less. */
function shades(): THREE.DataTexture {
  const colours = new Uint8Array(4 * SHADES);
  const centre = (SHADES - 1) / 2;
  for (let k = 0; k < SHADES; ++k) {
    colours.set(differenceColour((k - centre) / centre, 1), 4 * k);
    colours[4 * k + 3] = 255;
  }
  const texture = new THREE.DataTexture(colours, SHADES, 1);
  texture.needsUpdate = true;
  return texture;
}

const number = (value: number) => value.toFixed(6);
const UNCHANGED = differenceColour(0, 1).map((c) => number(c / 255));

export const CHANGE_UNIFORMS = `
uniform highp sampler2DArray spans;
uniform int spanCount;
uniform vec3 corner;
uniform sampler2D shades;
uniform float changeFull;
uniform bool isCompared;
float changeAt(vec3 at, vec3 outward) {
  float pitch = corner.z;
  float slope = length(outward.xy) / max(abs(outward.z), 1e-6);
  float near = ${number(SMALLEST)} + pitch * (slope < ${number(STEEP)} ? 1.5 * slope : ${number(AT_WALLS)});
  ivec2 size = textureSize(spans, 0).xy;
  float found = 0.0;
  for (int turn = 0; turn < 2; ++turn) {
    float side = turn == 0 ? 1.0 : -1.0;
    ivec2 column = ivec2(floor((at.xy + side * ${number(BESIDE)} * pitch * outward.xy - corner.xy) / pitch));
    if (any(lessThan(column, ivec2(0))) || any(greaterThanEqual(column, size))) continue;
    float z = at.z + side * outward.z * near;
    for (int k = 0; k < spanCount; ++k) {
      vec2 span = texelFetch(spans, ivec3(column, k), 0).rg;
      float d = span.x - span.y;
      if (d * side >= 0.0 || abs(d) <= abs(found)) continue;
      if (z >= min(span.x, span.y) - near && z <= max(span.x, span.y) + near) found = d;
    }
  }
  return found;
}
`;

/** After the colour of the fragment is known; `outward` is the normal there. */
export const CHANGE_COLOUR = `
if (isCompared) {
  float d = changeAt(vPosition, outward);
  diffuseColor.rgb = d == 0.0 ? vec3(${UNCHANGED.join(', ')})
                              : texture2D(shades, vec2(0.5 + 0.5 * d / changeFull, 0.5)).rgb;
}
`;
