// Where the model comes from: a server or a worker that follows a program, or the data inside an exported
// page.
import {
  type BurnAnswer,
  decodeBurn,
  decodeMesh,
  decodeTarget,
  type MeshAnswer,
  type TargetAnswer,
  type Tile,
  unpack,
} from './decode';
import type { ErrorsEvent, FailedProgram, Model, ModelEvent, ProgressEvent } from './protocol';
import { fileName } from './files';
import type { DrawingUnit } from './format';
import { decodePath, MissingBlock, type Path } from './path';
import { stlOf } from './stl';
import type { Query, Transport } from './transport';

export interface ModelListener {
  model(model: Model, mesh: MeshAnswer, path: Path | null, target: TargetAnswer | null): void;
  /** The part of a revision with exact edges. */
  exact(revision: number, mesh: MeshAnswer): void;
  /** `failed`: the program with the errors as it is now; null: not known. */
  errors(event: ErrorsEvent, failed: FailedProgram | null, printed?: string): void;
  progress(event: ProgressEvent): void;
  /** Whether the server answers; false until it does again. */
  connected(isConnected: boolean): void;
  failed(message: string): void;
  /** The text of a file that is opened, before it is read: it can be repaired even if it has errors. */
  opened?(name: string, text: string): void;
}

export interface ModelSource {
  start(listener: ModelListener): void;
  /** The part after `step` steps, or null if this source has only the finished part. */
  instant(step: number, from: number | null): Promise<MeshAnswer> | null;
  stop?(): void;
  /** The burn of a laser's program; throws with the reason if there is none. */
  burn(): Promise<BurnAnswer>;
  /** Reads drawings that specify no unit with this one; missing where that cannot be chosen. */
  useUnit?(unit: DrawingUnit): Promise<void>;
  /** The files beside the program that can be opened; missing where there are none. */
  names?(): Promise<string[]>;
  /** `mayRun`: a script may run with all rights of the user. */
  open?(name: string, mayRun?: boolean): Promise<void>;
  /** Shows a file of the user. */
  upload?(file: File): Promise<void>;
  /** The text of a block of a source; missing where all texts are whole. */
  block?(id: number): Promise<string>;
  /** Changes the text of a file of the program; missing where files are edited elsewhere. */
  edit?(name: string, text: string): Promise<void>;
  /** Makes a file, or null where it cannot be made. */
  download(what: string): (() => Promise<Response>) | null;
}

const NOT_NOW = 204;
const RETRY = 150; // ms

export class LiveSource implements ModelSource {
  private listener: ModelListener | null = null;
  private meshRevision = 0;
  private path: Path | null = null;
  private loading = false;
  private errorEvents = 0;
  private newestExact: MeshAnswer | null = null;
  private next: ModelEvent | null = null;
  private edited: { name: string; text: string } | null = null;
  private isSending = false;
  readonly edit?: (name: string, text: string) => Promise<void>;
  readonly useUnit?: (unit: DrawingUnit) => Promise<void>;

  /** `first`: a file beside the program to be shown instead of it. */
  constructor(
    private readonly transport: Transport,
    private readonly first: string | null = null,
  ) {
    if (transport.isEditable) this.edit = (name, text) => this.send(name, text);
    else this.useUnit = async (unit) => void (await this.get('unit', { unit }, { method: 'POST' }));
  }

  start(listener: ModelListener): void {
    this.listener = listener;
    this.transport.listen({
      connected: (isConnected) => listener.connected(isConnected),
      event: (name, data) => this.onEvent(name, data),
      restarted: () => window.location.reload(), // the page of that run may be another one, too
    });
    if (this.first !== null) this.open(this.first).catch((error: Error) => listener.failed(error.message));
  }

  private onEvent(name: string, data: string): void {
    if (name === 'progress') this.listener?.progress(JSON.parse(data) as ProgressEvent);
    if (name === 'errors') void this.onErrors(JSON.parse(data) as ErrorsEvent);
    if (name === 'exact') void this.loadExact();
    if (name === 'model') void this.load(JSON.parse(data) as ModelEvent);
  }

