// Replacing the marks of the page.
#include "app/view/page.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <vector>
#include <zlib.h>

#include "app/shown/binary.h"
#include "app/shown/downloads.h"
#include "app/view/access.h"
#include "base/names.h"
#include "embedded_view_page.h"

namespace kerf::app::view {
namespace {

constexpr std::string_view kNonce = "KERF_NONCE", kData = "<!--KERF_DATA-->", kFrames = "KERF_FRAMES";
constexpr std::size_t kInstantBytes = std::size_t{24} << 20, kMinInstants = 4,
                      kMaxInstants = 48;              // of an export
constexpr std::string_view kFullPage = "index.html";  // the other one is minimal.html

/// The text with each `mark` replaced.
std::string replaced(std::string_view text, std::string_view mark, std::string_view by) {
  std::string out;
  for (std::size_t at = 0;;) {
    const std::size_t next = text.find(mark, at);
    out.append(text.substr(at, next - at));
    if (next == std::string_view::npos) return out;
    out.append(by);
    at = next + mark.size();
  }
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::array<unsigned, 3> group{};
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - k);
    for (std::size_t i = 0; i < count; ++i) group[i] = static_cast<unsigned char>(bytes[k + i]);
    const unsigned all = group[0] << 16 | group[1] << 8 | group[2];
    for (std::size_t i = 0; i < 4; ++i) out += i <= count ? kDigits[all >> (18 - 6 * i) & 63u] : '=';
  }
  return out;
}

std::string data_block(std::string_view name, std::string_view bytes) {
  return fmt::format(
      "<script type=\"text/plain\" id=\"kerf-{}\" data-encoding=\"deflate-base64\" "
      "nonce=\"{}\">{}</script>\n",
      name, kNonce, packed(bytes));
}

/// Parts on the way, each as the bytes of /at from the one before, with their length before them. Many where
/// they are small.
std::string instants_of(Session& session, const Shown& shown) {
  if (!shown.job) return {};
  const std::size_t steps = shown.job->program.path.size();
  const std::size_t size = shown.tiles.changed_since(0, shown.revision).size();
  const std::size_t count =
      std::min(std::clamp(kInstantBytes / std::max<std::size_t>(size, 1), kMinInstants, kMaxInstants), steps);
  std::string all;
  std::uint32_t from = kWholeJob;
  for (std::size_t k = 0; k < count; ++k) {
    const auto step = static_cast<std::uint32_t>(steps * k / count);
    const auto body = session.at(step, from);
    if (!body || body->empty()) return {};
    BinaryWriter length;
    length.number(static_cast<std::uint32_t>(body->size()));
    all += length.take() + *body;
    from = step;
  }
  return all;
}

}  // namespace

bool has_full_page() { return embedded::view_page[0].name == kFullPage; }
std::string_view page_text() { return embedded::view_page[0].bytes; }

Page served_page(const std::vector<std::string>& frame_origins) {
  const std::string nonce = random_token(), frames = joined(frame_origins, " ");
  Page page;
  page.html = replaced(replaced(replaced(page_text(), kData, ""), kFrames, frames), kNonce, nonce);
  page.policy = fmt::format(
      "default-src 'none'; script-src 'nonce-{}' 'wasm-unsafe-eval'; style-src 'nonce-{}' 'unsafe-inline'; "
      "img-src data: blob:; worker-src blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
      "frame-ancestors {}",
      nonce, nonce, frames.empty() ? "'none'" : frames);
  return page;
}

std::string exported_page(Session& session) {
  const auto kept = session.shown();
  const Shown& shown = *kept;
  const Download gcode = make_download(shown, {"gcode", "grbl", ""}, session.options().threads);
  const Download burn = make_download(shown, {"burn", "", ""}, session.options().threads);
  const std::string blocks = data_block("model", exported_model_body(shown)) +
                             data_block("mesh", shown.tiles.changed_since(0, shown.revision)) +
                             data_block("path", shown.path->body(0)) +
                             (shown.target ? data_block("target", *shown.target) : std::string()) +
                             (burn.problem.empty() ? data_block("burn", burn.bytes) : std::string()) +
                             data_block("instants", instants_of(session, shown)) +
                             (gcode.problem.empty() ? data_block("gcode", gcode.bytes) : std::string());
  const std::string page = replaced(page_text(), kFrames, joined(session.options().frame_origins, " "));
  return replaced(replaced(page, kData, blocks), kNonce, random_token());
}

std::string packed(std::string_view bytes) {
  const auto length = static_cast<uLong>(bytes.size());  // 32 bits on Windows; the page is smaller
  uLongf size = compressBound(length);
  std::string out(size, '\0');
  compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()), length,
            Z_DEFAULT_COMPRESSION);
  out.resize(size);
  return base64(out);
}

}  // namespace kerf::app::view
