// Files of measured heights: which reader a file needs, lists of probes, and the heights of targets.
#include "kerf/formats/measured.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <unordered_map>

#include "base/codes/pathdxf.h"
#include "base/names.h"
#include "base/number.h"
#include "codec/heights/sink.h"

#include "kerf/base/limits.h"

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

Diagnostic& HeightsSink::error_at(std::size_t line, std::string_view part, std::string message) const {
  const auto at = static_cast<std::size_t>(part.data() - bytes.data());
  const std::size_t start = at == 0 ? std::string_view::npos : bytes.rfind('\n', at - 1);
  const std::size_t column = start == std::string_view::npos ? at + 1 : at - start;
  return diagnostics.error(
      codes::heights_format,
      TextLocation{out.file, static_cast<std::uint32_t>(line), static_cast<std::uint32_t>(column)},
      std::move(message));
}

std::optional<double> HeightsSink::number(std::size_t line, std::string_view field) const {
  const auto value = parse_number(field);
  if (!value)
    error_at(line, field,
             field.empty() ? std::string("expected a number, found an empty field")
                           : fmt::format("expected a number, found \"{}\"", clipped(field, 40)));
  return value;
}

std::optional<std::vector<double>> HeightsSink::numbers(std::size_t line,
                                                        const std::vector<std::string_view>& fields) const {
  std::vector<double> values;
  for (const std::string_view field : fields) {
    const auto value = number(line, field);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
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

std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  for (std::size_t i = 0; i <= line.size();) {
    const std::size_t end = std::min(line.find(separator, i), line.size());
    fields.push_back(trim(line.substr(i, end - i)));
    i = end + 1;
  }
  if (fields.size() > 1 && fields.back().empty()) fields.pop_back();
  return fields;
}

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view kBlanks = " \t";
  std::vector<std::string_view> words;
  for (std::size_t i = line.find_first_not_of(kBlanks); i != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, i), line.size());
    words.push_back(line.substr(i, end - i));
    i = line.find_first_not_of(kBlanks, end);
  }
  return words;
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
  std::vector<double> numbers;
  for (const std::string_view field : fields_of(rest.substr(0, rest.find_first_of("]|>:")), ',')) {
    const auto number = parse_number(field);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers.size() >= count ? std::optional(std::move(numbers)) : std::nullopt;
}

std::optional<std::string_view> binary_kind(std::string_view bytes) {
  const std::string_view start = bytes.substr(0, 4096);
  if (start.substr(0, 4) == "\x89PNG") return "a PNG picture";
  if (start.substr(0, 5) == "%PDF-") return "a PDF document";
  if (start.substr(0, 2) == "PK") return "a zip archive";
  if (start.find('\0') != std::string_view::npos) return "no text";
  return std::nullopt;
}

}  // namespace heights_detail

namespace {

using namespace heights_detail;

constexpr double kMaxVariable = 1e6;
constexpr double kSameHeight = 0.001;  // mm, of two results at one position
constexpr double kOnePosition = 0.05;  // mm, as of a grid's rows

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

/// Heights by position: those within kOnePosition of each other are found.
class PositionIndex {
 public:
  /// The line of the last height at this position, which `h` replaces.
  const MeasuredHeight* replace(const MeasuredHeight& h) {
    const auto cell_of = [](double v) { return static_cast<std::int64_t>(std::floor(v / kOnePosition)); };
    const std::int64_t i = cell_of((*h.at)[0]), j = cell_of((*h.at)[1]);
    const MeasuredHeight* found = nullptr;
    for (std::int64_t di = -1; di <= 1; ++di)
      for (std::int64_t dj = -1; dj <= 1; ++dj) {
        const auto known = cells_.find(key(i + di, j + dj));
        if (known == cells_.end()) continue;
        const MeasuredHeight& other = *known->second;
        if (std::hypot((*other.at)[0] - (*h.at)[0], (*other.at)[1] - (*h.at)[1]) <= kOnePosition &&
            (found == nullptr || other.line > found->line))
          found = &other;
      }
    cells_[key(i, j)] = &h;
    return found;
  }

