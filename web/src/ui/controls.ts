// The toolbar and the keys: views, colours, what is shown, section, measuring, units, theme, downloads.
import { byId, el, linkButton } from '../dom';
import { length, type Unit } from '../format';
import type { ModelSource } from '../model_source';
import type { Program } from '../program';
import type { ProgressEvent } from '../protocol';
import { applies } from '../colours';
import { COLOURS, type ColourMode, type LayerName, type Settings } from '../settings';
import type { Section, Stage, ViewName } from '../view3d/stage';
import { VIEWS } from '../view3d/stage';
import type { Player } from './player';

export interface ControlActions {
  settingsChanged(): void;
  pickCentre(): void;
  /** To the next hazard in time (1), or the one before (-1). */
  toFinding(by: 1 | -1): void;
  measureChanged(): void;
  /** From distances to circles, and back. */
  measureWhat(): void;
  toggleChange(): void;
  sectionChanged(): void;
  clear(): void;
  open(): void;
  printSheet(): void;
  film(): void;
  /** A file that is made on request; `name` is for messages. */
  download(make: () => Promise<Response>, name: string): void;
}

const TURN = Math.PI / 24;
const SECTION_STEPS = 200;
const DOWNLOADS: [string, string][] = [
  ['download/stl', 'Mesh (STL)'],
  ['download/3mf', 'Mesh (3MF, colours)'],
  ['download/glb', 'Mesh (GLB, colours)'],
  ['download/png?view=iso', 'Picture (PNG)'],
  ['export', 'Page (HTML)'],
];

/** Keys, what they do (for the help table), and the action. */
type Key = [string[], string, () => void];

export class Controls {
  isMeasuring = false;
  private readonly keys: Key[];
  private readonly sectionBox = byId('section');
  private readonly sectionAxis = byId<HTMLSelectElement>('section-axis');
  private readonly sectionAt = byId<HTMLInputElement>('section-at');
  private program: Program | null = null;
  private unit: Unit = 'mm';
  private positions: (number | null)[] = [null, null, null];
  private hides: Section['hides'] = 'near';

  constructor(
    private readonly settings: Settings,
    private readonly stage: Stage,
    private readonly player: Player,
    private readonly source: ModelSource,
    private readonly actions: ControlActions,
  ) {
    this.keys = this.keyTable();
    this.listenToToolbar();
    this.listenToSection();
    this.listenToKeys();
    this.addDownloads();
  }

  // State of the elements.

  update(program: Program): void {
    const posts = this.program?.model.posts?.join();
    this.program = program;
    if (program.model.posts?.join() !== posts) this.addDownloads();
    // Hidden choices would be for nothing: a file without a target, fixtures or a known travel has none.
    for (const choice of byId<HTMLSelectElement>('colour').options)
      choice.hidden = choice.disabled = !applies(program, choice.value as ColourMode);
    const has = {
      fixtures: (program.model.fixtures ?? []).length > 0,
      machine: program.model.machine?.travel != null,
    };
    for (const [layer, isThere] of Object.entries(has))
      document.querySelector<HTMLElement>(`[data-layer="${layer}"]`)!.parentElement!.hidden = !isThere;
    this.showSection();
  }

  show(unit: Unit, colour: ColourMode): void {
    this.unit = unit;
    byId('units').textContent = unit === 'mm' ? 'mm' : 'inch';
    byId<HTMLSelectElement>('colour').value = colour;
    for (const box of document.querySelectorAll<HTMLInputElement>('[data-layer]')) {
      box.checked = this.settings.show[box.dataset.layer as LayerName];
    }
    byId('sizes').setAttribute('aria-pressed', String(this.settings.show.sizes));
    const theme = this.theme();
    document.documentElement.dataset.theme = theme;
    byId('theme').textContent = theme === 'dark' ? 'Light' : 'Dark';
    this.stage.setBackground(getComputedStyle(document.documentElement).getPropertyValue('--scene').trim());
    this.showSection();
  }

  progress(event: ProgressEvent | null): void {
    const bar = byId<HTMLProgressElement>('progress');
    bar.hidden = event === null;
    byId('stop').hidden = event === null || !this.source.stop;
    if (event?.fraction === null) bar.removeAttribute('value');
    else if (event) bar.value = event.fraction;
  }

  private theme(): 'light' | 'dark' {
    if (this.settings.theme !== 'auto') return this.settings.theme;
    return window.matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
  }

  // The toolbar.

