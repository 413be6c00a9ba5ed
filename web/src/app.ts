// The application: connects the model, the picture and the panes.
import { applies, isContact } from './colours';
import { FINAL, type MeshAnswer, NO_STEP, type TargetAnswer } from './decode';
import { byId } from './dom';
import { fileName, saveAnswer, saveFile } from './files';
import { Film } from './film';
import { Frame, type FrameHost } from './frame/frame';
import type { Problem } from './frame/messages';
import { type DrawingUnit, length, lengthNumber, type Unit } from './format';
import { InstantLoader } from './instant_loader';
import type { ModelListener, ModelSource } from './model_source';
import type { Path } from './path';
import { type Location, Program } from './program';
import type {
  Diagnostic,
  ErrorsEvent,
  FailedProgram,
  Finding,
  Model,
  Origin,
  ProgressEvent,
} from './protocol';
import { Scene } from './scene';
import { type ColourMode, COLOURS, Memory, type Settings } from './settings';
import { ConsolePane } from './ui/console_pane';
import { Controls } from './ui/controls';
import { errorsAmong, FindingsPane, originText, unitChoice } from './ui/findings_pane';
import { LayerSlider } from './ui/layer_slider';
import { Legend } from './ui/legend';
import { Measure } from './ui/measure';
import { HintBox } from './ui/measure_hint';
import { Opening } from './ui/opening';
import { Player } from './ui/player';
import { ReportPane } from './ui/report_pane';
import { printSheet } from './ui/sheet';
import { SourcePane } from './ui/source_pane';
import { Tabs } from './ui/tabs';

const SHORTEST_FILM = 2; // s
const LAST_PICTURE = 400; // ms that a film stays at its end
const BEFORE_END = 1e-6; // s
const STOPPABLE = 400; // ms
const GREYED = 200; // ms of work, after which the part is shown as the old one
const FINDINGS_SENT = 1000; // to the page around a frame
const CLICK_REACH = 4; // CSS pixels between pressing and releasing; more is a turn of the view

export class App implements ModelListener {
  private readonly memory = new Memory();
  private readonly settings: Settings = this.memory.settings();
  private readonly scene = new Scene(byId<HTMLCanvasElement>('canvas'));
  private readonly tabs = new Tabs();
  private readonly sources: SourcePane;
  private readonly report = new ReportPane();
  private readonly legend = new Legend();
  private readonly layers = new LayerSlider((time) => this.seek(time));
  private readonly player = new Player(this.settings.speed);
  private readonly controls: Controls;
  private readonly instants: InstantLoader;
  private readonly opening: Opening;
  private readonly findings: FindingsPane;
  private readonly console = new ConsolePane(
    (origin) => this.toOrigin(origin),
    (origin) => this.sources.locate(origin) !== null,
  );
  private readonly frame = new Frame();
  private program: Program | null = null;
  /** What the load that failed has found, its notes and warnings too; empty: it has not failed. */
  private errorList: Diagnostic[] = [];
  private readonly measure = new Measure(this.scene.marks, () => this.scene.stage.draw());
  private readonly hint = new HintBox(this.scene.marks, () => this.scene.stage.draw());
  private announced = 0; // changes of the files that the server has noticed
  private isWorking = false;
  private burning: Program | null = null; // its burn is being made
  private colourBefore: ColourMode = 'tool'; // that by the last save
  private greying = 0;

  constructor(private readonly source: ModelSource) {
    this.sources = new SourcePane(source.edit !== undefined, source.block?.bind(source));
    this.findings = new FindingsPane({
      toOrigin: (origin) => this.toOrigin(origin),
      toFinding: (finding, text) => this.toFinding(finding, text),
      useUnit: this.useUnit,
    });
    this.sources.onText = (name, text) => void this.edit(name, text);
    this.instants = new InstantLoader(
      source,
      this.scene.part,
      () => this.instantChanged(),
      (m) => this.failed(m),
    );
    this.opening = new Opening(source, (m) => this.failed(m));
    this.controls = new Controls(this.settings, this.scene.stage, this.player, source, {
      settingsChanged: () => this.settingsChanged(),
      pickCentre: () => this.pickCentre(),
      toFinding: (by) => this.findings.go(by),
      measureChanged: () => {
        this.hint.hide();
        this.measure.clear(this.controls.isMeasuring);
      },
      toggleChange: () => this.toggleChange(),
      measureWhat: () => this.measure.toggleWhat(),
      sectionChanged: () => this.scene.stage.draw(),
      clear: () => this.clearSelection(),
      open: () => void this.opening.show(),
      printSheet: () => void this.printSheet(),
      film: () => void this.film(),
      download: (make, name) => void this.download(make, name),
    });
  }

