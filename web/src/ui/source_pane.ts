// The source pane: the lines of one file, of which only the visible ones are in the document, so that files
// with hundreds of thousands of lines stay quick. A listbox for the keyboard: arrows move, Enter shows the
// motions.
import { byId, el, linkButton } from '../dom';
import type { Origin, SourceFile } from '../protocol';
import { locate, type Location } from '../program';
import { Editor } from './editor';
import { BlockLines, type BlockSource, linesOf, type SourceLines } from './source_lines';

const ROW = 20; // px, as in style.css
const EXTRA = 20;
const HIGHEST = 15_000_000; // px; browsers do not show higher elements
const MAX_SHOWN = 2000; // characters of a line; longer ones are cut, drawing them would take seconds

export class SourcePane {
  onPick: (where: Location) => void = () => {};
  /** The text of a file has been changed in the pane. */
  onText: (name: string, text: string) => void = () => {};
  private readonly list = byId('source-list');
  private readonly rows = el('div', { class: 'rows', role: 'presentation' });
  private readonly room = el('div', { 'aria-hidden': 'true' });
  private readonly choice = byId<HTMLSelectElement>('file');
  private readonly calls = byId('calls');
  private files: SourceFile[] = [];
  private lines: SourceLines = linesOf(undefined, undefined, () => {});
  private file = 0;
  private current = 1;
  private picked: Location[] = [];
  private running: Location | null = null;
  private errors: Location[] = [];
  private readonly editor: Editor | null;

  /** `isEditable`: texts are changed here, else only shown; `blockOf`: reads a block of a large text. */
  constructor(
    isEditable: boolean,
    private readonly blockOf?: BlockSource,
  ) {
    this.editor = isEditable ? new Editor() : null;
    if (this.editor) {
      this.editor.onText = (name, text) => this.onText(name, text);
      this.editor.onLine = (line) => this.onPick({ file: this.file, line });
    }
    this.list.append(this.room, this.rows);
    this.list.addEventListener('scroll', () => this.draw());
    this.list.addEventListener('keydown', (event) => this.onKey(event));
    this.list.addEventListener('click', (event) => {
      // By the position: the rows may have been drawn again since the button was pressed.
      const y = event.clientY - this.list.getBoundingClientRect().top + this.list.scrollTop + this.skipped;
      const line = Math.floor(y / ROW) + 1;
      if (line < 1 || line > this.lines.count) return;
      this.current = line;
      this.pickCurrent();
    });
    this.choice.addEventListener('change', () => this.open(Number(this.choice.value), 1));
    new ResizeObserver(() => this.draw()).observe(this.list);
  }

  setFiles(files: SourceFile[]): void {
    const open = this.files[this.file]?.path;
    this.files = files;
    this.choice.replaceChildren(...files.map((f, i) => el('option', { value: String(i) }, f.path)));
    this.choice.hidden = files.length < 2;
    const again = files.findIndex((f) => f.path === open);
    this.load(Math.max(again, 0));
    this.draw();
  }

  /** The location of a diagnostic in the files shown. */
  locate(origin: Origin | null | undefined): Location | null {
    return locate(this.files, origin);
  }

  path(file: number): string | undefined {
    return this.files[file]?.path;
  }

  /** Whether a text is being changed, so that nothing else should take its place. */
  get isEditing(): boolean {
    return this.editor?.isShown ?? false;
  }

  setErrors(errors: Location[], first = ''): void {
    this.errors = errors;
    this.editor?.setProblem(first);
    this.draw();
  }

  /** Marks lines, innermost first, and shows the first. */
  show(chain: Location[]): void {
    this.picked = chain;
    this.calls.hidden = chain.length < 2;
    this.calls.replaceChildren(
      ...chain.map((where, i) => {
        const name = `${this.files[where.file]?.path ?? '?'}:${where.line}`;
        return el(
          'li',
          {},
          i === 0 ? null : 'called by ',
          linkButton(name, () => this.open(where.file, where.line)),
        );
      }),
    );
    const first = chain[0];
    if (first) this.open(first.file, first.line);
    else this.draw();
  }

  /** Marks the line of the motion that runs, and scrolls to it. */
  setRunning(where: Location | null): void {
    if (where?.file === this.running?.file && where?.line === this.running?.line) return;
    this.running = where;
    if (where && where.file === this.file) this.reveal(where.line);
    this.draw();
  }

