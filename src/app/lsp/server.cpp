// The language server's loop: documents, diagnostics after each change, and the requests about a location.
#include "app/lsp/server.h"

#include <fmt/format.h>
#include <map>
#include <set>
#include <utility>

#include "app/lsp/analysis.h"
#include "app/lsp/completion.h"
#include "app/lsp/messages.h"
#include "app/lsp/symbols.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"

namespace kerf::app::lsp {
namespace {

constexpr int kMethodNotFound = -32601, kInvalidRequest = -32600, kParseError = -32700;
constexpr int kNotInitialized = -32002;

struct Document {
  std::string path, text;
  std::int64_t version = 0;
  Analysis analysis;
  std::optional<Depth> wanted = Depth::hazards;  // that is still to be done
};

class Server {
 public:
  Server(std::FILE* in, std::FILE* out) : messages_(in), out_(out) {}

  int run() {
    while (auto message = messages_.next()) {
      handle(*message);
      if (exits_) return is_shut_down_ ? 0 : 1;
      if (!messages_.has_next()) analyse_all();
    }
    return is_shut_down_ ? 0 : 1;
  }

 private:
  using Answer = Json (Server::*)(const Json& parameters);
  using Note = void (Server::*)(const Json& parameters);

  void handle(const Json& message);
  void answer(const Json& id, const std::string& method, const Json& parameters);
  void fail(const Json& id, int code, const std::string& text) {
    write_message(out_, {{"jsonrpc", "2.0"}, {"id", id}, {"error", {{"code", code}, {"message", text}}}});
  }

  Json initialize(const Json& parameters);
  Json shutdown(const Json&) {
    is_shut_down_ = true;
    return nullptr;
  }
  Json hover(const Json& parameters);
  Json definition(const Json& parameters);
  Json symbols(const Json& parameters);
  Json completion(const Json& parameters);

  void opened(const Json& parameters);
  void changed(const Json& parameters);
  void saved(const Json& parameters);
  void closed(const Json& parameters);

  void analyse_all();
  void publish(const std::string& address, const Document& document);
  Document* document_of(const Json& parameters);
  /// The line, and the byte in it, of a request.
  std::pair<std::size_t, std::size_t> location_of(const Json& parameters, const Document& document) const;
  std::size_t units(std::string_view line, std::size_t byte) const {
    return counts_bytes_ ? std::min(byte, line.size()) : units_before(line, byte);
  }
  Json range_of(std::string_view text, const Span& span) const;

