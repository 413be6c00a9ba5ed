// The texts of prints: thumbnails and the values of the filament.
#include <algorithm>
#include <fmt/format.h>
#include <numbers>

#include "back/gcode/file_texts.h"
#include "base/number.h"
#include "path/bead.h"

namespace kerf::gcode {
namespace {

constexpr double kSameLayer = 0.01;         // mm in Z
constexpr std::size_t kThumbnailLine = 78;  // characters of a picture on each line

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += k <= count ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
  }
  return out;
}

}  // namespace

bool lays_bead(const Toolpath& path, std::size_t i) {
  return path[i].kind() == StepKind::extrude && path.extrude(i).volume > Volume();
}

void FileTexts::thumbnails() {
  if (profile_.comments != CommentStyle::semicolon || !profile_.has_letter('E')) return;
  for (const Thumbnail& picture : options_.thumbnails) {
    const std::string text = base64(picture.png);
    lines_.text_line(";");
    lines_.text_line(fmt::format("; thumbnail begin {}x{} {}", picture.width, picture.height, text.size()));
    for (std::size_t k = 0; k < text.size(); k += kThumbnailLine)
      lines_.text_line("; " + text.substr(k, kThumbnailLine));
    lines_.text_line("; thumbnail end");
    lines_.text_line(";");
  }
}

/// The names of templates for prints; those of the steps of the current file.
std::optional<std::string> FileTexts::print_value_of(std::string_view key) {
  const bool prints = path_.has(StepKind::extrude);
  if (key == "extruder_zero") return prints ? "G92 E0" : "";
  if (key == "filament_diameter" && !prints) return "";
  if (key == "extruder")
    return !prints ? "" : profile_.extruder.mode == ExtruderMode::relative ? "M83" : "M82";
  if (key == "extruder_number") return fmt::format("{}", extruder_);
  if (key == "extruder_name") return extruder_ == 0 ? "extruder" : fmt::format("extruder{}", extruder_);
  if (key == "filament_diameter") return number_text(filament_.diameter().mm(), 4);
  constexpr std::string_view kHeaters[] = {"nozzle", "bed", "chamber"};
  for (std::size_t h = 0; h < std::size(kHeaters); ++h) {
    if (key != kHeaters[h]) continue;
    double celsius = 0.0;
    for (std::size_t i = file_start_; i < file_end_; ++i) {
      if (lays_bead(path_, i) && celsius > 0.0) break;
      if (path_[i].kind() != StepKind::temperature) continue;
      const step::Temperature t = path_[i].temperature();
      if (static_cast<std::size_t>(t.heater) == h && t.celsius > 0.0) celsius = t.celsius;
    }
    return number_text(celsius, 1);
  }
  if (key != "filament_mm" && key != "filament_cm3" && key != "layers" && key != "layer_height")
    return std::nullopt;
  double volume = 0.0;
  std::vector<double> levels;
  for (std::size_t i = file_start_; i < file_end_; ++i) {
    if (path_[i].kind() != StepKind::extrude) continue;
    const step::Extrude bead = path_.extrude(i);
    volume += bead.volume.mm3();
    if (bead.volume > Volume() && (levels.empty() || bead.to.z != levels.back())) levels.push_back(bead.to.z);
  }
  if (key == "filament_mm") return number_text(volume / filament_.area(), 2);
  if (key == "filament_cm3") return number_text(1e-3 * volume, 3);
  std::sort(levels.begin(), levels.end());
  const auto same = [](double a, double b) { return b - a <= kSameLayer; };
  levels.erase(std::unique(levels.begin(), levels.end(), same), levels.end());
  if (key == "layers") return fmt::format("{}", levels.size());
  return number_text(levels.empty() ? 0.0 : levels.front(), 3);
}

namespace {

/// Whether a line of a template is this command.
bool is_command(std::string_view line, std::string_view code) {
  return line.starts_with(code) && (line.size() == code.size() || line[code.size()] == ' ');
}

}  // namespace

/// A macro that is given a temperature heats and waits, such as START_PRINT BED={bed}.
HeaderActs::HeaderActs(const PostProfile& profile) {
  constexpr std::string_view kSet[] = {"M104", "M140", "M141"}, kWait[] = {"M109", "M190", "M191"};
  constexpr std::string_view kName[] = {"{nozzle}", "{bed}", "{chamber}"};
  for (const std::string& line : profile.header) {
    homes_ = homes_ || is_command(line, "G28");
    for (std::size_t h = 0; h < std::size(kSet); ++h) {
      const bool macro = !is_comment(line) && line[0] != 'M' && line.find(kName[h]) != std::string::npos;
      waits_[h] = waits_[h] || macro || is_command(line, kWait[h]);
      sets_[h] = sets_[h] || waits_[h] || is_command(line, kSet[h]);
    }
  }
}

namespace {

/// That of the printer, else of the program, else the usual one.
Length diameter_of(const PostProfile& profile, const PostOptions& options, const Toolpath& path) {
  for (const Length diameter : {profile.filament, options.filament, filament_of_path(path)})
    if (diameter > Length()) return diameter;
  return kUsualFilament;
}

}  // namespace

Filament::Filament(PostContext& context)
    : PostPart(context), diameter_(diameter_of(profile_, options_, path_)) {}

bool Filament::needs_comment() const {
  if (diameter_ == kUsualFilament) return false;
  if (profile_.comments != CommentStyle::semicolon || !path_.has(StepKind::extrude)) return false;
  return std::none_of(profile_.header.begin(), profile_.header.end(), [](const std::string& line) {
    return is_comment(line) && line.find("filament_diameter") != std::string::npos;
  });
}

double Filament::area() const {
  const double radius = 0.5 * diameter_.mm();
  return std::numbers::pi * radius * radius;
}

}  // namespace kerf::gcode
