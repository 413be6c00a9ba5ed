// Playing the job: play, pause, single motions, a scrubber in planned time with tool changes and hazards
// marked.
import { byId, el } from '../dom';
import { duration, feed, type Unit } from '../format';
import { RAPID, type Program } from '../program';

const SPEEDS = [1, 2, 4, 8, 16, 32, 64, 128, 256, 1024];
const KINDS = ['rapid', 'cut', 'arc', 'probe', 'extrusion'];

export class Player {
  onTime: () => void = () => {};
  /** Playing has ended, at the end of the job or before. */
  onPaused: () => void = () => {};
  onSpeed: (speed: number) => void = () => {};
  isPlaying = false;
  /** The job is not played faster than in so many seconds. */
  shortest = 0;
  /** Seconds from the start of the job. */
  time = 0;
  private program: Program | null = null;
  private last = 0;
  private readonly slider = byId<HTMLInputElement>('time');
  private readonly playButton = byId<HTMLButtonElement>('play');
  private readonly speedChoice = byId<HTMLSelectElement>('speed');

  constructor(speed: number) {
    this.speedChoice.append(...SPEEDS.map((s) => el('option', { value: String(s) }, `${s}×`)));
    this.speedChoice.value = String(SPEEDS.includes(speed) ? speed : 16);
    this.speedChoice.addEventListener('change', () => this.onSpeed(this.speed));
    this.slider.addEventListener('input', () => {
      this.pause();
      this.seek(Number(this.slider.value));
    });
    this.playButton.addEventListener('click', () => this.toggle());
    byId('to-start').addEventListener('click', () => this.toStart());
    byId('to-end').addEventListener('click', () => this.toEnd());
    byId('step-back').addEventListener('click', () => this.step(-1));
    byId('step-on').addEventListener('click', () => this.step(1));
  }

  get speed(): number {
    return Number(this.speedChoice.value);
  }

  get isAtEnd(): boolean {
    return !this.program || this.time >= this.program.totalTime;
  }

  /** The motion that runs now; -1 without motions. */
  get motion(): number {
    return this.program?.motionAt(this.time) ?? -1;
  }

  /** A new state of the program: at the end it stays at the end, else at its time. */
  update(program: Program): void {
    const wasAtEnd = this.isAtEnd;
    this.program = program;
    this.slider.max = String(Math.max(program.totalTime, 1e-3));
    // Arrow keys move by a hundredth of the job; exact instants come from the step buttons.
    this.slider.step = 'any';
    this.drawMarks(program);
    this.time = wasAtEnd ? program.totalTime : Math.min(this.time, program.totalTime);
    this.slider.value = String(this.time);
  }

  private drawMarks(program: Program): void {
    const total = program.totalTime;
    const mark = (step: number, kind: string) => {
      const tick = el('i', { class: kind });
      tick.style.left = `${total > 0 ? (100 * program.timeOfStep(step)) / total : 0}%`;
      return tick;
    };
    const tools = program.model.marks.filter((m) => m.kind === 'tool' || m.kind === 'pause');
    const hazards = program.model.findings.filter((f) => typeof f.step === 'number');
    byId('time-marks').replaceChildren(
      ...tools.map((m) => mark(m.step, 'change')),
      ...hazards.slice(0, 2000).map((f) => mark(f.step!, 'hazard')),
    );
  }

  toggle(): void {
    if (this.isPlaying) this.pause();
    else this.play();
  }

  play(): void {
    if (!this.program || this.program.motions === 0) return;
    if (this.isAtEnd) this.seek(0);
    this.isPlaying = true;
    this.last = performance.now();
    this.showState();
    requestAnimationFrame((now) => this.advance(now));
  }

  pause(): void {
    const wasPlaying = this.isPlaying;
    this.isPlaying = false;
    this.showState();
    if (wasPlaying) this.onPaused();
  }

  private advance(now: number): void {
    if (!this.isPlaying || !this.program) return;
    const seconds = Math.max(now - this.last, 0) / 1000;
    this.last = now;
    const fastest = this.shortest > 0 ? this.program.totalTime / this.shortest : Infinity;
    this.seek(this.time + Math.min(this.speed, fastest) * seconds);
    if (this.isAtEnd) this.pause();
    else requestAnimationFrame((t) => this.advance(t));
  }

  seek(time: number): void {
    this.time = Math.min(Math.max(time, 0), this.program?.totalTime ?? 0);
    this.slider.value = String(this.time);
    this.onTime();
  }

  toStart(): void {
    this.pause();
    this.seek(0);
  }

  toEnd(): void {
    this.pause();
    this.seek(Infinity);
  }

  /**
   * To the end of the motion that runs (1), or to the end of the one before it (-1). Motions without time
   * are skipped.
   */
  step(by: 1 | -1): void {
    this.pause();
    if (!this.program || this.program.motions === 0) return;
    const { program } = this;
    let m = this.motion;
    if (by > 0) {
      while (m < program.motions && program.startOf(m + 1) <= this.time) ++m;
      this.seek(program.startOf(Math.min(m + 1, program.motions)));
    } else {
      while (m > 0 && program.startOf(m) >= this.time) --m;
      this.seek(program.startOf(Math.max(m, 0)));
    }
  }

  /** The clock, and what runs now. */
  showText(unit: Unit, where: string): void {
    const program = this.program;
    const total = program?.totalTime ?? 0;
    byId('clock').textContent = `${duration(this.time, 1)} / ${duration(total)}`;
    const m = this.motion;
    if (!program || m < 0) {
      byId('motion').textContent = '';
      return;
    }
    const { path } = program;
    const words = [path.tool[m]! >= 0 ? `T${path.tool[m]}` : '', KINDS[path.kind[m]!] ?? '', where];
    if (path.kind[m] !== RAPID && path.feed[m]! > 0) words.push(feed(path.feed[m], unit));
    byId('motion').textContent = words.filter(Boolean).join(' · ');
    this.slider.setAttribute('aria-valuetext', `${duration(this.time, 1)} of ${duration(total)}`);
  }

  private showState(): void {
    this.playButton.classList.toggle('playing', this.isPlaying);
    this.playButton.setAttribute('aria-label', this.isPlaying ? 'Pause' : 'Play');
  }
}
