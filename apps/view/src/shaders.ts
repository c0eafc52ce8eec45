/// The programs that put the picture on the screen. They work in linear sRGB.

export const vertexShader = `#version 300 es
uniform vec4 rectangle; // of the picture, in clip coordinates: left, top, right, bottom
out vec2 place;
void main() {
  place = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(mix(rectangle.xy, rectangle.zw, place), 0.0, 1.0);
}`;

export const fragmentShader = `#version 300 es
precision highp float;
precision highp sampler2D;
uniform sampler2D picture;
uniform sampler2D palette;
uniform float scale;      // values are texels times this
uniform float exposure;   // a factor
uniform int operator;     // 0 linear, 1 filmic, 2 Reinhard, 3 false colours, 4 directions
uniform vec3 limits;      // of false colours: minimum, maximum, 1 where logarithmic
in vec2 place;
out vec4 shown;

const vec3 photopic = vec3(0.2126390, 0.7151687, 0.0721923);

// Moves a colour that the display cannot show toward grey of the same luminance.
vec3 into_gamut(vec3 rgb) {
  float y = dot(rgb, photopic);
  if (!(y > 0.0)) return vec3(0.0);
  if (y >= 1.0) return vec3(1.0);
  float kept = 1.0;
  for (int c = 0; c < 3; ++c) {
    if (rgb[c] > 1.0) kept = min(kept, (1.0 - y) / (rgb[c] - y));
    if (rgb[c] < 0.0) kept = min(kept, y / (y - rgb[c]));
  }
  return clamp(y + kept * (rgb - y), 0.0, 1.0);
}

// Hill's fit (2016) of the ACES reference rendering and sRGB output transforms.
vec3 filmic(vec3 rgb) {
  const mat3 inward = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
  const mat3 outward = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
  vec3 x = clamp(inward * rgb, 0.0, 1e4);
  return outward * ((x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081));
}

// Reinhard et al. 2002, equation 4, with white at four stops above middle grey.
vec3 reinhard(vec3 rgb) {
  const float white = 2.88;
  float y = dot(rgb, photopic);
  return rgb * ((1.0 + y / (white * white)) / (1.0 + y));
}

vec3 false_color(vec3 rgb) {
  float value = dot(rgb, photopic);
  float t = limits.z > 0.5 ? log(max(value, 1e-30) / limits.x) / log(limits.y / limits.x)
                           : (value - limits.x) / (limits.y - limits.x);
  return texture(palette, vec2((clamp(t, 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5)).rgb;
}

vec3 encoded(vec3 v) {
  return mix(12.92 * v, 1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, v));
}

void main() {
  vec3 rgb = texture(picture, place).rgb * scale;
  if (operator == 3) {
    shown = vec4(false_color(rgb), 1.0);
    return;
  }
  if (operator == 4) {
    shown = vec4(clamp(0.5 + 0.5 * rgb, 0.0, 1.0), 1.0);
    return;
  }
  rgb *= exposure;
  if (operator == 1) rgb = filmic(rgb);
  if (operator == 2) rgb = reinhard(rgb);
  shown = vec4(encoded(into_gamut(rgb)), 1.0);
}`;
