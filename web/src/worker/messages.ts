// What the page and its worker send each other: the requests of PROTOCOL.md with their answers, and its
// events.

export interface Request {
  id: number;
  what: string;
  query: Record<string, string>;
  body: ArrayBuffer | null;
}

export interface Answer {
  id: number;
  /** As in HTTP; the body of an error is the reason as text. */
  status: number;
  body: ArrayBuffer;
  /** Of a file to be saved. */
  name?: string;
}

export interface Event {
  event: string;
  /** JSON. */
  data: string;
}

/** The engine is loaded, or why not. */
export interface Ready {
  ready: boolean;
  problem?: string;
}

export type FromWorker = Answer | Event | Ready;
