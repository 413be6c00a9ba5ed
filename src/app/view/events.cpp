// The list of recent events and the pages that wait for the next.
#include "app/view/events.h"

#include <algorithm>

namespace kerf::app::view {
namespace {

constexpr std::size_t kKept = 64;  // a page that is further behind gets the state as a whole

}  // namespace

std::string event_text(const std::string& name, const std::string& data) {
  std::string line = data;
  for (char& c : line)
    if (c == '\n' || c == '\r') c = ' ';
  return "event: " + name + "\ndata: " + line + "\n\n";
}

void Events::publish(const std::string& name, const std::string& data) {
  const std::lock_guard lock(mutex_);
  if (name == "progress") {
    const auto is_progress = [](const Event& event) { return event.name == "progress"; };
    kept_.erase(std::remove_if(kept_.begin(), kept_.end(), is_progress), kept_.end());
  }
  kept_.push_back({++newest_, name, event_text(name, data)});
  if (kept_.size() > kKept) kept_.pop_front();
  changed_.notify_all();
}

void Events::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

bool Events::is_closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

std::uint64_t Events::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

std::optional<Events::Batch> Events::wait(std::uint64_t after, std::chrono::milliseconds timeout) const {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, timeout, [&] { return closed_ || newest_ > after; });
  if (closed_) return std::nullopt;
  Batch batch;
  batch.newest = newest_;
  batch.has_missed = newest_ > after + kKept;
  for (const Event& event : kept_)
    if (event.number > after) batch.text += event.text;
  return batch;
}

}  // namespace kerf::app::view
