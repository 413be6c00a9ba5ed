// The texts of a posted file: templates, comments, and the values that templates name.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "back/gcode/modal_words.h"
#include "back/gcode/post_part.h"

#include "kerf/path/report.h"

namespace kerf::gcode {

/// True for a line of a template that is a comment.
bool is_comment(std::string_view line);
/// True for a step that extrudes filament.
bool lays_bead(const Toolpath& path, std::size_t i);
/// True for the text of a comment that a controller would carry out.
bool acts(std::string_view text);

/// The filament of a print.
class Filament : PostPart {
 public:
  explicit Filament(PostContext& context);

  Length diameter() const { return diameter_; }
  /// In mm2, of its section.
  double area() const;
  /// Whether a print needs a comment with the diameter: it is an unusual one, and the header has none.
  bool needs_comment() const;

 private:
  Length diameter_;
};

/// What the header of a printer's post does itself, so that the program's own steps for it are not repeated.
class HeaderActs {
 public:
  explicit HeaderActs(const PostProfile& profile);

  bool homes() const { return homes_; }
  /// `wait`: and waits for the temperature.
  bool heats(Heater heater, bool wait) const {
    const auto h = static_cast<std::size_t>(heater);
    return wait ? waits_[h] : sets_[h];
  }

 private:
  bool homes_ = false;
  bool sets_[3] = {}, waits_[3] = {};
};

class FileTexts : PostPart {
 public:
  FileTexts(PostContext& context, ModalWords& words, const Filament& filament)
      : PostPart(context), words_(words), filament_(filament) {}

  /// Finds the tool of the file that starts at a step, and the end of the file.
  void start_file(std::size_t first_step, ToolChangePolicy policy);
  std::size_t end_of_file() const { return file_end_; }
  /// At the first motion of the file.
  std::optional<int> file_tool() const { return file_tool_; }
  void header();
  void templates(const std::vector<std::string>& lines);
  void comment(std::string_view text, NoteKind kind = NoteKind::comment);

  std::optional<int> tool() const { return tool_; }
  void set_tool(std::optional<int> tool) { tool_ = tool; }
  void set_extruder(int number) { extruder_ = number; }

 private:
  void header_comment(std::string_view text);
  void divided_comment(std::string_view text);
  void thumbnails();
  bool lacks_value(std::string_view line, std::string_view key);
  std::string expanded(std::string_view line);
  std::optional<std::string> value_of(std::string_view key);
  std::optional<std::string> print_value_of(std::string_view key);
  std::string sanitised(std::string_view text, std::size_t longest) const;
  const MotionFigures& figures();
  std::string bounds_text();
  std::string time_text();
  std::string tools_text() const;

  ModalWords& words_;
  const Filament& filament_;
  std::size_t file_start_ = 0, file_end_ = 0;  // steps of the current file
  std::optional<MotionFigures> figures_;       // of those steps
  std::optional<int> file_tool_;
  std::optional<int> tool_;
  int extruder_ = 0;
};

}  // namespace kerf::gcode