  MessageQueue messages_;
  std::FILE* out_;
  std::map<std::string, Document> documents_;
  bool is_initialized_ = false, is_shut_down_ = false, exits_ = false, counts_bytes_ = false;
};

/// A member of an object; null where it is missing.
const Json& member(const Json& object, const char* name) {
  static const Json none;
  const auto found = object.is_object() ? object.find(name) : object.end();
  return object.is_object() && found != object.end() ? *found : none;
}

std::string text_in(const Json& value) {
  return value.is_string() ? value.get<std::string>() : std::string();
}
std::size_t number_in(const Json& value) {
  return value.is_number_integer() && value.get<std::int64_t>() > 0 ? value.get<std::size_t>() : 0;
}

void Server::handle(const Json& message) {
  if (message.is_discarded()) return fail(nullptr, kParseError, "the message is no JSON");
  const std::string method = text_in(member(message, "method"));
  const Json& id = member(message, "id");
  const Json& parameters = member(message, "params");
  if (!id.is_null()) {
    if (method.empty() && !member(message, "result").is_null()) return;  // an answer to a request of ours
    return answer(id, method, parameters);
  }
  static const std::map<std::string, Note, std::less<>> kNotes{{"textDocument/didOpen", &Server::opened},
                                                               {"textDocument/didChange", &Server::changed},
                                                               {"textDocument/didSave", &Server::saved},
                                                               {"textDocument/didClose", &Server::closed}};
  if (method == "exit") exits_ = true;
  if (const auto note = kNotes.find(method); note != kNotes.end() && is_initialized_)
    (this->*note->second)(parameters);
}

void Server::answer(const Json& id, const std::string& method, const Json& parameters) {
  static const std::map<std::string, Answer, std::less<>> kAnswers{
      {"initialize", &Server::initialize},
      {"shutdown", &Server::shutdown},
      {"textDocument/hover", &Server::hover},
      {"textDocument/definition", &Server::definition},
      {"textDocument/documentSymbol", &Server::symbols},
      {"textDocument/completion", &Server::completion}};
  const auto found = kAnswers.find(method);
  if (found == kAnswers.end()) return fail(id, kMethodNotFound, "there is no method " + method);
  if (!is_initialized_ && method != "initialize") return fail(id, kNotInitialized, "initialize comes first");
  if (is_shut_down_) return fail(id, kInvalidRequest, "the server is shut down");
  write_message(out_, {{"jsonrpc", "2.0"}, {"id", id}, {"result", (this->*found->second)(parameters)}});
}

Json Server::initialize(const Json& parameters) {
  is_initialized_ = true;
  const Json& encodings = member(member(member(parameters, "capabilities"), "general"), "positionEncodings");
  for (const Json& encoding : encodings) counts_bytes_ = counts_bytes_ || text_in(encoding) == "utf-8";
  constexpr int kFullTexts = 1;
  return {{"capabilities",
           {{"positionEncoding", counts_bytes_ ? "utf-8" : "utf-16"},
            {"textDocumentSync", {{"openClose", true}, {"change", kFullTexts}, {"save", true}}},
            {"hoverProvider", true},
            {"definitionProvider", true},
            {"documentSymbolProvider", true},
            {"completionProvider", {{"triggerCharacters", Json::array()}}}}},
          {"serverInfo", {{"name", "kerf"}, {"version", KERF_VERSION}}}};
}

// ------------------------------------------------------------------------------------------------ documents

void Server::opened(const Json& parameters) {
  const Json& given = member(parameters, "textDocument");
  const std::string address = text_in(member(given, "uri"));
  if (address.empty()) return;
  Document document;
  document.path = path_of_address(address);
  document.text = text_in(member(given, "text"));
  document.version = static_cast<std::int64_t>(number_in(member(given, "version")));
  documents_[address] = std::move(document);
}

void Server::changed(const Json& parameters) {
  Document* const document = document_of(parameters);
  if (document == nullptr) return;
  for (const Json& change : member(parameters, "contentChanges"))
    if (member(change, "range").is_null()) document->text = text_in(member(change, "text"));
  document->version =
      static_cast<std::int64_t>(number_in(member(member(parameters, "textDocument"), "version")));
  document->wanted = Depth::reading;
}

void Server::saved(const Json& parameters) {
  if (Document* const document = document_of(parameters)) document->wanted = Depth::hazards;
}

void Server::closed(const Json& parameters) {
  const std::string address = text_in(member(member(parameters, "textDocument"), "uri"));
  if (documents_.erase(address) == 0) return;
  write_message(out_, {{"jsonrpc", "2.0"},
                       {"method", "textDocument/publishDiagnostics"},
                       {"params", {{"uri", address}, {"diagnostics", Json::array()}}}});
}

Document* Server::document_of(const Json& parameters) {
  const auto found = documents_.find(text_in(member(member(parameters, "textDocument"), "uri")));
  return found == documents_.end() ? nullptr : &found->second;
}

/// Reads what has changed, until a message waits.
void Server::analyse_all() {
  for (auto& [address, document] : documents_) {
    if (!document.wanted) continue;
    Analysis made;
    if (script_of(document.path) != Script::other)
      made = analyse(document.path, document.text, *document.wanted, [this] { return messages_.has_next(); });
    if (made.is_stopped && messages_.has_next()) return;  // later, or of the newer text
    document.wanted.reset();
    document.analysis = std::move(made);
    publish(address, document);
  }
}

Json Server::range_of(std::string_view text, const Span& span) const {
  const TextLines lines(text);
  const std::string_view line = lines.line(span.line);
  return {{"start", {{"line", span.line}, {"character", units(line, span.start)}}},
          {"end", {{"line", span.line}, {"character", units(line, span.end)}}}};
}

void Server::publish(const std::string& address, const Document& document) {
  constexpr int kError = 1, kWarning = 2, kInformation = 3;
  Json list = Json::array();
  const TextLines lines(document.text);
  for (const Annotation& found : document.analysis.annotations) {
    const bool is_here = found.file == document.path;
    const std::size_t number = is_here && found.line > 0 ? found.line - 1 : 0;
    const std::string_view line = lines.line(number);
    const Span span{number, found.column > 0 && is_here ? found.column - 1 : 0, line.size()};
    list.push_back({{"range", range_of(document.text, span)},
                    {"severity", found.severity == Severity::error     ? kError
                                 : found.severity == Severity::warning ? kWarning
                                                                       : kInformation},
                    {"code", found.rule},
                    {"source", "kerf"},
                    {"message", is_here || found.file.empty()
                                    ? found.text
                                    : fmt::format("{}:{}: {}", found.file, found.line, found.text)}});
  }
  write_message(out_, {{"jsonrpc", "2.0"},
                       {"method", "textDocument/publishDiagnostics"},
                       {"params", {{"uri", address}, {"version", document.version}, {"diagnostics", list}}}});
}

// ------------------------------------------------------------------------------------------------- requests

std::pair<std::size_t, std::size_t> Server::location_of(const Json& parameters,
                                                        const Document& document) const {
  const Json& position = member(parameters, "position");
  const std::size_t number = number_in(member(position, "line")),
                    at = number_in(member(position, "character"));
  const std::string_view line = TextLines(document.text).line(number);
  return {number, counts_bytes_ ? std::min(at, line.size()) : byte_of(line, at)};
}

Json Server::hover(const Json& parameters) {
  Document* const document = document_of(parameters);
  if (document == nullptr) return nullptr;
  if (document->wanted) analyse_all();
  const auto [number, byte] = location_of(parameters, *document);
  const Script script = script_of(document->path);
  const std::string word = word_at(script, TextLines(document->text).line(number), byte);
  std::string text = meaning_of(script, document->text, number, word);
  const auto work = document->analysis.lines.find(static_cast<std::uint32_t>(number + 1));
  if (work != document->analysis.lines.end())
    text += (text.empty() ? "" : "\n\n") + text_of(work->second, document->analysis);
  if (text.empty()) return nullptr;
  return {{"contents", {{"kind", "markdown"}, {"value", text}}}};
}

Json Server::definition(const Json& parameters) {
  Document* const document = document_of(parameters);
  if (document == nullptr) return nullptr;
  const auto [number, byte] = location_of(parameters, *document);
  const auto read_file = [this](const std::string& path) -> std::optional<std::string> {
    if (const auto open = documents_.find(address_of_path(path)); open != documents_.end())
      return open->second.text;
    Diagnostics ignored;
    const auto file = InputFile::open(path, ignored, limits::kMaxStreamBytes);
    return file ? std::optional(std::string(file->bytes())) : std::nullopt;
  };
  const auto found =
      definition_of(script_of(document->path), document->path, document->text, number, byte, read_file);
  if (!found) return nullptr;
  const std::string text =
      found->file == document->path ? document->text : read_file(found->file).value_or("");
  return {{"uri", address_of_path(found->file)}, {"range", range_of(text, found->at)}};
}

Json Server::symbols(const Json& parameters) {
  Document* const document = document_of(parameters);
  Json list = Json::array();
  if (document == nullptr) return list;
  const TextLines lines(document->text);
  for (const Symbol& symbol : outline_of(script_of(document->path), document->text)) {
    const std::size_t last = std::max(symbol.last_line, symbol.at.line);
    Json range = range_of(document->text, {symbol.at.line, 0, 0});
    range["end"] = {{"line", last}, {"character", units(lines.line(last), lines.line(last).size())}};
    list.push_back({{"name", symbol.name},
                    {"kind", static_cast<int>(symbol.kind)},
                    {"range", range},
                    {"selectionRange", range_of(document->text, symbol.at)}});
  }
  return list;
}

Json Server::completion(const Json& parameters) {
  Document* const document = document_of(parameters);
  Json list = Json::array();
  if (document == nullptr) return list;
  constexpr int kFunction = 3, kProperty = 10, kKeyword = 14;
  const Script script = script_of(document->path);
  for (const Proposal& word : proposals(script, document->text, location_of(parameters, *document).first)) {
    Json item{{"label", word.word},
              {"kind", word.is_function        ? kFunction
                       : script == Script::job ? kProperty
                                               : kKeyword}};
    if (!word.meaning.empty()) item["detail"] = word.meaning;
    list.push_back(std::move(item));
  }
  return list;
}

}  // namespace

int serve(std::FILE* in, std::FILE* out) { return Server(in, out).run(); }

}  // namespace kerf::app::lsp
