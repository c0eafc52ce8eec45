import type { Vec3 } from './protocol';

/// Photopic share of linear sRGB primaries, as in the renderer.
export function luminance(rgb: readonly number[]): number {
  return 0.212639 * (rgb[0] ?? 0) + 0.7151687 * (rgb[1] ?? 0) + 0.0721923 * (rgb[2] ?? 0);
}

export function srgbFromLinear(value: number): number {
  const v = Math.min(1, Math.max(0, value));
  return v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055;
}

export function linearFromSrgb(value: number): number {
  return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
}

/// '#rrggbb' of linear components from 0 to 1.
export function hexFromLinear(rgb: readonly number[]): string {
  const two = (v: number) => Math.round(255 * srgbFromLinear(v)).toString(16).padStart(2, '0');
  return `#${two(rgb[0] ?? 0)}${two(rgb[1] ?? 0)}${two(rgb[2] ?? 0)}`;
}

export function linearFromHex(hex: string): Vec3 {
  const part = (i: number) => linearFromSrgb(parseInt(hex.slice(i, i + 2), 16) / 255);
  return [part(1), part(3), part(5)];
}

/// Viridis, whose lightness rises evenly: numbers 0, 17, 34, … 255 of its 256 colours, sRGB.
const viridis: Vec3[] = [
  [0.267, 0.0049, 0.3294], [0.2827, 0.1002, 0.4222], [0.2771, 0.1852, 0.4899], [0.2539, 0.2653, 0.53],
  [0.222, 0.3392, 0.5488], [0.1906, 0.4071, 0.5561], [0.1636, 0.4711, 0.5581], [0.1391, 0.5338, 0.5553],
  [0.1206, 0.5964, 0.5436], [0.1347, 0.6586, 0.5176], [0.208, 0.7187, 0.4729], [0.3278, 0.774, 0.4066],
  [0.4775, 0.8214, 0.3182], [0.6473, 0.8584, 0.2099], [0.8249, 0.8847, 0.1062], [0.9932, 0.9062, 0.1439],
];

/// For signed values: blue below zero, orange above, dark at zero.
const signed: Vec3[] = [
  [0.55, 0.83, 0.98], [0.25, 0.58, 0.88], [0.14, 0.33, 0.6], [0.1, 0.17, 0.29], [0.09, 0.09, 0.1],
  [0.28, 0.16, 0.1], [0.58, 0.29, 0.11], [0.88, 0.51, 0.2], [0.99, 0.8, 0.5],
];

/// 256 colours as RGBA bytes.
export function paletteBytes(isSigned: boolean): Uint8Array {
  const table = isSigned ? signed : viridis;
  const bytes = new Uint8Array(256 * 4);
  for (let i = 0; i < 256; ++i) {
    const x = (i / 255) * (table.length - 1);
    const k = Math.min(Math.floor(x), table.length - 2);
    for (let c = 0; c < 3; ++c) {
      const low = table[k]![c]!;
      bytes[4 * i + c] = Math.round(255 * (low + (x - k) * (table[k + 1]![c]! - low)));
    }
    bytes[4 * i + 3] = 255;
  }
  return bytes;
}
