/// Numbers as people read them.

const minus = '\u2212';

function withMinus(text: string): string {
  return text.replace('-', minus);
}

/// Significant digits, without a long row of zeros; powers of ten beyond the usual range.
export function formatNumber(value: number, digits = 4): string {
  if (!Number.isFinite(value)) return Number.isNaN(value) ? 'NaN' : value > 0 ? '∞' : `${minus}∞`;
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split('e');
    return withMinus(`${trimZeros(mantissa!)}e${Number(exponent)}`);
  }
  return withMinus(trimZeros(value.toPrecision(digits)));
}

function trimZeros(text: string): string {
  return text.includes('.') ? text.replace(/\.?0+$/, '') : text;
}

/// Of a fixed number of digits, for columns.
export function formatFixed(value: number, digits: number): string {
  return withMinus(value.toFixed(digits));
}

/// Value and standard error as one: 0.1234(5).
export function formatWithError(value: number, error: number | null): string {
  if (error === null || !(error > 0) || !Number.isFinite(error)) return formatNumber(value);
  const places = Math.max(0, -Math.floor(Math.log10(error)) + (leading(error) < 3 ? 1 : 0));
  if (places > 7 || Math.abs(value) >= 1e6) return `${formatNumber(value)} ± ${formatNumber(error, 2)}`;
  return `${withMinus(value.toFixed(places))}(${Math.round(error * 10 ** places)})`;
}

/// Both ends of an interval, to a tenth of its width.
export function formatInterval([low, high]: readonly [number, number], factor = 1): string {
  const places = 1 - Math.floor(Math.log10((high - low) * factor));
  const fits = places >= 0 && places <= 7 && Math.abs(high * factor) < 1e6;
  const text = (value: number) => (fits ? withMinus((value * factor).toFixed(places)) : formatNumber(value * factor));
  return `${text(low)} to ${text(high)}`;
}

function leading(value: number): number {
  return value / 10 ** Math.floor(Math.log10(value));
}

export function formatCount(value: number): string {
  for (const [unit, size] of [['G', 1e9], ['M', 1e6], ['k', 1e4]] as const)
    if (value >= size) return `${(value / (unit === 'k' ? 1e3 : size)).toPrecision(3)} ${unit}`;
  return String(Math.round(value));
}

export function formatPercent(share: number): string {
  return `${formatNumber(share * 100, 3)} %`;
}

/// A share of the screen's pixels for one of the picture.
export function formatZoom(zoom: number): string {
  return zoom < 10 ? `${formatNumber(zoom * 100, 3)} %` : `${formatNumber(zoom, 3)} ×`;
}

export function formatTime(seconds: number): string {
  if (seconds < 60) return `${seconds.toFixed(seconds < 10 ? 1 : 0)} s`;
  const whole = Math.round(seconds);
  const two = (n: number) => String(n).padStart(2, '0');
  const [h, m, s] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60, whole % 60];
  return h > 0 ? `${h}:${two(m)}:${two(s)}` : `${m}:${two(s)} min`;
}