  /** A page opened while the program has an error still shows the last good part. */
  private async onErrors(event: ErrorsEvent): Promise<void> {
    if (event.revision > 0 && this.meshRevision === 0) await this.load({ revision: event.revision });
    const newest = ++this.errorEvents;
    const model = await this.get('model')
      .then((r) => r.json() as Promise<Model>)
      .catch(() => null);
    // A later state follows.
    if (newest !== this.errorEvents || (model?.input ?? 0) > (event.input ?? 0)) return;
    this.listener?.errors(event, model?.failed ?? null, model?.console);
  }

  /** Loads the newest state; what is announced meanwhile is loaded once afterwards. */
  private async load(event: ModelEvent): Promise<void> {
    if (this.loading) {
      this.next = { ...event, path: (event.path ?? true) || (this.next?.path ?? false) };
      return;
    }
    this.loading = true;
    try {
      await this.loadOnce(event);
    } catch (error) {
      this.listener?.failed(error instanceof Error ? error.message : String(error));
    } finally {
      this.loading = false;
    }
    const next = this.next;
    this.next = null;
    if (next) await this.load(next);
  }

  private async loadOnce(event: ModelEvent): Promise<void> {
    // After a restart of the server its revisions start over.
    const restarted = event.reset === true || event.revision < this.meshRevision;
    const since = restarted ? 0 : this.meshRevision;
    const before = restarted ? null : this.path;
    const wantsPath = !this.path || restarted || event.path !== false;
    const [model, mesh, motions] = await Promise.all([
      this.get('model').then((r) => r.json() as Promise<Model>),
      this.get('mesh', { since: String(since) }).then((r) => r.arrayBuffer()),
      wantsPath ? this.loadPath(before) : null,
    ]);
    if (model.protocol !== 1)
      throw new Error(`The server uses protocol ${model.protocol}; this page is for protocol 1`);
    const answer = decodeMesh(mesh);
    if (since === 0) answer.reset = true;
    this.meshRevision = answer.revision;
    this.path = motions ?? this.path;
    const target = model.target ? decodeTarget(await this.get('target').then((r) => r.arrayBuffer())) : null;
    this.listener?.model(model, answer, motions, target);
    const exact = this.newestExact; // may have arrived before the part
    this.newestExact = null;
    if (exact) this.listener?.exact(exact.revision, exact);
  }

  /** The blocks of the path that are not those of `before`. */
  private async loadPath(before: Path | null): Promise<Path> {
    const since = String(before?.revision ?? 0);
    const bytes = await this.get('path', { since }).then((r) => r.arrayBuffer());
    try {
      return decodePath(bytes, before);
    } catch (error) {
      if (before === null || !(error instanceof MissingBlock)) throw error;
      return this.loadPath(null);
    }
  }

  /** What is missing or late is only less sharp. */
  private async loadExact(): Promise<void> {
    const mesh = await this.get('exact')
      .then(async (r) => (r.status === NOT_NOW ? null : decodeMesh(await r.arrayBuffer())))
      .catch(() => null);
    if (!mesh) return;
    this.newestExact = mesh;
    if (!this.loading) this.listener?.exact(mesh.revision, mesh);
  }

  async block(id: number): Promise<string> {
    return (await this.get('source', { id: String(id) })).text();
  }

  async instant(step: number, from: number | null): Promise<MeshAnswer> {
    const query: Record<string, string> = { step: String(step) };
    if (from !== null) query.from = String(from);
    for (;;) {
      const answer = await this.get('at', query);
      if (answer.status !== NOT_NOW) return decodeMesh(await answer.arrayBuffer());
      await new Promise((done) => setTimeout(done, RETRY)); // the part is being cut
    }
  }

  stop(): void {
    this.transport.stop();
  }

  async burn(): Promise<BurnAnswer> {
    return decodeBurn(await (await this.get('download/burn')).arrayBuffer());
  }

  download(what: string): (() => Promise<Response>) | null {
    return this.transport.makes(what) ? () => this.get(what) : null;
  }

  async names(): Promise<string[]> {
    const answer = (await (await this.get('files')).json()) as { files: string[] };
    return answer.files;
  }

  async open(name: string, mayRun = false): Promise<void> {
    if (!this.transport.isEditable) {
      const query: Record<string, string> = { src: name };
      if (mayRun) query.run = 'yes';
      return void (await this.get('open', query, { method: 'POST' }));
    }
    await this.upload(new File([await (await this.get('program', { src: name })).blob()], name));
  }

