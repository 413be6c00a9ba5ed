// Files for the user: what the server makes, and what the page makes itself.
import { el } from './dom';

/** Gives the bytes to the browser as a file. */
export function saveFile(bytes: Blob, name: string): void {
  const address = URL.createObjectURL(bytes);
  const link = el('a', { href: address, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  // The browser reads the address after this task.
  window.setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

/** The answer to a request; throws with the server's reason if it is an error. */
export async function answerOf(address: string, how: RequestInit = {}): Promise<Response> {
  const response = await fetch(address, how);
  if (response.ok) return response;
  const reason = await response.json().then(
    (b: { error?: string }) => b.error,
    () => undefined,
  );
  throw new Error(reason ?? `The server answered ${response.status}`);
}

/** Saves an answer as a file. */
export async function saveAnswer(response: Response): Promise<void> {
  const named = /filename="([^"]*)"/.exec(response.headers.get('Content-Disposition') ?? '');
  saveFile(await response.blob(), named?.[1] ?? 'part');
}

/** A name for a stored file, as file_name.h makes it: the paths of diagnostics are those of the page. */
export function fileName(name: string): string {
  const kept = name.slice(0, 100).replace(/[^A-Za-z0-9._-]/g, '_');
  return kept === '' || kept.startsWith('.') ? `_${kept}` : kept;
}
