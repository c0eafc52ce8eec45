// A synthetic picture for tests of the page: spheres on a floor below a lamp, traced roughly, with
// noise that falls with the passes. No renderer: nothing here is right but the geometry.

const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const times = (a, k) => [a[0] * k, a[1] * k, a[2] * k];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => times(a, 1 / (Math.sqrt(dot(a, a)) || 1));

const spheres = [
  { centre: [-1.1, 1, 0.2], radius: 1, albedo: [0.75, 0.3, 0.16], mirror: 0 },
  { centre: [1.15, 1, -0.3], radius: 1, albedo: [0.9, 0.9, 0.9], mirror: 0.85 },
  { centre: [0.3, 0.45, 1.5], radius: 0.45, albedo: [0.15, 0.4, 0.7], mirror: 0.1 },
];
const lamp = { centre: [1.5, 5, 2.5], radius: 0.5 };
const caustic = { at: [0.1, 0, -1.6], size: 0.5 };

function hitSphere(origin, direction, { centre, radius }) {
  const oc = sub(origin, centre);
  const b = dot(oc, direction);
  const d = b * b - dot(oc, oc) + radius * radius;
  if (d < 0) return Infinity;
  const t = -b - Math.sqrt(d);
  return t > 1e-4 ? t : Infinity;
}

function nearest(origin, direction) {
  let best = { t: Infinity };
  for (const sphere of spheres) {
    const t = hitSphere(origin, direction, sphere);
    if (t < best.t) best = { t, sphere };
  }
  const floor = -origin[1] / direction[1];
  if (floor > 1e-4 && floor < best.t && floor < 40) best = { t: floor, sphere: null };
  return best;
}

/// Layers of the light that comes along a ray.
function traced(origin, direction, scene, depth = 0) {
  const light = { direct: [0, 0, 0], caustic: [0, 0, 0], indirect: [0, 0, 0], emission: [0, 0, 0], distance: 0 };
  const { t, sphere } = nearest(origin, direction);
  const toLamp = hitSphere(origin, direction, lamp);
  if (toLamp < t) return { ...light, emission: times(scene.radiance, 1), distance: toLamp, normal: [0, 1, 0] };
  if (t === Infinity) {
    const sky = 0.06 + 0.1 * Math.max(0, direction[1]);
    return { ...light, indirect: [0.8 * sky, 0.95 * sky, 1.2 * sky], normal: [0, 0, 0] };
  }
  const at = add(origin, times(direction, t));
  const normal = sphere ? unit(sub(at, sphere.centre)) : [0, 1, 0];
  const checks = (Math.floor(at[0]) + Math.floor(at[2])) & 1;
  const albedo = sphere ? sphere.albedo : checks ? [0.55, 0.52, 0.47] : [0.3, 0.29, 0.28];
  light.distance = t;
  light.normal = normal;
  light.albedo = albedo;
  const toward = sub(lamp.centre, at);
  const distanceSq = dot(toward, toward);
  const way = times(toward, 1 / Math.sqrt(distanceSq));
  const facing = Math.max(0, dot(normal, way));
  const isLit = facing > 0 && nearest(add(at, times(normal, 1e-3)), way).t > Math.sqrt(distanceSq);
  const mirror = sphere?.mirror ?? 0;
  const share = 1 - mirror;
  for (let c = 0; c < 3; ++c) {
    const e = (scene.radiance[c] * Math.PI * lamp.radius ** 2 * facing) / distanceSq;
    if (isLit) light.direct[c] = (share * albedo[c] * e) / Math.PI;
    light.indirect[c] = share * albedo[c] * (0.05 + 0.03 * normal[1]);
    if (!sphere) {
      const d = Math.hypot(at[0] - caustic.at[0], at[2] - caustic.at[2]) / caustic.size;
      const ring = Math.exp(-(((d - 0.9) / 0.18) ** 2)) + 0.5 * Math.exp(-d * d);
      light.caustic[c] = (albedo[c] * scene.radiance[c] * 0.05 * ring) / Math.PI;
    }
  }
  if (mirror > 0 && depth < 2) {
    const bounced = sub(direction, times(normal, 2 * dot(direction, normal)));
    const seen = traced(add(at, times(normal, 1e-3)), bounced, scene, depth + 1);
    for (let c = 0; c < 3; ++c)
      light.indirect[c] += mirror * (seen.direct[c] + seen.caustic[c] + seen.indirect[c] + seen.emission[c]);
  }
  return light;
}