  private listenToToolbar(): void {
    for (const view of [...VIEWS, 'fit'] as const) {
      const name = view[0]!.toUpperCase() + view.slice(1);
      const button = el('button', { type: 'button' }, name);
      button.addEventListener('click', () => this.turnTo(view));
      byId('views').append(button);
    }
    byId('colour').addEventListener('change', () => {
      const value = byId<HTMLSelectElement>('colour').value;
      this.settings.colour = COLOURS.find((c) => c === value) ?? 'tool';
      this.actions.settingsChanged();
    });
    for (const box of document.querySelectorAll<HTMLInputElement>('[data-layer]')) {
      box.addEventListener('change', () => {
        this.settings.show[box.dataset.layer as LayerName] = box.checked;
        this.actions.settingsChanged();
      });
    }
    byId('section-toggle').addEventListener('click', () => this.toggleSection());
    byId('measure').addEventListener('click', () => this.toggleMeasure());
    byId('sizes').addEventListener('click', () => this.toggleLayer('sizes'));
    byId('units').addEventListener('click', () => this.toggleUnits());
    byId('theme').addEventListener('click', () => this.toggleTheme());
    byId('stop').addEventListener('click', () => this.source.stop?.());
    byId('help-open').addEventListener('click', () => this.openHelp());
    window
      .matchMedia('(prefers-color-scheme: dark)')
      .addEventListener('change', () => this.actions.settingsChanged());
    for (const menu of document.querySelectorAll<HTMLDetailsElement>('.menu')) {
      menu.addEventListener('keydown', (event) => {
        if (event.key !== 'Escape' || !menu.open) return;
        menu.open = false;
        menu.querySelector('summary')!.focus();
        event.stopPropagation();
      });
      menu.addEventListener('focusout', (event) => {
        if (!menu.contains(event.relatedTarget as Node | null)) menu.open = false;
      });
    }
  }

  private turnTo(view: ViewName | 'fit'): void {
    if (view === 'fit') this.stage.fit();
    else this.stage.show(view);
  }

  private toggleUnits(): void {
    this.settings.units = this.unit === 'mm' ? 'inch' : 'mm';
    this.actions.settingsChanged();
  }

  private toggleLayer(layer: LayerName): void {
    this.settings.show[layer] = !this.settings.show[layer];
    this.actions.settingsChanged();
  }

  private toggleTheme(): void {
    this.settings.theme = this.theme() === 'dark' ? 'light' : 'dark';
    this.actions.settingsChanged();
  }

  private toggleMeasure(): void {
    this.isMeasuring = !this.isMeasuring;
    byId('measure').setAttribute('aria-pressed', String(this.isMeasuring));
    this.actions.measureChanged();
  }

  private measureWhat(): void {
    if (!this.isMeasuring) this.toggleMeasure();
    this.actions.measureWhat();
  }

  private addDownloads(): void {
    const links: HTMLElement[] = DOWNLOADS.flatMap(([what, text]) => {
      const make = this.source.download(what);
      return make ? [linkButton(text, () => this.actions.download(make, text))] : [];
    });
    const posts = this.program?.model.posts ?? ['grbl'];
    const gcode = (name: string) => this.source.download(`download/gcode?post=${name}`);
    if (gcode('grbl')) {
      const none = el('option', { value: '' }, 'Program for…');
      const choice = el('select', { 'aria-label': 'Program for' }, none);
      const made = posts.filter((name) => gcode(name));
      choice.append(...made.map((name) => el('option', { value: name }, name)));
      choice.addEventListener('change', () => {
        const make = choice.value ? gcode(choice.value) : null;
        if (make) this.actions.download(make, `the program for ${choice.value}`);
        choice.value = '';
      });
      links.push(choice);
    }
    const own = [
      linkButton('Setup sheet (print)', () => this.actions.printSheet()),
      linkButton('Film (WebM)', () => this.actions.film()),
    ];
    byId('downloads').replaceChildren(...links, ...own);
  }

  // The section plane.

  private listenToSection(): void {
    this.sectionAxis.addEventListener('change', () => this.showSection());
    this.sectionAt.addEventListener('input', () => {
      this.positions[this.axis] = Number(this.sectionAt.value);
      this.showSection();
    });
    byId('section-flip').addEventListener('click', () => this.flipSection());
  }

  private get axis(): 0 | 1 | 2 {
    return Number(this.sectionAxis.value) as 0 | 1 | 2;
  }

  private toggleSection(): void {
    this.sectionBox.hidden = !this.sectionBox.hidden;
    this.hides = 'near';
    byId('section-toggle').setAttribute('aria-pressed', String(!this.sectionBox.hidden));
    this.showSection();
    if (!this.sectionBox.hidden) this.sectionAt.focus();
  }

  /** Opens the section, or turns it from X to Y to Z. */
  private turnSection(): void {
    if (this.sectionBox.hidden) return this.toggleSection();
    this.sectionAxis.value = String((this.axis + 1) % 3);
    this.hides = 'near';
    this.showSection();
  }

  /** The other side is hidden, and stays so while the view turns. */
  private flipSection(): void {
    if (this.sectionBox.hidden) this.toggleSection();
    this.hides = this.stage.hiddenSide === 'high' ? 'low' : 'high';
    this.showSection();
  }

