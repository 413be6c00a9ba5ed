// The extension for Visual Studio Code: what `kerf lsp` says of the text, and the page of `kerf view`.
const { spawn } = require("child_process");
const vscode = require("vscode");
const { Server } = require("./server.js");

const kFiles = [{ language: "gcode" }, { language: "gcmc" }, { pattern: "**/*.scad" }];

let server;
let viewer;

function command() {
  return vscode.workspace.getConfiguration("kerf").get("command", "kerf");
}

const range = (r) => new vscode.Range(r.start.line, r.start.character, r.end.line, r.end.character);
const isOurs = (document) => document.uri.scheme === "file" && vscode.languages.match(kFiles, document) > 0;
const name = (document) => ({ uri: document.uri.toString() });
const at = (document, position) => ({
  textDocument: name(document),
  position: { line: position.line, character: position.character },
});

// ---------------------------------------------------------------------------------- documents and messages

function opened(document) {
  if (!isOurs(document)) return;
  const { languageId, version } = document;
  server.note("textDocument/didOpen", {
    textDocument: { ...name(document), languageId, version, text: document.getText() },
  });
}

function changed({ document }) {
  if (!isOurs(document)) return;
  server.note("textDocument/didChange", {
    textDocument: { ...name(document), version: document.version },
    contentChanges: [{ text: document.getText() }],
  });
}

const kSeverities = [undefined, 0, 1, 2, 3]; // the protocol counts from 1

function show(collection, params) {
  collection.set(
    vscode.Uri.parse(params.uri),
    params.diagnostics.map((found) => {
      const shown = new vscode.Diagnostic(range(found.range), found.message, kSeverities[found.severity]);
      shown.source = found.source;
      shown.code = found.code;
      return shown;
    }),
  );
}

function follow(collection) {
  const workspace = vscode.workspace;
  for (const document of workspace.textDocuments) opened(document);
  return [
    collection,
    workspace.onDidOpenTextDocument(opened),
    workspace.onDidChangeTextDocument(changed),
    workspace.onDidSaveTextDocument((d) => isOurs(d) && server.note("textDocument/didSave", { textDocument: name(d) })),
    workspace.onDidCloseTextDocument((d) => isOurs(d) && server.note("textDocument/didClose", { textDocument: name(d) })),
  ];
}

// ------------------------------------------------------------------------------------------------ requests

async function hover(document, position) {
  const found = await server.request("textDocument/hover", at(document, position));
  return found && new vscode.Hover(new vscode.MarkdownString(found.contents.value));
}

async function definition(document, position) {
  const found = await server.request("textDocument/definition", at(document, position));
  return found && new vscode.Location(vscode.Uri.parse(found.uri), range(found.range));
}

async function symbols(document) {
  const found = await server.request("textDocument/documentSymbol", { textDocument: name(document) });
  return found.map((s) => new vscode.DocumentSymbol(s.name, "", s.kind - 1, range(s.range), range(s.selectionRange)));
}

async function completion(document, position) {
  const found = await server.request("textDocument/completion", at(document, position));
  return found.map((word) => {
    const item = new vscode.CompletionItem(word.label, word.kind - 1);
    item.detail = word.detail;
    return item;
  });
}

function provide() {
  const { languages } = vscode;
  return [
    languages.registerHoverProvider(kFiles, { provideHover: hover }),
    languages.registerDefinitionProvider(kFiles, { provideDefinition: definition }),
    languages.registerDocumentSymbolProvider(kFiles, { provideDocumentSymbols: symbols }),
    languages.registerCompletionItemProvider(kFiles, { provideCompletionItems: completion }),
  ];
}

// -------------------------------------------------------------------------------------------------- viewer

function stopViewer() {
  if (viewer) viewer.kill();
  viewer = undefined;
}

/** Starts the viewer for the file of the active editor, and opens its page when it says where it is. */
function showPart() {
  const editor = vscode.window.activeTextEditor;
  if (!editor) return;
  stopViewer();
  viewer = spawn(command(), ["view", editor.document.fileName]);
  let text = "";
  let isOpen = false;
  const read = (bytes) => {
    text += bytes;
    const address = /http:\/\/(?:127\.0\.0\.1|localhost):\d+\S*/.exec(text);
    if (!address || isOpen) return;
    isOpen = true;
    vscode.env.openExternal(vscode.Uri.parse(address[0], true));
  };
  viewer.stdout.on("data", read);
  viewer.stderr.on("data", read);
  viewer.on("error", (error) => vscode.window.showErrorMessage(`${command()}: ${error.message}`));
}

async function activate(context) {
  const collection = vscode.languages.createDiagnosticCollection("kerf");
  server = new Server(
    command(),
    (method, params) => method === "textDocument/publishDiagnostics" && show(collection, params),
    (text) => vscode.window.showErrorMessage(text),
  );
  context.subscriptions.push(vscode.commands.registerCommand("kerf.show", showPart), { dispose: stopViewer });
  await server.request("initialize", { processId: process.pid, capabilities: {}, rootUri: null });
  server.note("initialized", {});
  context.subscriptions.push(...follow(collection), ...provide());
}

function deactivate() {
  stopViewer();
  return server ? server.stop().catch(() => {}) : undefined;
}

module.exports = { activate, deactivate };
