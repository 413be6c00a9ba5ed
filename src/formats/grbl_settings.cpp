// GRBL's settings in the dumps of senders: text in any layout, and JSON.
#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/codes/files.h"
#include "base/number.h"
#include "formats/machine_settings.h"

namespace kerf::detail {
namespace {

using Json = nlohmann::json;

constexpr double kDefaultRpm = 1000;  // GRBL's default of $30
constexpr int kMaxDepth = 50;         // of JSON
constexpr std::string_view kDigits = "0123456789", kBlanks = " \t";

/// A setting as it is written.
struct Written {
  int number = 0;
  std::string_view value;
  std::size_t at = 0;  // of its $ in the text
};

/// The digits at the start of a text as a number; nothing for none and for more than three.
std::optional<int> leading_number(std::string_view text) {
  constexpr std::size_t kMaxDigits = 3;
  const std::size_t digits = std::min(text.find_first_not_of(kDigits), text.size());
  if (digits == 0 || digits > kMaxDigits) return std::nullopt;
  int number = 0;
  for (const char c : text.substr(0, digits)) number = 10 * number + (c - '0');
  return number;
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// A line with blanks where it has comments: what is in parentheses, a line that starts with # or ;, what
/// follows a # behind a setting, and words that follow a ; there.
std::string without_comments(std::string_view line) {
  std::string text(line);
  bool is_first = true, has_setting = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const std::size_t next = c == ';' ? std::min(text.find_first_not_of(kBlanks, i + 1), text.size()) : 0;
    const bool is_comment =
        c == ';' && (is_first || (has_setting && next < text.size() && is_letter(text[next])));
    if (is_comment || (c == '#' && (is_first || has_setting))) return text.substr(0, i);
    const std::size_t end = c == '(' ? text.find(')', i) : std::string::npos;
    is_first = is_first && kBlanks.find(c) != std::string_view::npos;
    has_setting = has_setting || c == '$';
    if (c == '(' && end == std::string::npos) return text;
    if (c == '(') std::fill_n(text.begin() + static_cast<std::ptrdiff_t>(i), end - i + 1, ' ');
  }
  return text;
}

/// The value at the start of a text, up to a blank, bracket, quote or the next setting. A comma within digits
/// belongs to it: "0,010".
std::string_view value_at(std::string_view text) {
  std::size_t end = text.find_first_of(" \t([{;|\"'`]})<>$");
  end = std::min(end, text.size());
  text = text.substr(0, end);
  for (std::size_t comma = text.find(','); comma < end; comma = text.find(',', comma + 1)) {
    const bool within = comma > 0 && comma + 1 < end && kDigits.find(text[comma - 1]) != kDigits.npos &&
                        kDigits.find(text[comma + 1]) != kDigits.npos;
    if (!within) end = comma;
  }
  return text.substr(0, end);
}

/// The settings of a line of which comments are blanks: "$110=3000", "$110: 3000", "$110","3000" and columns,
/// after anything. `$110` without a value is a question to the controller.
void settings_of(std::string_view line, std::size_t start, std::vector<Written>& out) {
  const auto letter =
      static_cast<std::size_t>(std::find_if(line.begin(), line.end(), is_letter) - line.begin());
  for (std::size_t sign = line.find('$'); sign != std::string_view::npos; sign = line.find('$', sign + 1)) {
    const std::optional<int> number = leading_number(line.substr(sign + 1));
    const std::size_t digits = std::min(line.find_first_not_of(kDigits, sign + 1), line.size());
    if (!number || digits == line.size()) continue;
    const std::size_t value = std::min(line.find_first_not_of(" \t=:,;|\"'`", digits), line.size());
    const std::string_view between = line.substr(digits, value - digits);
    const bool assigned = between.find_first_of("=:") != std::string_view::npos;
    if (between.empty() || (!assigned && value == line.size())) continue;
    const std::string_view text = value_at(line.substr(value));
    const bool is_value = !text.empty() && (kDigits.find(text[0]) != kDigits.npos || text.size() > 1) &&
                          std::string_view("+-.0123456789").find(text[0]) != std::string_view::npos;
    if (!assigned && !is_value && (text.empty() || letter < sign)) continue;
    out.push_back({*number, text, start + sign});
  }
}

/// Calls `take` with each line and its start, as they end on any system.
template <typename Take>
void each_line(std::string_view text, Take take) {
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", start), text.size());
    if (!take(text.substr(start, end - start), start)) return;
    start = end + 1;
  }
}

std::uint32_t line_of(std::string_view text, std::size_t at) {
  std::uint32_t line = 1;
  for (std::size_t i = 0; i < std::min(at, text.size()); ++i)
    if (text[i] == '\n' || (text[i] == '\r' && text.substr(i + 1, 1) != "\n")) ++line;
  return line;
}

std::string_view without_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  return text.substr(0, kMark.size()) == kMark ? text.substr(kMark.size()) : text;
}

