// The file that is shown: a thread reads it, cuts it, and does so again after every save.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/shown/printed.h"
#include "app/shown/shown.h"
#include "app/view/events.h"
#include "app/view/script.h"
#include "app/view/watch.h"
#include "job/record/record.h"

#include "kerf/job/job.h"
#include "kerf/job/program.h"

namespace kerf::app::view {

/// Whether the edges of a milled part are made exact once its file rests.
enum class IdleEdges : std::uint8_t { exact, columns };

struct SessionOptions {
  std::string file;
  std::vector<std::string> other_files = {};                   // of tools, stock, fixtures: watched as well
  std::function<Inputs(Diagnostics&, Progress*)> read_inputs;  // called for every change, as files are read
  Length resolution = {};  // of the columns; 0: by the size of the stock, coarser than for files
  unsigned threads = 0;
  IdleEdges edges = IdleEdges::exact;
  std::vector<std::string> frame_origins = {};      // of pages that may have the page in a frame
  std::chrono::milliseconds reading_limit{60'000};  // a program that is not read by then is stopped
};

class Session {
 public:
  Session(SessionOptions options, Events& events);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  std::shared_ptr<const Shown> shown() const;
  /// Of the last load.
  Diagnostics last_diagnostics() const;
  /// The findings of a failed load, once after each.
  std::optional<Diagnostics> take_failure();
  /// Reads and cuts once, on the calling thread.
  void load_once();
  /// Follows the file on a thread of its own.
  void start();
  void end();
  /// Stops the present reading or cutting.
  void stop_work();
  /// The progress of the present work as the data of an event; empty while there is none.
  std::string work() const;
  /// Reads the file again, and all further ones, with this unit of drawings that specify none.
  void use_unit(Length unit);
  /// Follows another file from now on.
  void open(std::string file);

  /// The body of /at: the tiles that may differ between two states, at `step`. Nothing if the part is not a
  /// milled one; empty while another part is being cut.
  std::optional<std::string> at(std::uint32_t step, std::uint32_t from);

  const SessionOptions& options() const { return options_; }

 private:
  class Work;
  void follow();
  void settle();
  void announce();
  /// When errors are shown: a file that was saved a moment ago may not be written in full.
  enum class Errors : std::uint8_t { at_once, once_still };
  void load(Errors errors);
  bool is_still() const;
  void show_errors(const Diagnostics& diagnostics);
  bool load_part(Work& work, Diagnostics& diagnostics);
  struct Read {
    std::optional<Job> job;
    Diagnostics diagnostics;
  };
  class Relay;
  std::optional<Read> read_apart(Work& work, std::function<Read(Progress&)> read);
  std::optional<Job> read_job(Work& work, const Inputs& inputs, Diagnostics& diagnostics);
  void publish(Shown next);
  void publish_progress(std::string_view phase, Record fraction);
  void publish_result(const std::string& name, Shown next,
                      const std::function<std::string(const Shown&)>& event_of);
  void make_exact();
  void publish_errors(const Diagnostics& diagnostics);
  bool sleep(std::chrono::milliseconds time);
  std::optional<std::string> take_wanted();
  std::optional<Length> take_wanted_unit();

  SessionOptions options_;
  Events& events_;
  FileWatch watch_;
  ScriptRun script_;
  Printed printed_;             // by the program; used by the session's thread alone
  std::optional<Length> unit_;  // of drawings, used by the session's thread alone
  std::mutex live_mutex_;       // of part_
  LivePart part_;

  mutable std::mutex mutex_;  // of what follows, up to ended_
  std::condition_variable wake_;
  Diagnostics last_diagnostics_;
  std::optional<Diagnostics> failure_;
  std::shared_ptr<const Shown> shown_ = std::make_shared<const Shown>();
  bool ended_ = false;
  std::optional<std::string> wanted_;  // the file to be followed next
  std::optional<Length> wanted_unit_;  // of drawings, chosen on a page
  std::string work_;                   // progress of a load
  std::uint32_t input_ = 0;            // how often the files have changed
  std::atomic<bool> stop_work_{false};
  int cancelled_ = 0;                                  // loads in a row that a further save stopped
  std::chrono::steady_clock::time_point loaded_at_{};  // used by the session's thread alone
  std::optional<Diagnostics> held_;  // errors, until the files are still; used by the session's thread alone
  // The first load whose errors have been held; used by the session's thread alone
  std::optional<std::chrono::steady_clock::time_point> failing_since_;
  std::future<Read> abandoned_;  // of reading that was stopped; used by the session's thread alone
  bool exact_tried_ = false;     // of the part shown
  std::thread thread_;
};

}  // namespace kerf::app::view
