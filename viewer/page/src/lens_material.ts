// SPDX-License-Identifier: GPL-3.0-or-later
// What the microscope's optics add to the rendered picture: shallow depth of field, a little veiling glare, darkness
// in narrow gaps (screen-space occlusion), the round field of view, tone mapping, and the colours of an anaglyph's
// eye.
import * as THREE from 'three';

export interface LensSettings {
  occlusion: boolean;
  depthOfField: boolean;
  samples: number;
}

const fragment = /* glsl */ `
#include <common>
uniform sampler2D picture;
uniform highp sampler2D depth_map;
uniform vec2 size;
uniform vec2 near_far;
uniform float focus, tan_half, round_field, grey_share;
uniform mat3 eye_colours;
varying vec2 v_uv;

float distance_at(vec2 uv) {
  float d = texture2D(depth_map, uv).x;
  return near_far.x * near_far.y / (near_far.y - d * (near_far.y - near_far.x));
}
float hash(vec2 p) { return fract(52.9829189 * fract(dot(p, vec2(0.06711056, 0.00583715)))); }

#ifdef OCCLUSION
float gap_shade(vec2 uv, float z) {
  uv = (floor(uv * size) + 0.5) / size;
  float aspect = size.x / size.y;
  float shut = 0.0;
  for (int ring = 0; ring < 2; ring++) {
    float radius = ring == 0 ? 0.0011 : 0.0034;
    vec2 r = radius / (2.0 * z * tan_half) * vec2(1.0 / aspect, 1.0);
    for (int i = 0; i < 5; i++) {
      float a = (float(i) + 0.5 * float(ring)) * 0.62832;
      // Whole pixels: both samples then lie equally far from the middle, and a plane stays a plane.
      vec2 o = round(vec2(cos(a), sin(a)) * r * size) / size;
      float za = distance_at(uv + o), zb = distance_at(uv - o);
      // Opposite neighbours both nearer: a groove. Slopes and single edges cancel or are cut off.
      float da = clamp((z - za) / radius, -1.0, 1.4), db = clamp((z - zb) / radius, -1.0, 1.4);
      // Gentle curvature is no gap.
      shut += clamp(da + db - 0.3, 0.0, 1.2);
    }
  }
  return 1.0 / (1.0 + 0.13 * shut);
}
#endif

void main() {
  vec2 pixel = 1.0 / size;
  float z = distance_at(v_uv);
  vec3 c = texture2D(picture, v_uv).rgb;
#ifdef DEPTH_OF_FIELD
  float blur = clamp(abs(z - focus) / focus * 46.0 - 1.2, 0.0, 7.0) * size.y / 1080.0;
  if (blur > 0.35) {
    vec3 sum = c; float n = 1.0;
    float spin = hash(gl_FragCoord.xy) * 6.2832;
    for (int i = 0; i < 12; i++) {
      float a = spin + float(i) * 2.39996;
      float r = sqrt((float(i) + 0.5) / 12.0) * blur;
      vec2 uv = v_uv + vec2(cos(a), sin(a)) * r * pixel;
      float zi = distance_at(uv);
      // A sharp nearer thing must not bleed into what lies behind it.
      float w = zi < z - 0.002 ? clamp(abs(zi - focus) / focus * 46.0 - 1.2, 0.0, 7.0) / 7.0 : 1.0;
      sum += w * min(textureLod(picture, uv, max(0.0, log2(blur * 0.45))).rgb, vec3(6.0)); n += w;
    }
    c = sum / n;
  }
#endif
#ifdef OCCLUSION
  float shade = gap_shade(v_uv, z);
  c *= mix(vec3(0.35, 0.10, 0.08), vec3(1.0), smoothstep(0.0, 1.0, shade)) * mix(0.75, 1.0, shade);
#endif
  vec3 glare = textureLod(picture, v_uv, 4.0).rgb;
  glare += textureLod(picture, v_uv, 5.0).rgb + textureLod(picture, v_uv, 6.0).rgb;
  c += min(glare, vec3(9.0)) * 0.016;
  vec2 from_middle = (v_uv - 0.5) * vec2(size.x / size.y, 1.0);
  float r = length(from_middle) * max(1.0, 1.15 * size.y / size.x);
  c *= 1.0 - 0.45 * smoothstep(0.18, 0.62, r);
  c *= mix(1.0, 1.0 - smoothstep(0.560, 0.600, r), round_field);
  gl_FragColor = vec4(c, 1.0);
  #include <tonemapping_fragment>
  #include <colorspace_fragment>
  vec3 grey = vec3(dot(gl_FragColor.rgb, vec3(0.35, 0.5, 0.15)));
  gl_FragColor.rgb = clamp(eye_colours * mix(gl_FragColor.rgb, grey, grey_share), 0.0, 1.0);
  gl_FragColor.rgb += (hash(gl_FragCoord.xy + 17.0) - 0.5) / 255.0;
}
`;

const inSpacePosition = 'projectionMatrix * modelViewMatrix * vec4(position, 1.0)';
const flatPosition = 'vec4(position.xy, 0.0, 1.0)';

/** `in_space`: for a screen that hangs in a headset's room; else it fills the viewport. */
export function makeLensMaterial(inSpace = false): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    uniforms: {
      picture: { value: null },
      depth_map: { value: null },
      size: { value: new THREE.Vector2(1, 1) },
      near_far: { value: new THREE.Vector2(0.01, 1) },
      focus: { value: 0.25 },
      tan_half: { value: 0.26 },
      round_field: { value: 1 },
      grey_share: { value: 0 },
      eye_colours: { value: new THREE.Matrix3() },
    },
    vertexShader: `varying vec2 v_uv;
      void main() { v_uv = uv; gl_Position = ${inSpace ? inSpacePosition : flatPosition}; }`,
    fragmentShader: fragment,
    depthTest: inSpace,
    depthWrite: inSpace,
  });
}
