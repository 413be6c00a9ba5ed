// What is remembered over reloads: display settings, and the view of each program. Kept in the browser's
// own storage, never sent anywhere; without storage (private windows, files from disk) the defaults are
// used.
import type { Vec3 } from './protocol';

export const COLOURS = [
  'tool',
  'operation',
  'depth',
  'step',
  'speed',
  'flow',
  'type',
  'layer',
  'power',
  'burn',
  'target',
  'change',
] as const;
export type ColourMode = (typeof COLOURS)[number];
export const LAYERS = [
  'part',
  'clear',
  'cuts',
  'wide',
  'rapids',
  'stock',
  'tool',
  'fixtures',
  'machine',
  'grid',
  'sizes',
  'legend',
  'perspective',
] as const;
export type LayerName = (typeof LAYERS)[number];

export interface Settings {
  theme: 'auto' | 'light' | 'dark';
  units: 'auto' | 'mm' | 'inch';
  colour: ColourMode;
  show: Record<LayerName, boolean>;
  speed: number;
}

export interface SavedView {
  position: Vec3;
  target: Vec3;
  zoom: number;
}

const PREFIX = 'kerf.view.';
const PROGRAMS_KEPT = 20;

export function defaultSettings(): Settings {
  return {
    theme: 'auto',
    units: 'auto',
    colour: 'tool',
    show: {
      part: true,
      clear: false,
      cuts: true,
      wide: false,
      rapids: true,
      stock: true,
      tool: true,
      fixtures: true,
      machine: true,
      grid: true,
      sizes: true,
      legend: true,
      perspective: false,
    },
    speed: 16,
  };
}

/** Settings from stored text; what is missing or invalid gets its default. */
export function readSettings(text: string | null): Settings {
  const result = defaultSettings();
  const stored = parse(text);
  if (!stored) return result;
  if (stored.theme === 'light' || stored.theme === 'dark') result.theme = stored.theme;
  if (stored.units === 'mm' || stored.units === 'inch') result.units = stored.units;
  const colour = COLOURS.find((c) => c === stored.colour);
  if (colour) result.colour = colour;
  if (typeof stored.speed === 'number' && stored.speed >= 1 && stored.speed <= 1024)
    result.speed = stored.speed;
  const show = stored.show as Record<string, unknown> | undefined;
  for (const name of LAYERS) {
    if (show && typeof show[name] === 'boolean') result.show[name] = show[name] as boolean;
  }
  return result;
}

/** A view from stored text, or null if it is not a complete one. */
export function readView(text: string | null): SavedView | null {
  const stored = parse(text);
  const isPoint = (v: unknown): v is Vec3 => Array.isArray(v) && v.length === 3 && v.every(Number.isFinite);
  if (!stored || !isPoint(stored.position) || !isPoint(stored.target)) return null;
  const zoom = stored.zoom;
  if (typeof zoom !== 'number' || !(zoom > 0) || !Number.isFinite(zoom)) return null;
  return { position: stored.position, target: stored.target, zoom };
}

function parse(text: string | null): Record<string, unknown> | null {
  try {
    const value: unknown = JSON.parse(text ?? 'null');
    return typeof value === 'object' && value !== null ? (value as Record<string, unknown>) : null;
  } catch {
    return null;
  }
}

export class Memory {
  constructor(private readonly storage: Storage | null = browserStorage()) {}

  settings(): Settings {
    return readSettings(this.get('settings'));
  }

  saveSettings(settings: Settings): void {
    this.set('settings', JSON.stringify(settings));
  }

  view(program: string): SavedView | null {
    return readView(this.get(`of.${program}`));
  }

  saveView(program: string, view: SavedView): void {
    this.set(`of.${program}`, JSON.stringify(view));
    const names =
      (parse(this.get('programs'))?.names as string[] | undefined)?.filter((n) => n !== program) ?? [];
    names.push(program);
    for (const old of names.splice(0, names.length - PROGRAMS_KEPT))
      this.storage?.removeItem(`${PREFIX}of.${old}`);
    this.set('programs', JSON.stringify({ names }));
  }

  private get(key: string): string | null {
    try {
      return this.storage?.getItem(PREFIX + key) ?? null;
    } catch {
      return null;
    }
  }

  private set(key: string, text: string): void {
    try {
      this.storage?.setItem(PREFIX + key, text);
    } catch {
      // A full or forbidden storage only means that nothing is remembered.
    }
  }
}

function browserStorage(): Storage | null {
  try {
    return window.localStorage;
  } catch {
    return null;
  }
}
