/// The scale of false colours: round limits, round marks.

export interface Scale {
  minimum: number;
  maximum: number;
  isLogarithmic: boolean;
}

const tiny = 1e-9;

function roundUp(value: number): number {
  const decade = 10 ** Math.floor(Math.log10(value) + tiny);
  for (const factor of [1, 2, 5]) if (factor * decade >= value * (1 - tiny)) return factor * decade;
  return 10 * decade;
}

function roundDown(value: number): number {
  const decade = 10 ** Math.floor(Math.log10(value) + tiny);
  for (const factor of [5, 2]) if (factor * decade <= value * (1 + tiny)) return factor * decade;
  return decade;
}

/// Ends above 98 % of the lit pixels, so that lamps do not stretch it. Signed: as far to both sides.
export function chosenScale(values: Float64Array, isLogarithmic: boolean, isSigned: boolean): Scale {
  const sizes = (isSigned ? values.map(Math.abs) : values).filter((v) => v > 0 && Number.isFinite(v)).sort();
  const at = (share: number) => sizes[Math.floor(share * (sizes.length - 1))] ?? 0;
  const high = at(0.98);
  if (!(high > 0)) return { minimum: isSigned ? -1 : isLogarithmic ? 0.01 : 0, maximum: 1, isLogarithmic };
  if (isSigned) return { minimum: -roundUp(high), maximum: roundUp(high), isLogarithmic: false };
  if (!isLogarithmic) {
    const step = roundUp(high / 6);
    return { minimum: 0, maximum: step * Math.ceil(high / step - tiny), isLogarithmic };
  }
  const maximum = roundUp(high);
  const low = Math.min(Math.max(at(0.02), maximum * 1e-4), maximum / 2);
  return { minimum: roundDown(low), maximum, isLogarithmic };
}

/// A scale that can be drawn, whatever was typed.
export function usable(scale: Scale): Scale {
  const isLogarithmic = scale.isLogarithmic && scale.minimum > 0;
  const maximum = scale.maximum > scale.minimum ? scale.maximum : scale.minimum + 1;
  return { minimum: scale.minimum, maximum, isLogarithmic };
}

/// From 0 at the minimum to 1 at the maximum.
export function positionOf(value: number, scale: Scale): number {
  const { minimum, maximum, isLogarithmic } = scale;
  if (!isLogarithmic) return (value - minimum) / (maximum - minimum);
  return value > 0 ? Math.log(value / minimum) / Math.log(maximum / minimum) : -Infinity;
}

export function ticksOf(scale: Scale, most = 7): number[] {
  const { minimum, maximum, isLogarithmic } = scale;
  const inside: number[] = [];
  if (isLogarithmic) {
    const decades = Math.log10(maximum / minimum);
    const factors = decades <= most / 3 ? [1, 2, 5] : [1];
    const apart = Math.max(1, Math.ceil(decades / most));
    for (let e = Math.floor(Math.log10(minimum)); e <= Math.log10(maximum); e += apart)
      for (const factor of factors) inside.push(factor * 10 ** e);
  } else {
    const step = roundUp(((maximum - minimum) / (most - 1)) * (1 - tiny));
    for (let i = Math.ceil(minimum / step); i * step < maximum; ++i) inside.push(i * step);
  }
  const gap = 0.6 / most;
  const between = inside.filter((tick) => {
    const position = positionOf(tick, scale);
    return position > gap && position < 1 - gap;
  });
  return [minimum, ...between, maximum];
}
