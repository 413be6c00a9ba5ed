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

/** Saves an answer of the server as a file; throws with the server's reason if it is none. */
export async function downloadFile(address: string): Promise<void> {
  const response = await answerOf(address);
  const named = /filename="([^"]*)"/.exec(response.headers.get('Content-Disposition') ?? '');
  saveFile(await response.blob(), named?.[1] ?? 'part');
}
