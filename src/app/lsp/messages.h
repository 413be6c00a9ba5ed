// Messages of JSON-RPC as the Language Server Protocol frames them: "Content-Length: 52", a blank line, JSON.
#pragma once

#include <condition_variable>
#include <cstdio>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>

namespace kerf::app::lsp {

using Json = nlohmann::json;

/// Reads one message; nothing at the end of the stream or where it is not framed so. A body that is no JSON
/// gives a discarded value. Bodies are limited to kMaxMessageBytes.
std::optional<Json> read_message(std::FILE* in);
/// Writes one message at once.
void write_message(std::FILE* out, const Json& message);

/// A thread that reads messages, so that a later one can stop the work on an earlier one. It ends with the
/// stream; a reader that waits for input does not hold up the end of the process.
class MessageQueue {
 public:
  explicit MessageQueue(std::FILE* in);
  /// The next message; nothing at the end of the stream.
  std::optional<Json> next();
  /// Whether a message waits.
  bool has_next();

 private:
  struct Shared {
    std::mutex mutex;
    std::condition_variable changed;
    std::deque<Json> waiting;
    bool has_ended = false;
  };
  std::shared_ptr<Shared> shared_;
};

}  // namespace kerf::app::lsp
