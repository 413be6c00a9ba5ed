// The worker of the page without a server: loads Kerf in WebAssembly and answers the page's requests.
import { Desk } from './desk';
import { engineOf, type Module } from './engine';
import type { FromWorker, Request } from './messages';

/** The worker's global object, as far as it is used; the types of pages describe windows. */
interface Worker {
  importScripts(...addresses: string[]): void;
  createKerf(options: { progress(phase: string, fraction: number): void }): Promise<Module>;
  postMessage(message: FromWorker, transfer?: ArrayBuffer[]): void;
  onmessage: ((event: MessageEvent<Request>) => void) | null;
}
const worker = self as unknown as Worker;
const post = (message: FromWorker, transfer: ArrayBuffer[] = []) => worker.postMessage(message, transfer);

async function start(): Promise<void> {
  worker.importScripts('kerf.js');
  const module = await worker.createKerf({
    progress: (phase, fraction) => post({ event: 'progress', data: JSON.stringify({ phase, fraction }) }),
  });
  const desk = new Desk(engineOf(module), post);
  worker.onmessage = (event) => desk.handle(event.data);
  post({ ready: true });
}

start().catch((error: unknown) => {
  post({ ready: false, problem: error instanceof Error ? error.message : String(error) });
});
