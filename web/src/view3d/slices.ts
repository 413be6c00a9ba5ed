// When the picture at rest is drawn: in slices, each as large as what is drawn within its time, and none of
// them once the view has changed.

export const REST_MS = 150; // without a change
export const SLICE_MS = 50; // of a slice, until the graphics processor has drawn it
const FIRST_SIZE = 20_000; // triangles, or segments of lines, while the speed is not known
const MIN_SIZE = 2_000;
const MAX_SIZE = 65_536;

/** A picture that can be drawn bit by bit. */
export interface SlicedPicture {
  /** Starts it from the first triangle; false: what is drawn with each change has all details. */
  begin(): boolean;
  /** Draws up to `count` further triangles or segments and returns how many; 0: all are drawn. */
  draw(count: number): number;
  /** Whether the graphics processor has done what it was given. */
  isDrawn(): boolean;
  /** Puts the picture on the canvas. */
  finish(): void;
}

export interface Frames {
  now(): number;
  /** Calls before the next frame of the browser. */
  next(call: () => void): void;
  /** Calls after so many ms; the answer cancels that. */
  after(ms: number, call: () => void): () => void;
}

export const BROWSER_FRAMES: Frames = {
  now: () => performance.now(),
  next: (call) => requestAnimationFrame(call),
  after: (ms, call) => {
    const timer = setTimeout(call, ms);
    return () => clearTimeout(timer);
  },
};

export class Slices {
  /** Drawn since the last change. */
  count = 0;
  /** Whether the canvas has the picture of full detail. */
  isFinished = false;
  /** A slice, or the whole, is drawn, or the drawing starts again. */
  onChange: () => void = () => {};
  private size = FIRST_SIZE;
  private turn = 0; // the slices of an earlier one are not continued
  private cancel: () => void = () => {};
  private startedAt: number | null = null; // of the slice that is being drawn

  constructor(
    private readonly picture: SlicedPicture,
    private readonly frames: Frames = BROWSER_FRAMES,
  ) {}

  /** Something has changed: no further slice of what was shown before. */
  stop(): void {
    ++this.turn;
    this.cancel();
    this.cancel = () => {};
    this.count = 0;
    this.isFinished = false;
    this.startedAt = null;
    this.size = Math.min(this.size, FIRST_SIZE); // what was drawn last may have cost less than the next
    this.onChange();
  }

  /** The change is drawn: slices follow unless there is a further one. */
  start(): void {
    this.stop();
    const { turn } = this;
    this.cancel = this.frames.after(REST_MS, () => {
      if (turn === this.turn && this.picture.begin()) this.continueWith(turn);
    });
  }

  /** The picture of full detail without a pause, for a copy of it; false: there is no need. */
  drawAll(): boolean {
    this.stop();
    if (!this.picture.begin()) return false;
    while (this.picture.draw(MAX_SIZE) > 0) ++this.count;
    this.end();
    return true;
  }

  private continueWith(turn: number): void {
    if (turn !== this.turn) return;
    if (this.startedAt !== null && !this.picture.isDrawn())
      return this.frames.next(() => this.continueWith(turn));
    const now = this.frames.now();
    if (this.startedAt !== null) this.adapt(now - this.startedAt);
    this.startedAt = now;
    if (this.picture.draw(this.size) === 0) return this.end();
    ++this.count;
    this.onChange();
    this.frames.next(() => this.continueWith(turn));
  }

  private end(): void {
    this.picture.finish();
    this.isFinished = true;
    this.onChange();
  }

  /** A slice whose end is noticed a frame later counts as longer than it was: the next one is shorter. */
  private adapt(ms: number): void {
    const factor = Math.min(Math.max(SLICE_MS / Math.max(ms, 1), 0.25), 1.5);
    this.size = Math.round(Math.min(Math.max(this.size * factor, MIN_SIZE), MAX_SIZE));
  }
}