  async upload(file: File): Promise<void> {
    if (this.transport.isEditable) this.listener?.opened?.(file.name, await file.text());
    const headers = { 'Content-Type': 'application/octet-stream' };
    await this.get('drop', { name: file.name }, { method: 'POST', body: file, headers });
  }

  /** Sends a text; while one is being cut, only the newest of the next ones is kept. */
  private async send(name: string, text: string): Promise<void> {
    this.edited = { name, text };
    if (this.isSending) return;
    this.isSending = true;
    try {
      while (this.edited) {
        const { name, text }: { name: string; text: string } = this.edited;
        this.edited = null;
        await this.get('drop', { name }, { method: 'POST', body: text });
      }
    } finally {
      this.isSending = false;
    }
  }

  private get(what: string, query: Query = {}, how: RequestInit = {}): Promise<Response> {
    return this.transport.get(what, query, how);
  }
}

/** As the server answers a download. */
function named(bytes: ArrayBuffer, name: string): Response {
  return new Response(bytes, { headers: { 'Content-Disposition': `attachment; filename="${name}"` } });
}

/** The data blocks of an exported page. */
export class ExportedSource implements ModelSource {
  private readonly instants: { step: number; tiles: Map<number, Tile> }[] = [];
  private last: Map<number, Tile> | null = null; // of the instant that was asked for last
  private mesh: MeshAnswer | null = null;
  private name = '';

  static isHere(): boolean {
    return document.getElementById('kerf-model') !== null;
  }

  start(listener: ModelListener): void {
    void this.load(listener);
  }

  private async load(listener: ModelListener): Promise<void> {
    try {
      const [model, mesh, path] = await Promise.all(
        ['model', 'mesh', 'path'].map((name) => {
          const block = document.getElementById(`kerf-${name}`);
          if (!block) throw new Error(`This file does not contain its ${name}: it is incomplete`);
          return unpack(block.textContent ?? '');
        }),
      );
      const parsed = JSON.parse(new TextDecoder().decode(model)) as Model;
      const target = document.getElementById('kerf-target');
      const instants = document.getElementById('kerf-instants');
      if (instants) this.readInstants(await unpack(instants.textContent ?? ''));
      this.name = parsed.name;
      this.mesh = decodeMesh(mesh!);
      const compared = target ? decodeTarget(await unpack(target.textContent ?? '')) : null;
      listener.model(parsed, this.mesh, decodePath(path!), compared);
    } catch (error) {
      listener.failed(error instanceof Error ? error.message : String(error));
    }
  }

  /** The part of the nearest instant that the file has. */
  instant(step: number, from: number | null): Promise<MeshAnswer> | null {
    if (this.instants.length === 0) return null;
    let k = 0;
    while (k + 1 < this.instants.length && this.instants[k + 1]!.step <= step) ++k;
    const { tiles } = this.instants[k]!;
    const before = from === null ? null : this.last;
    this.last = tiles;
    const changed = [...tiles.values()].filter((tile) => before?.get(tile.id) !== tile);
    return Promise.resolve({
      revision: 0,
      reset: false,
      atStep: step,
      renumberings: [],
      tiles: changed,
    });
  }

  async burn(): Promise<BurnAnswer> {
    const block = document.getElementById('kerf-burn');
    if (!block) throw new Error('This file does not contain the burn');
    return decodeBurn(await unpack(block.textContent ?? ''));
  }

  private readInstants(bytes: ArrayBuffer): void {
    const view = new DataView(bytes);
    let tiles = new Map<number, Tile>();
    for (let at = 0; at + 4 <= bytes.byteLength; ) {
      const length = view.getUint32(at, true);
      const answer = decodeMesh(bytes.slice(at + 4, at + 4 + length));
      tiles = new Map(tiles);
      for (const tile of answer.tiles) tiles.set(tile.id, tile);
      this.instants.push({ step: answer.atStep, tiles });
      at += 4 + length;
    }
  }

  download(what: string): (() => Promise<Response>) | null {
    if (what === 'download/stl')
      return () => Promise.resolve(named(stlOf(this.mesh?.tiles ?? []), `${this.stem}.stl`));
    const gcode = document.getElementById('kerf-gcode');
    if (what !== 'download/gcode?post=grbl' || !gcode) return null;
    return async () => named(await unpack(gcode.textContent ?? ''), `${this.stem}.nc`);
  }

  private get stem(): string {
    return fileName(this.name.replace(/\.[^.]*$/, ''));
  }
}
