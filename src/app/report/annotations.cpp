// Lines for editors and for GitHub, and SARIF logs.
#include "app/report/annotations.h"

#include <fmt/format.h>
#include <set>

namespace kerf::app {
namespace {

void set_location(Annotation& annotation, const Origin& origin) {
  if (const auto* text = std::get_if<TextLocation>(&origin)) {
    annotation.file = text->file;
    annotation.line = text->line;
    annotation.column = text->column;
  } else if (const auto* call = std::get_if<CallLocation>(&origin); call != nullptr && !call->file.empty()) {
    annotation.file = call->file;
    annotation.line = call->line;
  } else if (const auto* drawing = std::get_if<DrawingLocation>(&origin)) {
    annotation.file = drawing->file;
    const std::string where = to_string(origin);
    annotation.text = fmt::format("{}: {}", where.substr(drawing->file.size() + 2), annotation.text);
  }
}

/// A line of a command cannot hold line ends; GitHub writes them as %0A.
std::string escaped(std::string_view text, bool is_property) {
  std::string out;
  for (const char c : text) {
    const bool is_special = c == '%' || c == '\r' || c == '\n' || (is_property && (c == ':' || c == ','));
    if (is_special)
      out += fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    else
      out += c;
  }
  return out;
}

/// The address of a file in a log: names with "/" as they are, all other bytes than unreserved ones as %XX.
std::string address(std::string_view file) {
  constexpr std::string_view kUnreserved = "-._~/";
  std::string out;
  for (const char c : file) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       kUnreserved.find(c) != std::string_view::npos;
    if (plain)
      out += c;
    else
      out += fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  return out;
}

Record result_of(const Annotation& a) {
  Record physical = Record::object();
  physical["artifactLocation"] = Record{{"uri", address(a.file)}};
  if (a.line > 0) {
    physical["region"]["startLine"] = a.line;
    if (a.column > 0) physical["region"]["startColumn"] = a.column;
  }
  Record location = Record::object();
  location["physicalLocation"] = physical;
  Record locations = Record::array();
  locations.push_back(location);
  Record message = Record::object();
  message["text"] = a.text;
  Record result = Record::object();
  result["ruleId"] = a.rule;
  result["level"] = to_string(a.severity);
  result["message"] = message;
  result["locations"] = locations;
  return result;
}

}  // namespace

std::vector<Annotation> annotations_of(const std::vector<Finding>& findings, const Diagnostics& diagnostics,
                                       const std::string& file) {
  std::vector<Annotation> out;
  for (const Diagnostic& d : diagnostics.list()) {
    Annotation a{d.severity, file, 0, 0, std::string(name_of(d.code)), d.message};
    set_location(a, d.where);
    out.push_back(std::move(a));
  }
  for (const Finding& f : grouped(findings)) {
    Annotation a{Severity::error, file, 0, 0, f.kind, f.message};
    set_location(a, f.origin);
    out.push_back(std::move(a));
  }
  return out;
}

std::string gcc_line(const Annotation& a) {
  std::string where = a.file;
  if (a.line > 0) where += fmt::format(":{}", a.line);
  if (a.line > 0 && a.column > 0) where += fmt::format(":{}", a.column);
  return fmt::format("{}: {}: {} [{}]\n", where, to_string(a.severity), a.text, a.rule);
}

std::string github_line(const Annotation& a) {
  std::string where = "file=" + escaped(a.file, true);
  if (a.line > 0) where += fmt::format(",line={}", a.line);
  if (a.line > 0 && a.column > 0) where += fmt::format(",col={}", a.column);
  const std::string_view command = a.severity == Severity::note ? "notice" : to_string(a.severity);
  return fmt::format("::{} {},title={}::{}\n", command, where, a.rule, escaped(a.text, false));
}

Record sarif_log(const std::vector<Annotation>& annotations) {
  std::set<std::string> names;
  Record results = Record::array(), rules = Record::array();
  for (const Annotation& a : annotations) {
    results.push_back(result_of(a));
    names.insert(a.rule);
  }
  for (const std::string& name : names) {
    Record rule = Record::object();
    rule["id"] = name;
    rules.push_back(rule);
  }
  Record run = Record::object();
  run["tool"]["driver"]["name"] = "kerf";
  run["tool"]["driver"]["version"] = KERF_VERSION;
  run["tool"]["driver"]["rules"] = rules;
  run["results"] = results;
  Record log = Record::object();
  log["$schema"] = "https://json.schemastore.org/sarif-2.1.0.json";
  log["version"] = "2.1.0";
  log["runs"].push_back(run);
  return log;
}

}  // namespace kerf::app