  /** Shows a line of a file. */
  open(file: number, line: number): void {
    if (file !== this.file) this.load(file);
    this.current = Math.min(Math.max(line, 1), Math.max(this.lines.count, 1));
    this.reveal(this.current);
    if (this.isEditing) this.editor!.select(this.current);
    this.draw();
  }

  private load(file: number): void {
    const found = this.files[file];
    this.file = file;
    const before = this.lines;
    const lines = linesOf(found, this.blockOf, () => {
      if (this.lines === lines) this.draw();
    });
    this.lines = lines;
    if (lines instanceof BlockLines) lines.takeFrom(before);
    this.choice.value = String(file);
    this.current = Math.min(this.current, lines.count);
    this.room.style.height = `${Math.min(lines.count * ROW, HIGHEST)}px`;
    const edits = this.editor !== null && found !== undefined && Editor.takes(found.text, found.complete);
    if (edits) this.editor!.show(found.path, found.text!);
    else this.editor?.hide();
    this.list.hidden = edits;
  }

  /** Pixels of lines for each pixel of the scroll bar: more than 1 where it would be too long. */
  private get scale(): number {
    const all = this.lines.count * ROW;
    const { clientHeight } = this.list;
    return all > HIGHEST ? (all - clientHeight) / (HIGHEST - clientHeight) : 1;
  }

  /** How many pixels of lines are above the shown ones in addition to those that are scrolled. */
  private get skipped(): number {
    return Math.round(this.list.scrollTop * (this.scale - 1));
  }

  private reveal(line: number): void {
    const top = (line - 1) * ROW;
    const { scrollTop, clientHeight } = this.list;
    const shown = scrollTop + this.skipped;
    if (top < shown || top + ROW > shown + clientHeight) {
      this.list.scrollTop = Math.max(top - clientHeight / 2, 0) / this.scale;
    }
  }

  private draw(): void {
    const { skipped } = this;
    const top = this.list.scrollTop + skipped;
    const first = Math.max(Math.floor(top / ROW) - EXTRA, 0);
    const last = Math.min(Math.ceil((top + this.list.clientHeight) / ROW) + EXTRA, this.lines.count);
    const rows: HTMLElement[] = [];
    for (let i = first; i < last; ++i) rows.push(this.row(i + 1));
    this.rows.style.top = `${first * ROW - skipped}px`;
    this.rows.replaceChildren(...rows);
    if (this.rows.querySelector(`#line-${this.current}`)) {
      this.list.setAttribute('aria-activedescendant', `line-${this.current}`);
    } else {
      this.list.removeAttribute('aria-activedescendant');
    }
  }

  private row(line: number): HTMLElement {
    const isHere = (where: Location | null | undefined) => where?.file === this.file && where.line === line;
    const isPicked = this.picked.some(isHere);
    const classes = ['row'];
    if (isPicked) classes.push('active');
    if (line === this.current) classes.push('current');
    if (isHere(this.running)) classes.push('running');
    if (this.errors.some(isHere)) classes.push('error');
    const text = this.lines.line(line - 1) ?? '';
    return el(
      'div',
      {
        class: classes.join(' '),
        id: `line-${line}`,
        role: 'option',
        'data-line': String(line),
        'aria-selected': String(isPicked),
        'aria-setsize': String(this.lines.count),
        'aria-posinset': String(line),
      },
      el('span', { class: 'number' }, String(line)),
      el('span', { class: 'text' }, text.length > MAX_SHOWN ? `${text.slice(0, MAX_SHOWN)} …` : text),
    );
  }

  private onKey(event: KeyboardEvent): void {
    const page = Math.max(Math.floor(this.list.clientHeight / ROW) - 1, 1);
    const moves: Record<string, number> = {
      ArrowDown: 1,
      ArrowUp: -1,
      PageDown: page,
      PageUp: -page,
      Home: -Infinity,
      End: Infinity,
    };
    if (event.key in moves) {
      const to = this.current + moves[event.key]!;
      this.open(this.file, Math.min(Math.max(to, 1), this.lines.count));
    } else if (event.key === 'Enter') {
      this.pickCurrent();
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }

  private pickCurrent(): void {
    const where = { file: this.file, line: this.current };
    this.show([where]);
    this.onPick(where);
  }
}
