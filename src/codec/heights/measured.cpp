// Files of measured heights: one reader for each form of line.
#include "kerf/formats/measured.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "base/codes/pathdxf.h"
#include "base/names.h"
#include "base/number.h"
#include "codec/heights/sink.h"

namespace kerf {

namespace heights_detail {

Diagnostic& HeightsSink::error(Code code, std::size_t line, std::string message) const {
  return diagnostics.error(code, TextLocation{out.file, static_cast<std::uint32_t>(line), 0},
                           std::move(message));
}

Diagnostic& HeightsSink::warning(Code code, std::size_t line, std::string message) const {
  return diagnostics.warning(code, TextLocation{out.file, static_cast<std::uint32_t>(line), 0},
                             std::move(message));
}

bool HeightsSink::add(std::size_t line, double x, double y, std::optional<double> z,
                      double mm_per_unit) const {
  MeasuredHeight h;
  h.line = line;
  h.at = {x * mm_per_unit, y * mm_per_unit};
  if (z) h.height = *z * mm_per_unit;
  out.heights.push_back(std::move(h));
  if (out.heights.size() <= options.max_heights) return true;
  error(codes::level_map, line, fmt::format("more than {} heights", options.max_heights));
  return false;
}

void for_each_line(std::string_view bytes, const std::function<bool(std::size_t, std::string_view)>& visit) {
  std::size_t line = 1;
  for (std::size_t i = 0; i < bytes.size(); ++line) {
    const std::size_t end = std::min(bytes.find('\n', i), bytes.size());
    const std::string_view text = trim(bytes.substr(i, end - i));
    if (!text.empty() && !visit(line, text)) return;
    i = end + 1;
  }
}

std::optional<std::vector<double>> numbers_of(std::string_view line, std::string_view separators,
                                              std::size_t max_count) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < line.size() && numbers.size() <= max_count;) {
    const std::size_t start = std::min(line.find_first_not_of(separators, i), line.size());
    const std::size_t end = std::min(line.find_first_of(separators, start), line.size());
    if (start == end) break;
    const auto number = parse_number(line.substr(start, end - start));
    if (!number) return std::nullopt;
    numbers.push_back(*number);
    i = end;
  }
  return numbers;
}

std::optional<std::vector<double>> values_after(std::string_view line, std::string_view key,
                                                std::size_t count) {
  const std::size_t at = line.find(key);
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view rest = line.substr(at + key.size());
  auto numbers = numbers_of(rest.substr(0, rest.find_first_of("]|>:")), ",");
  return numbers && numbers->size() >= count ? numbers : std::nullopt;
}

}  // namespace heights_detail

namespace {

using heights_detail::for_each_line;
using heights_detail::HeightsSink;
using heights_detail::is_log;
using heights_detail::map_format;
using heights_detail::numbers_of;
using heights_detail::read_log;
using heights_detail::read_map;

constexpr double kMaxVariable = 1e6;
constexpr std::size_t kMaxNumbers = 16;  // of a line of positions

constexpr Bilingual kFormat{"Line does not have format '(comment) #...=value'",
                            "Zeile hat nicht das Format '(Kommentar) #...=Wert'"};
constexpr Bilingual kNoNumber{"Value '{}' for #{} is not a valid number",
                              "Wert '{}' für #{} ist keine gültige Zahl"};

constexpr Bilingual kDeviation{"Value {} for #{} differs from {} by more than /m={}",
                               "Wert {} für #{} weicht von {} um mehr als /m={} ab"};

constexpr Bilingual kTwice{"#{} is specified a second time", "#{} mehrfach angegeben"};

std::optional<double> comma_number(std::string_view text) {
  std::string number(trim(text));
  std::replace(number.begin(), number.end(), ',', '.');
  return parse_number(number);
}

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

/// The numbers of a line of positions. A comma is a decimal point where semicolons or blanks separate the
/// numbers ("1,5;2;0,1", "1,5 2 0,1"), else it separates them ("1.5,2,0.1"). Nothing where it may be either.
std::optional<std::vector<double>> position_numbers(std::string_view line) {
  const std::size_t comma = line.find(',');
  if (comma == std::string_view::npos) return numbers_of(line, " \t;");
  bool is_decimal = line.find(';') != std::string_view::npos;
  if (!is_decimal) {
    std::size_t fields = 0;
    bool comma_at_end = false;
    for (std::size_t i = 0; i < line.size();) {
      const std::size_t start = std::min(line.find_first_not_of(" \t", i), line.size());
      const std::size_t end = std::min(line.find_first_of(" \t", start), line.size());
      if (start == end) break;
      ++fields;
      comma_at_end = comma_at_end || line[start] == ',' || line[end - 1] == ',';
      i = end;
    }
    is_decimal = fields > 1 && !comma_at_end;
  }
  if (is_decimal) {
    std::string with_points(line);
    std::replace(with_points.begin(), with_points.end(), ',', '.');
    return line.find('.') == std::string_view::npos ? numbers_of(with_points, " \t;") : std::nullopt;
  }
  auto numbers = numbers_of(line, " \t,");
  const bool is_ambiguous = numbers && numbers->size() > 3 && line.find('.') == std::string_view::npos;
  return is_ambiguous ? std::nullopt : std::move(numbers);
}

class HeightsReader {
 public:
  HeightsReader(std::string_view bytes, const std::string& file, const MeasuredOptions& options,
                Diagnostics& diagnostics)
      : bytes_(bytes), options_(options), diagnostics_(diagnostics) {
    out_.file = file;
  }

