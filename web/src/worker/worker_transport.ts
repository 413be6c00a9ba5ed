// The page's side of its worker. Stopping ends the worker, as nothing else interrupts WebAssembly without
// threads; a new one gets the files again.
import { fileName } from '../files';
import type { Query, Transport, TransportListener } from '../transport';
import type { Answer, FromWorker, Request } from './messages';

/** What is used of a Worker. */
export interface Channel {
  postMessage(message: Request, transfer: Transferable[]): void;
  terminate(): void;
  onmessage: ((event: MessageEvent<FromWorker>) => void) | null;
  onerror: ((event: ErrorEvent) => void) | null;
}

interface Waiting {
  done(answer: Response): void;
  failed(error: Error): void;
}

const NO_CONTENT = 204;

export class WorkerTransport implements Transport {
  readonly isEditable = true;
  private listener: TransportListener | null = null;
  private channel: Channel | null = null;
  private unsent: [Request, Transferable[]][] = [];
  private isReady = false;
  private isNew = true; // its revisions start over
  private lastId = 0;
  private readonly waiting = new Map<number, Waiting>();
  private readonly files = new Map<string, ArrayBuffer>();

  /** `programs`: the folder of the programs that come with the page. */
  constructor(
    private readonly startWorker: () => Channel,
    private readonly programs = 'programs',
    private readonly fetchFile: (address: string) => Promise<Response> = (address) => fetch(address),
  ) {}

  listen(listener: TransportListener): void {
    this.listener = listener;
    this.begin();
  }

  async get(what: string, query: Query = {}, how: RequestInit = {}): Promise<Response> {
    const [path, own = ''] = what.split('?');
    const all = { ...Object.fromEntries(new URLSearchParams(own)), ...query };
    if (path === 'files') return this.load('index.json');
    if (path === 'program') return this.load(all.src ?? '');
    if (path !== 'drop') return this.ask(path!, all, null);
    const body = await new Response(how.body).arrayBuffer();
    const name = fileName(all.name ?? '');
    this.files.set(name, body.slice(0));
    return this.ask('drop', { name }, body);
  }

  stop(): void {
    this.channel?.terminate();
    for (const { failed } of this.waiting.values()) failed(new Error('stopped'));
    this.waiting.clear();
    this.unsent = [];
    this.begin();
    for (const [name, bytes] of this.files)
      this.ask('put', { name }, bytes.slice(0)).catch(() => {}); // too large: refused before
  }

  makes(what: string): boolean {
    return /^download\/(stl|3mf|glb|obj|gcode)\b/.test(what);
  }

  private begin(): void {
    this.isReady = false;
    this.isNew = true;
    const channel = this.startWorker();
    this.channel = channel;
    channel.onmessage = (event) => this.receive(event.data);
    channel.onerror = (event) => this.lost(event.message || 'the worker of the page cannot be loaded');
  }

  private async load(name: string): Promise<Response> {
    const answer = await this.fetchFile(`${this.programs}/${encodeURIComponent(name)}`);
    if (!answer.ok) throw new Error(`There is no program ${name}`);
    return answer;
  }

  private ask(what: string, query: Query, body: ArrayBuffer | null): Promise<Response> {
    const id = ++this.lastId;
    const answered = new Promise<Response>((done, failed) => this.waiting.set(id, { done, failed }));
    const message: [Request, Transferable[]] = [{ id, what, query, body }, body ? [body] : []];
    if (this.isReady) this.channel!.postMessage(...message);
    else this.unsent.push(message);
    return answered;
  }

  private receive(message: FromWorker): void {
    if ('id' in message) return this.answered(message);
    if ('event' in message) return this.announced(message.event, message.data);
    if (!message.ready) return this.lost(message.problem ?? 'Kerf cannot be loaded');
    this.isReady = true;
    this.listener?.connected(true);
    const messages = this.unsent;
    this.unsent = [];
    for (const unsent of messages) this.channel!.postMessage(...unsent);
  }

  private announced(event: string, data: string): void {
    if (event !== 'model' || !this.isNew) return this.listener?.event(event, data);
    this.isNew = false;
    const model = JSON.parse(data) as Record<string, unknown>;
    this.listener?.event(event, JSON.stringify({ ...model, reset: true }));
  }

  private answered({ id, status, body, name }: Answer): void {
    const found = this.waiting.get(id);
    this.waiting.delete(id);
    if (!found) return;
    if (status >= 400) return found.failed(new Error(new TextDecoder().decode(body)));
    const headers: Record<string, string> = name ? { 'Content-Disposition': `filename="${name}"` } : {};
    found.done(new Response(status === NO_CONTENT ? null : body, { status, headers }));
  }

  /** Requests fail that wait, and later ones never arrive. */
  private lost(reason: string): void {
    this.listener?.connected(false);
    for (const { failed } of this.waiting.values()) failed(new Error(reason));
    this.waiting.clear();
  }
}
