// What the program has printed. A line that starts with its location, "part.scad:3: ...", leads there.
import { byId, linkButton } from '../dom';
import type { Origin } from '../protocol';

const LOCATION = /^(.+?):(\d+)(?::(\d+))?(?=: )/;
const LINKS = 2000; // of the last lines; the document stays small

export class ConsolePane {
  private readonly box = byId('console-text');

  constructor(
    private readonly toOrigin: (origin: Origin) => void,
    private readonly isShown: (origin: Origin) => boolean,
  ) {}

  show(printed: string): void {
    byId('tab-console').hidden = printed === '';
    const lines = printed.split('\n');
    const last = lines.splice(Math.max(lines.length - LINKS, 0));
    const before = lines.length > 0 ? `${lines.join('\n')}\n` : '';
    this.box.replaceChildren(before, ...last.flatMap((line, i) => this.parts(line, i === last.length - 1)));
  }

  private parts(line: string, isLast: boolean): (string | Node)[] {
    const end = isLast ? '' : '\n';
    const found = LOCATION.exec(line);
    if (!found) return [line + end];
    const origin = { file: found[1]!, line: Number(found[2]) };
    if (!this.isShown(origin)) return [line + end];
    return [linkButton(found[0], () => this.toOrigin(origin)), line.slice(found[0].length) + end];
  }
}
