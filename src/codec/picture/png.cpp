// Writes PNG. Bands of rows are filtered and compressed on all threads, each ended at a byte of the stream,
// so that their concatenation is one stream. The bytes do not depend on the number of threads.
#if KERF_WITH_PNG

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <vector>
#include <zlib.h>

#include "base/parallel.h"
#include "codec/picture/image_files.h"

namespace kerf {
namespace {

constexpr int kMaxSide = 1'000'000;  // pixels: what readers accept
constexpr std::size_t kBandBytes = std::size_t{1} << 19;
constexpr int kLevel = 4;        // of zlib; 6 takes twice as long for 3 % fewer bytes
constexpr int kRawStream = -15;  // windowBits of a stream without head and checksum

void append_number(std::string& out, std::size_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xff);
}

void append_chunk(std::string& out, const std::string& kind, const std::string& data) {
  append_number(out, data.size());
  const std::size_t from = out.size();
  out += kind;
  out += data;
  const auto* bytes = reinterpret_cast<const Bytef*>(out.data() + from);
  append_number(out, crc32_z(crc32_z(0, nullptr, 0), bytes, out.size() - from));
}

/// The rows of an image as the bytes of a PNG, without alpha if all pixels are opaque.
class Rows {
 public:
  explicit Rows(const ImageView& image)
      : image_(image), width_(static_cast<std::size_t>(image.width)), channels_(4) {
    std::uint8_t all = 255;
    const std::size_t size = 4 * width_ * static_cast<std::size_t>(image.height);
    for (std::size_t k = 3; k < size; k += 4) all &= image.rgba[k];
    if (all == 255) channels_ = 3;
  }
  bool has_alpha() const { return channels_ == 4; }
  std::size_t bytes() const { return channels_ * width_; }
  /// Row y after kChannels bytes that are 0; row -1 is 0.
  void read(int y, std::vector<std::uint8_t>& row) const {
    row.assign(channels_ + bytes(), 0);
    if (y < 0) return;
    const std::uint8_t* from = image_.rgba.data() + 4 * width_ * static_cast<std::size_t>(y);
    for (std::size_t x = 0; x < width_; ++x)
      for (std::size_t c = 0; c < channels_; ++c) row[channels_ * (x + 1) + c] = from[4 * x + c];
  }
  std::size_t channels() const { return channels_; }

