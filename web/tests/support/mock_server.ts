// Serves the built page with a given model, for tests of what a real program cannot easily cause: damaged
// answers, hostile texts, a server that goes away.
import { readFileSync } from 'node:fs';
import { createServer, type Server, type ServerResponse } from 'node:http';
import type { AddressInfo } from 'node:net';
import { deflateSync } from 'node:zlib';
import type { Diagnostic, Model } from '../../src/protocol';
import { sampleMesh, sampleModel, samplePath, type SampleOptions } from './sample';

const NONCE = 'c2FtcGxl';
const POLICY =
  `default-src 'none'; script-src 'nonce-${NONCE}' 'wasm-unsafe-eval'; style-src 'nonce-${NONCE}'; ` +
  "img-src data: blob:; worker-src blob:; connect-src 'self'";

export function pageText(path = 'dist/index.html'): string {
  return readFileSync(path, 'utf8').replaceAll('KERF_NONCE', NONCE).replaceAll('KERF_FRAMES', '');
}

/** The page as an exported file. */
export function exportedPage(options: SampleOptions = {}): string {
  const block = (name: string, data: Uint8Array) =>
    `<script type="text/plain" id="kerf-${name}" data-encoding="deflate-base64" nonce="${NONCE}">` +
    `${Buffer.from(deflateSync(data)).toString('base64')}</script>`;
  const blocks = [
    block('model', Buffer.from(JSON.stringify(sampleModel(options)))),
    block('mesh', new Uint8Array(sampleMesh(options))),
    block('path', new Uint8Array(samplePath(options))),
  ];
  return pageText().replace('<!--KERF_DATA-->', () => blocks.join('\n'));
}

export class MockServer {
  options: SampleOptions = { revision: 1 };
  /** Replaces the answer of /mesh. */
  mesh: ArrayBuffer | null = null;
  changeModel: (model: Model) => void = () => {};
  readonly requests: string[] = [];
  private server: Server | null = null;
  private readonly listeners = new Set<ServerResponse>();

  async start(): Promise<string> {
    this.server = createServer((request, response) => this.answer(request.url ?? '/', response));
    await new Promise<void>((done) => this.server!.listen(0, '127.0.0.1', done));
    return `http://127.0.0.1:${(this.server.address() as AddressInfo).port}/?t=secret`;
  }

  async close(): Promise<void> {
    for (const listener of this.listeners) listener.end();
    this.server?.closeAllConnections();
    await new Promise((done) => this.server?.close(done));
  }

  send(name: string, data: unknown): void {
    for (const listener of this.listeners)
      listener.write(`event: ${name}\ndata: ${JSON.stringify(data)}\n\n`);
  }

  change(options: SampleOptions): void {
    this.options = { ...options, revision: (this.options.revision ?? 1) + 1 };
    this.send('model', { revision: this.options.revision, tiles: 6, reset: false, path: true });
  }

  fail(diagnostics: Diagnostic[]): void {
    this.send('errors', { revision: this.options.revision, diagnostics });
  }

  private answer(address: string, response: ServerResponse): void {
    const url = new URL(address, 'http://127.0.0.1');
    this.requests.push(url.pathname);
    const send = (type: string, body: string | ArrayBuffer) => {
      response.writeHead(200, {
        'Content-Type': type,
        'Content-Security-Policy': POLICY,
        'Cache-Control': 'no-store',
      });
      response.end(typeof body === 'string' ? body : Buffer.from(body));
    };
    switch (url.pathname) {
      case '/':
        return send('text/html; charset=utf-8', pageText());
      case '/model': {
        const model = sampleModel(this.options);
        this.changeModel(model);
        return send('application/json', JSON.stringify(model));
      }
      case '/mesh':
        return send('application/octet-stream', this.mesh ?? sampleMesh(this.options));
      case '/path':
        return send('application/octet-stream', samplePath(this.options));
      case '/at': {
        const steps = Number(url.searchParams.get('step'));
        return send('application/octet-stream', sampleMesh({ ...this.options, steps }));
      }
      case '/events': {
        response.writeHead(200, { 'Content-Type': 'text/event-stream', 'Cache-Control': 'no-store' });
        this.listeners.add(response);
        response.on('close', () => this.listeners.delete(response));
        response.write(
          `event: model\ndata: ${JSON.stringify({ revision: this.options.revision, tiles: 6 })}\n\n`,
        );
        return;
      }
      default:
        response.writeHead(404, { 'Content-Type': 'application/json' });
        response.end('{"error": "no such page"}');
    }
  }
}
