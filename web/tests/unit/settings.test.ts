// Remembered settings: whatever is stored, the page starts.
import { describe, expect, test } from 'vitest';
import { defaultSettings, Memory, readSettings, readView } from '../../src/settings';

class FakeStorage implements Storage {
  readonly values = new Map<string, string>();
  get length(): number {
    return this.values.size;
  }
  clear(): void {
    this.values.clear();
  }
  getItem(key: string): string | null {
    return this.values.get(key) ?? null;
  }
  key(): string | null {
    return null;
  }
  removeItem(key: string): void {
    this.values.delete(key);
  }
  setItem(key: string, value: string): void {
    this.values.set(key, value);
  }
}

describe('settings', () => {
  test.each([null, '', 'x', '[]', '3', '{"theme":"blue","colour":7,"speed":"fast","show":3}'])(
    '%s gives defaults',
    (text) => {
      expect(readSettings(text)).toEqual(defaultSettings());
    },
  );

  test('are stored and read again', () => {
    const memory = new Memory(new FakeStorage());
    const changed = {
      ...defaultSettings(),
      theme: 'dark' as const,
      units: 'inch' as const,
      colour: 'depth' as const,
      speed: 64,
    };
    changed.show.rapids = false;
    memory.saveSettings(changed);
    expect(memory.settings()).toEqual(changed);
  });

  test('no storage, or one that refuses', () => {
    const refusing = new FakeStorage();
    refusing.setItem = () => {
      throw new Error('full');
    };
    for (const memory of [new Memory(null), new Memory(refusing)]) {
      memory.saveSettings(defaultSettings());
      expect(memory.settings()).toEqual(defaultSettings());
    }
  });
});

describe('views', () => {
  const view = { position: [1, 2, 3], target: [0, 0, 0], zoom: 2 } as const;

  test.each([
    null,
    '{}',
    '{"position":[1,2],"target":[0,0,0],"zoom":1}',
    '{"position":[1,2,3],"target":[0,0,0],"zoom":0}',
    '{"position":[1,2,null],"target":[0,0,0],"zoom":1}',
  ])('%s is no view', (text) => expect(readView(text)).toBeNull());

  test('of the last 20 programs are kept', () => {
    const storage = new FakeStorage();
    const memory = new Memory(storage);
    for (let i = 0; i < 30; ++i)
      memory.saveView(`p${i}.nc`, { ...view, position: [i, 2, 3], target: [0, 0, 0] });
    expect(memory.view('p29.nc')?.position).toEqual([29, 2, 3]);
    expect(memory.view('p10.nc')).not.toBeNull();
    expect(memory.view('p9.nc')).toBeNull();
    expect(storage.length).toBe(21);
  });
});
