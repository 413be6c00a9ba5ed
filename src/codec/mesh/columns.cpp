// Reads and writes .kstock files, see column_files.h.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

#include "base/codes/stock.h"
#include "codec/mesh/column_files.h"
#include "codec/mesh/readers.h"
#include "codec/mesh/writers.h"

#include "kerf/base/limits.h"

namespace kerf {
namespace {

constexpr std::string_view kMagic = "KERFSTK1";

void append_double(std::string& out, double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  mesh_format::append_little(out, static_cast<std::uint32_t>(bits));
  mesh_format::append_little(out, static_cast<std::uint32_t>(bits >> 32));
}

void append_count(std::string& out, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) out += static_cast<char>((value & 0x7f) | 0x80);
  out += static_cast<char>(value);
}

/// Reads bytes from the front; after the end all values are 0 and `failed` is true.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : bytes_(bytes) {}
  bool failed() const { return failed_; }
  bool empty() const { return at_ == bytes_.size(); }
  template <class T>
  T number() {
    if (bytes_.size() - at_ < sizeof(T)) {
      failed_ = true;
      return T{};
    }
    const T value = mesh_format::little_at<T>(bytes_, at_);
    at_ += sizeof(T);
    return value;
  }
  double real() {
    const std::uint64_t low = number<std::uint32_t>(), high = number<std::uint32_t>();
    const std::uint64_t bits = low | high << 32;
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof bits);
    return value;
  }
  std::uint64_t count() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 35; shift += 7) {
      const auto byte = number<std::uint8_t>();
      value |= std::uint64_t{byte & 0x7fu} << shift;
      if ((byte & 0x80u) == 0) return value;
    }
    failed_ = true;
    return 0;
  }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

bool valid_head(const ColumnData& data) {
  for (std::size_t k = 0; k < 3; ++k)
    if (!(std::abs(data.low[k]) <= limits::kMaxCoordinate) ||
        !(std::abs(data.high[k]) <= limits::kMaxCoordinate) || !(data.low[k] < data.high[k]))
      return false;
  return std::abs(data.x) <= limits::kMaxCoordinate && std::abs(data.y) <= limits::kMaxCoordinate &&
         data.pitch > 0.0 && data.pitch <= limits::kMaxCoordinate && data.nx > 0 && data.ny > 0;
}

/// Whether the runs of a column are within the block, in order and separate.
bool read_runs(Bytes& bytes, std::uint64_t count, float height, std::vector<std::array<float, 2>>& runs) {
  float above = 0.0f;
  for (std::uint64_t k = 0; k < count; ++k) {
    const float low = bytes.number<float>(), high = bytes.number<float>();
    if (bytes.failed() || !(low >= above) || !(high > low) || !(high <= height)) return false;
    runs.push_back({low, high});
    above = high;
  }
  return true;
}

bool read_groups(Bytes& bytes, ColumnData& data, const ColumnLimits& limits) {
  const std::size_t columns = std::size_t{data.nx} * data.ny;
  const auto height = static_cast<float>(data.high[2] - data.low[2]);
  data.first.push_back(0);
  std::vector<std::array<float, 2>> runs;
  while (data.first.size() <= columns) {
    const std::uint64_t times = bytes.count(), count = bytes.count();
    runs.clear();
    if (bytes.failed() || times == 0 || times > columns + 1 - data.first.size()) return false;
    if (count > limits.runs || !read_runs(bytes, count, height, runs)) return false;
    if (times * count > limits.runs - std::min(limits.runs, data.runs.size())) return false;
    for (std::uint64_t k = 0; k < times; ++k) {
      data.runs.insert(data.runs.end(), runs.begin(), runs.end());
      data.first.push_back(static_cast<std::uint32_t>(data.runs.size()));
    }
  }
  return bytes.empty();
}

}  // namespace

std::string write_columns(const ColumnData& data) {
  std::string out(kMagic);
  for (const auto& corner : {data.low, data.high})
    for (const double v : corner) append_double(out, v);
  for (const double v : {data.x, data.y, data.pitch}) append_double(out, v);
  mesh_format::append_little(out, data.nx);
  mesh_format::append_little(out, data.ny);
  const auto same = [&data](std::size_t a, std::size_t b) {
    return std::equal(data.runs.data() + data.first[a], data.runs.data() + data.first[a + 1],
                      data.runs.data() + data.first[b], data.runs.data() + data.first[b + 1]);
  };
  const std::size_t columns = data.first.empty() ? 0 : data.first.size() - 1;
  for (std::size_t n = 0; n < columns;) {
    std::size_t end = n + 1;
    while (end < columns && same(n, end)) ++end;
    append_count(out, end - n);
    append_count(out, data.first[n + 1] - data.first[n]);
    for (std::uint32_t k = data.first[n]; k < data.first[n + 1]; ++k)
      for (const float v : data.runs[k]) mesh_format::append_little(out, v);
    n = end;
  }
  return out;
}

std::optional<ColumnData> read_columns(std::string_view bytes, const std::string& name,
                                       Diagnostics& diagnostics, const ColumnLimits& limits) {
  const auto refuse = [&](std::string message) {
    diagnostics.error(codes::stock_left_file, TextLocation{name, 0, 0}, std::move(message));
    return std::nullopt;
  };
  if (bytes.substr(0, kMagic.size()) != kMagic)
    return refuse("the file does not start as left-over stock does");
  Bytes rest(bytes.substr(kMagic.size()));
  ColumnData data;
  for (double& v : data.low) v = rest.real();
  for (double& v : data.high) v = rest.real();
  for (double* v : {&data.x, &data.y, &data.pitch}) *v = rest.real();
  data.nx = rest.number<std::uint32_t>();
  data.ny = rest.number<std::uint32_t>();
  if (rest.failed() || !valid_head(data)) return refuse("the block or the columns of the file are invalid");
  if (std::uint64_t{data.nx} * data.ny > limits.columns)
    return refuse(fmt::format("the file has more than {} columns", limits.columns));
  if (!read_groups(rest, data, limits)) return refuse("the columns in the file are damaged, or too many");
  return data;
}

}  // namespace kerf
