// Starts and ends of files, templates, comments.
#include "back/gcode/file_texts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/gcode.h"
#include "base/names.h"
#include "base/number.h"
#include "path/own_header.h"

#include "kerf/base/limits.h"
#include "kerf/base/units.h"
#include "kerf/path/report.h"

namespace kerf::gcode {
namespace {

#ifndef KERF_VERSION
#define KERF_VERSION "0"
#endif

bool is_empty_comment(std::string_view line) {
  return is_comment(line) && line.find_first_not_of("(); ") == std::string_view::npos;
}

}  // namespace

/// Whether LinuxCNC would carry out a comment with this text ("LOGOPEN, file"). MSG only shows a text.
bool acts(std::string_view text) {
  constexpr std::string_view kWords[] = {"LOG", "PROBEOPEN", "PROBECLOSE", "ABORT", "PY", "DEBUG", "PRINT"};
  const std::string start = fold_name(text.substr(0, text.find_first_of(", ")));
  return std::any_of(std::begin(kWords), std::end(kWords),
                     [&](std::string_view word) { return start.rfind(fold_name(word), 0) == 0; });
}

bool is_comment(std::string_view line) {
  return !line.empty() && (line.front() == '(' || line.front() == ';');
}

/// The lines before a program's first comment: "%" and the program number.
bool is_opening(std::string_view line) { return line == "%" || line.substr(0, 1) == "O"; }

void FileTexts::start_file(std::size_t first_step, ToolChangePolicy policy) {
  file_start_ = first_step;
  figures_.reset();
  extruder_ = 0;
  bool moved = false;
  file_tool_.reset();
  for (file_end_ = file_start_; file_end_ < path_.size(); ++file_end_) {
    const Step& s = path_[file_end_];
    // Rapids before the first tool, as those of a retract, are of its file.
    moved = moved || (s.is_motion() && (file_tool_ || s.kind() != StepKind::rapid));
    if (s.kind() != StepKind::tool_change) continue;
    if (moved && s.tool_change().kind == ToolChangeKind::number_only) continue;
    const int tool = s.tool_change().tool;
    if (!moved)
      file_tool_ = tool;
    else if (policy == ToolChangePolicy::files && tool != file_tool_)
      return;
  }
}

/// Text that is safe in a comment: printable ASCII, no parentheses, no characters that controllers execute.
std::string FileTexts::sanitised(std::string_view text, std::size_t longest) const {
  std::string out;
  for (const char c : text.substr(0, longest)) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0u) == 0x80u) continue;  // within a character of several bytes
    const bool plain = byte >= 0x20 && byte < 0x7f;
    if (!plain)
      out += '_';
    else if (profile_.comment_forbidden.find(c) != std::string::npos)
      out += '.';
    else
      out += profile_.comments != CommentStyle::brackets ? c : c == '(' ? '[' : c == ')' ? ']' : c;
  }
  return out;
}

/// A message for the operator is one where the controller has such comments.
void FileTexts::comment(std::string_view text, NoteKind kind) {
  if (profile_.comments == CommentStyle::none) return;
  std::string clean = sanitised(trim(text), limits::kMaxTemplateValueBytes);
  if (clean.empty()) return;
  const bool message = kind == NoteKind::message && profile_.comments == CommentStyle::brackets;
  if (message)
    clean = "MSG, " + clean;
  else if (acts(clean))
    clean = "- " + clean;
  clean = clean.substr(0, profile_.longest_line - 3);
  lines_.start_line();
  lines_.drop_line();
  const bool parentheses = profile_.comments == CommentStyle::brackets;
  lines_.put(parentheses ? "(" : "; ");
  lines_.put(clean);
  if (parentheses) lines_.put(")");
  lines_.end_line(path_.size());
}

/// A comment beside those of the header's template.
void FileTexts::header_comment(std::string_view text) {
  if (profile_.comments == CommentStyle::none) return;
  const bool parentheses = profile_.comments == CommentStyle::brackets;
  const std::string line = (parentheses ? "(" : "; ") + std::string(text) + (parentheses ? ")" : "");
  if (line.size() > profile_.longest_line)
    divided_comment(line);
  else
    words_.raw_line(line);
}

void FileTexts::header() {
  const auto first = std::find_if_not(profile_.header.begin(), profile_.header.end(), is_opening);
  const auto first_code = std::find_if_not(first, profile_.header.end(), is_comment);
  templates({profile_.header.begin(), first_code});
  for (const std::string& text : options_.stock_comments) header_comment(text);
  if (!options_.start_tool.empty() && file_start_ == 0) header_comment(options_.start_tool);
  if (filament_.needs_comment())
    lines_.text_line("; filament_diameter = " + number_text(filament_.diameter().mm(), 4));
  const bool volumes = profile_.extruder.unit == ExtruderUnit::volume && path_.has(StepKind::extrude);
  if (volumes) header_comment("use_volumetric_e = 1");
  thumbnails();
  templates({first_code, profile_.header.end()});
  if (volumes && profile_.has_m(2000)) words_.raw_line("M200 D" + number_text(filament_.diameter().mm(), 4));
}

/// A line of a template that states what the program has not.
bool FileTexts::lacks_value(std::string_view line, std::string_view key) {
  const bool states = line.find(fmt::format("{{{}}}", key)) != std::string_view::npos;
  return states && value_of(key).value_or("").empty();
}

