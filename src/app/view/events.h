// Events for the pages: every page gets each one, a slow page only the newest progress.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

namespace kerf::app::view {

class Events {
 public:
  /// `data` is one line of JSON.
  void publish(const std::string& name, const std::string& data);
  /// Ends all waiting, for good.
  void close();
  bool is_closed() const;

  /// The number of the newest event; a new page waits for those after it.
  std::uint64_t newest() const;
  struct Batch {
    std::string text;          // in the form of server-sent events; empty after a timeout
    std::uint64_t newest = 0;  // number of the last one
    bool has_missed = false;   // older ones are gone: the page needs the whole state
  };
  /// The events after number `after`; waits for one up to `timeout`. Nothing once closed.
  std::optional<Batch> wait(std::uint64_t after, std::chrono::milliseconds timeout) const;

 private:
  struct Event {
    std::uint64_t number;
    std::string name, text;
  };
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::deque<Event> kept_;
  std::uint64_t newest_ = 0;
  bool closed_ = false;
};

/// One event in the form of server-sent events.
std::string event_text(const std::string& name, const std::string& data);

}  // namespace kerf::app::view
