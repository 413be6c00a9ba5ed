// The text of one file, to be changed in the page: what is typed is cut after a short rest.
import { byId } from '../dom';

const REST = 120; // ms without a key
const MAX_TEXT = 1 << 21; // characters; longer texts make text fields slow

export class Editor {
  onText: (name: string, text: string) => void = () => {};
  /** The caret has been moved to another line by a click or a key. */
  onLine: (line: number) => void = () => {};
  private readonly box = byId('editor');
  private readonly area = byId<HTMLTextAreaElement>('editor-text');
  private readonly state = byId('editor-state');
  private name = '';
  private line = 1;
  private timer = 0;

  constructor() {
    this.area.addEventListener('input', () => {
      window.clearTimeout(this.timer);
      this.timer = window.setTimeout(() => this.onText(this.name, this.area.value), REST);
      this.line = this.caretLine();
    });
    this.area.addEventListener('click', () => this.caretMoved());
    this.area.addEventListener('keyup', (event) => {
      if (event.key.startsWith('Arrow') || event.key.startsWith('Page')) this.caretMoved();
    });
  }

  get isShown(): boolean {
    return !this.box.hidden;
  }

  hide(): void {
    this.box.hidden = true;
  }

  static takes(text: string | null, isComplete: boolean): boolean {
    return text !== null && isComplete && text.length <= MAX_TEXT;
  }

  /** Shows a text; one that is being typed stays. */
  show(name: string, text: string): void {
    this.box.hidden = false;
    const isTyping = name === this.name && document.activeElement === this.area;
    if (isTyping || (name === this.name && this.area.value === text)) return;
    window.clearTimeout(this.timer);
    if (name !== this.name) this.line = 1;
    this.name = name;
    this.area.value = text;
  }

  /** Selects a line and shows it. */
  select(line: number): void {
    const lines = this.area.value.split('\n');
    const index = Math.min(Math.max(line, 1), lines.length) - 1;
    const from = lines.slice(0, index).reduce((sum, text) => sum + text.length + 1, 0);
    this.area.setSelectionRange(from, from + lines[index]!.length);
    const height = this.area.scrollHeight / lines.length;
    this.area.scrollTop = Math.max(index * height - this.area.clientHeight / 2, 0);
    this.line = index + 1;
  }

  /** The first error, or nothing. */
  setProblem(text: string): void {
    if (this.state.textContent !== text) this.state.textContent = text;
    this.state.hidden = text === '';
  }

  private caretMoved(): void {
    const line = this.caretLine();
    if (line === this.line) return;
    this.line = line;
    this.onLine(line);
  }

  private caretLine(): number {
    return this.area.value.slice(0, this.area.selectionStart).split('\n').length;
  }
}
