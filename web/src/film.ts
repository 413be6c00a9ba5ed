// A film of the cut as WebM: the canvas is recorded while the job plays.
const RATE = 30; // frames a second
const TYPES = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm'];

export class Film {
  private readonly recorder: MediaRecorder;
  private readonly parts: Blob[] = [];

  /** Null: this browser cannot record. */
  static start(canvas: HTMLCanvasElement): Film | null {
    if (typeof MediaRecorder === 'undefined' || !canvas.captureStream) return null;
    const type = TYPES.find((t) => MediaRecorder.isTypeSupported(t));
    return type ? new Film(canvas, type) : null;
  }

  private constructor(canvas: HTMLCanvasElement, type: string) {
    this.recorder = new MediaRecorder(canvas.captureStream(RATE), { mimeType: type });
    this.recorder.addEventListener('dataavailable', (event) => this.parts.push(event.data));
    this.recorder.start();
  }

  /** Ends the recording. */
  finish(): Promise<Blob> {
    return new Promise((done) => {
      this.recorder.addEventListener('stop', () => done(new Blob(this.parts, { type: 'video/webm' })));
      this.recorder.stop();
      for (const track of this.recorder.stream.getTracks()) track.stop();
    });
  }
}
