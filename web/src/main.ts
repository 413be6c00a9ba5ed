// Starts the page: finds where the model comes from and hands it to the application.
import './style.css';
import { App } from './app';
import { byId } from './dom';
import { ExportedSource, type ModelSource, ServerSource } from './model_source';
import { NoWebGl } from './view3d/stage';

function source(): ModelSource {
  if (ExportedSource.isHere()) return new ExportedSource();
  const query = new URLSearchParams(window.location.search);
  return new ServerSource(query.get('t') ?? '', query.get('src'));
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