  start(): void {
    this.player.onTime = () => this.showInstant();
    this.player.onSpeed = (speed) => {
      this.settings.speed = speed;
      this.memory.saveSettings(this.settings);
    };
    this.sources.onPick = (where) => this.selectLine(where);
    this.legend.onFilter = () => this.scene.hideBeads(this.legend.hidden);
    this.scene.onFade = () => this.showLegend();
    this.listenToPointer();
    let saving = 0;
    this.scene.stage.onViewChanged = () => {
      window.clearTimeout(saving);
      saving = window.setTimeout(() => this.saveView(), 300);
    };
    window.addEventListener('pagehide', () => this.saveView());
    this.settingsChanged();
    this.setState('Loading…', false);
    this.frame.listen(this.frameHost());
    this.source.start(this);
  }

  private get useUnit(): ((unit: DrawingUnit) => void) | undefined {
    const { source } = this;
    if (!source.useUnit) return undefined;
    return (unit) => {
      source.useUnit!(unit).catch((error: Error) => this.failed(error.message));
    };
  }

  get unit(): Unit {
    if (this.settings.units !== 'auto') return this.settings.units;
    return this.program?.model.units === 'inch' ? 'inch' : 'mm';
  }

  // What the source of the model reports.

  model(model: Model, mesh: MeshAnswer, path: Path | null, target: TargetAnswer | null): void {
    const isFirst = this.program === null || this.program.model.name !== model.name;
    const motions = path ?? this.program?.path;
    if (!motions) return this.failed('The toolpath is missing');
    const program = new Program(model, motions);
    this.program = program;
    this.errorList = model.errors;
    this.workEnded(model.input);
    byId('message').hidden = true;
    byId('name').textContent = model.name;
    document.title = `${model.name} - Kerf`;
    this.scene.update(program, mesh, target, this.colour);
    this.layers.update(program);
    if (isFirst) this.firstView(program);
    this.controls.update(program);
    this.player.update(program);
    this.instants.modelChanged();
    this.sources.setFiles(model.files);
    this.console.show(model.console ?? '');
    this.settingsChanged();
    this.showErrors();
    this.showInstant();
    document.documentElement.dataset.revision = String(model.revision);
    this.reportToFrame();
  }

  exact(revision: number, mesh: MeshAnswer): void {
    if (this.program?.model.revision !== revision) return;
    this.scene.part.setExact(mesh);
    this.scene.stage.draw();
    document.documentElement.dataset.exact = String(revision);
  }

  errors(event: ErrorsEvent, failed: FailedProgram | null, printed?: string): void {
    this.errorList = event.diagnostics;
    this.workEnded(event.input);
    this.frame.send({ event: 'errors', diagnostics: event.diagnostics });
    if (failed && !this.sources.isEditing) {
      this.sources.setFiles(failed.files);
      this.console.show(printed ?? '');
      byId('name').textContent = failed.name;
      document.title = `${failed.name} - Kerf`;
    }
    this.showErrors();
    if (!this.program && this.errorList.length > 0) this.showFirstError();
    // Without a part the first error is beside the source, which is shown at its line.
    if (event.diagnostics.length > 0 && !this.sources.isEditing)
      this.tabs.show(this.program ? 'problems' : 'source');
  }

  progress(event: ProgressEvent): void {
    this.announced = Math.max(this.announced, event.input ?? 0);
    this.controls.progress(event);
    this.setState(`${event.phase}…`, false);
    if (this.isWorking) return;
    this.isWorking = true;
    byId('message').hidden = true;
    this.greying = window.setTimeout(() => byId('stage').classList.add('working'), GREYED);
  }

