// When the slices of the picture at rest are drawn: after the rest, within their time, never after a change.
import { expect, test } from 'vitest';
import { type Frames, REST_MS, SLICE_MS, type SlicedPicture, Slices } from '../../src/view3d/slices';

const FRAME = 16; // ms

/** A clock with frames, and a renderer that draws so many triangles per ms beside it. */
class Machine implements Frames, SlicedPicture {
  time = 0;
  left = 0;
  starts = 0;
  finished = 0;
  slices: { at: number; count: number; ms: number }[] = [];
  isCoarse = true;
  private busyUntil = 0;
  private calls: { at: number; call: () => void }[] = [];

  constructor(
    readonly total: number,
    public speed: number,
  ) {}

  now = () => this.time;
  next = (call: () => void) => this.at((Math.floor(this.time / FRAME) + 1) * FRAME, call);
  after = (ms: number, call: () => void) => this.at(this.time + ms, call);

  private at(time: number, call: () => void): () => void {
    const entry = { at: time, call };
    this.calls.push(entry);
    return () => (this.calls = this.calls.filter((other) => other !== entry));
  }

  run(ms: number): void {
    const end = this.time + ms;
    for (;;) {
      this.calls.sort((a, b) => a.at - b.at);
      if (!this.calls[0] || this.calls[0].at > end) break;
      const { at, call } = this.calls.shift()!;
      this.time = at;
      call();
    }
    this.time = end;
  }

  begin(): boolean {
    if (!this.isCoarse) return false;
    ++this.starts;
    this.left = this.total;
    return true;
  }
  draw(count: number): number {
    const drawn = Math.min(count, this.left);
    this.left -= drawn;
    if (drawn > 0) this.slices.push({ at: this.time, count: drawn, ms: drawn / this.speed });
    this.busyUntil = Math.max(this.busyUntil, this.time) + drawn / this.speed;
    return drawn;
  }
  isDrawn = () => this.time >= this.busyUntil;
  finish(): void {
    ++this.finished;
  }
}

test('slices follow each other after the rest, until all is drawn', () => {
  const machine = new Machine(500_000, 1000);
  const slices = new Slices(machine, machine);
  slices.start();
  machine.run(REST_MS - 1);
  expect(machine.starts).toBe(0);
  machine.run(20_000);
  expect(machine.left).toBe(0);
  expect(machine.finished).toBe(1);
  expect(slices.isFinished).toBe(true);
  expect(slices.count).toBe(machine.slices.length);
  for (let k = 1; k < machine.slices.length; ++k) {
    const [before, one] = [machine.slices[k - 1]!, machine.slices[k]!];
    expect(one.at).toBeGreaterThanOrEqual(before.at + before.ms); // one at a time
    expect(Math.floor(one.at / FRAME)).toBeGreaterThan(Math.floor(before.at / FRAME)); // one a frame
  }
});

test.each([100, 1000, 100_000])('slices keep their time at %i triangles per ms', (speed) => {
  const machine = new Machine(2_000_000, speed);
  new Slices(machine, machine).start();
  machine.run(100_000);
  expect(machine.finished).toBe(1);
  const known = machine.slices.slice(4);
  for (const { ms } of known) expect(ms).toBeLessThanOrEqual(SLICE_MS);
  // They use it as well, as far as they are not the longest or the last one.
  const usual = known.slice(0, -1).filter(({ count }) => count < 65_536);
  for (const { ms } of usual) expect(ms).toBeGreaterThan(SLICE_MS / 4);
});

test('slices become shorter on a machine that becomes slower', () => {
  const machine = new Machine(5_000_000, 1000);
  new Slices(machine, machine).start();
  machine.run(1500);
  machine.speed = 100;
  const before = machine.slices.length;
  machine.run(100_000);
  for (const { ms } of machine.slices.slice(before + 3)) expect(ms).toBeLessThanOrEqual(SLICE_MS);
});

test('a change stops the slices at once, and the next ones start again after the rest', () => {
  const machine = new Machine(500_000, 1000);
  const slices = new Slices(machine, machine);
  slices.start();
  machine.run(REST_MS + 4 * SLICE_MS);
  const drawn = machine.slices.length;
  expect(drawn).toBeGreaterThan(1);
  slices.stop();
  expect(slices.count).toBe(0);
  machine.run(10_000);
  expect(machine.slices.length).toBe(drawn);
  expect(machine.finished).toBe(0);
  for (let k = 0; k < 20; ++k) {
    slices.start();
    machine.run(REST_MS / 2); // as while the view turns
  }
  expect(machine.slices.length).toBe(drawn);
  machine.run(20_000);
  expect(machine.starts).toBe(2);
  expect(machine.finished).toBe(1);
  expect(machine.slices.slice(drawn).reduce((sum, { count }) => sum + count, 0)).toBe(500_000);
});

test('nothing is drawn again where the frames have all details', () => {
  const machine = new Machine(1000, 1000);
  machine.isCoarse = false;
  const slices = new Slices(machine, machine);
  slices.start();
  machine.run(1000);
  expect(machine.slices).toEqual([]);
  expect(slices.isFinished).toBe(false);
  expect(slices.drawAll()).toBe(false);
});

test('a copy of the picture has full detail without a pause', () => {
  const machine = new Machine(200_000, 1000);
  const slices = new Slices(machine, machine);
  slices.start();
  machine.run(REST_MS + SLICE_MS);
  expect(slices.drawAll()).toBe(true);
  expect([machine.left, machine.finished, machine.starts]).toEqual([0, 1, 2]);
  machine.run(10_000);
  expect([machine.finished, machine.starts]).toEqual([1, 2]);
});
