// What the writers of all languages have in common: the walk along the steps, the position, files per tool,
// and what the machine cannot do.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "back/native/native.h"

namespace kerf::native {

class Writer {
 public:
  Writer(const Toolpath& path, const NativeOptions& options, NativeToolChange tool_change,
         Diagnostics& diagnostics);
  virtual ~Writer() = default;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  std::vector<NativeFile> run(Progress* progress);

 protected:
  enum class Speed : std::uint8_t { rapid, feed };
  virtual void open_file() = 0;
  virtual void close_file() = 0;
  /// A straight motion of `axes` (bits 1, 2, 4) to a position; the others stay. `feed` is that of a cut.
  virtual void straight(std::size_t i, Speed speed, Point3 to, unsigned axes, Feed feed) = 0;
  /// An arc in XY on one level of less than a whole turn, or a circle; by default as chords.
  virtual bool arc(std::size_t i, const ArcWalk& walk, Point3 to, Feed feed) = 0;
  virtual void spindle(std::size_t i, const step::Spindle& wanted) = 0;
  virtual void dwell(std::size_t i, Duration time) = 0;
  virtual void pause(std::size_t i) = 0;
  /// `in_use`: another tool has worked in this file before.
  virtual void change_tool(std::size_t i, int tool, bool in_use) = 0;
  virtual void comment(std::string_view text) = 0;

  /// Errors and warnings with the line of step `i`; `what` is given once per run.
  void cannot(std::size_t i, const std::string& what);
  void left_out(std::size_t i, const std::string& what);
  bool once(const std::string& what) { return reported_.insert(what).second; }
  const PathPosition& position() const { return position_; }
  /// The highest Z of the program, mm.
  std::optional<double> top() const { return top_; }

  const Toolpath& path_;
  const NativeOptions& options_;
  Diagnostics& diagnostics_;
  NativeToolChange tool_change_;
  std::string text_;
  bool moved_ = false;  // in this file

 private:
  void step(std::size_t i);
  void motion(std::size_t i);
  void straight_step(std::size_t i, Feed feed);
  void arc_step(std::size_t i, Feed feed);
  void chords(std::size_t i, const ArcWalk& walk, Point3 to, Feed feed);
  bool can_run(std::size_t i);
  std::optional<Feed> feed_of(std::size_t i);
  void machine_motion(std::size_t i);
  void approach(std::size_t i);
  void tool_step(std::size_t i);
  void zero_step(std::size_t i);
  void other_step(std::size_t i);
  void finish_file();

  std::vector<NativeFile> files_;
  std::optional<int> tool_;
  bool used_ = false;      // in this file: a tool with a number moved, or one without did more than rapids
  step::Spindle spindle_;  // wanted by the program
  std::optional<double> top_;
  PathPosition position_;
  std::set<std::string> reported_;
};

}  // namespace kerf::native