  /** Something of the files as they were after `input` changes is there; newer work may continue. */
  private workEnded(input: number | undefined): void {
    if ((input ?? 0) < this.announced) return;
    this.isWorking = false;
    window.clearTimeout(this.greying);
    byId('stage').classList.remove('working');
    this.controls.progress(null);
  }

  connected(isConnected: boolean): void {
    byId('stage').classList.toggle('lost', !isConnected);
    if (!isConnected) this.setState('Not connected to kerf view', true);
    else if (this.program) this.showErrors();
  }

  /** There is no part that could be shown. */
  private showFirstError(): void {
    const first = errorsAmong(this.errorList)[0]!;
    const where = originText(first.origin);
    this.showMessage(`${where ? `${where}: ` : ''}${first.message}${first.hint ? ` (${first.hint})` : ''}`);
    const line = this.sources.locate(first.origin);
    if (line) this.sources.show([line]);
    const choice = unitChoice(first, this.useUnit);
    if (choice) byId('message').append(choice);
  }

  failed(message: string): void {
    this.setState(message, true);
    if (!this.program) this.showMessage(message);
  }

  private showMessage(message: string): void {
    const box = byId('message');
    box.textContent = message;
    box.hidden = false;
  }

  /** Its text can be repaired even if it cannot be read. */
  opened(name: string, text: string): void {
    this.sources.setFiles([{ path: fileName(name), text, complete: true }]);
    this.tabs.show('source');
  }

  private async edit(name: string, text: string): Promise<void> {
    // Work that takes longer can be stopped.
    const timer = window.setTimeout(() => this.progress({ phase: 'working', fraction: null }), STOPPABLE);
    try {
      await this.source.edit?.(name, text);
    } catch (error) {
      this.controls.progress(null);
      this.failed(error instanceof Error ? error.message : String(error));
    } finally {
      window.clearTimeout(timer);
    }
  }

  private showErrors(): void {
    const errors = errorsAmong(this.errorList);
    const hasErrors = errors.length > 0;
    byId('stage').classList.toggle('outdated', hasErrors && this.program !== null);
    this.findings.update(this.program?.model ?? null, this.errorList, this.unit);
    const lines = errors.map((d) => this.sources.locate(d.origin)).filter((l): l is Location => !!l);
    const first = errors[0];
    this.sources.setErrors(lines, first ? `${originText(first.origin) ?? 'error'}: ${first.message}` : '');
    if (this.isWorking) return; // its state is shown
    this.controls.progress(null);
    if (hasErrors) this.setState(`${errors.length} error${errors.length > 1 ? 's' : ''}`, true);
    else this.setState(this.summary(), (this.program?.model.findings.length ?? 0) > 0);
  }

  private summary(): string {
    const count = this.program?.model.findings.length ?? 0;
    if (count === 0) return this.program ? 'Up to date' : 'Loading…';
    return `${count} hazard${count > 1 ? 's' : ''}`;
  }

  private setState(text: string, isBad: boolean): void {
    const state = byId('state');
    if (state.textContent !== text) state.textContent = text;
    state.classList.toggle('bad', isBad);
  }

  private firstView(program: Program): void {
    const saved = this.memory.view(program.model.source ?? program.model.name);
    if (saved) this.scene.stage.setView(saved);
    else this.scene.stage.show('iso');
  }

  private saveView(): void {
    if (!this.program) return;
    this.memory.saveView(this.program.model.source ?? this.program.model.name, this.scene.stage.view());
  }

  // Settings and panes.

  private settingsChanged(): void {
    this.memory.saveSettings(this.settings);
    this.controls.show(this.unit, this.colour);
    this.scene.setColourMode(this.colour);
    this.scene.setUnit(this.unit);
    this.scene.show(this.settings.show);
    this.scene.hideBeads(this.legend.hidden);
    this.showLegend();
    if (!this.program) return;
    if (this.colour === 'burn' && !this.program.burn) void this.loadBurn(this.program);
    this.report.update(this.program, this.unit);
    this.findings.update(this.program.model, this.errorList, this.unit);
    this.measure.show(this.controls.isMeasuring, this.unit);
    this.showInstant();
  }

