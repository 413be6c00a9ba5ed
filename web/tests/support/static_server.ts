// Serves the files of one folder, as any server of static files does.
import { readFile } from 'node:fs/promises';
import { createServer, type Server } from 'node:http';
import type { AddressInfo } from 'node:net';
import { extname, join, normalize } from 'node:path';

const TYPES: Record<string, string> = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript',
  '.json': 'application/json',
  '.wasm': 'application/wasm',
};

export class StaticServer {
  private constructor(
    private readonly server: Server,
    readonly address: string,
  ) {}

  /** `pages`: further pages by their names, which precede files. */
  static async start(folder: string, pages: Record<string, string> = {}): Promise<StaticServer> {
    const server = createServer((request, response) => {
      const { pathname } = new URL(request.url ?? '/', 'http://localhost');
      const name = normalize(pathname === '/' ? '/index.html' : decodeURIComponent(pathname));
      const page = pages[name.slice(1)];
      if (page !== undefined)
        return void response.writeHead(200, { 'Content-Type': TYPES['.html'] }).end(page);
      readFile(join(folder, name)).then(
        (bytes) =>
          response.writeHead(200, { 'Content-Type': TYPES[extname(name)] ?? 'text/plain' }).end(bytes),
        () => response.writeHead(404).end(),
      );
    });
    await new Promise<void>((done) => server.listen(0, '127.0.0.1', done));
    return new StaticServer(server, `http://127.0.0.1:${(server.address() as AddressInfo).port}/`);
  }

  async end(): Promise<void> {
    this.server.closeAllConnections();
    await new Promise((done) => this.server.close(done));
  }
}
