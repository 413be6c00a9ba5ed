// Errors, hazards and warnings as a list; each entry leads to its source line, hazards also to their
// instant.
import { byId, el, linkButton } from '../dom';
import { type Unit, length } from '../format';
import type { Diagnostic, Finding, Model, Origin } from '../protocol';

export interface FindingActions {
  toOrigin(origin: Origin): void;
  toFinding(finding: Finding): void;
}

export class FindingsPane {
  private readonly pane = byId('problems');
  private readonly tab = byId('tab-problems');

  constructor(private readonly actions: FindingActions) {}

  update(model: Model | null, errors: readonly Diagnostic[], unit: Unit): void {
    const findings = model?.findings ?? [];
    const others = model?.diagnostics ?? [];
    const count = errors.length + findings.length + others.length;
    this.tab.textContent = count > 0 ? `Findings (${count})` : 'Findings';
    this.tab.classList.toggle('bad', errors.length + findings.length > 0);
    const parts: HTMLElement[] = [];
    if (errors.length > 0) {
      parts.push(el('h2', {}, 'Errors'));
      if (model) parts.push(el('p', { class: 'quiet' }, 'The part shown is the one before these errors.'));
      parts.push(list(errors.map((d) => this.diagnostic(d))));
    }
    if (findings.length > 0) {
      parts.push(el('h2', {}, 'Hazards'), list(findings.map((f) => this.finding(f, unit))));
    }
    if (others.length > 0) {
      parts.push(el('h2', {}, 'Warnings and notes'), list(others.map((d) => this.diagnostic(d))));
    }
    if (count === 0) parts.push(el('p', {}, model ? 'Nothing found.' : 'No part yet.'));
    this.pane.replaceChildren(...parts);
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
    return el(
      'li',
      {},
      el('span', { class: 'severity-hazard' }, `${f.kind.replaceAll('_', ' ')}: `),
      f.message,
      depth,
      f.hint ? el('div', { class: 'hint' }, f.hint) : null,
      el(
        'div',
        {},
        linkButton(where, () => this.actions.toFinding(f)),
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
  }
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