 private:
  static std::uint64_t key(std::int64_t i, std::int64_t j) {
    return static_cast<std::uint64_t>(i) * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(j);
  }
  std::unordered_map<std::uint64_t, const MeasuredHeight*> cells_;
};

/// A warning where two results at one position, or of one probe, differ: the last one counts.
void compare_heights(const MeasuredFile& file, const MeasuredHeight& first, const MeasuredHeight& second,
                     Diagnostics& diagnostics) {
  if (!first.height || !second.height) return;
  const double difference = *second.height - *first.height;
  if (std::abs(difference) <= kSameHeight) return;
  diagnostics
      .warning(
          codes::heights_repeated, TextLocation{file.file, static_cast<std::uint32_t>(second.line), 0},
          fmt::format("the height at {}, {} is {} here and {} in line {}, a difference of {} mm; this one "
                      "counts",
                      fixed_text((*second.at)[0], 3), fixed_text((*second.at)[1], 3),
                      fixed_text(*second.height, 3), fixed_text(*first.height, 3), first.line,
                      fixed_text(std::abs(difference), 3)))
      .hint = "remove the line that is wrong, or measure the point again";
}

class HeightsReader {
 public:
  HeightsReader(std::string_view bytes, const std::string& file, const MeasuredOptions& options,
                Diagnostics& diagnostics)
      : bytes_(bytes), options_(options), diagnostics_(diagnostics) {
    out_.file = file;
  }

  MeasuredFile read() {
    const HeightsSink sink{out_, options_, diagnostics_, bytes_};
    if (const auto kind = binary_kind(bytes_)) {
      error(codes::heights_format, fmt::format("the file is {}; expected a text with heights", *kind)).hint =
          "specify the log, or the map itself, not a picture of it";
    } else if (is_probe_map(bytes_, out_.file)) {
      read_probe_map(bytes_, sink);
    } else if (const auto map = map_format(bytes_)) {
      out_.format = *map;
      read_map(*map, bytes_, sink);
    } else if (is_log(bytes_)) {
      out_.format = HeightsFormat::controller_log;
      read_log(bytes_, sink);
    } else if (const std::size_t sign = bytes_.find('#');
               sign != std::string_view::npos && bytes_.find('=', sign) != std::string_view::npos) {
      out_.format = HeightsFormat::probe_list;
      read_list();
    } else {
      read_positions(bytes_, sink);
    }
    if (out_.format != HeightsFormat::probe_list) compare_repeated();
    return std::move(out_);
  }

 private:
  Diagnostic& error(Code code, std::string message) {
    return diagnostics_.error(code, TextLocation{out_.file, static_cast<std::uint32_t>(line_), 0},
                              std::move(message));
  }
  void take_probe(std::string_view line);
  void read_list();
  void compare_repeated();

  std::string_view bytes_;
  const MeasuredOptions& options_;
  Diagnostics& diagnostics_;
  MeasuredFile out_;
  std::size_t line_ = 1;
};

void HeightsReader::read_list() {
  for_each_line(bytes_, [&](std::size_t line, std::string_view text) {
    line_ = line;
    take_probe(text);
    if (out_.heights.size() <= options_.max_heights) return true;
    error(codes::level_map, fmt::format("more than {} heights", options_.max_heights));
    return false;
  });
}

void HeightsReader::compare_repeated() {
  PositionIndex index;
  for (const MeasuredHeight& h : out_.heights)
    if (h.at && h.height && std::abs((*h.at)[0]) <= limits::kMaxCoordinate &&
        std::abs((*h.at)[1]) <= limits::kMaxCoordinate)
      if (const MeasuredHeight* other = index.replace(h)) compare_heights(out_, *other, h, diagnostics_);
}

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
  if (t != std::string_view::npos) {
    h.expected = comma_number(head.substr(t + 3, head.rfind(')') - t - 3));
    if (!h.expected) error(codes::heights_format, std::string(kFormat.in(options_.language)));
  }
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
    const auto [known, is_new] = found.emplace(target->variable, &h);
    if (is_new) continue;
    const MeasuredHeight& before = *known->second;
    if (h.variable)
      diagnostics.error(codes::heights_format, line_of(measured, h.line),
                        fmt::format(fmt::runtime(kTwice.in(language)), *h.variable));
    else if (std::hypot((*before.at)[0] - (*h.at)[0], (*before.at)[1] - (*h.at)[1]) > kOnePosition)
      compare_heights(measured, before, h, diagnostics);  // of one position: when the file is read
    known->second = &h;
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
