// Lines of retraction by the firmware. Sources: Marlin's pages G010, G011, M207, M208; Duet's "GCode
// dictionary"; Klipper's page "G-Codes", firmware_retraction.
#include "path/firmware_retraction.h"

#include <algorithm>

#include "base/names.h"
#include "base/number.h"

namespace kerf {
namespace {

constexpr double kPerMinute = 60.0;
constexpr double kMaxLength = 1000.0, kMaxSpeed = 1e6;  // mm, mm/min

/// The value that a word of a line sets; null for words of other lines.
std::optional<double>* value_of(std::string_view code, std::string_view word, RetractionLengths& lengths) {
  const bool klipper = code == "setretraction";
  if (klipper && word == "retractlength") return &lengths.length;
  if (klipper && word == "retractspeed") return &lengths.speed;
  if (klipper && word == "unretractextralength") return &lengths.extra;
  if (klipper && word == "unretractspeed") return &lengths.return_speed;
  if (code == "m207" && word == "s") return &lengths.length;
  if (code == "m207" && word == "f") return &lengths.speed;
  if (code == "m207" && word == "r") return &lengths.extra;
  if (code == "m207" && word == "t") return &lengths.return_speed;
  if (code == "m207" && word == "z") return &lengths.hop;
  if (code == "m208" && word == "s") return &lengths.extra;
  if (code == "m208" && word == "f") return &lengths.return_speed;
  return nullptr;
}

/// "S1.5" or "RETRACT_LENGTH=1.5"; false for what the line cannot have.
bool read_word(std::string_view code, std::string_view word, RetractionLengths& lengths) {
  const std::size_t sign = word.find('=');
  const bool named = sign != std::string_view::npos;
  const auto number = parse_number(word.substr(named ? sign + 1 : 1));
  if (!number) return false;
  const std::string name = fold_name(word.substr(0, named ? sign : 1));
  if (code == "g10" || code == "g11") return name == "s";  // of long retractions; the same here
  std::optional<double>* value = value_of(code, name, lengths);
  if (value == nullptr) return false;
  const bool is_speed = value == &lengths.speed || value == &lengths.return_speed;
  *value = *number * (is_speed && code == "setretraction" ? kPerMinute : 1.0);
  return **value >= (is_speed ? 0.0 : -kMaxLength) && **value <= (is_speed ? kMaxSpeed : kMaxLength);
}

}  // namespace

void RetractionLengths::update(const RetractionLengths& other) {
  if (other.length) length = other.length;
  if (other.speed) speed = other.speed;
  if (other.extra) extra = other.extra;
  if (other.return_speed) return_speed = other.return_speed;
  if (other.hop) hop = other.hop;
}

std::string retraction_in_mm(std::string_view text, double unit_mm) {
  constexpr int kDecimals = 6;
  text = trim(text.substr(0, text.find(';')));
  std::size_t end = std::min(text.find_first_of(" \t"), text.size());
  std::string out(text.substr(0, end));
  for (text = trim(text.substr(end)); !text.empty(); text = trim(text.substr(end))) {
    end = std::min(text.find_first_of(" \t"), text.size());
    const auto number = parse_number(text.substr(1, end - 1));
    out += ' ';
    out += text[0];
    if (number) out += number_text(*number * unit_mm, kDecimals);
  }
  return out;
}

FirmwareRetraction read_firmware_retraction(std::string_view text) {
  text = trim(text.substr(0, text.find(';')));
  std::size_t end = std::min(text.find_first_of(" \t"), text.size());
  const std::string code = fold_name(text.substr(0, end));
  FirmwareRetraction made;
  const bool back = code == "g10", forth = code == "g11";
  if (!back && !forth && code != "m207" && code != "m208" && code != "setretraction") return made;
  for (text = trim(text.substr(end)); !text.empty(); text = trim(text.substr(end))) {
    end = std::min(text.find_first_of(" \t"), text.size());
    if (!read_word(code, text.substr(0, end), made.lengths)) return {};
  }
  if (!back && !forth && !made.lengths.any()) return {};
  made.line = back ? RetractionLine::back : forth ? RetractionLine::forth : RetractionLine::lengths;
  return made;
}

}  // namespace kerf
