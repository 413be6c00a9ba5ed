// The words with lasting effects, by modal group.
#include "codec/gcode/lasting_effect.h"

#include <cmath>

namespace kerf::gcode {
namespace {

struct Codes {
  int first, last;  // in tenths
  std::string_view effect;
};

constexpr Codes kGCodes[] = {
    {0, 30, "the modal motion"},
    {40, 40, ""},
    {50, 53, "the modal motion"},
    {70, 80, "the diameter mode"},
    {100, 100, "offsets or tool data"},
    {150, 160, "the polar mode"},
    {170, 191, "the plane"},
    {200, 210, "the unit"},
    {280, 280, "the position"},
    {281, 281, "the stored home"},
    {300, 300, "the position"},
    {301, 301, "the stored home"},
    {330, 331, "the modal motion"},
    {382, 385, "the position"},
    {400, 421, "cutter compensation"},
    {430, 490, "the tool length offset"},
    {500, 510, "the scale"},
    {520, 520, "the work zero"},
    {530, 530, "the position"},
    {540, 593, "the coordinate system"},
    {610, 640, ""},
    {680, 690, "the rotation of the coordinates"},
    {700, 890, "the modal motion"},
    {900, 900, "the distance mode"},
    {901, 901, "the distance mode of arc centres"},
    {910, 910, "the distance mode"},
    {911, 911, "the distance mode of arc centres"},
    {920, 923, "the work zero"},
    {930, 950, "the feed mode"},
    {960, 970, "the spindle mode"},
    {980, 990, "the retract level of cycles"},
};
constexpr Codes kMCodes[] = {
    {0, 10, "the run of the program"},
    {20, 20, "the end of the program"},
    {30, 50, "the spindle"},
    {60, 60, "the tool"},
    {70, 90, "the coolant"},
    {170, 180, "the motors"},
    {300, 300, "the end of the program"},
    {470, 470, "the run of the program"},
    {600, 600, "the run of the program"},
    {610, 610, "the tool"},
    {700, 730, "the stored modes"},
    {820, 830, "the extruder mode"},
    {840, 840, "the motors"},
    {970, 990, "the run of the program"},
    {1120, 1120, "the run of the program"},
};

template <std::size_t N>
std::string_view find(const Codes (&codes)[N], double value, std::string_view otherwise) {
  const double tenths = std::round(value * 10.0);
  for (const Codes& c : codes)
    if (tenths >= c.first && tenths <= c.last) return c.effect;
  return otherwise;
}

}  // namespace

std::string_view lasting_effect(char letter, double value) {
  switch (letter) {
    case 'G': return find(kGCodes, value, "the machine in an unknown way");
    case 'M': return find(kMCodes, value, "");
    case 'F': return "the feed";
    case 'S': return "the spindle speed";
    case 'T': return "the selected tool";
    case '$': return "the selected spindle";
    case 'A':
    case 'B':
    case 'C':
    case 'U':
    case 'V':
    case 'W':
    case 'X':
    case 'Y':
    case 'Z':
    case '@':
    case '^': return "the position";
    default: return "";
  }
}

LastingEffect lasting_effect(const Block& block) {
  if (block.percent) return {"%", "the end of the program", 1};
  if (block.optional) return {"/", "what is read, by the block delete switch", 1};
  if (block.o_word) return {std::string(block.o_word->text), "the run of the program", block.o_word->column};
  if (!block.assignments.empty())
    return {std::string(block.assignments[0].text), "a parameter", block.assignments[0].column};
  for (const Word& word : block.words) {
    const std::string text = word.letter + std::string(block.value_text(word));
    if (word.kind == ValueKind::expression) return {text, "what depends on parameters", word.column};
    const std::string_view effect = lasting_effect(word.letter, word.value);
    if (!effect.empty()) return {text, effect, word.column};
  }
  return {};
}

}  // namespace kerf::gcode
