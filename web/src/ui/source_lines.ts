// The lines of a source: of a small text all, of a large one those of the blocks that were shown last.
import type { SourceFile } from '../protocol';

const KEPT = 24; // blocks
const LINE_END = /\r\n|\n|\r/;

export interface SourceLines {
  readonly count: number;
  /** Counted from 0; null: asked for, and not there yet. */
  line(index: number): string | null;
}

export type BlockSource = (id: number) => Promise<string>;

/** `changed` is called when lines have arrived. */
export function linesOf(
  file: SourceFile | undefined,
  blockOf: BlockSource | undefined,
  changed: () => void,
): SourceLines {
  if (file?.blocks && blockOf) return new BlockLines(file.blocks, blockOf, changed);
  if (file?.text === null) return new WholeLines(['(not a text file)']);
  const lines = (file?.text ?? '').split(LINE_END);
  if (file && !file.complete) lines.push('(the rest of this file is not shown)');
  return new WholeLines(lines);
}

class WholeLines implements SourceLines {
  constructor(private readonly lines: string[]) {}

  get count(): number {
    return this.lines.length;
  }

  line(index: number): string {
    return this.lines[index]!;
  }
}

export class BlockLines implements SourceLines {
  readonly count: number;
  /** The first line of each block. */
  private readonly first: Uint32Array;
  private readonly kept = new Map<number, string[] | null>(); // by id, the last used at the end

  constructor(
    private readonly blocks: readonly [number, number][],
    private readonly blockOf: BlockSource,
    private readonly changed: () => void,
  ) {
    this.first = new Uint32Array(blocks.length);
    let count = 0;
    blocks.forEach(([, lines], b) => {
      this.first[b] = count;
      count += lines;
    });
    this.count = count;
  }

  line(index: number): string | null {
    let low = 0;
    let high = this.first.length - 1;
    while (low < high) {
      const mid = (low + high + 1) >> 1;
      if (this.first[mid]! <= index) low = mid;
      else high = mid - 1;
    }
    return this.textOf(this.blocks[low]![0])?.[index - this.first[low]!] ?? null;
  }

  private textOf(id: number): string[] | null {
    const found = this.kept.get(id);
    this.kept.delete(id);
    this.kept.set(id, found ?? null);
    if (found === undefined) void this.load(id);
    for (const oldest of this.kept.keys()) {
      if (this.kept.size <= KEPT) break;
      this.kept.delete(oldest);
    }
    return found ?? null;
  }

  /** Blocks of the text before that this one has, too. */
  takeFrom(before: SourceLines): void {
    if (!(before instanceof BlockLines)) return;
    const own = new Set(this.blocks.map(([id]) => id));
    for (const [id, lines] of before.kept) if (lines && own.has(id)) this.kept.set(id, lines);
  }

  private async load(id: number): Promise<void> {
    try {
      this.kept.set(id, (await this.blockOf(id)).split(LINE_END));
    } catch {
      this.kept.delete(id); // the program has changed, its next state follows; else the next look asks again
      return;
    }
    this.changed();
  }
}
