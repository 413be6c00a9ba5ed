// The extension for Visual Studio Code: starts `kerf lsp`, and opens the page of `kerf view`.
const { spawn } = require("child_process");
const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;
let viewer;

function command() {
  return vscode.workspace.getConfiguration("kerf").get("command", "kerf");
}

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

function activate(context) {
  client = new LanguageClient(
    "kerf",
    "Kerf",
    { command: command(), args: ["lsp"] },
    {
      documentSelector: [
        { scheme: "file", language: "gcode" },
        { scheme: "file", language: "gcmc" },
        { scheme: "file", pattern: "**/*.scad" },
      ],
    },
  );
  context.subscriptions.push(vscode.commands.registerCommand("kerf.show", showPart), { dispose: stopViewer });
  return client.start();
}

function deactivate() {
  stopViewer();
  return client ? client.stop() : undefined;
}

module.exports = { activate, deactivate };
