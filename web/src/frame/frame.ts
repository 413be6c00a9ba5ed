// The viewer in a frame of another page: takes messages of that page and reports to it what happens. Only of
// and to pages that may see the program: those of the viewer's own address, and those whose origins its maker
// has allowed (kerf view --frame-in).
import {
  ACTIONS,
  type FrameAction,
  type FrameAnswer,
  type FrameEvent,
  idOf,
  type Problem,
  readRequest,
  VERSION,
} from './messages';

/** What the page does. Each returns or throws why it cannot. */
export interface FrameHost {
  /** Reports the present state. */
  hello(): void;
  /** Missing where programs are not loaded from texts. */
  load?: (name: string, text: string) => Promise<void>;
  line(line: number, file: string | undefined): Problem | null;
  colour(name: string): Problem | null;
  play(): Problem | null;
  stop(): void;
}

const NOT_ALLOWED: Problem = {
  error: 'messages of this origin are not taken',
  expected: 'a page of the same origin, or of one that was allowed when this page was made (--frame-in)',
};

type Event = FrameEvent extends infer E ? (E extends { kerf: unknown } ? Omit<E, 'kerf'> : never) : never;

/** The origins of a list in an attribute; other words are left out. */
export function originsIn(list: string): string[] {
  return list.split(/\s+/).filter((word) => /^https?:\/\/[a-z0-9.-]+(:\d{1,5})?$/.test(word));
}

/** Whether a page of this origin may use the one at `address`. */
export function isAllowed(origin: string, address: string, others: readonly string[]): boolean {
  const own = new URL(address);
  // No page of a server can have a file in a frame.
  if (own.protocol === 'file:') return origin === 'null' || origin === 'file://';
  return origin !== 'null' && (origin === own.origin || others.includes(origin));
}

export class Frame {
  private readonly outer: Window | null = window.parent === window ? null : window.parent;
  private readonly allowed = originsIn(
    document.querySelector<HTMLMetaElement>('meta[name="kerf-frames"]')?.content ?? '',
  );
  private host: FrameHost | null = null;
  private lastLine = '';

  listen(host: FrameHost): void {
    this.host = host;
    if (!this.outer) return;
    window.addEventListener('message', (event) => {
      if (event.source === this.outer) void this.receive(event.data, event.origin);
    });
  }

  get actions(): string[] {
    return ACTIONS.filter((name) => name !== 'load' || this.host?.load);
  }

  /** A line is shown; the same one again is no event. */
  line(file: string, line: number): void {
    const key = `${file}:${line}`;
    if (key === this.lastLine) return;
    this.lastLine = key;
    this.send({ event: 'line', file, line });
  }

  /** Reaches the outer page only if it is allowed: the browser compares the origins. */
  send(event: Event): void {
    if (!this.outer) return;
    for (const target of this.targets()) this.outer.postMessage({ kerf: VERSION, ...event }, target);
  }

  private targets(): string[] {
    const { href, protocol } = window.location;
    if (protocol === 'file:') return ['*'];
    const all = [new URL(href).origin, ...this.allowed].filter((origin) =>
      isAllowed(origin, href, this.allowed),
    );
    const known = window.location.ancestorOrigins?.[0]; // where the browser names it
    return known === undefined ? all : all.filter((origin) => origin === known);
  }

  private async receive(data: unknown, origin: string): Promise<void> {
    const id = idOf(data);
    // A page that must not see the program hears nothing of it.
    const problem = isAllowed(origin, window.location.href, this.allowed)
      ? await this.carryOut(data)
      : NOT_ALLOWED;
    const answer: FrameAnswer = { kerf: VERSION, id, ok: problem === null, ...problem };
    // The source is the outer page; pages without an origin can only be reached by "*".
    this.outer?.postMessage(answer, /^https?:/.test(origin) ? origin : '*');
  }

  private async carryOut(data: unknown): Promise<Problem | null> {
    const action = readRequest(data);
    if ('error' in action) return action;
    try {
      return await this.act(action);
    } catch (error) {
      const reason = error instanceof Error ? error.message : String(error);
      return { error: reason, expected: 'a program that is read' };
    }
  }

  private async act(action: FrameAction): Promise<Problem | null> {
    const host = this.host!;
    switch (action.do) {
      case 'hello':
        host.hello();
        return null;
      case 'load':
        if (!host.load)
          return { error: 'this page shows one program', expected: 'the page without a server' };
        await host.load(action.name, action.text);
        return null;
      case 'line':
        return host.line(action.line, action.file);
      case 'colour':
        return host.colour(action.colour);
      case 'play':
        return host.play();
      case 'stop':
        host.stop();
        return null;
    }
  }
}
