// Loads the part at the instant of the scrubber: one request at a time, always for the latest instant.
import { FINAL, type MeshAnswer } from './decode';
import type { ModelSource } from './model_source';

interface InstantView {
  readonly shownStep: number;
  updateInstant(answer: MeshAnswer): void;
  showFinished(): void;
}

export class InstantLoader {
  private wanted = FINAL;
  private isLoading = false;
  private generation = 0;

  constructor(
    private readonly source: ModelSource,
    private readonly view: InstantView,
    private readonly redraw: () => void,
    private readonly failed: (message: string) => void,
  ) {}

  /** Shows the part after `step` steps; FINAL: the finished part. */
  want(step: number): void {
    this.wanted = step;
    if (!this.isLoading) void this.load();
  }

  /** The tiles that are shown belong to the finished part of a new program. */
  modelChanged(): void {
    ++this.generation;
  }

  private async load(): Promise<void> {
    this.isLoading = true;
    try {
      while (this.wanted !== this.view.shownStep) {
        if (this.wanted === FINAL) {
          this.view.showFinished();
        } else {
          const generation = this.generation;
          const from = this.view.shownStep === FINAL ? null : this.view.shownStep;
          const request = this.source.instant(this.wanted, from);
          if (!request) break; // an exported page has only the finished part
          const answer = await request;
          if (generation !== this.generation) continue;
          // A number of steps at or after the end is answered as the finished part.
          if (answer.atStep === FINAL) {
            this.view.showFinished();
            this.redraw();
            break;
          }
          this.view.updateInstant(answer);
        }
        this.redraw();
      }
    } catch (error) {
      this.failed(error instanceof Error ? error.message : String(error));
    } finally {
      this.isLoading = false;
    }
  }
}
