// A program that is edited in a page without a server: its files in memory, and the part that they make.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "app/shown/downloads.h"
#include "app/shown/printed.h"
#include "app/shown/shown.h"

namespace kerf::app::view {

class Workbench {
 public:
  /// `folder`: where files are kept, with a "/" at its end, or empty for the present one; in a browser it is
  /// in memory.
  explicit Workbench(std::string folder);

  /// Stores a file: one that is opened, or a new text of one. False, with problem(), if it cannot be stored.
  bool put(std::string_view name, std::string_view bytes);
  /// Reads and cuts the file of this name and shows it from now on. False if there are errors: shown() has
  /// them, and the last good part.
  bool load(std::string_view name, Progress* progress);
  /// Makes the edges of the shown part exact. False if stopped, and for parts that are not milled or too
  /// large.
  bool make_exact(Progress* progress);

  const Shown& shown() const { return shown_; }
  /// Data of the event that announces the last load: "model" or "errors".
  const std::string& event() const { return event_; }
  const std::string& problem() const { return problem_; }

  /// See LivePart::at().
  std::optional<std::string> at(std::uint32_t step, std::uint32_t from) const;
  Download download(const DownloadRequest& request) const;

 private:
  std::optional<Job> read(const std::string& file, const Inputs& inputs, Printed& printed,
                          Diagnostics& diagnostics, Progress* progress) const;

  std::string folder_;
  LivePart part_;
  Shown shown_;
  std::string event_, problem_;
};

}  // namespace kerf::app::view
