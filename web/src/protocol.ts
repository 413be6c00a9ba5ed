// The JSON of the server's answers: types only. Lengths are mm in work coordinates, times are seconds.
// Texts come from users' files: they are shown as text, never as HTML.

export type Vec3 = [number, number, number];
export type Rgb = [number, number, number];

export interface Origin {
  file?: string | null;
  line?: number | null;
  column?: number | null;
  layer?: string;
  handle?: string;
  call?: string;
}

export interface Diagnostic {
  severity: string;
  code?: number | string;
  name?: string;
  message: string;
  hint?: string;
  origin?: Origin | null;
}

export interface Finding {
  kind: string;
  at?: Vec3 | null;
  depth_mm?: number | null;
  removed_mm3?: number | null;
  step?: number | null;
  steps?: number;
  message: string;
  hint?: string;
  origin?: Origin | null;
  callers?: Origin[];
}

export interface ToolProfile {
  part: string;
  points: [number, number][];
}

export interface Tool {
  number: number | null;
  name: string;
  source?: string;
  colour: Rgb;
  profiles: ToolProfile[];
  flute_length?: number | null;
  time_s?: number | null;
  removed_mm3?: number | null;
}

export interface Mark {
  step: number;
  kind: string;
  text: string;
  tool?: number | null;
}

export interface SourceFile {
  path: string;
  /** Null: no text, or one in blocks. */
  text: string | null;
  complete: boolean;
  /** The id and the number of lines of each block of a large text. */
  blocks?: [number, number][];
}

export interface Times {
  total_s: number;
  cutting_s?: number;
  rapid_s?: number;
  dwell_s?: number;
  planned?: boolean;
  machine?: string;
}

export interface Stock {
  block: [Vec3, Vec3];
  source?: string;
  shape?: string;
  diameter?: number;
}

export interface Fixture {
  name: string;
  block: [Vec3, Vec3];
  shape: string;
}

/** The travel is in work coordinates; null: not known. */
export interface MachineFigures {
  name: string;
  travel: [Vec3, Vec3] | null;
}

export interface TargetFigures {
  file: string;
  tolerance_mm: number;
  left_mm3: number;
  gouged_mm3: number;
  region_count: number;
  regions: { kind: string; depth_mm: number; volume_mm3: number; at: Vec3 }[];
}

export interface FailedProgram {
  name: string;
  files: SourceFile[];
}

export interface Model {
  protocol: number;
  revision: number;
  /** How often the files had changed when they were read. */
  input?: number;
  state: 'loading' | 'ready' | 'failed';
  errors: Diagnostic[];
  /** The program with the errors; the rest of the model is the last good one. */
  failed?: FailedProgram;
  name: string;
  source?: string;
  front_end?: string;
  kind: 'milling' | 'rotary' | 'print' | 'drawing';
  units: 'mm' | 'inch';
  bounds?: [Vec3, Vec3] | null;
  stock?: Stock | null;
  pitch?: number | null;
  fixtures?: Fixture[];
  machine?: MachineFigures | null;
  target?: TargetFigures | null;
  steps: number;
  motions: number;
  tools: Tool[];
  stock_colour?: Rgb;
  hazard_colour?: Rgb;
  findings: Finding[];
  diagnostics: Diagnostic[];
  report?: Record<string, unknown> | null;
  times?: Times | null;
  marks: Mark[];
  /** Targets for which the program can be downloaded. */
  posts?: string[];
  /** Of prints: what beads are part of, by the numbers of /path. */
  bead_kinds?: string[];
  /** What the program has printed. */
  console?: string;
  files: SourceFile[];
  tiles?: { count: number; level: number };
}

export interface ModelEvent {
  revision: number;
  tiles?: number;
  reset?: boolean;
  path?: boolean;
}

export interface ErrorsEvent {
  revision: number;
  input?: number;
  diagnostics: Diagnostic[];
}

export interface ProgressEvent {
  phase: string;
  fraction: number | null;
  /** How often the files have changed: what was made of fewer changes is out of date. */
  input?: number;
}
