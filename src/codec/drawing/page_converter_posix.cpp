// Code pages by iconv.
#include "codec/drawing/page_converter.h"

#if defined(__EMSCRIPTEN__)
namespace kerf::dxf {

std::unique_ptr<PageConverter> PageConverter::open(int) { return nullptr; }

}  // namespace kerf::dxf
#elif !defined(_WIN32)
#include <fmt/format.h>
#include <iconv.h>

#include "codec/drawing/code_page.h"

namespace kerf::dxf {
namespace {

constexpr char32_t kReplacement = 0xFFFD;

/// The name of a page for iconv.
std::string iconv_name(int page) {
  if (page >= 28591 && page <= 28606) return fmt::format("ISO-8859-{}", page - 28590);
  if (page == 10000) return "MACINTOSH";
  if (page == 1361) return "JOHAB";
  if (page == 949) return "UHC";
  if (page == 950) return "BIG5";
  return fmt::format("CP{}", page);
}

class Iconv final : public PageConverter {
 public:
  explicit Iconv(iconv_t state) : state_(state) {}
  Iconv(const Iconv&) = delete;
  Iconv& operator=(const Iconv&) = delete;
  ~Iconv() override { iconv_close(state_); }

  bool append(std::string& out, std::string_view bytes) override {
    iconv(state_, nullptr, nullptr, nullptr, nullptr);
    std::string copy(bytes);
    char* at = copy.data();
    std::size_t left = copy.size();
    bool valid = true;
    while (left > 0) {
      char room[256];
      char* to = room;
      std::size_t space = sizeof room;
      const std::size_t result = iconv(state_, &at, &left, &to, &space);
      out.append(room, static_cast<std::size_t>(to - room));
      if (result != static_cast<std::size_t>(-1) || space < 8) continue;
      append_utf8(out, kReplacement);
      valid = false;
      if (left == 0) break;
      ++at;
      --left;
    }
    return valid;
  }

 private:
  iconv_t state_;
};

}  // namespace

std::unique_ptr<PageConverter> PageConverter::open(int page) {
  const iconv_t state = iconv_open("UTF-8", iconv_name(page).c_str());
  // NOLINTNEXTLINE: iconv_open's documented failure
  if (state == reinterpret_cast<iconv_t>(-1)) return nullptr;
  return std::make_unique<Iconv>(state);
}

}  // namespace kerf::dxf
#endif