  private async loadBurn(program: Program): Promise<void> {
    if (program === this.burning) return;
    this.burning = program;
    try {
      program.burn = await this.source.burn();
    } catch (error) {
      const reason = error instanceof Error ? error.message : String(error);
      if (program === this.program) this.setState(reason, true);
    }
    if (program !== this.program || !program.burn) return;
    this.scene.showBurn();
    this.showLegend();
    document.documentElement.dataset.burn = String(program.burn.revision);
  }

  /** The colouring by what the last save has changed, and back. */
  private toggleChange(): void {
    if (!this.program || !applies(this.program, 'change'))
      return this.setState('Nothing has been saved since this part was opened', false);
    const { colour } = this.settings;
    this.settings.colour = colour === 'change' ? this.colourBefore : 'change';
    if (colour !== 'change') this.colourBefore = colour;
    this.settingsChanged();
  }

  /** The chosen colouring, or that by tool where it does not apply. */
  private get colour(): ColourMode {
    const { colour } = this.settings;
    return !this.program || applies(this.program, colour) ? colour : 'tool';
  }

  private showLegend(): void {
    if (!this.program) return;
    const { rulers, moves } = this.scene;
    this.legend.update(this.program, this.colour, this.unit, this.settings.show, rulers.step, moves.fade);
  }

  private seek(time: number): void {
    this.player.pause();
    this.player.seek(time);
  }

  private showInstant(): void {
    const program = this.program;
    if (!program) return;
    const { time, isAtEnd } = this.player;
    this.layers.show(time);
    this.scene.setInstant(time, isAtEnd, this.settings.show.tool);
    byId('readout').textContent = ''; // it was that of another instant
    const m = this.player.motion;
    const where = !isAtEnd && m >= 0 ? (program.path.chain(m)[0] ?? null) : null;
    this.sources.setRunning(where && this.isShown(where) ? where : null);
    this.lineShown(where);
    this.player.showText(this.unit, where ? `line ${where.line}` : '');
    if (program.model.kind === 'milling')
      this.instants.want(isAtEnd ? FINAL : m < 0 ? 0 : program.path.step[m]! + 1);
  }

  private async printSheet(): Promise<void> {
    if (this.program) await printSheet(this.program, this.unit, this.scene.stage.picture());
  }

  /** Plays the whole job at the chosen speed and saves it as a film; pausing ends it there. */
  private async film(): Promise<void> {
    if (!this.program || this.program.totalTime === 0 || this.player.isPlaying) return;
    const film = Film.start(this.scene.stage.canvas);
    if (!film) return this.setState('This browser cannot record films', true);
    const name = this.program.model.name.replace(/[^A-Za-z0-9._-]/g, '_');
    const ended = new Promise<void>((done) => (this.player.onPaused = done));
    this.player.seek(0);
    this.player.shortest = SHORTEST_FILM;
    this.player.play();
    this.setState('Recording; pause ends it', false);
    await ended;
    this.player.onPaused = () => {};
    this.player.shortest = 0;
    this.scene.stage.draw();
    await new Promise((done) => window.setTimeout(done, LAST_PICTURE));
    const bytes = await film.finish();
    saveFile(bytes, `${name}.webm`);
    this.showErrors();
  }

  private async download(make: () => Promise<Response>, name: string): Promise<void> {
    this.setState(`Making ${name}…`, false);
    try {
      await saveAnswer(await make());
      this.showErrors();
    } catch (error) {
      this.setState(error instanceof Error ? error.message : String(error), true);
    }
  }

  private instantChanged(): void {
    const { shownStep } = this.scene.part;
    document.documentElement.dataset.instant = shownStep === FINAL ? 'end' : String(shownStep);
    this.scene.stage.draw();
  }

  // From the picture to the source, and back.

