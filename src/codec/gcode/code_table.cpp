// The table of codes.
#include "codec/gcode/code_table.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <iterator>

namespace kerf::gcode {
namespace {

constexpr CodeEntry kGCodes[] = {
    {0, Group::motion, Support::read},         {10, Group::motion, Support::read},
    {20, Group::motion, Support::read},        {30, Group::motion, Support::read},
    {40, Group::dwell, Support::read},         {50, Group::motion, Support::read},
    {51, Group::motion, Support::read},        {52, Group::motion, Support::read},
    {53, Group::motion, Support::read},        {70, Group::lathe, Support::read},
    {80, Group::lathe, Support::read},         {100, Group::reference, Support::read},
    {120, Group::reference, Support::read},    {130, Group::reference, Support::read},
    {150, Group::polar, Support::read},        {160, Group::polar, Support::read},
    {170, Group::plane, Support::read},        {180, Group::plane, Support::read},
    {190, Group::plane, Support::read},        {200, Group::units, Support::read},
    {171, Group::plane, Support::missing},     {181, Group::plane, Support::missing},
    {191, Group::plane, Support::missing},     {210, Group::units, Support::read},
    {280, Group::reference, Support::read},    {281, Group::reference, Support::read},
    {300, Group::reference, Support::read},    {301, Group::reference, Support::read},
    {310, Group::motion, Support::read},       {330, Group::motion, Support::read},
    {331, Group::motion, Support::read},       {382, Group::motion, Support::read},
    {383, Group::motion, Support::read},       {384, Group::motion, Support::read},
    {385, Group::motion, Support::read},       {400, Group::compensation, Support::read},
    {410, Group::compensation, Support::read}, {411, Group::compensation, Support::read},
    {420, Group::compensation, Support::read}, {421, Group::compensation, Support::read},
    {430, Group::tool_length, Support::read},  {431, Group::tool_length, Support::read},
    {432, Group::tool_length, Support::read},  {490, Group::tool_length, Support::read},
    {500, Group::scaling, Support::read},      {510, Group::scaling, Support::read},
    {520, Group::reference, Support::read},    {530, Group::machine_coordinates, Support::read},
    {540, Group::coordinates, Support::read},  {550, Group::coordinates, Support::read},
    {560, Group::coordinates, Support::read},  {570, Group::coordinates, Support::read},
    {580, Group::coordinates, Support::read},  {590, Group::coordinates, Support::read},
    {591, Group::coordinates, Support::read},  {592, Group::coordinates, Support::read},
    {593, Group::coordinates, Support::read},  {610, Group::path_control, Support::read},
    {611, Group::path_control, Support::read}, {640, Group::path_control, Support::read},
    {650, Group::subroutine, Support::read},   {660, Group::subroutine, Support::read},
    {670, Group::subroutine, Support::read},   {680, Group::rotation, Support::read},
    {690, Group::rotation, Support::read},     {700, Group::motion, Support::missing},
    {710, Group::motion, Support::missing},    {711, Group::motion, Support::missing},
    {712, Group::motion, Support::missing},    {720, Group::motion, Support::missing},
    {721, Group::motion, Support::missing},    {722, Group::motion, Support::missing},
    {730, Group::motion, Support::read},       {740, Group::motion, Support::read},
    {760, Group::motion, Support::read},       {800, Group::motion, Support::read},
    {810, Group::motion, Support::read},       {820, Group::motion, Support::read},
    {830, Group::motion, Support::read},       {840, Group::motion, Support::read},
    {850, Group::motion, Support::read},       {860, Group::motion, Support::read},
    {870, Group::motion, Support::read},       {880, Group::motion, Support::read},
    {890, Group::motion, Support::read},       {900, Group::distance, Support::read},
    {901, Group::arc_distance, Support::read}, {910, Group::distance, Support::read},
    {911, Group::arc_distance, Support::read}, {920, Group::reference, Support::read},
    {921, Group::reference, Support::read},    {922, Group::reference, Support::read},
    {923, Group::reference, Support::read},    {930, Group::feed_mode, Support::read},
    {940, Group::feed_mode, Support::read},    {950, Group::feed_mode, Support::read},
    {960, Group::spindle_mode, Support::read}, {970, Group::spindle_mode, Support::read},
    {980, Group::retract, Support::read},      {990, Group::retract, Support::read},
};

constexpr CodeEntry kMCodes[] = {
    {0, Group::stop, Support::read},
    {10, Group::stop, Support::read},
    {20, Group::stop, Support::read},
    {30, Group::spindle, Support::read},
    {40, Group::spindle, Support::read},
    {50, Group::spindle, Support::read},
    {60, Group::tool_change, Support::read},
    {70, Group::mist, Support::read},
    {80, Group::flood, Support::read},
    {90, Group::no_coolant, Support::read},
    {190, Group::other, Support::ignored},
    {300, Group::stop, Support::read},
    {480, Group::override_switch, Support::ignored},
    {490, Group::override_switch, Support::ignored},
    {500, Group::override_switch, Support::ignored},
    {510, Group::override_switch, Support::ignored},
    {520, Group::override_switch, Support::ignored},
    {530, Group::override_switch, Support::ignored},
    {560, Group::other, Support::ignored},
    {600, Group::stop, Support::read},
    {610, Group::tool_change, Support::read},
    {620, Group::other, Support::ignored},
    {630, Group::other, Support::ignored},
    {640, Group::other, Support::ignored},
    {650, Group::other, Support::ignored},
    {660, Group::other, Support::ignored},
    {670, Group::other, Support::ignored},
    {680, Group::other, Support::ignored},
    {700, Group::saved_modes, Support::read},
    {710, Group::saved_modes, Support::read},
    {720, Group::saved_modes, Support::read},
    {730, Group::saved_modes, Support::read},
    {820, Group::other, Support::read},
    {830, Group::other, Support::read},
    {840, Group::other, Support::read},
    {970, Group::other, Support::missing},
    {980, Group::subroutine, Support::read},
    {990, Group::subroutine, Support::read},
};

/// Codes below 100 in tenths, as an index into a table (0 = unknown).
template <std::size_t N>
constexpr std::array<std::uint8_t, 1000> index_of(const CodeEntry (&entries)[N]) {
  static_assert(N < 255);
  std::array<std::uint8_t, 1000> index{};
  for (std::size_t i = 0; i < N; ++i)
    index[static_cast<std::size_t>(entries[i].number)] = static_cast<std::uint8_t>(i + 1);
  return index;
}
constexpr auto kGIndex = index_of(kGCodes);
constexpr auto kMIndex = index_of(kMCodes);

template <std::size_t N>
const CodeEntry* find(const CodeEntry (&entries)[N], const std::array<std::uint8_t, 1000>& index,
                      Tenths number) {
  if (number < 0 || number >= 1000) return nullptr;
  const std::uint8_t at = index[static_cast<std::size_t>(number)];
  return at == 0 ? nullptr : &entries[at - 1];
}

}  // namespace

const CodeEntry* find_g_code(Tenths number) { return find(kGCodes, kGIndex, number); }

/// Holes on a circle and on an arc (G70, G71), the smoothness of motions (G187).
const CodeEntry* find_haas_g_code(Tenths number) {
  static constexpr CodeEntry kCodes[] = {{700, Group::reference, Support::read},
                                         {710, Group::reference, Support::read},
                                         {1870, Group::other, Support::ignored}};
  for (const CodeEntry& entry : kCodes)
    if (entry.number == number) return &entry;
  return find_g_code(number);
}

const CodeEntry* find_m_code(Tenths number) { return find(kMCodes, kMIndex, number); }

/// Brakes of the fourth and fifth axis (M10 to M13), chip conveyor (M31, M33), coolant spigot (M34, M35),
/// gears (M41, M42), air through the tool (M73, M74), door (M80, M81), air gun (M83, M84), coolant through
/// the spindle (M88, M89), variation of the spindle's speed (M138, M139), mist extractor (M158, M159).
/// Source: Haas, Mill Operator's Manual, "M-codes".
bool is_idle_on_haas(Tenths number) {
  constexpr int kCodes[] = {10, 11, 12, 13, 31, 33, 34, 35,  41,  42,  73,
                            74, 80, 81, 83, 84, 88, 89, 138, 139, 158, 159};
  return std::any_of(std::begin(kCodes), std::end(kCodes), [=](int code) { return 10 * code == number; });
}

std::string code_text(char letter, Tenths number) {
  if (number % 10 == 0) return fmt::format("{}{}", letter, number / 10);
  return fmt::format("{}{}.{}", letter, number / 10, number % 10);
}

}  // namespace kerf::gcode