 private:
  const ImageView& image_;
  std::size_t width_, channels_;
};

std::uint8_t paeth(int left, int up, int corner) {
  const int guess = left + up - corner;
  const int to_left = std::abs(guess - left), to_up = std::abs(guess - up),
            to_corner = std::abs(guess - corner);
  if (to_left <= to_up && to_left <= to_corner) return static_cast<std::uint8_t>(left);
  return static_cast<std::uint8_t>(to_up <= to_corner ? up : corner);
}

enum Filter : std::uint8_t { none = 0, sub = 1, up = 2, paeth_filter = 4 };  // as in the file

/// A row with its filter's number in front; `row` and `above` as from Rows::read. Returns the sum of the
/// differences' sizes, which is small for rows that compress well.
template <Filter kFilter>
long filter_row(const std::vector<std::uint8_t>& row, const std::vector<std::uint8_t>& above,
                std::size_t channels, std::vector<std::uint8_t>& out) {
  const std::size_t count = row.size() - channels;
  out.resize(1 + count);
  out[0] = kFilter;
  const std::uint8_t *now = row.data() + channels, *before = row.data(), *high = above.data() + channels,
                     *corner = above.data();
  long sum = 0;
  for (std::size_t k = 0; k < count; ++k) {
    std::uint8_t guess = 0;
    if constexpr (kFilter == sub) guess = before[k];
    if constexpr (kFilter == up) guess = high[k];
    if constexpr (kFilter == paeth_filter) guess = paeth(before[k], high[k], corner[k]);
    const auto difference = static_cast<std::uint8_t>(now[k] - guess);
    out[1 + k] = difference;
    sum += std::abs(static_cast<int>(static_cast<std::int8_t>(difference)));
  }
  return sum;
}

/// A part of the stream, and what its checksum is made of.
struct Band {
  std::string compressed;
  uLong adler = adler32(0, nullptr, 0);
  std::size_t size = 0;  // before compression
};

/// The filtered rows from `first` to `end`.
std::vector<std::uint8_t> filtered(const Rows& rows, int first, int end) {
  std::vector<std::uint8_t> out, row, above;
  std::array<std::vector<std::uint8_t>, 4> tries;
  rows.read(first - 1, above);
  for (int y = first; y < end; ++y) {
    rows.read(y, row);
    const std::array<long, 4> sums{filter_row<none>(row, above, rows.channels(), tries[0]),
                                   filter_row<sub>(row, above, rows.channels(), tries[1]),
                                   filter_row<up>(row, above, rows.channels(), tries[2]),
                                   filter_row<paeth_filter>(row, above, rows.channels(), tries[3])};
    const auto best = static_cast<std::size_t>(std::min_element(sums.begin(), sums.end()) - sums.begin());
    out.insert(out.end(), tries[best].begin(), tries[best].end());
    std::swap(row, above);
  }
  return out;
}

/// An empty string if memory is short.
Band compressed(const std::vector<std::uint8_t>& bytes, bool is_last) {
  Band band;
  band.size = bytes.size();
  band.adler = adler32_z(band.adler, bytes.data(), bytes.size());
  z_stream stream{};
  if (deflateInit2(&stream, kLevel, Z_DEFLATED, kRawStream, MAX_MEM_LEVEL, Z_FILTERED) != Z_OK) return band;
  band.compressed.resize(deflateBound(&stream, static_cast<uLong>(bytes.size())) + 64);
  stream.next_in = const_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(band.compressed.data());
  stream.avail_out = static_cast<uInt>(band.compressed.size());
  const int result = deflate(&stream, is_last ? Z_FINISH : Z_FULL_FLUSH);
  const bool is_done = result == (is_last ? Z_STREAM_END : Z_OK) && stream.avail_in == 0;
  band.compressed.resize(is_done ? band.compressed.size() - stream.avail_out : 0);
  deflateEnd(&stream);
  return band;
}

/// All rows as one stream of zlib; empty if memory is short.
std::string stream_of(const Rows& rows, int height) {
  const auto each = static_cast<int>(std::clamp<std::size_t>(kBandBytes / (rows.bytes() + 1), 1, 4096));
  const auto count = static_cast<std::size_t>((height + each - 1) / each);
  std::vector<Band> bands(count);
  const auto work = [&](std::size_t n) {
    const int first = static_cast<int>(n) * each, end = std::min(first + each, height);
    bands[n] = compressed(filtered(rows, first, end), n + 1 == count);
  };
  parallel_for(thread_count(0), count, work, [] { return false; });
  std::string stream = "\x78\x5e";
  uLong adler = adler32(0, nullptr, 0);
  for (const Band& band : bands) {
    if (band.compressed.empty()) return {};
    stream += band.compressed;
    adler = adler32_combine(adler, band.adler, static_cast<z_off_t>(band.size));
  }
  append_number(stream, adler);
  return stream;
}

}  // namespace

std::string write_png(const ImageView& image) {
  if (image.width <= 0 || image.height <= 0 || std::max(image.width, image.height) > kMaxSide) return {};
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  if (image.rgba.size() / 4 / width < height) return {};
  const Rows rows(image);
  const std::string stream = stream_of(rows, image.height);
  if (stream.empty()) return {};
  std::string head, gamma, chromaticities, out = "\x89PNG\r\n\x1a\n";
  append_number(head, width);
  append_number(head, height);
  head += std::string{'\10', rows.has_alpha() ? '\6' : '\2', '\0', '\0',
                      '\0'};  // bits per channel, kind of pixel, usual methods
  append_number(gamma, 45455);
  for (const std::size_t c : {31270UL, 32900UL, 64000UL, 33000UL, 30000UL, 60000UL, 15000UL, 6000UL})
    append_number(chromaticities, c);
  append_chunk(out, "IHDR", head);
  append_chunk(out, "sRGB",
               std::string(1, '\0'));  // perceptual; then the same for readers that do not know it
  append_chunk(out, "gAMA", gamma);
  append_chunk(out, "cHRM", chromaticities);
  constexpr std::size_t kMaxChunk = std::size_t{1} << 30;
  for (std::size_t from = 0; from < stream.size(); from += kMaxChunk)
    append_chunk(out, "IDAT", stream.substr(from, kMaxChunk));
  append_chunk(out, "IEND", "");
  return out;
}

}  // namespace kerf

#endif  // KERF_WITH_PNG
