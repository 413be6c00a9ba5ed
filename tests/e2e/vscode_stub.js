// Drives the extension for Visual Studio Code without the editor: a stand-in for the parts of its interface that
// the extension uses. Usage: node vscode_stub.js EXTENSION FILE; prints what the editor would show, as JSON.
const Module = require("module");
const fs = require("fs");
const path = require("path");
const { pathToFileURL, fileURLToPath } = require("url");

class Values {
  constructor(...values) {
    this.values = values;
  }
}
const shown = { diagnostics: [], errors: [] };
const providers = {};
const listeners = {};
const provider = (kind) => (files, given) => ((providers[kind] = given), { dispose() {} });
const listener = (kind) => (given) => ((listeners[kind] = given), { dispose() {} });
const file = process.argv[3];
const uri = { scheme: "file", toString: () => pathToFileURL(file).href };
const document = {
  uri,
  languageId: "gcode",
  version: 1,
  fileName: file,
  text: fs.readFileSync(file, "utf8"),
  getText() {
    return this.text;
  },
};
let wake = () => {};
const vscode = {
  Range: class extends Values {},
  Hover: class extends Values {},
  MarkdownString: class extends Values {},
  Location: class extends Values {},
  Diagnostic: class extends Values {},
  DocumentSymbol: class extends Values {},
  CompletionItem: class extends Values {},
  Uri: { parse: (text) => ({ path: text.startsWith("file:") ? fileURLToPath(text) : text }) },
  workspace: {
    textDocuments: [document],
    getConfiguration: () => ({ get: () => process.env.KERF }),
    onDidOpenTextDocument: listener("open"),
    onDidChangeTextDocument: listener("change"),
    onDidSaveTextDocument: listener("save"),
    onDidCloseTextDocument: listener("close"),
  },
  languages: {
    match: () => 10,
    createDiagnosticCollection: () => ({
      set(where, list) {
        shown.diagnostics = list.map((d) => ({ line: d.values[0].values[0], code: d.code, severity: d.values[2] }));
        wake();
      },
      dispose() {},
    }),
    registerHoverProvider: provider("hover"),
    registerDefinitionProvider: provider("definition"),
    registerDocumentSymbolProvider: provider("symbols"),
    registerCompletionItemProvider: provider("completion"),
  },
  window: { showErrorMessage: (text) => shown.errors.push(text) },
  commands: { registerCommand: () => ({ dispose() {} }) },
  env: {},
};
const load = Module._load;
Module._load = (name, ...rest) => (name === "vscode" ? vscode : load(name, ...rest));

async function main() {
  const extension = require(path.resolve(process.argv[2]));
  const first = new Promise((resolve) => (wake = resolve));
  await extension.activate({ subscriptions: [] });
  await first;
  shown.opened = shown.diagnostics;
  const next = new Promise((resolve) => (wake = resolve));
  document.text = document.text.replace("X70", "X7O");
  document.version = 2;
  listeners.change({ document });
  await next;
  shown.changed = shown.diagnostics;
  const position = { line: 3, character: 1 };
  shown.hover = (await providers.hover.provideHover(document, position)).values[0].values[0];
  shown.symbols = (await providers.symbols.provideDocumentSymbols(document)).map((s) => s.values[0]);
  shown.words = (await providers.completion.provideCompletionItems(document, position)).length;
  await extension.deactivate();
  console.log(JSON.stringify(shown));
}
main();
