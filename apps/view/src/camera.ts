import type { Camera, Vec3 } from './protocol';

/// Turns and moves of a camera that looks at a target. Right-handed: right = forward × up.

const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const times = (a: Vec3, k: number): Vec3 => [a[0] * k, a[1] * k, a[2] * k];
const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
const length = (a: Vec3): number => Math.sqrt(dot(a, a));

function unit(a: Vec3, otherwise: Vec3): Vec3 {
  const size = length(a);
  return size > 1e-12 ? times(a, 1 / size) : otherwise;
}

/// About a unit axis, by Rodrigues' formula.
function turned(v: Vec3, axis: Vec3, angle: number): Vec3 {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return add(add(times(v, c), times(cross(axis, v), s)), times(axis, dot(axis, v) * (1 - c)));
}

interface Frame {
  distance: number;
  forward: Vec3;
  right: Vec3;
  up: Vec3; // of the picture
  pole: Vec3; // about which the camera orbits
}

function frameOf(camera: Camera): Frame {
  const toTarget = sub(camera.target, camera.origin);
  const forward = unit(toTarget, [0, 0, 1]);
  const pole = unit(camera.up, [0, 1, 0]);
  const aside: Vec3 = Math.abs(forward[0]) < 0.9 ? [1, 0, 0] : [0, 0, 1];
  const right = unit(cross(forward, pole), unit(cross(forward, aside), aside));
  return { distance: length(toTarget) || 1, forward, right, up: cross(right, forward), pole };
}

const nearest = (2 * Math.PI) / 180; // to the poles

/// Around the target: to the right and upward, in radians.
export function orbited(camera: Camera, toRight: number, upward: number): Camera {
  const { right, pole, distance, forward } = frameOf(camera);
  const polar = Math.acos(Math.min(1, Math.max(-1, dot(times(forward, -1), pole))));
  const next = Math.min(Math.PI - nearest, Math.max(nearest, polar - upward));
  const lifted = turned(times(forward, -distance), right, next - polar);
  return { ...camera, origin: add(camera.target, turned(lifted, pole, toRight)) };
}

/// The camera and its target: shares of the picture's width, at the target's distance.
export function panned(camera: Camera, toRight: number, upward: number): Camera {
  const { right, up, distance } = frameOf(camera);
  const width = 2 * distance * Math.tan((((camera.fov ?? 40) / 2) * Math.PI) / 180);
  const step = add(times(right, toRight * width), times(up, upward * width));
  return { ...camera, origin: add(camera.origin, step), target: add(camera.target, step) };
}

/// The distance to the target is multiplied.
export function dollied(camera: Camera, factor: number): Camera {
  const { forward, distance } = frameOf(camera);
  return { ...camera, origin: sub(camera.target, times(forward, distance * factor)) };
}

export const fovRange = { minimum: 1, maximum: 150 };

export function withFov(camera: Camera, fov: number): Camera {
  if (camera.fov === null) return camera;
  return { ...camera, fov: Math.min(fovRange.maximum, Math.max(fovRange.minimum, fov)) };
}

export function distanceOf(camera: Camera): number {
  return length(sub(camera.target, camera.origin));
}

export function isSameCamera(a: Camera, b: Camera): boolean {
  const near = (u: Vec3, v: Vec3) => length(sub(u, v)) <= 1e-6 * (1 + length(u));
  const fov = Math.abs((a.fov ?? 0) - (b.fov ?? 0)) < 1e-4;
  return fov && near(a.origin, b.origin) && near(a.target, b.target) && near(a.up, b.up);
}