  MeasuredFile read() {
    const std::size_t sign = bytes_.find('#');
    const HeightsSink sink{out_, options_, diagnostics_};
    if (const auto map = map_format(bytes_)) {
      out_.format = *map;
      read_map(*map, bytes_, sink);
      return std::move(out_);
    }
    if (is_log(bytes_)) {
      out_.format = HeightsFormat::controller_log;
      read_log(bytes_, sink);
      return std::move(out_);
    }
    const bool is_list = sign != std::string_view::npos && bytes_.find('=', sign) != std::string_view::npos;
    out_.format = is_list ? HeightsFormat::probe_list : HeightsFormat::positions;
    for_each_line(bytes_, [&](std::size_t line, std::string_view text) {
      line_ = line;
      if (is_list)
        take_probe(text);
      else
        take_position(text);
      if (out_.heights.size() <= options_.max_heights) return true;
      error(codes::level_map, fmt::format("more than {} heights", options_.max_heights));
      return false;
    });
    if (!is_list) remove_limits(), scale();
    return std::move(out_);
  }

 private:
  Diagnostic& error(Code code, std::string message) {
    return diagnostics_.error(code, TextLocation{out_.file, static_cast<std::uint32_t>(line_), 0},
                              std::move(message));
  }
  void take_probe(std::string_view line);
  void take_position(std::string_view line);
  void remove_limits();
  void scale();

