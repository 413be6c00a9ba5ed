// Answers the requests of the page with the engine, as the server of `kerf view` does.
import { FINAL } from '../decode';
import type { Engine, EngineAnswer } from './engine';
import type { FromWorker, Request } from './messages';

export type Post = (message: FromWorker, transfer?: ArrayBuffer[]) => void;

const FOUND = 200;
const BAD = 400;
const NOT_FOUND = 404;

export class Desk {
  constructor(
    private readonly engine: Engine,
    private readonly post: Post,
  ) {}

  handle(request: Request): void {
    const { id } = request;
    try {
      const { status, bytes, name } = this.answer(request);
      this.post({ id, status, body: bytes.buffer, name }, [bytes.buffer]);
    } catch (error) {
      // A trap of the engine, e.g. for want of memory.
      const reason = error instanceof Error ? error.message : String(error);
      this.post({ id, status: 500, body: textOf(`The program cannot be cut here: ${reason}`).buffer });
    }
  }

  private answer({ what, query, body }: Request): EngineAnswer & { name?: string } {
    const { engine } = this;
    const [kind, format = ''] = what.split('/');
    switch (kind) {
      case 'put':
      case 'drop':
        return this.take(query.name ?? '', new Uint8Array(body ?? new ArrayBuffer(0)), kind === 'drop');
      case 'model':
        return engine.model();
      case 'mesh':
        return withNumbers([query.since ?? '0'], ([since]) => engine.mesh(since!));
      case 'path':
        return withNumbers([query.since ?? '0'], ([since]) => engine.path(since!));
      case 'source':
        return withNumbers([query.id ?? ''], ([id]) => engine.source(id!));
      case 'exact':
        return engine.exact();
      case 'at':
        return withNumbers([query.step ?? '', query.from ?? String(FINAL)], ([step, from]) =>
          engine.at(step!, from!),
        );
      case 'download':
        return engine.download(format, query.post ?? '', query.view ?? '');
      default:
        return { status: NOT_FOUND, bytes: textOf(`There is no answer to ${what}`) };
    }
  }

  /** Stores a file, and shows it unless it is one that others include. */
  private take(name: string, bytes: Uint8Array, isShown: boolean): EngineAnswer {
    const stored = this.engine.put(name, bytes);
    if (stored.status !== FOUND || !isShown) return stored;
    const loaded = this.engine.load(name);
    const data = new TextDecoder().decode(loaded.bytes);
    this.post({ event: loaded.status === FOUND ? 'model' : 'errors', data });
    return { status: FOUND, bytes: textOf('{}') };
  }
}

function withNumbers(texts: string[], answer: (numbers: number[]) => EngineAnswer): EngineAnswer {
  const numbers = texts.map((text) => (/^\d{1,10}$/.test(text) ? Number(text) : NaN));
  if (numbers.every((n) => n <= FINAL)) return answer(numbers);
  return { status: BAD, bytes: textOf('Steps and revisions are whole numbers') };
}

function textOf(text: string): Uint8Array<ArrayBuffer> {
  return new TextEncoder().encode(text) as Uint8Array<ArrayBuffer>;
}
