// Stock from files; flips, bars and shifts from text.
#include <cctype>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/stock.h"
#include "base/number.h"
#include "codec/mesh/column_files.h"

#include "kerf/base/limits.h"
#include "kerf/formats/mesh_files.h"
#include "kerf/formats/workshop_files.h"

namespace kerf {
namespace {

constexpr std::string_view kLeftEnding = ".kstock";

ColumnData data_of(const LeftColumns& left) {
  ColumnData data;
  for (int k = 0; k < 3; ++k) {
    data.low[static_cast<std::size_t>(k)] = left.bounds.low[k];
    data.high[static_cast<std::size_t>(k)] = left.bounds.high[k];
  }
  data.x = left.positions.x;
  data.y = left.positions.y;
  data.pitch = left.positions.pitch;
  data.nx = static_cast<std::uint32_t>(left.positions.nx);
  data.ny = static_cast<std::uint32_t>(left.positions.ny);
  data.first = left.columns.first;
  data.runs.reserve(left.columns.runs.size());
  for (const Run& run : left.columns.runs) data.runs.push_back({run.low, run.high});
  return data;
}

LeftColumns left_of(const ColumnData& data) {
  LeftColumns left;
  left.bounds.add(Point3{data.low[0], data.low[1], data.low[2]});
  left.bounds.add(Point3{data.high[0], data.high[1], data.high[2]});
  left.positions = {
      data.x, data.y, data.low[2], data.pitch, static_cast<int>(data.nx), static_cast<int>(data.ny)};
  left.columns.nx = left.positions.nx;
  left.columns.ny = left.positions.ny;
  left.columns.first = data.first;
  left.columns.runs.reserve(data.runs.size());
  for (const auto& run : data.runs) left.columns.runs.push_back({run[0], run[1]});
  return left;
}

/// The words of an option in lower case, commas as blanks.
std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (c == ' ' || c == ',' || c == '\t') {
      if (!words.back().empty()) words.emplace_back();
    } else {
      words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

std::optional<double> length_of(std::string_view text) {
  if (text.size() > 2 && text.substr(text.size() - 2) == "mm") text.remove_suffix(2);
  const auto value = parse_number(text);
  return value && std::abs(*value) <= limits::kMaxStockSize ? value : std::nullopt;
}

/// One word of a flip after its axis; false if it is invalid.
bool read_position(const std::string& word, StockMove& move) {
  if (word.size() < 3 || word[1] != '=') return false;
  const auto value = length_of(std::string_view(word).substr(2));
  const char across = move.flip == StockMove::Flip::about_x ? 'y' : 'x';
  if (!value || (word[0] != 'z' && word[0] != across)) return false;
  (word[0] == 'z' ? move.z : move.across) = value;
  return true;
}

}  // namespace

bool is_left_file(std::string_view name) {
  if (name.size() < kLeftEnding.size()) return false;
  const auto words = words_of(name.substr(name.size() - kLeftEnding.size()));
  return words.size() == 1 && words[0] == kLeftEnding;
}

bool is_stock_file(std::string_view name) { return is_left_file(name) || mesh_format_of(name).has_value(); }

std::optional<Stock> read_stock_file(std::string_view bytes, const std::string& name,
                                     Diagnostics& diagnostics, Progress* progress) {
  if (is_left_file(name)) {
    const auto data = read_columns(bytes, name, diagnostics);
    if (!data) return std::nullopt;
    return stock_of(make_columns_body(left_of(*data)));
  }
  const auto format = mesh_format_of(name);
  if (!format) {
    diagnostics
        .error(codes::mesh_file, TextLocation{name, 0, 0}, "the file ending is not that of a stock format")
        .hint = "supported: .stl .3mf .glb .obj (meshes), .kstock (left-over stock of an earlier job)";
    return std::nullopt;
  }
  const auto mesh = read_mesh(bytes, *format, name, diagnostics, {}, progress);
  if (!mesh) return std::nullopt;
  const auto body = make_mesh_body(mesh->positions, mesh->triangles, name, diagnostics, progress);
  if (!body) return std::nullopt;
  return stock_of(body);
}

std::string write_left_file(const LeftColumns& left) { return write_columns(data_of(left)); }

std::optional<StockMove> read_flip_option(std::string_view text, const Origin& where,
                                          Diagnostics& diagnostics) {
  std::vector<std::string> words = words_of(text.substr(0, limits::kMaxStockOptionBytes));
  if (!words.empty() && words[0] == "about") words.erase(words.begin());
  StockMove move;
  if (!words.empty() && words[0] == "x") move.flip = StockMove::Flip::about_x;
  if (!words.empty() && words[0] == "y") move.flip = StockMove::Flip::about_y;
  bool good = move.flip != StockMove::Flip::none && text.size() <= limits::kMaxStockOptionBytes;
  for (std::size_t k = 1; k < words.size(); ++k) good = good && read_position(words[k], move);
  if (good) return move;
  diagnostics.error(codes::stock_flip, where,
                    fmt::format("\"{}\" is not a flip; expected \"x\", \"x y=30 z=-6\" (by 180 degrees about "
                                "an axis along X through "
                                "Y30 Z-6) or \"y x=50 z=-6\"",
                                text.substr(0, 40)));
  return std::nullopt;
}

std::optional<RoundBar> read_rotary_option(std::string_view text, const Origin& where,
                                           Diagnostics& diagnostics) {
  RoundBar bar;
  double size = 0.0;
  bool good = text.size() <= limits::kMaxStockOptionBytes;
  for (const std::string& word : words_of(text.substr(0, limits::kMaxStockOptionBytes))) {
    const std::size_t equals = std::min(word.find('='), word.size());
    const std::string key = word.substr(0, equals);
    const auto value = length_of(std::string_view(word).substr(std::min(equals + 1, word.size())));
    double* const target = key == "d"        ? &bar.diameter
                           : key == "length" ? &size
                           : key == "x"      ? &bar.x_low
                           : key == "y"      ? &bar.axis_y
                           : key == "z"      ? &bar.axis_z
                                             : nullptr;
    good = good && target != nullptr && value.has_value();
    if (target != nullptr) *target = value.value_or(0.0);
  }
  bar.x_high = bar.x_low + size;
  if (good && bar.diameter > 0.0 && size > 0.0) return bar;
  diagnostics.error(
      codes::rotary_option, where,
      fmt::format("\"{}\" is not a bar; expected \"d=40 length=100\", and start and axis if they are not 0: "
                  "\"x=-5 y=0 z=12\", all in mm",
                  text.substr(0, 40)));
  return std::nullopt;
}

std::optional<Point3> read_shift_option(std::string_view text, const Origin& where,
                                        Diagnostics& diagnostics) {
  const std::vector<std::string> words = words_of(text.substr(0, limits::kMaxStockOptionBytes));
  Point3 shift;
  bool good = words.size() == 3 && text.size() <= limits::kMaxStockOptionBytes;
  for (int k = 0; k < 3 && good; ++k) {
    const auto value = length_of(words[static_cast<std::size_t>(k)]);
    good = value.has_value();
    shift[k] = value.value_or(0.0);
  }
  if (good) return shift;
  diagnostics.error(codes::stock_flip, where,
                    fmt::format("\"{}\" is not a shift; expected three lengths in mm, such as \"10,0,-3\"",
                                text.substr(0, 40)));
  return std::nullopt;
}

}  // namespace kerf
