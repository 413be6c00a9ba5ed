// A part as pages show it: what is published after each change, and the run that is kept up to date between
// changes. The server of kerf view and the page in WebAssembly both use it, so that they show the same.
#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "app/shown/burn.h"
#include "app/shown/motions.h"
#include "app/shown/sources.h"
#include "app/shown/target.h"
#include "app/shown/tiles.h"

#include "kerf/job/job.h"
#include "kerf/job/live_job.h"
#include "kerf/job/program.h"

namespace kerf::app::view {

/// How a file is read and run.
struct Inputs {
  JobSettings job;
  ProgramOptions program;
  std::optional<Target> target = {};
  BurnSettings burn = {};
  std::optional<Length> unit = {};  // of drawings that specify none
};

enum class State : std::uint8_t { loading, ready, failed };

/// What pages show: the last good part, and the errors since. Never changes once published.
struct Shown {
  State state = State::loading;
  std::uint32_t revision = 0;
  std::uint32_t input = 0;    // how often the files had changed when they were read
  std::string errors = "[]";  // JSON
  std::string model;          // members of the JSON object without braces; empty: no part yet
  std::string console;        // what the program has printed last
  std::string timing;         // of the header Server-Timing: ms of each stage
  std::shared_ptr<const Sources> sources = std::make_shared<const Sources>();  // of the part
  std::string files = "[]";                                                    // JSON of them
  std::string failed;  // JSON: name and files of the program with errors; empty: none
  std::shared_ptr<const Sources> failed_sources = std::make_shared<const Sources>();
  /// A block of a source; null if there is none with this id.
  std::shared_ptr<const std::string> source_block(std::uint32_t id) const;
  std::shared_ptr<const PathBlocks> path = std::make_shared<const PathBlocks>();
  TileSet tiles;
  std::shared_ptr<const std::string> exact;   // body of /exact; null: not made, or not yet
  std::shared_ptr<const std::string> target;  // body of /target; null: none
  std::shared_ptr<const Job> job;
  Inputs inputs;  // of that job
};
/// The bodies of /model, and of the events that announce a state.
std::string model_body(const Shown& shown);
/// For a page without a server.
std::string exported_model_body(const Shown& shown);
std::string model_event(const Shown& shown, std::size_t tiles);
std::string exact_event(const Shown& shown);
std::string errors_event(const Shown& shown);
/// The last good part with the errors of a program that cannot be shown, and the texts of `file` and of the
/// files that the errors name; larger ones than `whole` bytes in blocks.
Shown with_errors(const Shown& before, const std::string& file, const Diagnostics& diagnostics,
                  std::size_t whole = kWholeText);

struct PartOptions {
  Length resolution = {};  // of the columns; 0: by the size of the stock, coarser than for files
  unsigned threads = 0;
  std::size_t whole_text = kWholeText;  // bytes; larger sources are in blocks
};

/// The run of the shown job. Not for several threads at a time.
class LivePart {
 public:
  explicit LivePart(PartOptions options) : options_(options) {}

  struct Update {
    Shown shown;
    std::size_t changed_tiles = 0;
  };
  /// Runs a job and makes what follows `before`. Nothing, with an error or stopped, if it cannot be shown.
  std::optional<Update> update(Job job, const Inputs& inputs, const Shown& before, Diagnostics& diagnostics,
                               Progress* progress);
  /// The body of /at: the tiles that may differ between two states, at `step`. Nothing if the part is not a
  /// milled one.
  std::optional<std::string> at(std::uint32_t step, std::uint32_t from, std::uint32_t revision) const;
  /// `before` with exact edges. Nothing if stopped, and for parts that are not milled or too large.
  std::optional<Shown> exact(const Shown& before, Progress* progress) const;

 private:
  /// What does not depend on the cut.
  struct Apart {
    PathBlocks path;
    Sources sources;
    double path_ms = 0.0, sources_ms = 0.0;
  };
  Apart make_apart(const Job& job, const Inputs& inputs, const Shown& before) const;
  std::optional<Update> publish(const LiveJobChange& change, const Inputs& inputs, const Shown& before,
                                std::future<Apart> apart, Diagnostics& diagnostics, Progress* progress);

  PartOptions options_;
  LiveJob live_;
  MeshTiling tiling_;
};

}  // namespace kerf::app::view