  std::string_view bytes_;
  const MeasuredOptions& options_;
  Diagnostics& diagnostics_;
  MeasuredFile out_;
  std::size_t line_ = 1;
};

/// "([1 2]/L:left/T=5) #51=5.1" or "@[1|2] #2001=5,1".
void HeightsReader::take_probe(std::string_view line) {
  MeasuredHeight h;
  h.line = line_;
  const std::size_t sign = line.find('#');
  const std::size_t equals = sign == std::string_view::npos ? sign : line.find('=', sign);
  const std::string_view head = line.substr(0, std::min(sign, line.size()));
  const std::size_t open = head.find('['), close = head.find(']');
  const bool has_point = open != std::string_view::npos && close != std::string_view::npos && open < close;
  const std::size_t t = head.rfind("/T=");
  std::optional<double> variable;
  if (equals != std::string_view::npos)
    variable = parse_number(trim(line.substr(sign + 1, equals - sign - 1)));
  const bool of_document = !head.empty() && head[0] == '@';
  const std::string_view value =
      equals == std::string_view::npos ? std::string_view() : trim(line.substr(equals + 1));
  const bool has_variable =
      variable && *variable == std::floor(*variable) && *variable >= 0.0 && *variable <= kMaxVariable;
  // Without a value the point is kept: another file may have it.
  if (!has_variable || (!value.empty() && t == std::string_view::npos && !of_document)) {
    error(codes::heights_format, std::string(kFormat.in(options_.language)));
    return;
  }
  h.variable = static_cast<int>(*variable);
  if (t != std::string_view::npos) h.expected = comma_number(head.substr(t + 3, head.rfind(')') - t - 3));
  if (has_point)
    if (const auto xy = numbers_of(head.substr(open + 1, close - open - 1), " |\t"); xy && xy->size() == 2)
      h.at = {(*xy)[0], (*xy)[1]};
  if (const std::size_t label = head.find("/L:"); label != std::string_view::npos)
    h.label = std::string(head.substr(label + 3, std::min(t, head.size()) - label - 3));
  h.height = comma_number(value);
  if (!value.empty() && !h.height)
    error(codes::heights_format,
          fmt::format(fmt::runtime(kNoNumber.in(options_.language)), clipped(value), *h.variable));
  out_.heights.push_back(std::move(h));
}

void HeightsReader::take_position(std::string_view line) {
  if (line[0] == ';' || line[0] == '(' || line[0] == '#') return;
  const auto numbers = position_numbers(line);
  if (!numbers && line_ == 1 && std::any_of(line.begin(), line.end(), is_letter)) return;  // column names
  if (!numbers || numbers->size() < 3 || numbers->size() > kMaxNumbers) {
    error(codes::heights_format, "expected numbers: x y z").hint =
        "separate numbers that have decimal commas by semicolons or blanks";
    return;
  }
  MeasuredHeight h;
  h.line = line_;
  h.at = {(*numbers)[0], (*numbers)[1]};
  h.height = (*numbers)[2];
  out_.heights.push_back(std::move(h));
}

/// Removes the lines "xmin xmax count", "ymin ymax count", "zmin zmax feed" of a .probe file.
void HeightsReader::remove_limits() {
  std::vector<MeasuredHeight>& all = out_.heights;
  if (all.size() < 3 + 4) return;
  const auto is_limits = [](const MeasuredHeight& h) {
    return (*h.at)[0] < (*h.at)[1] && *h.height >= 2.0 && *h.height == std::floor(*h.height);
  };
  if (is_limits(all[0]) && is_limits(all[1]) &&
      *all[0].height * *all[1].height == static_cast<double>(all.size() - 3))
    all.erase(all.begin(), all.begin() + 3);
}

/// Positions in the unit of the options.
void HeightsReader::scale() {
  const double unit = options_.mm_per_unit.value_or(1.0);
  for (MeasuredHeight& h : out_.heights) {
    (*h.at)[0] *= unit, (*h.at)[1] *= unit;
    *h.height *= unit;
  }
}

TextLocation line_of(const MeasuredFile& measured, std::size_t line) {
  return {measured.file, static_cast<std::uint32_t>(line), 0};
}

using Matches = std::map<int, const MeasuredHeight*>;  // by variable

/// The target of a height: by its variable, or the nearest one.
const HeightTarget* target_of(const MeasuredHeight& h, const std::vector<HeightTarget>& targets,
                              Length within) {
  const HeightTarget* found = nullptr;
  double nearest = within.mm();
  for (const HeightTarget& t : targets) {
    if (h.variable && t.variable == *h.variable) return &t;
    if (h.variable || !h.at) continue;
    const double d = std::hypot(t.at[0] - (*h.at)[0], t.at[1] - (*h.at)[1]);
    if (d > nearest) continue;
    nearest = d;
    found = &t;
  }
  return found;
}

Matches match(const MeasuredFile& measured, const std::vector<HeightTarget>& targets, Length within,
              Language language, Diagnostics& diagnostics) {
  Matches found;
  for (const MeasuredHeight& h : measured.heights) {
    const HeightTarget* target = target_of(h, targets, within);
    if (target == nullptr) {
      diagnostics.warning(codes::heights_unmatched, line_of(measured, h.line),
                          h.variable ? fmt::format("#{} is no probe of the program", *h.variable)
                                     : fmt::format("[{} {}] is at none of the program's probes",
                                                   fixed_text((*h.at)[0], 3), fixed_text((*h.at)[1], 3)));
      continue;
    }
    const bool is_new = found.insert_or_assign(target->variable, &h).second;
    if (!is_new && h.variable)
      diagnostics.error(codes::heights_format, line_of(measured, h.line),
                        fmt::format(fmt::runtime(kTwice.in(language)), *h.variable));
  }
  return found;
}

}  // namespace

MeasuredFile read_measured(std::string_view bytes, const std::string& file, const MeasuredOptions& options,
                           Diagnostics& diagnostics) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";  // of UTF-8
  if (bytes.substr(0, kMark.size()) == kMark) bytes.remove_prefix(kMark.size());
  return HeightsReader(bytes, file, options, diagnostics).read();
}

std::map<int, double> heights_of(const MeasuredFile& measured, const std::vector<HeightTarget>& targets,
                                 Length within, Length max_correction, Language language,
                                 Diagnostics& diagnostics) {
  const Matches found = match(measured, targets, within, language, diagnostics);
  std::map<int, double> values;
  for (const HeightTarget& t : targets) {
    const auto entry = found.find(t.variable);
    if (entry == found.end()) {
      diagnostics.error(codes::heights_missing, TextLocation{measured.file, 0, 0},
                        fmt::format("no height for probe #{} at [{} {}]", t.variable, fixed_text(t.at[0], 3),
                                    fixed_text(t.at[1], 3)));
      continue;
    }
    const MeasuredHeight& h = *entry->second;
    const TextLocation where = line_of(measured, h.line);
    if (!h.height && h.variable) {
      diagnostics.error(codes::heights_format, where, std::string(kFormat.in(language))).hint =
          "enter the measured height after the equals sign";
      continue;
    }
    if (!h.height) {
      diagnostics.error(codes::heights_missing, where,
                        fmt::format("probe #{} was measured without contact", t.variable));
      continue;
    }
    const std::optional<double> expected = h.expected ? h.expected : t.expected;
    if (expected && std::abs(*expected - *h.height) > max_correction.mm())
      diagnostics.error(
          codes::heights_deviation, where,
          fmt::format(fmt::runtime(kDeviation.in(language)), number_text(*expected, 6), t.variable,
                      number_text(*h.height, 6), number_text(max_correction.mm(), 6)));
    values.emplace(t.variable, *h.height);
  }
  return values;
}

}  // namespace kerf
