// How the requests of PROTOCOL.md reach what makes the part: the server of `kerf view`, or a worker in this
// page.
import { answerOf } from './files';

export interface TransportListener {
  /** `data` is the JSON of an event. */
  event(name: string, data: string): void;
  /** Whether requests are answered; false until they are again. */
  connected(isConnected: boolean): void;
  /** Another run of the server answers: nothing of the page is its. */
  restarted(): void;
}

export type Query = Record<string, string>;

export interface Transport {
  listen(listener: TransportListener): void;
  /** Throws with the reason of an error. */
  get(what: string, query?: Query, how?: RequestInit): Promise<Response>;
  /** Stops the present work. */
  stop(): void;
  /** Whether a file is made for this request, e.g. "download/stl". */
  makes(what: string): boolean;
  /** Whether texts of the program can be changed in the page. */
  readonly isEditable: boolean;
}

export class ServerTransport implements Transport {
  readonly isEditable = false;
  private run: string | null = null; // of the server
  private listener: TransportListener | null = null;

  constructor(private readonly token: string) {}

  listen(listener: TransportListener): void {
    this.listener = listener;
    const events = new EventSource(this.address('events'));
    events.addEventListener('open', () => listener.connected(true));
    events.addEventListener('run', (e) => {
      this.isOwnRun((JSON.parse(String((e as MessageEvent).data)) as { run: string }).run);
    });
    events.addEventListener('error', () => listener.connected(false));
    for (const name of ['progress', 'errors', 'exact', 'model'])
      events.addEventListener(name, (e) => {
        if (e instanceof MessageEvent && !this.isAnothers) listener.event(name, String(e.data));
      });
  }

  async get(what: string, query: Query = {}, how: RequestInit = {}): Promise<Response> {
    const answer = await answerOf(this.address(what, query), how);
    if (this.isOwnRun(answer.headers.get('X-Kerf-Run'))) return answer;
    return new Promise(() => {}); // the page starts afresh
  }

  private isAnothers = false; // the server is that of another run

  /** The first run that answers is that of the page. */
  private isOwnRun(run: string | null): boolean {
    if (run === null || this.isAnothers) return !this.isAnothers;
    this.run ??= run;
    if (run === this.run) return true;
    this.isAnothers = true;
    this.listener?.restarted();
    return false;
  }

  stop(): void {
    void fetch(this.address('stop'), { method: 'POST' });
  }

  makes(): boolean {
    return true;
  }

  private address(what: string, query: Query = {}): string {
    const [name, own = ''] = what.split('?');
    const all = new URLSearchParams(own);
    all.set('t', this.token);
    for (const [key, value] of Object.entries(query)) all.set(key, value);
    return `/${name}?${all.toString()}`;
  }
}
