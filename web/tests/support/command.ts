// Runs the real `kerf view` on files in a folder of its own.
import { type ChildProcess, spawn, spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';

export const KERF = process.env.KERF ?? '../kerf';
export const EXAMPLES = join(process.env.KERF_SOURCE_DIR ?? '../..', 'examples');

/** A folder that is removed at the end. */
export class Folder {
  readonly path = mkdtempSync(join(tmpdir(), 'kerf-'));

  write(name: string, text: string | Uint8Array): string {
    const path = join(this.path, name);
    writeFileSync(path, text);
    return path;
  }

  copy(from: string, name: string): string {
    return this.write(name, readFileSync(from));
  }

  remove(): void {
    rmSync(this.path, { recursive: true, force: true });
  }
}

/** What the command prints with these arguments. */
export function kerf(...args: string[]): string {
  const done = spawnSync(KERF, args, { encoding: 'utf8' });
  if (done.status !== 0) throw new Error(`kerf ${args.join(' ')}: ${done.stderr}`);
  return done.stdout;
}

/** A running `kerf view`. */
export class ViewServer {
  private constructor(
    private readonly process: ChildProcess,
    readonly address: string,
  ) {}

  /**
   * Starts it and waits for its address. Columns of 0.5 mm, unless options differ, are few to draw; their
   * edges are made exact only with the option --exact, which the command does not have.
   */
  static async start(file: string, ...options: string[]): Promise<ViewServer> {
    const resolution = options.includes('--resolution') ? [] : ['--resolution', '0.5'];
    const edges = options.includes('--exact') ? [] : ['--columns'];
    const others = options.filter((option) => option !== '--exact');
    const child = spawn(KERF, ['view', file, '--json', ...resolution, ...edges, ...others], {
      stdio: ['ignore', 'pipe', 'inherit'],
    });
    const line = await new Promise<string>((done, failed) => {
      createInterface(child.stdout!).once('line', done);
      child.once('exit', (status) => failed(new Error(`kerf view ended with status ${status}`)));
    });
    return new ViewServer(child, (JSON.parse(line) as { address: string }).address);
  }

  get pid(): number {
    return this.process.pid!;
  }

  get(path: string): Promise<Response> {
    const url = new URL(this.address);
    const [name, query = ''] = path.split('?');
    return fetch(`${url.origin}/${name}?${query}&t=${url.searchParams.get('t')}`);
  }

  /** Ends it as Ctrl-C does; its exit status. */
  async end(): Promise<number | null> {
    if (this.process.exitCode !== null) return this.process.exitCode;
    const ended = new Promise<number | null>((done) => this.process.once('exit', done));
    this.process.kill('SIGINT');
    return ended;
  }
}
