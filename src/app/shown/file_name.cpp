// Other characters become "_".
#include "app/shown/file_name.h"

#include <algorithm>

namespace kerf::app::view {
namespace {

constexpr std::size_t kMaxName = 100;
constexpr std::string_view kKept = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.";

}  // namespace

std::string download_name(std::string_view name) {
  std::string out(name.substr(0, kMaxName));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return kKept.find(c) == std::string_view::npos; }, '_');
  if (out.empty() || out.front() == '.') out.insert(out.begin(), '_');
  return out;
}

}  // namespace kerf::app::view