  private listenToPointer(): void {
    const canvas = this.scene.stage.canvas;
    let down: [number, number] | null = null;
    let waiting = false;
    canvas.addEventListener('pointerdown', (e) => {
      down = [e.offsetX, e.offsetY];
      this.hint.hide();
    });
    canvas.addEventListener('wheel', () => this.hint.hide(), { passive: true });
    canvas.addEventListener('pointerup', (e) => {
      if (down && e.button === 0 && Math.hypot(e.offsetX - down[0], e.offsetY - down[1]) <= CLICK_REACH) {
        this.pick(e.offsetX, e.offsetY);
      }
      down = null;
    });
    canvas.addEventListener('pointermove', (e) => {
      if (down || waiting) return;
      waiting = true;
      requestAnimationFrame(() => {
        waiting = false;
        this.readOut(e.offsetX, e.offsetY);
        this.hintAt(e.offsetX, e.offsetY);
      });
    });
    canvas.addEventListener('pointerleave', () => {
      byId('readout').textContent = '';
      this.hint.hide();
    });
  }

  private hintAt(x: number, y: number): void {
    if (!this.controls.isMeasuring || !this.program) return;
    this.hint.want(x, y, this.unit, () => this.scene.measureHint(x, y, this.measure.centres));
  }

  private pickCentre(): void {
    const { clientWidth, clientHeight } = this.scene.stage.canvas;
    this.pick(clientWidth / 2, clientHeight / 2);
    this.readOut(clientWidth / 2, clientHeight / 2);
  }

  private pick(x: number, y: number): void {
    const program = this.program;
    if (!program) return;
    if (this.controls.isMeasuring) {
      const measured = this.scene.measuredPoint(x, y, this.measure.centres);
      if (measured) this.measure.add(measured);
      return;
    }
    const picked = this.scene.pick(x, y);
    if (!picked || picked.step === NO_STEP) return this.clearSelection();
    const chain =
      picked.motion >= 0
        ? program.path.chain(picked.motion)
        : program.chainOfStep(picked.step);
    this.sources.show(chain);
    this.lineShown(chain[0]);
    this.tabs.show('source');
    this.scene.marks.setPoint(picked.point);
    this.scene.select(motionsOfStep(program, picked.step));
    this.setState(this.pickedText(chain, picked.step), false);
  }

  private pickedText(chain: Location[], step: number): string {
    const where = chain
      .map((l) => `${this.program!.model.files[l.file]?.path ?? '?'}:${l.line}`)
      .join(', called by ');
    return where || `Step ${step}`;
  }

  private selectLine(where: Location): void {
    const program = this.program;
    if (!program) return;
    this.lineShown(where);
    const motions = this.isShown(where) ? program.path.motionsOf(where) : new Uint32Array();
    this.scene.marks.setPoint(null);
    this.scene.select(motions);
    const count = motions.length;
    this.setState(
      `Line ${where.line}: ${count === 0 ? 'no motion' : count === 1 ? '1 motion' : `${count} motions`}`,
      false,
    );
  }

  /** The sources shown may be those of a program with errors, the part that of the one before. */
  private isShown(where: Location): boolean {
    return this.program?.model.files[where.file]?.path === this.sources.path(where.file);
  }

  private clearSelection(): void {
    this.sources.show([]);
    this.scene.marks.setPoint(null);
    this.scene.select(new Uint32Array());
    this.measure.clear(this.controls.isMeasuring);
    if (this.program) this.showErrors();
  }

  private toOrigin(origin: Origin): void {
    const where = this.sources.locate(origin);
    if (!where)
      return this.setState(`${originText(origin) ?? 'This location'} is not among the files shown`, false);
    this.tabs.show('source');
    this.sources.show([where]);
    this.selectLine(where);
  }

  private toFinding(finding: Finding, text: string): void {
    const program = this.program;
    if (!program) return;
    if (finding.origin) this.toOrigin(finding.origin);
    if (typeof finding.step === 'number') {
      const m = program.motionOfStep(finding.step);
      this.player.pause();
      // Still in the hazard's motion, so that its own line runs and nothing after it is cut.
      const end = program.startOf(Math.min(m + 1, program.motions));
      this.player.seek(Math.max(end - BEFORE_END, program.startOf(m)));
    }
    if (finding.at && isContact(finding)) this.scene.marks.setPoint(finding.at);
    if (text) this.setState(text, true);
    this.scene.stage.draw();
  }

