import type { FrameFormat } from './protocol';

export type Operator = 'linear' | 'filmic' | 'reinhard' | 'falsecolor';

/// How a kind of layer is shown until somebody says otherwise.
export interface LayerKind {
  id: string;
  operator: Operator;
  format: FrameFormat;
  isLight: boolean; // in the picture's unit
  isSigned: boolean;
  exposes: boolean; // an exposure makes sense, and is chosen by itself at first
}

const light: LayerKind = {
  id: 'light', operator: 'filmic', format: 'rgb9e5', isLight: true, isSigned: false, exposes: true,
};
const kinds: Record<string, LayerKind> = {
  error: { ...light, id: 'error', operator: 'falsecolor' },
  bias: { ...light, id: 'bias', operator: 'falsecolor', format: 'f32', isSigned: true },
  albedo: { ...light, id: 'albedo', operator: 'linear', isLight: false, exposes: false },
  N: { ...light, id: 'N', operator: 'linear', format: 'f32', isLight: false, isSigned: true, exposes: false },
  depth: { ...light, id: 'depth', operator: 'falsecolor', format: 'f32', isLight: false },
};

export function kindOf(layer: string): LayerKind {
  return kinds[layer] ?? light;
}

const titles: Record<string, string> = {
  '': 'Picture', direct: 'Direct', caustic: 'Caustics', indirect: 'Indirect', specular: 'Specular',
  volume: 'Volume', emission: 'Emission', error: 'Error map', bias: 'Bias', albedo: 'Albedo',
  N: 'Normals', depth: 'Depth',
};

export function titleOf(layer: string): string {
  return titles[layer] ?? layer;
}
