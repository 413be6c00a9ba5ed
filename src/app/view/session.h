// The file that is shown: a thread reads it, cuts it, and does so again after every save.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/view/events.h"
#include "app/view/script.h"
#include "app/view/target.h"
#include "app/view/tiles.h"
#include "app/view/watch.h"

#include "kerf/job.h"
#include "kerf/live_job.h"
#include "kerf/program.h"

namespace kerf::app::view {

/// How the file is read and run; read again with every change, as it depends on files too.
struct Inputs {
  JobSettings job;
  ProgramOptions program;
  std::optional<Target> target = {};
};
/// Whether the edges of a milled part are made exact once its file rests.
enum class IdleEdges : std::uint8_t { exact, columns };

struct SessionOptions {
  std::string file;
  std::vector<std::string> other_files = {};  // of tools, stock, fixtures: watched as well
  std::function<Inputs(Diagnostics&)> read_inputs;
  Length resolution = {};  // of the columns; 0: by the size of the stock, coarser than for files
  unsigned threads = 0;
  IdleEdges edges = IdleEdges::exact;
  std::chrono::milliseconds reading_limit{60'000};  // a program that is not read by then is stopped
};

enum class State : std::uint8_t { loading, ready, failed };

/// What pages show: the last good part, and the errors since. Never changes once published.
struct Shown {
  State state = State::loading;
  std::uint32_t revision = 0;
  std::string errors = "[]";  // JSON
  std::string model;          // members of the JSON object without braces; empty: no part yet
  std::shared_ptr<const std::string> path = std::make_shared<const std::string>();  // body of /path
  TileSet tiles;
  std::shared_ptr<const std::string> exact;   // body of /exact; null: not made, or not yet
  std::shared_ptr<const std::string> target;  // body of /target; null: none
  std::shared_ptr<const Job> job;
  Inputs inputs;  // of that job
};
/// The bodies of /model, and of the events that announce a state.
std::string model_body(const Shown& shown);
std::string model_event(const Shown& shown, std::size_t tiles);
std::string exact_event(const Shown& shown);
std::string errors_event(const Shown& shown);

class Session {
 public:
  Session(SessionOptions options, Events& events);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  std::shared_ptr<const Shown> shown() const;
  /// Of the last load.
  Diagnostics last_diagnostics() const;
  /// Reads and cuts once, on the calling thread.
  void load_once();
  /// Follows the file on a thread of its own.
  void start();
  void end();
  /// Stops the present reading or cutting.
  void stop_work();
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
  void load();
  bool load_part(Work& work, Diagnostics& diagnostics);
  std::optional<Job> read_job(Work& work, const Inputs& inputs, Diagnostics& diagnostics);
  bool publish_part(const LiveJobChange& change, const Inputs& inputs, Diagnostics& diagnostics, Work& work);
  void make_exact();
  void publish_errors(const Diagnostics& diagnostics);
  bool sleep(std::chrono::milliseconds time);
  std::optional<std::string> take_wanted();

  SessionOptions options_;
  Events& events_;
  FileWatch watch_;
  ScriptRun script_;
  std::mutex live_mutex_;  // of live_ and tiling_
  LiveJob live_;
  MeshTiling tiling_;

  mutable std::mutex mutex_;  // of what follows, up to ended_
  std::condition_variable wake_;
  Diagnostics last_diagnostics_;
  std::shared_ptr<const Shown> shown_ = std::make_shared<const Shown>();
  bool ended_ = false;
  std::optional<std::string> wanted_;  // the file to be followed next
  std::atomic<bool> stop_work_{false};
  int cancelled_ = 0;                                  // loads in a row that a further save stopped
  std::chrono::steady_clock::time_point loaded_at_{};  // used by the session's thread alone
  bool exact_tried_ = false;                           // of the part shown
  std::thread thread_;
};

}  // namespace kerf::app::view
