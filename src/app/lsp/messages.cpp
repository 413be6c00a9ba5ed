// Messages of JSON-RPC with their lengths, and the thread that reads them.
#include "app/lsp/messages.h"

#include <fmt/format.h>
#include <memory>

#include "base/names.h"
#include "base/number.h"

namespace kerf::app::lsp {
namespace {

constexpr std::size_t kMaxMessageBytes = std::size_t{256} << 20;
constexpr std::size_t kMaxHeaderBytes = 4096;  // of one line
constexpr std::size_t kMaxWaiting = 10'000;

/// A line of the header without its end; nothing at the end of the stream, or if it is too long.
std::optional<std::string> header_line(std::FILE* in) {
  std::string line;
  for (int c = std::getc(in); c != EOF; c = std::getc(in)) {
    if (c == '\n') {
      if (!line.empty() && line.back() == '\r') line.pop_back();
      return line;
    }
    if (line.size() == kMaxHeaderBytes) return std::nullopt;
    line += static_cast<char>(c);
  }
  return std::nullopt;
}

/// The length of the body; nothing if the header does not state one.
std::optional<std::size_t> body_length(std::FILE* in) {
  constexpr std::string_view kLength = "content-length:";
  std::optional<std::size_t> length;
  for (auto line = header_line(in); line; line = header_line(in)) {
    if (line->empty()) return length;
    if (fold_name(line->substr(0, kLength.size())) != fold_name(kLength)) continue;
    const auto value = parse_number(trim(std::string_view(*line).substr(kLength.size())));
    if (value && *value >= 0.0 && *value <= static_cast<double>(kMaxMessageBytes))
      length = static_cast<std::size_t>(*value);
  }
  return std::nullopt;
}

}  // namespace

std::optional<Json> read_message(std::FILE* in) {
  const auto length = body_length(in);
  if (!length) return std::nullopt;
  std::string body(*length, '\0');
  if (std::fread(body.data(), 1, body.size(), in) != body.size()) return std::nullopt;
  return Json::parse(body, nullptr, false);
}

void write_message(std::FILE* out, const Json& message) {
  const std::string body = message.dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::string framed = fmt::format("Content-Length: {}\r\n\r\n{}", body.size(), body);
  std::fwrite(framed.data(), 1, framed.size(), out);
  std::fflush(out);
}

MessageQueue::MessageQueue(std::FILE* in) : shared_(std::make_shared<Shared>()) {
  std::thread([shared = shared_, in] {
    for (auto message = read_message(in); message; message = read_message(in)) {
      std::unique_lock lock(shared->mutex);
      shared->changed.wait(lock, [&] { return shared->waiting.size() < kMaxWaiting; });
      shared->waiting.push_back(std::move(*message));
      shared->changed.notify_all();
    }
    const std::lock_guard lock(shared->mutex);
    shared->has_ended = true;
    shared->changed.notify_all();
  }).detach();
}

std::optional<Json> MessageQueue::next() {
  std::unique_lock lock(shared_->mutex);
  shared_->changed.wait(lock, [&] { return !shared_->waiting.empty() || shared_->has_ended; });
  if (shared_->waiting.empty()) return std::nullopt;
  Json message = std::move(shared_->waiting.front());
  shared_->waiting.pop_front();
  shared_->changed.notify_all();
  return message;
}

bool MessageQueue::has_next() {
  const std::lock_guard lock(shared_->mutex);
  return !shared_->waiting.empty() || shared_->has_ended;
}

}  // namespace kerf::app::lsp
