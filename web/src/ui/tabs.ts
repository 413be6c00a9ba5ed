// The tabs of the panel: arrow keys change the tab, as in the ARIA practices.
import { byId } from '../dom';

const NAMES = ['source', 'problems', 'report', 'console'] as const;
export type TabName = (typeof NAMES)[number];

export class Tabs {
  constructor() {
    for (const [i, name] of NAMES.entries()) {
      const tab = byId(`tab-${name}`);
      tab.addEventListener('click', () => this.show(name));
      tab.addEventListener('keydown', (event) => {
        const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        if (by === undefined) return;
        let at = i;
        do at = (at + by + NAMES.length) % NAMES.length;
        while (byId(`tab-${NAMES[at]!}`).hidden);
        const next = NAMES[at]!;
        this.show(next);
        byId(`tab-${next}`).focus();
        event.preventDefault();
        event.stopPropagation();
      });
    }
  }

  show(shown: TabName): void {
    for (const name of NAMES) {
      const tab = byId(`tab-${name}`);
      tab.setAttribute('aria-selected', String(name === shown));
      tab.tabIndex = name === shown ? 0 : -1;
      byId(name).hidden = name !== shown;
    }
  }
}
