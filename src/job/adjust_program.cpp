// Programs of path drawings with their heights corrected by measured values, from the files of a drawing.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>

#include "back/pathdxf/adjust_z.h"
#include "base/codes/pathdxf.h"
#include "base/ending.h"
#include "job/path_programs.h"

#include "kerf/base/files.h"
#include "kerf/base/limits.h"

namespace kerf {
namespace {

constexpr Length kSamePosition = mm(0.2);  // of a measured position and the probe's

constexpr Bilingual kNoList{
    "this is no list of probes; specify files with positions with --measured",
    "Das ist keine Liste von Z-Probes; Dateien mit Positionen mit --measured angeben"};
constexpr Bilingual kCounts{"the program measures {} positions, {} lists {} probes",
                            "Das Programm misst {} Positionen, {} nennt {} Z-Probes"};
constexpr Bilingual kDeviation{"Value {} for #{} differs from {} by more than /m={}",
                               "Wert {} für #{} weicht von {} um mehr als /m={} ab"};

/// The name without what is appended to it: "part.dxf", "part_Clean.gcode", "part_Z.txt".
std::string base_of(const std::string& name) {
  for (const std::string_view ending : {".dxf", "_clean.gcode", "_z.txt", "_milling.gcode", ".gcode"})
    if (has_ending(name, ending)) return name.substr(0, name.size() - ending.size());
  return name;
}

class Adjustment {
 public:
  Adjustment(std::string base, const AdjustOptions& options, Diagnostics& diagnostics, Progress* progress)
      : base_(std::move(base)), options_(options), diagnostics_(diagnostics), progress_(progress) {}

  std::optional<AdjustedProgram> run();

 private:
  std::optional<InputFile> open(const std::string& name) {
    if (options_.report) options_.report(name);
    return InputFile::open(name, diagnostics_, limits::kMaxProgramBytes, progress_);
  }
  template <class... Values>
  std::string text(const Bilingual& message, const Values&... values) const {
    return fmt::format(fmt::runtime(message.in(options_.reading.language)), values...);
  }
  std::optional<MeasuredFile> read_list();
  std::vector<HeightTarget> targets(const MeasuredFile& list);
  std::optional<std::map<int, double>> values(const MeasuredFile& list);
  void check_deviations(std::string_view program, const std::map<int, double>& heights);

  std::string base_;
  const AdjustOptions& options_;
  Diagnostics& diagnostics_;
  Progress* progress_;
};

std::optional<MeasuredFile> Adjustment::read_list() {
  const std::string name = base_ + path_endings::kProbeList;
  const auto file = open(name);
  if (!file) return std::nullopt;
  MeasuredFile list =
      read_measured(file->bytes(), name, {options_.reading.language, std::nullopt}, diagnostics_);
  if (list.format != HeightsFormat::probe_list && !list.heights.empty())
    diagnostics_.error(codes::heights_format, TextLocation{list.file, 0, 0}, text(kNoList));
  return list;
}

/// The probes of a list, with the positions where the probing program measures them.
std::vector<HeightTarget> Adjustment::targets(const MeasuredFile& list) {
  std::vector<HeightTarget> out;
  for (const MeasuredHeight& h : list.heights) out.push_back({*h.variable, {}, h.expected});
  if (options_.measured.empty()) return out;
  const auto probing = open(base_ + path_endings::kProbing);
  if (!probing) return {};
  const auto positions = probed_positions(probing->bytes());
  if (positions.size() != out.size()) {
    diagnostics_.error(codes::heights_unmatched, TextLocation{probing->path(), 0, 0},
                       text(kCounts, positions.size(), list.file, out.size()));
    return {};
  }
  for (std::size_t i = 0; i < out.size(); ++i) out[i].at = positions[i];
  return out;
}

std::optional<std::map<int, double>> Adjustment::values(const MeasuredFile& list) {
  const auto of = [&](const MeasuredFile& measured) {
    return heights_of(measured, targets(list), kSamePosition, options_.max_correction,
                      options_.reading.language, diagnostics_);
  };
  if (options_.measured.empty()) return of(list);
  const auto file = open(options_.measured);
  if (!file) return std::nullopt;
  const MeasuredFile measured =
      read_measured(file->bytes(), options_.measured, options_.reading, diagnostics_);
  if (diagnostics_.has_errors()) return std::nullopt;
  return of(measured);
}

/// Lists in the form of PathDxf2GCode's manual have no T: the formulas have it.
void Adjustment::check_deviations(std::string_view program, const std::map<int, double>& heights) {
  for (const auto& [variable, expected] : expected_heights(program)) {
    const auto height = heights.find(variable);
    if (height == heights.end() || std::abs(height->second - expected) <= options_.max_correction.mm())
      continue;
    diagnostics_.error(codes::heights_deviation, TextLocation{base_ + path_endings::kProbeList, 0, 0},
                       text(kDeviation, expected, variable, height->second, options_.max_correction.mm()));
  }
}

std::optional<AdjustedProgram> Adjustment::run() {
  const std::size_t errors = diagnostics_.errors();
  const auto list = read_list();
  if (!list || diagnostics_.errors() > errors) return std::nullopt;
  const auto heights = values(*list);
  if (!heights || diagnostics_.errors() > errors) return std::nullopt;
  const auto program = open(base_ + path_endings::kClean);
  if (!program) return std::nullopt;
  check_deviations(program->bytes(), *heights);
  auto text = adjust_z(program->bytes(), program->path(), *heights, options_.reading.language, diagnostics_);
  if (!text || diagnostics_.errors() > errors) return std::nullopt;
  return AdjustedProgram{base_, std::string(program->bytes()), std::move(*text)};
}

}  // namespace

std::optional<AdjustedProgram> adjust_path_program(const std::string& name, const AdjustOptions& options,
                                                   Diagnostics& diagnostics, Progress* progress) {
  return Adjustment(base_of(name), options, diagnostics, progress).run();
}

}  // namespace kerf
