// Opening other files: a list of those beside the program, a file of the user's choice, or one that is
// dropped anywhere on the page.
import { byId, el, linkButton } from '../dom';
import type { ModelSource } from '../model_source';

const SCRIPT = /\.py$/i;

export class Opening {
  private readonly dialog = byId<HTMLDialogElement>('open-dialog');
  private readonly names = byId('open-names');
  private readonly choice = byId<HTMLInputElement>('open-file');

  constructor(
    private readonly source: ModelSource,
    private readonly failed: (message: string) => void,
  ) {
    const button = byId('open');
    button.hidden = !source.upload;
    if (!source.upload) return;
    button.addEventListener('click', () => void this.show());
    this.choice.addEventListener('change', () => this.upload(this.choice.files));
    this.listenToDrops();
  }

  /** The list of files; nothing where no file can be opened. */
  async show(): Promise<void> {
    if (!this.source.upload || this.dialog.open) return;
    this.names.replaceChildren();
    this.choice.value = '';
    this.dialog.showModal();
    await this.attempt(async () => {
      const names = (await this.source.names?.()) ?? [];
      const buttons = names.map((name) =>
        el(
          'li',
          {},
          linkButton(name, () => {
            if (SCRIPT.test(name)) return this.ask(name);
            this.dialog.close();
            void this.attempt(async () => this.source.open?.(name));
          }),
        ),
      );
      this.names.replaceChildren(el('ul', { class: 'list' }, ...buttons));
    });
  }

  /** A script runs only after a second click, which says so. */
  private ask(name: string): void {
    const run = el('button', { type: 'button' }, `Run ${name}`);
    run.addEventListener('click', () => {
      this.dialog.close();
      void this.attempt(async () => this.source.open?.(name, true));
    });
    this.names.replaceChildren(
      el('p', {}, `${name} is a script. It runs with all your rights: it can read and change your files.`),
      el('p', {}, run),
    );
    run.focus();
  }

  private upload(files: FileList | null | undefined): void {
    const file = files?.[0];
    if (!file) return;
    this.dialog.close();
    void this.attempt(async () => this.source.upload!(file));
  }

  private listenToDrops(): void {
    const mark = (isOver: boolean) => document.body.classList.toggle('dropping', isOver);
    document.addEventListener('dragover', (event) => {
      event.preventDefault();
      mark(true);
    });
    document.addEventListener('dragleave', (event) => {
      if (event.relatedTarget === null) mark(false);
    });
    document.addEventListener('drop', (event) => {
      event.preventDefault();
      mark(false);
      this.upload(event.dataTransfer?.files);
    });
  }

  private async attempt(work: () => Promise<void>): Promise<void> {
    try {
      await work();
    } catch (error) {
      this.failed(error instanceof Error ? error.message : String(error));
    }
  }
}
