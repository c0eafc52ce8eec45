import { Signal } from './signal';
import { store, stored } from './stored';

/// Luminances are shown in the renderer's unit, or as eyes weigh them: cd/m² (lx of irradiance).
export type Photometry = 'radiometric' | 'photometric';

export const photometry = new Signal<Photometry>(
  stored('photometry') === 'photometric' ? 'photometric' : 'radiometric',
);
photometry.onChange((value) => store('photometry', value));

const lumensPerWatt = 179;

/// Of luminances in the renderer's unit.
export function shownFactor(): number {
  return photometry.value === 'photometric' ? lumensPerWatt : 1;
}

export function shownUnit(unit: string): string {
  if (photometry.value === 'radiometric') return unit;
  return unit.includes('sr') ? 'cd/m²' : 'lx';
}