void FileTexts::templates(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    if (lacks_value(line, "tool_name")) continue;
    if (lacks_value(line, "filament_diameter") || lacks_value(line, "extruder_zero")) continue;
    std::string text = expanded(line);
    if (is_empty_comment(text)) continue;
    if (is_comment(text)) {
      if (profile_.comments == CommentStyle::none) continue;
      if (text.size() > profile_.longest_line) {
        divided_comment(text);
        continue;
      }
    }
    if (!text.empty()) words_.raw_line(text);
  }
}

/// A comment that is longer than a line continues after a comma in the next one; without a comma its end is
/// left out.
void FileTexts::divided_comment(std::string_view text) {
  const bool parentheses = text.front() == '(';
  const std::string_view open = parentheses ? "(" : "; ", close = parentheses ? ")" : "";
  text = trim(text.substr(1, text.size() - 1 - close.size()));
  const std::size_t room = profile_.longest_line - open.size() - close.size();
  while (text.size() > room) {
    const std::size_t comma = text.rfind(", ", room - 1);
    if (comma == std::string_view::npos) break;
    words_.raw_line(fmt::format("{}{}{}", open, text.substr(0, comma + 1), close));
    text.remove_prefix(comma + 2);
  }
  words_.raw_line(fmt::format("{}{}{}", open, text.substr(0, room), close));
}

std::string FileTexts::expanded(std::string_view line) {
  std::string out;
  while (!line.empty()) {
    const std::size_t open = line.find('{');
    out += line.substr(0, open);
    if (open == std::string_view::npos) break;
    const std::size_t close = line.find('}', open);
    const std::string_view key =
        line.substr(open + 1, close == std::string_view::npos ? close : close - open - 1);
    if (const auto value = value_of(key))
      out += sanitised(*value, key == "tool_name" ? value->size() : limits::kMaxTemplateValueBytes);
    else
      diagnostics_
          .error(codes::post_placeholder, {}, fmt::format("post {}: unknown name {{{}}}", profile_.name, key))
          .hint =
          "names: name, units, tool, tool_name, tool_comment, tools, bounds, time, version, profile, "
          "extruder, extruder_zero, extruder_number, extruder_name, filament_diameter, filament_mm, "
          "filament_cm3, layers, "
          "layer_height, nozzle, bed, "
          "chamber, and those of the section variables";
    if (close == std::string_view::npos) break;
    line.remove_prefix(close + 1);
  }
  return out;
}

std::optional<std::string> FileTexts::value_of(std::string_view key) {
  const int tool = tool_ ? *tool_ : file_tool_.value_or(0);
  const auto of_tool = [tool](const std::map<int, std::string>& texts) {
    const auto it = texts.find(tool);
    return it == texts.end() ? std::string() : it->second;
  };
  if (key == "name") return options_.program_name;
  if (key == "units") return units_.unit == LengthUnit::mm ? "G21" : "G20";
  if (key == "tool") return fmt::format("{}", tool);
  if (key == "tool_name") return of_tool(options_.tool_names);
  if (key == "tool_comment") return of_tool(options_.tool_comments);
  if (key == "tools") return tools_text();
  if (key == "bounds") return bounds_text();
  if (key == "time") return time_text();
  if (key == "version") return KERF_VERSION;
  if (key == "profile") {
    const bool as_beam = profile_.drive.kind != Drive::beam && path_.has(StepKind::laser_power);
    const bool has_own = profile_.dialect.empty() || profile_.dialect == profile_.name;
    return profile_.name + (has_own ? "" : std::string(kForDialect) + profile_.dialect) +
           (as_beam ? std::string(kForBeam) : std::string());
  }
  for (const auto* variables : {&options_.variables, &profile_.variables})
    if (const auto it = variables->find(std::string(key)); it != variables->end()) return it->second;
  return print_value_of(key);
}

/// Figures of the file, computed at the first use in a template.
const MotionFigures& FileTexts::figures() {
  if (!figures_) figures_ = report_on(path_, {.first = file_start_, .end = file_end_}).all;
  return *figures_;
}

std::string FileTexts::bounds_text() {
  const Box3& box = figures().cut_bounds;
  if (box.empty()) return {};
  const double unit_mm = units_.unit_mm;
  std::string text = "cuts within";
  for (int axis = 0; axis < 3; ++axis)
    text += fmt::format(" {} {} to {}", "XYZ"[axis], number_text(box.low[axis] / unit_mm, 3),
                        number_text(box.high[axis] / unit_mm, 3));
  return text + (units_.unit == LengthUnit::mm ? " mm" : " inch");
}

std::string FileTexts::time_text() {
  const MotionFigures& all = figures();
  const double seconds = (all.cutting + all.rapid + all.dwell).seconds();
  if (!(seconds > 0.0 && seconds < 1e9)) return {};
  const auto whole = static_cast<long long>(std::llround(seconds));
  return fmt::format("about {}:{:02}:{:02}, acceleration not counted", whole / 3600, whole / 60 % 60,
                     whole % 60);
}

std::string FileTexts::tools_text() const {
  std::string text;
  std::optional<int> last;
  for (std::size_t i = file_start_; i < file_end_; ++i) {
    const Step& s = path_[i];
    if (s.kind() != StepKind::tool_change || last == s.tool_change().tool) continue;
    last = s.tool_change().tool;
    text += fmt::format("{}{}", text.empty() ? "tools " : ", ", *last);
    if (text.size() > 60) return text + " ...";
  }
  return text;
}

}  // namespace kerf::gcode