  // In a frame of another page.

  private frameHost(): FrameHost {
    const { source } = this;
    const upload = source.edit && source.upload?.bind(source); // of the page without a server
    return {
      hello: () => this.reportToFrame(),
      load: upload && ((name, text) => upload(new File([text], name))),
      line: (line, file) => this.goTo(line, file),
      colour: (name) => this.colourBy(name),
      play: () => {
        if (!this.program?.motions)
          return { error: 'there is nothing to play', expected: 'a program with motions' };
        if (!this.player.isPlaying) this.player.play();
        return null;
      },
      stop: () => this.player.pause(),
    };
  }

  private reportToFrame(): void {
    const { program, frame } = this;
    if (!program) return;
    const { name, revision, files, findings } = program.model;
    frame.send({
      event: 'ready',
      name,
      revision,
      files: files.map(({ path }) => path),
      colours: COLOURS.filter((mode) => applies(program, mode)),
      actions: frame.actions,
      findings: findings.length,
    });
    for (const finding of findings.slice(0, FINDINGS_SENT)) frame.send({ event: 'finding', finding });
  }

  private lineShown(where: Location | null | undefined): void {
    const path = where && this.program?.model.files[where.file]?.path;
    if (path) this.frame.line(path, where.line);
  }

  /** `file`: a path of the program's files, or its name without folders. */
  private goTo(line: number, file: string | undefined): Problem | null {
    const files = this.program?.model.files ?? [];
    const found =
      file === undefined
        ? files[0]
        : (files.find(({ path }) => path === file) ??
          files.find(({ path }) => path.split(/[/\\]/).pop() === file));
    const names = files.map(({ path }) => path).join(', ') || 'a program that is shown';
    if (!found?.text)
      return { error: 'there is no such file with a text', expected: `file: one of ${names}` };
    const lines = found.text.split(/\r\n|\n|\r/).length;
    if (line > lines) return { error: `${found.path} has no line ${line}`, expected: `line: 1 to ${lines}` };
    this.toOrigin({ file: found.path, line });
    return null;
  }

  private colourBy(name: string): Problem | null {
    const { program } = this;
    const offered = COLOURS.filter((mode) => program && applies(program, mode));
    const mode = offered.find((one) => one === name);
    if (!mode)
      return { error: 'this colouring does not apply', expected: `colour: one of ${offered.join(', ')}` };
    this.settings.colour = mode;
    this.settingsChanged();
    return null;
  }

  // Depth under the pointer, and distances.

  private differenceName(difference: number): string {
    if (this.colour === 'change') return difference > 0 ? 'removed less:' : 'removed more:';
    return difference > 0 ? 'left' : 'gouged';
  }

  private readOut(x: number, y: number): void {
    const picked = this.scene.pick(x, y, false);
    const out = byId('readout');
    const number = (v: number) => lengthNumber(v, this.unit);
    if (!picked) {
      const burnt = this.scene.burnAt(x, y);
      out.textContent = burnt
        ? `X ${number(burnt.point[0])}  Y ${number(burnt.point[1])}   ${burnt.energy.toPrecision(3)} J/mm²`
        : '';
      return;
    }
    const [px, py, pz] = picked.point;
    const top = this.program?.model.stock?.block[1][2];
    const depth = top === undefined ? '' : `   depth ${length(Math.max(top - pz, 0), this.unit)}`;
    const difference = this.scene.differenceAt(picked.point) ?? 0;
    const compared =
      difference === 0
        ? ''
        : `   ${this.differenceName(difference)} ${length(Math.abs(difference), this.unit)}`;
    out.textContent = `X ${number(px)}  Y ${number(py)}  Z ${number(pz)}${depth}${compared}`;
  }
}

function motionsOfStep(program: Program, step: number): Uint32Array {
  const first = program.motionOfStep(step);
  let last = first;
  while (last < program.motions && program.path.step[last] === step) ++last;
  return Uint32Array.from({ length: last - first }, (_, i) => first + i);
}
