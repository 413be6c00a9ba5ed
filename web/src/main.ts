// Starts the page: finds where the model comes from and hands it to the application.
import './style.css';
import { App } from './app';
import { byId } from './dom';
import { ExportedSource, LiveSource, type ModelSource } from './model_source';
import { ServerTransport } from './transport';
import { WorkerTransport } from './worker/worker_transport';
import { NoWebGl } from './view3d/stage';

const FIRST = 'demo.nc'; // of the programs that come with the page without a server

function source(): ModelSource {
  if (ExportedSource.isHere()) return new ExportedSource();
  const query = new URLSearchParams(window.location.search);
  const src = query.get('src');
  const engine = document.getElementById('kerf-engine')?.textContent; // where there is no server
  if (!engine) return new LiveSource(new ServerTransport(query.get('t') ?? ''), src);
  return new LiveSource(new WorkerTransport(() => new Worker(engine)), src ?? FIRST);
}

function showFatal(text: string): void {
  const message = byId('message');
  message.textContent = text;
  message.hidden = false;
}

try {
  new App(source()).start();
} catch (error) {
  if (!(error instanceof NoWebGl)) throw error;
  showFatal(
    'This browser has no WebGL 2, which the picture of the part needs. Switch on hardware acceleration ' +
      'in the browser settings, or make a picture with: kerf simulate FILE -o part.png',
  );
}
