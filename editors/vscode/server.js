// The client of `kerf lsp`: messages with their lengths over the streams of a process.
const { spawn } = require("child_process");

class Server {
  /** `onNote` takes the method and the parameters of each note, `onEnd` a text if the process fails or ends. */
  constructor(command, onNote, onEnd) {
    this.waiting = new Map();
    this.last = 0;
    this.bytes = Buffer.alloc(0);
    this.onNote = onNote;
    this.process = spawn(command, ["lsp"]);
    this.process.stdout.on("data", (bytes) => this.read(bytes));
    this.process.on("error", (error) => this.end(`${command}: ${error.message}`, onEnd));
    this.process.on("exit", (status) => this.end(status === 0 ? "" : `kerf lsp ended with status ${status}`, onEnd));
    this.process.stdin.on("error", () => {});
  }

  end(text, onEnd) {
    for (const { reject } of this.waiting.values()) reject(new Error(text || "kerf lsp has ended"));
    this.waiting.clear();
    if (text) onEnd(text);
  }

  send(message) {
    const body = Buffer.from(JSON.stringify({ jsonrpc: "2.0", ...message }));
    this.process.stdin.write(`Content-Length: ${body.length}\r\n\r\n`);
    this.process.stdin.write(body);
  }

  note(method, params) {
    this.send({ method, params });
  }

  request(method, params) {
    const id = ++this.last;
    this.send({ id, method, params });
    return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject }));
  }

  read(bytes) {
    this.bytes = Buffer.concat([this.bytes, bytes]);
    for (;;) {
      const start = this.bytes.indexOf("\r\n\r\n");
      if (start < 0) return;
      const length = Number(/content-length: *(\d+)/i.exec(this.bytes.toString("latin1", 0, start))[1]);
      if (this.bytes.length < start + 4 + length) return;
      const message = JSON.parse(this.bytes.toString("utf8", start + 4, start + 4 + length));
      this.bytes = this.bytes.subarray(start + 4 + length);
      this.take(message);
    }
  }

  take(message) {
    const asked = this.waiting.get(message.id);
    if (!asked) return this.onNote(message.method, message.params);
    this.waiting.delete(message.id);
    if (message.error) asked.reject(new Error(message.error.message));
    else asked.resolve(message.result);
  }

  async stop() {
    await this.request("shutdown");
    this.note("exit");
  }
}

module.exports = { Server };