/// An object, or an array that holds objects, texts or arrays; "[110: 500]" and TOML's tables are none.
bool starts_as_json(std::string_view text) {
  text = without_mark(text);
  const std::size_t first = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  const std::size_t second = std::min(text.find_first_not_of(" \t\r\n", first + 1), text.size());
  if (second == text.size()) return false;
  if (text[first] == '{') return true;
  return text[first] == '[' && (text[second] == '{' || text[second] == '[' || text[second] == '"') &&
         Json::accept(text);
}

class Reader {
 public:
  Reader(std::string_view text, std::string_view file_name, Diagnostics& diagnostics)
      : text_(text), file_(file_name), diagnostics_(diagnostics) {
    machine_.name = "GRBL";
    machine_.slowest_spindle = rpm(0);
  }

  void read_text() {
    each_line(text_, [this](std::string_view line, std::size_t start) {
      read_line(line, start);
      return true;
    });
  }

  void read_json() {
    constexpr const char* kHint = R"(expected e.g. {"$110": "500"} or [{"setting": "$110", "value": "500"}])";
    try {
      walk(Json::parse(text_), 0);
    } catch (const Json::parse_error& problem) {
      const std::size_t at = problem.byte == 0 ? 0 : problem.byte - 1;
      diagnostics_.error(codes::machine_file, location_of(at), "malformed JSON").hint = kHint;
      return;
    }
    if (values_.empty() && reported_.empty())
      diagnostics_
          .error(codes::machine_file, TextLocation{file_, 0, 0}, "the JSON contains no setting of GRBL")
          .hint = kHint;
  }

  std::optional<Machine> finish(std::size_t errors_before) {
    const bool is_default = machine_.fastest_spindle == rpm(kDefaultRpm);  // that of a mill is unknown then
    if (is_default && machine_.laser != LaserDrive::follows) machine_.fastest_spindle.reset();
    const auto soft_limits = values_.find(20);
    if (soft_limits == values_.end() || soft_limits->second != 1.0) machine_.travel = {};  // $130 is 200 then
    if (diagnostics_.errors() > errors_before) return std::nullopt;
    note_missing();
    return machine_;
  }

 private:
  void read_line(std::string_view line, std::size_t start) {
    const std::string text = without_comments(line);
    std::vector<Written> written;
    settings_of(text, start, written);
    for (const Written& w : written) set(w);
  }

  void set(const Written& written) {
    const auto value = parse_number(written.value);
    const auto& all = grbl_settings();
    const auto setting = std::find_if(all.begin(), all.end(),
                                      [&](const GrblSetting& s) { return s.number == written.number; });
    const bool known = setting != all.end();
    if (known && (!value || *value < setting->low || *value > setting->high)) {
      if (reported_.insert(written.number).second)
        diagnostics_.error(codes::machine_value, location_of(written.at),
                           fmt::format("${} must be {}, found \"{}\"", setting->number, setting->meaning,
                                       written.value.substr(0, 40)));
      return;
    }
    if (!value) return;
    const auto [entry, is_new] = values_.emplace(written.number, *value);
    if (!is_new && entry->second != *value && known && reported_.insert(written.number).second)
      diagnostics_.warning(codes::machine_value, location_of(written.at),
                           fmt::format("${} was {} before and is {} here; the last value is used",
                                       written.number, exact_text(entry->second), exact_text(*value)));
    entry->second = *value;
    if (known) setting->set(machine_, *value);
  }

