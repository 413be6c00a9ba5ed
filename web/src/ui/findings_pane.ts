// Errors, hazards and warnings as a list; each entry leads to its source line, hazards also to their
// instant.
import { byId, el, linkButton } from '../dom';
import { DRAWING_UNITS, type DrawingUnit, type Unit, length } from '../format';
import type { Diagnostic, Finding, Model, Origin } from '../protocol';

const NO_UNIT = '7121'; // of diagnostics: a drawing does not specify its unit

export interface FindingActions {
  toOrigin(origin: Origin): void;
  /** `text`: which of how many it is; empty: it was chosen itself. */
  toFinding(finding: Finding, text: string): void;
  /** The unit of drawings that specify none; missing where it cannot be chosen. */
  useUnit?(unit: DrawingUnit): void;
}

export class FindingsPane {
  private readonly pane = byId('problems');
  private readonly tab = byId('tab-problems');

  private inTime: Finding[] = [];
  private current: Finding | null = null;
  private items: [HTMLElement, Finding][] = [];

  constructor(private readonly actions: FindingActions) {}

  /** `failed`: the diagnostics of a load that failed; their notes are shown instead of the part's. */
  update(model: Model | null, failed: readonly Diagnostic[], unit: Unit): void {
    const errors = errorsAmong(failed);
    const findings = model?.findings ?? [];
    this.inTime = [...findings].sort((a, b) => (a.step ?? Infinity) - (b.step ?? Infinity));
    if (!this.current || !findings.includes(this.current)) this.current = null;
    const others = failed.length > 0 ? failed.filter((d) => !errors.includes(d)) : (model?.diagnostics ?? []);
    const count = errors.length + findings.length + others.length;
    this.tab.textContent = count > 0 ? `Findings (${count})` : 'Findings';
    this.tab.classList.toggle('bad', errors.length + findings.length > 0);
    const parts: HTMLElement[] = [];
    this.items = [];
    if (errors.length > 0) {
      parts.push(el('h2', {}, 'Errors'));
      if (model) parts.push(el('p', { class: 'quiet' }, 'The part shown is the one before these errors.'));
      parts.push(list(errors.map((d) => this.diagnostic(d))));
    }
    if (findings.length > 0) {
      const go = (text: string, by: 1 | -1, key: string) => {
        const button = el('button', { type: 'button', title: `${text} hazard (${key})` }, text);
        button.addEventListener('click', () => this.go(by));
        return button;
      };
      const buttons = el('div', { class: 'steps' }, go('Previous', -1, 'B'), go('Next', 1, 'N'));
      parts.push(el('h2', {}, 'Hazards'), buttons, list(findings.map((f) => this.finding(f, unit))));
    }
    if (others.length > 0) {
      parts.push(el('h2', {}, 'Warnings and notes'), list(others.map((d) => this.diagnostic(d))));
    }
    if (count === 0) parts.push(el('p', {}, model ? 'Nothing found.' : 'No part yet.'));
    this.pane.replaceChildren(...parts);
  }

  /** To the next hazard in time, or to the one before; from the last to the first. */
  go(by: 1 | -1): void {
    const count = this.inTime.length;
    if (count === 0) return;
    const now = this.current ? this.inTime.indexOf(this.current) : by > 0 ? -1 : 0;
    const index = (now + by + count) % count;
    const next = this.inTime[index]!;
    this.choose(next, `Hazard ${index + 1} of ${count}: ${next.kind.replaceAll('_', ' ')}`);
  }

  private choose(finding: Finding, text: string): void {
    this.current = finding;
    for (const [item, of] of this.items) setCurrent(item, of === finding);
    this.actions.toFinding(finding, text);
  }

  private diagnostic(d: Diagnostic): HTMLElement {
    const where = originText(d.origin);
    const origin = d.origin;
    return el(
      'li',
      {},
      el('span', { class: `severity-${severityClass(d.severity)}` }, `${d.severity}: `),
      d.message,
      d.hint ? el('div', { class: 'hint' }, d.hint) : null,
      unitChoice(d, this.actions.useUnit),
      where && origin
        ? el(
            'div',
            {},
            linkButton(where, () => this.actions.toOrigin(origin)),
          )
        : null,
    );
  }

  private finding(f: Finding, unit: Unit): HTMLElement {
    const where = originText(f.origin) ?? 'Show';
    const depth = f.depth_mm ? `, depth ${length(f.depth_mm, unit)}` : '';
    const item = el(
      'li',
      {},
      el('span', { class: 'severity-hazard' }, `${f.kind.replaceAll('_', ' ')}: `),
      f.message,
      depth,
      f.hint ? el('div', { class: 'hint' }, f.hint) : null,
      el(
        'div',
        {},
        linkButton(where, () => this.choose(f, '')),
      ),
      ...(f.callers ?? []).map((caller) =>
        el(
          'div',
          {},
          'called by ',
          linkButton(originText(caller) ?? '?', () => this.actions.toOrigin(caller)),
        ),
      ),
    );
    setCurrent(item, f === this.current);
    this.items.push([item, f]);
    return item;
  }
}

/** The errors among the diagnostics of a load that failed; all of them if none is marked as one. */
export function errorsAmong(failed: readonly Diagnostic[]): readonly Diagnostic[] {
  const errors = failed.filter((d) => d.severity === 'error');
  return errors.length > 0 ? errors : failed;
}

/** Buttons with the units of a drawing that does not specify its own; null for other errors. */
export function unitChoice(d: Diagnostic, use?: (unit: DrawingUnit) => void): HTMLElement | null {
  if (String(d.code) !== NO_UNIT || !use) return null;
  const button = (unit: DrawingUnit) => {
    const made = el('button', { type: 'button' }, unit);
    made.addEventListener('click', () => use(unit));
    return made;
  };
  return el('div', { class: 'steps' }, 'Its unit is ', ...DRAWING_UNITS.map(button));
}

function list(items: HTMLElement[]): HTMLElement {
  return el('ul', { class: 'list' }, ...items);
}

/** For a class name, so never the text itself. */
function severityClass(severity: string): string {
  return severity === 'error' || severity === 'warning' ? severity : 'note';
}

export function originText(origin: Origin | null | undefined): string | null {
  if (!origin) return null;
  const parts: string[] = [];
  if (origin.file) parts.push(origin.file);
  if (origin.line) parts.push(String(origin.line));
  if (origin.line && origin.column) parts.push(String(origin.column));
  let text = parts.join(':');
  if (origin.layer) text += `${text ? ', ' : ''}layer ${origin.layer}`;
  if (origin.handle) text += `${text ? ', ' : ''}entity ${origin.handle}`;
  if (origin.call) text += `${text ? ', ' : ''}${origin.call}`;
  return text || null;
}

function setCurrent(item: HTMLElement, isCurrent: boolean): void {
  if (isCurrent) item.setAttribute('aria-current', 'true');
  else item.removeAttribute('aria-current');
}