  private showSection(): void {
    const bounds = this.program?.model.bounds;
    if (this.sectionBox.hidden || !bounds) {
      this.stage.setSection(null);
      return;
    }
    const [low, high] = [bounds[0][this.axis], bounds[1][this.axis]];
    this.sectionAt.min = String(low);
    this.sectionAt.max = String(high);
    this.sectionAt.step = String((high - low) / SECTION_STEPS || 'any');
    const at = Math.min(Math.max(this.positions[this.axis] ?? (low + high) / 2, low), high);
    this.sectionAt.value = String(at);
    byId('section-text').textContent = length(at, this.unit);
    const kept = { near: 'far', low: 'upper', high: 'lower' }[this.hides];
    byId('section-flip').textContent = `Flip (${kept} side kept)`;
    this.stage.setSection({ axis: this.axis, at, hides: this.hides });
    this.actions.sectionChanged();
  }

  // Keys.

  private keyTable(): Key[] {
    const { stage, player } = this;
    const views: Key[] = VIEWS.map((view, i) => [[String(i + 1)], `${view} view`, () => stage.show(view)]);
    return [
      ...views,
      [['f', '0'], 'show the whole part', () => stage.fit()],
      [['+', '='], 'larger', () => stage.zoom(1.25)],
      [['-'], 'smaller', () => stage.zoom(0.8)],
      [[' '], 'play or pause', () => player.toggle()],
      [[','], 'one motion back', () => player.step(-1)],
      [['.'], 'one motion forward', () => player.step(1)],
      [['Home'], 'to the start', () => player.toStart()],
      [['End'], 'to the end', () => player.toEnd()],
      [['n'], 'next hazard, at its time', () => this.actions.toFinding(1)],
      [['b'], 'hazard before', () => this.actions.toFinding(-1)],
      [['e'], 'what the last save has changed', () => this.actions.toggleChange()],
      [['o'], 'open a file', () => this.actions.open()],
      [['x'], 'section plane', () => this.toggleSection()],
      [['s'], 'section along the next axis', () => this.turnSection()],
      [['r'], 'other side of the section', () => this.flipSection()],
      [['d'], 'sizes of stock and part', () => this.toggleLayer('sizes')],
      [['m'], 'distance between two points', () => this.toggleMeasure()],
      [['c'], 'measure a circle or a distance', () => this.measureWhat()],
      [['p'], 'pick the centre of the view', () => this.actions.pickCentre()],
      [['v'], 'perspective or parallel view', () => this.toggleLayer('perspective')],
      [['u'], 'mm or inch', () => this.toggleUnits()],
      [['l'], 'light or dark', () => this.toggleTheme()],
      [['Escape'], 'clear the selection', () => this.actions.clear()],
      [['?'], 'this list', () => this.openHelp()],
    ];
  }

  private listenToKeys(): void {
    document.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector('dialog[open]')) return;
      const target = event.target as HTMLElement;
      if (target === this.stage.canvas && this.turnByKey(event)) return event.preventDefault();
      if (usesKey(target, event.key)) return;
      const found = this.keys.find(([names]) =>
        names.includes(event.key.length === 1 ? event.key.toLowerCase() : event.key),
      );
      if (!found) return;
      event.preventDefault();
      found[2]();
    });
  }

  /** Arrow keys on the canvas turn the view, with Shift they move it. */
  private turnByKey(event: KeyboardEvent): boolean {
    const arrows: Record<string, [number, number]> = {
      ArrowLeft: [-1, 0],
      ArrowRight: [1, 0],
      ArrowUp: [0, 1],
      ArrowDown: [0, -1],
    };
    const by = arrows[event.key];
    if (!by) return false;
    if (event.shiftKey) this.stage.pan(0.06 * by[0], 0.06 * by[1]);
    else this.stage.orbit(TURN * by[0], -TURN * by[1]);
    return true;
  }

  private openHelp(): void {
    const rows = this.keys.map(([names, text]) => {
      const shown = names
        .map((n) => (n === ' ' ? 'Space' : n.length === 1 ? n.toUpperCase() : n))
        .join(' or ');
      return el('tr', {}, el('th', { scope: 'row' }, shown), el('td', {}, text));
    });
    rows.push(
      el(
        'tr',
        {},
        el('th', { scope: 'row' }, 'Arrows'),
        el('td', {}, 'turn the view when it has the focus; with Shift: move it'),
      ),
    );
    byId('keys').replaceChildren(el('tbody', {}, ...rows));
    const help = byId<HTMLDialogElement>('help');
    help.showModal();
    help.scrollTop = 0; // the button at the end has the focus
  }
}

/** Whether the focused element itself uses a key. */
function usesKey(target: HTMLElement, key: string): boolean {
  if (target.matches('select, textarea')) return key !== 'Escape';
  if (target.matches('input[type="range"]'))
    return ['Home', 'End', 'PageUp', 'PageDown'].includes(key) || key.startsWith('Arrow');
  return target.matches('button, summary, a, input') && (key === ' ' || key === 'Enter');
}