  Origin location_of(std::size_t at) const {
    const std::size_t start = text_.substr(0, at).find_last_of("\r\n") + 1;  // npos + 1 is 0
    return TextLocation{file_, line_of(text_, at), static_cast<std::uint32_t>(at - start) + 1};
  }

  /// "$110" and "110" as the name of a setting.
  static std::optional<int> setting_named(std::string_view name) {
    if (!name.empty() && name[0] == '$') name.remove_prefix(1);
    if (name.empty() || name.find_first_not_of(kDigits) != std::string_view::npos) return std::nullopt;
    return leading_number(name);
  }

  /// Objects with "$110" as a key or as a value beside "value", and texts with lines of settings.
  void walk(const Json& node, int depth) {
    if (depth > kMaxDepth) return;
    if (node.is_string()) {
      const auto& text = node.get_ref<const std::string&>();
      each_line(text, [this, &text](std::string_view line, std::size_t) {
        std::vector<Written> written;
        const std::string plain = without_comments(line);
        settings_of(plain, 0, written);
        for (Written& w : written) {
          w.at = std::min(text_.find(fmt::format("${}", w.number)), text_.size());
          set(w);
        }
        return !text.empty();
      });
    } else if (node.is_array()) {
      for (const Json& entry : node) walk(entry, depth + 1);
    } else if (node.is_object()) {
      walk_object(node, depth);
    }
  }

  void walk_object(const Json& object, int depth) {
    const auto value = object.find("value");
    for (const auto& [key, member] : object.items()) {
      if (const auto number = setting_named(key)) {
        const bool described = member.is_object() && member.contains("value");
        set_json(*number, described ? member["value"] : member);
      } else if (value != object.end() && member.is_string() && key != "value") {
        const auto named = setting_named(member.get_ref<const std::string&>());
        if (named && member.get_ref<const std::string&>()[0] == '$') set_json(*named, *value);
      } else {
        walk(member, depth + 1);
      }
    }
  }

  void set_json(int number, const Json& value) {
    const std::string text = value.is_string()   ? value.get<std::string>()
                             : value.is_number() ? value.dump()
                                                 : std::string(value.type_name());
    std::size_t at = text_.find(fmt::format("\"${}\"", number));
    if (at == std::string_view::npos) at = text_.find(fmt::format("\"{}\"", number));
    std::string_view trimmed = text;
    while (!trimmed.empty() && kBlanks.find(trimmed.front()) != kBlanks.npos) trimmed.remove_prefix(1);
    while (!trimmed.empty() && kBlanks.find(trimmed.back()) != kBlanks.npos) trimmed.remove_suffix(1);
    set({number, trimmed, at == std::string_view::npos ? text_.size() : at + 1});
  }

  void note_missing() {
    std::string missing;
    for (const int number : {11, 12, 110, 111, 112, 120, 121, 122})
      if (values_.count(number) == 0) missing += fmt::format("{}${}", missing.empty() ? "" : ", ", number);
    if (!missing.empty())
      diagnostics_.warning(
          codes::machine_incomplete, TextLocation{file_, 0, 0},
          fmt::format("the settings {} are missing; those of a small router are assumed", missing));
  }

  std::string_view text_;
  std::string file_;
  Diagnostics& diagnostics_;
  Machine machine_;
  std::map<int, double> values_;
  std::set<int> reported_;  // settings with an error or a warning
};

}  // namespace

bool has_grbl_settings(std::string_view text) {
  if (starts_as_json(text)) return true;
  bool found = false;
  each_line(text, [&found](std::string_view line, std::size_t) {
    std::vector<Written> written;
    const std::string plain = without_comments(line);
    settings_of(plain, 0, written);
    // In TOML a $ is within a text, behind the = of its key.
    found = !written.empty() && plain.find('=') >= written.front().at;
    return !found;
  });
  return found;
}

std::optional<Machine> read_grbl_settings(std::string_view text, std::string_view file_name,
                                          Diagnostics& diagnostics) {
  const std::size_t errors = diagnostics.errors();
  Reader reader(text, file_name, diagnostics);
  if (starts_as_json(text))
    reader.read_json();
  else
    reader.read_text();
  return reader.finish(errors);
}

}  // namespace kerf::detail