/// Layers without noise, as arrays of three floats a pixel.
export function sceneLayers(width, height, camera, scene) {
  const names = ['direct', 'caustic', 'indirect', 'emission', 'albedo', 'N', 'depth'];
  const layers = Object.fromEntries(names.map((name) => [name, new Float32Array(3 * width * height)]));
  const forward = unit(sub(camera.target, camera.origin));
  const right = unit(cross(forward, camera.up));
  const up = cross(right, forward);
  const half = Math.tan(((camera.fov ?? 40) * Math.PI) / 360);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const u = ((2 * (x + 0.5)) / width - 1) * half;
      const v = ((1 - (2 * (y + 0.5)) / height) * half * height) / width;
      const direction = unit(add(forward, add(times(right, u), times(up, v))));
      const light = traced(camera.origin, direction, scene);
      const i = 3 * (y * width + x);
      for (const name of ['direct', 'caustic', 'indirect', 'emission']) layers[name].set(light[name], i);
      layers.albedo.set(light.albedo ?? [0, 0, 0], i);
      layers.N.set(light.normal, i);
      layers.depth.set([light.distance, light.distance, light.distance], i);
    }
  return summed(layers);
}

/// Flat patches of known radiance, 4 × 3 of them.
export const patches = [
  [0.05, 0.05, 0.05], [0.18, 0.18, 0.18], [0.5, 0.5, 0.5], [0.9, 0.9, 0.9],
  [0.4, 0.1, 0.1], [0.1, 0.4, 0.1], [0.1, 0.1, 0.4], [0.4, 0.4, 0.1],
  [4, 4, 4], [0.02, 0.01, 0.03], [0.6, 0.3, 0.15], [0.15, 0.3, 0.6],
];

export function chartLayers(width, height) {
  const direct = new Float32Array(3 * width * height);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x)
      direct.set(patches[4 * Math.floor((3 * y) / height) + Math.floor((4 * x) / width)], 3 * (y * width + x));
  const zero = () => new Float32Array(direct.length);
  return summed({ direct, caustic: zero(), indirect: zero(), emission: zero(), albedo: zero(), N: zero(), depth: zero() });
}

/// A picture that was rendered before, as the only layer.
export function givenLayers(pixels) {
  const zero = () => new Float32Array(pixels.length);
  return summed({ direct: pixels, caustic: zero(), indirect: zero(), emission: zero(), albedo: zero(), N: zero(), depth: zero() });
}

function summed(layers) {
  const { direct, caustic, indirect, emission } = layers;
  const picture = direct.map((v, i) => v + caustic[i] + indirect[i] + emission[i]);
  return { '': picture, ...layers };
}

/// What one pass adds: a repeatable number for pixel and pass, from −1 to 1.
export function noise(i, pass) {
  let h = Math.imul(i ^ 0x9e3779b9, 0x85ebca6b) ^ Math.imul(pass + 1, 0xc2b2ae35);
  h = Math.imul(h ^ (h >>> 15), 0x27d4eb2f);
  return ((h ^ (h >>> 13)) >>> 0) / 2147483648 - 1;
}

/// EXT_texture_shared_exponent, as its specification has it.
export function rgb9e5(r, g, b) {
  const largest = 65408;
  const clamped = [r, g, b].map((v) => (v > 0 ? Math.min(v, largest) : 0));
  const most = Math.max(...clamped);
  let exponent = Math.max(-16, Math.floor(Math.log2(most || 1e-30))) + 16;
  if (Math.floor(most / 2 ** (exponent - 24) + 0.5) === 512) ++exponent;
  const m = clamped.map((v) => Math.floor(v / 2 ** (exponent - 24) + 0.5));
  return (m[0] | (m[1] << 9) | (m[2] << 18) | (exponent << 27)) >>> 0;
}
