// Numbers as text: lengths in mm or inch, times, volumes. What is unknown is shown as a dash, never as a
// number.

export type Unit = 'mm' | 'inch';

/** Of drawings that specify none; px are 1/96 inch, pt 1/72 inch. */
export const DRAWING_UNITS = ['mm', 'inch', 'px', 'pt'] as const;
export type DrawingUnit = (typeof DRAWING_UNITS)[number];
export const UNKNOWN = '–';
const MM_PER_INCH = 25.4;

type Maybe = number | null | undefined;

function isKnown(value: Maybe): value is number {
  return typeof value === 'number' && Number.isFinite(value);
}

/** Fixed decimals without a negative zero. */
function fixed(value: number, decimals: number): string {
  const text = value.toFixed(decimals);
  return /^-0\.?0*$/.test(text) ? text.slice(1) : text;
}

/** A length without its unit: 0.001 mm or 0.0001 inch. */
export function lengthNumber(mm: Maybe, unit: Unit): string {
  if (!isKnown(mm)) return UNKNOWN;
  return unit === 'mm' ? fixed(mm, 3) : fixed(mm / MM_PER_INCH, 4);
}

export function length(mm: Maybe, unit: Unit): string {
  return isKnown(mm) ? `${lengthNumber(mm, unit)} ${unit === 'mm' ? 'mm' : 'in'}` : UNKNOWN;
}

export function feed(mmPerMinute: Maybe, unit: Unit): string {
  if (!isKnown(mmPerMinute)) return UNKNOWN;
  return unit === 'mm' ? `${fixed(mmPerMinute, 0)} mm/min` : `${fixed(mmPerMinute / MM_PER_INCH, 1)} in/min`;
}

export function volume(mm3: Maybe, unit: Unit): string {
  if (!isKnown(mm3)) return UNKNOWN;
  return unit === 'mm' ? `${fixed(mm3, 1)} mm³` : `${fixed(mm3 / MM_PER_INCH ** 3, 4)} in³`;
}

/** 1:05 or 2:03:04; the decimal only where asked for. */
export function duration(seconds: Maybe, decimals = 0): string {
  if (!isKnown(seconds)) return UNKNOWN;
  const scale = 10 ** decimals;
  const total = Math.round(Math.max(seconds, 0) * scale) / scale;
  const whole = Math.floor(total);
  const h = Math.floor(whole / 3600);
  const m = Math.floor((whole % 3600) / 60);
  const s = (total - 3600 * h - 60 * m).toFixed(decimals).padStart(decimals ? decimals + 3 : 2, '0');
  return h > 0 ? `${h}:${String(m).padStart(2, '0')}:${s}` : `${m}:${s}`;
}
