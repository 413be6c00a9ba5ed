// Loading the part of an instant: one request at a time, always the latest, none after the job changed.
import { expect, test } from 'vitest';
import { FINAL, type MeshAnswer } from '../../src/decode';
import { InstantLoader } from '../../src/instant_loader';

function setUp() {
  const asked: [number, number | null][] = [];
  const waiting: ((answer: MeshAnswer) => void)[] = [];
  const failures: string[] = [];
  const view = {
    shownStep: FINAL,
    updateInstant(answer: MeshAnswer) {
      view.shownStep = answer.atStep;
    },
    showFinished() {
      view.shownStep = FINAL;
    },
  };
  const source = {
    start() {},
    download: () => null,
    burn: () => Promise.reject(new Error('no laser')),
    instant(step: number, from: number | null) {
      asked.push([step, from]);
      return new Promise<MeshAnswer>((resolve) => waiting.push(resolve));
    },
  };
  const loader = new InstantLoader(
    source,
    view,
    () => {},
    (m) => failures.push(m),
  );
  const answer = async (atStep: number) => {
    waiting.shift()!({ revision: 1, reset: false, atStep, renumberings: [], tiles: [] });
    await new Promise((done) => setTimeout(done));
  };
  return { asked, view, loader, answer, failures };
}

test('only the latest instant is loaded after the first', async () => {
  const { asked, view, loader, answer } = setUp();
  for (const step of [3, 4, 5, 9]) loader.want(step);
  expect(asked).toEqual([[3, null]]);
  await answer(3);
  expect(asked).toEqual([
    [3, null],
    [9, 3],
  ]);
  await answer(9);
  expect(view.shownStep).toBe(9);
  loader.want(FINAL);
  expect(view.shownStep).toBe(FINAL);
  expect(asked.length).toBe(2);
});

test('an answer for the program before a change is not shown', async () => {
  const { asked, view, loader, answer } = setUp();
  loader.want(3);
  loader.modelChanged();
  await answer(3);
  expect(view.shownStep).toBe(FINAL);
  expect(asked).toEqual([
    [3, null],
    [3, null],
  ]);
  await answer(3);
  expect(view.shownStep).toBe(3);
});

test('an instant at the end is the finished part, without asking again', async () => {
  const { asked, view, loader, answer } = setUp();
  loader.want(100);
  await answer(FINAL);
  expect(view.shownStep).toBe(FINAL);
  expect(asked.length).toBe(1);
});
