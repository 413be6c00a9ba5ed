// Numbers of tools, and the tool in use.
#include "design/machine/tool_in_use.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

#include "base/names.h"
#include "design/call/call.h"

namespace kerf::design {
namespace {

constexpr int kGenerated = 100'000;  // generated numbers have six digits
constexpr std::size_t kGeneratedDigits = 6;
constexpr double kSmall = 3.175, kSmallV = 6.35, kSame = 1e-6;  // mm: classes of tools by diameter
constexpr int kOFlutes[] = {282, 274, 278};
// Amana 45828 is known by two generated numbers.
constexpr int kTwice[][2] = {{808079, 45828}, {808071, 45828}};

/// Generated numbers that several makers' tools share; the table has each of them once.
constexpr int kShared[][2] = {{324, 100048}, {274, 100036}, {278, 100047},
                              {251, 100047}, {322, 100047}, {326, 100036}};

bool is_generated(const std::string& name) {
  return name.size() == kGeneratedDigits &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

ToolNumbers::ToolNumbers(const ToolTable& built_in) : all_(built_in) {
  for (const auto& [number, tool] : all_.tools()) {
    if (number >= kGenerated) continue;
    for (const std::string& name : tool.names)
      if (is_generated(name)) makers_.emplace(std::stoi(name), number);
  }
  for (const auto& [generated, maker] : kTwice) makers_[generated] = maker;
}

int ToolNumbers::maker_number(int number) const {
  const auto maker = makers_.find(number);
  const int found = maker == makers_.end() ? number : maker->second;
  if (all_.find(found) != nullptr) return found;
  std::vector<std::string> known;
  for (const auto& [n, tool] : all_.tools())
    if (n < kGenerated) known.push_back(std::to_string(n));
  refuse(fmt::format("tool_number: there is no tool {}; known: {}", number, joined(known, ", ")));
}

const Tool& ToolNumbers::tool(int number) const { return *all_.find(maker_number(number)); }

std::string ToolNumbers::generated_number(int number) const {
  const int maker = maker_number(number);
  for (const std::string& name : all_.find(maker)->names)
    if (is_generated(name)) return name;
  for (const auto& [number_of, generated] : kShared)
    if (number_of == maker) return std::to_string(generated);
  return std::to_string(maker);
}

void ToolNumbers::add(int number, Tool tool) {
  tool.number = number;
  all_.set(number, tool);
  own_.insert_or_assign(number, std::move(tool));
}

int ToolNumbers::free_number(int after) const {
  int number = after + 1;
  while (all_.find(number) != nullptr || makers_.count(number) != 0) ++number;
  return number;
}

std::string_view ToolInUse::shape() const {
  const bool is_o_flute =
      !described && std::find(std::begin(kOFlutes), std::end(kOFlutes), number) != std::end(kOFlutes);
  return is_o_flute ? "O-flute" : name_of(tool.shape);
}

std::string_view ToolInUse::feed_class() const {
  const std::string_view kind = shape();
  const bool small = diameter() <= (kind == "V" ? kSmallV : kSmall) + kSame;
  if (kind == "square" || kind == "O-flute") return small ? "small_square" : "large_square";
  if (kind == "ball") return small ? "small_ball" : "large_ball";
  if (kind == "V") return small ? "small_V" : "large_V";
  if (kind == "dovetail") return "DT";
  if (kind == "keyhole") return "KH";
  if (kind == "roundover") return "RO";
  return "MISC";
}

const std::vector<std::string>& feed_classes() {
  static const std::vector<std::string> names{"large_square", "small_square", "large_ball", "small_ball",
                                              "large_V",      "small_V",      "DT",         "KH",
                                              "RO",           "MISC"};
  return names;
}

double diameter_at(const Tool& tool, double height) {
  return 2 * tool.silhouette.cutting.radius_at(std::min(height, tool.flute.mm()));
}

}  // namespace kerf::design
