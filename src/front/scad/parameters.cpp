// Sets of parameters as OpenSCAD's customizer writes them: {"parameterSets": {"small": {"width": "40"}}}.
#include <cctype>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/codes/scad.h"
#include "base/names.h"
#include "base/number.h"
#include "front/scad/scad.h"

namespace kerf {
namespace {

bool is_name(const std::string& s) {
  const std::size_t first = !s.empty() && s[0] == '$' ? 1 : 0;
  for (const char c : std::string_view(s).substr(first))
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_') return false;
  return s.size() > first;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  return out + '"';
}

/// Whether a text is a vector of numbers, strings without escapes, and vectors.
bool is_vector(const std::string& text) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') in_string = !in_string;
    if (in_string && c == '\\') return false;
    if (in_string || c == '"') continue;
    depth += c == '[' ? 1 : c == ']' ? -1 : 0;
    if (depth <= 0 && i + 1 < text.size()) return false;
    if (std::string_view("[], +-.0123456789eE").find(c) == std::string_view::npos) return false;
  }
  return depth == 0 && !in_string && !text.empty();
}

/// A value of the file as an expression.
std::string expression(const nlohmann::json& value) {
  if (!value.is_string()) return value.dump();
  const std::string text = value.get<std::string>();
  if (text == "true" || text == "false" || parse_number(text) || is_vector(text)) return text;
  return quoted(text);
}

}  // namespace

std::vector<std::string> read_parameter_set(std::string_view text, const std::string& file,
                                            const std::string& set, Diagnostics& diagnostics) {
  const auto fail = [&](std::string message, std::string hint = {}) {
    diagnostics.error(codes::scad_parameters, TextLocation{file, 0, 0}, std::move(message)).hint =
        std::move(hint);
    return std::vector<std::string>();
  };
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded()) return fail("the file is not valid JSON");
  const auto sets = json.is_object() ? json.find("parameterSets") : json.end();
  if (!json.is_object() || sets == json.end() || !sets->is_object())
    return fail("the file has no \"parameterSets\"");
  const auto found = sets->find(set);
  if (found == sets->end() || !found->is_object()) {
    std::vector<std::string> names;
    for (const auto& [name, values] : sets->items()) names.push_back(name);
    return fail(fmt::format("there is no set of parameters \"{}\"", set),
                names.empty() ? std::string() : "sets: " + joined(names, ", "));
  }
  std::vector<std::string> out;
  for (const auto& [name, value] : found->items()) {
    if (!is_name(name) || value.is_object() || value.is_null())
      return fail(fmt::format("parameter \"{}\" of set \"{}\" has no name or value of OpenSCAD", name, set));
    out.push_back(name + "=" + expression(value));
  }
  return out;
}

}  // namespace kerf
