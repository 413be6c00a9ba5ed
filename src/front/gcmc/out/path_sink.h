// The toolpath of a running program: complete motions in mm, each with its line and the calls that led to it.
//
// A call has the effect of the words of its text form on a controller, so that the toolpath is that of the
// G-code: axes that a call does not name do not move; in inverse time a feed is valid for its own motion
// only.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "front/gcmc/run/sink.h"
#include "front/gcmc/run/vm.h"
#include "path/feed_mode.h"

#include "kerf/op/holes.h"
#include "kerf/path/toolpath.h"

namespace kerf::gcmc {

class PathSink final : public Sink {
 public:
  PathSink(Toolpath& path, Vm& vm);

  void move(const Move& m) override;
  void arc(const ArcMove& m) override;
  void drill(const DrillMove& m) override;
  void broken_move(bool) override {}
  void feed_rate(double feed) override;
  void feed_mode(int mode) override;
  void spindle(double speed) override;
  void spindle_speed(double speed) override;
  void coolant(int bits) override;
  void tool_change(int tool, bool length_offset) override;
  void dwell(double seconds) override;
  void path_mode(bool exact, std::optional<double> p, std::optional<double> q) override;
  void pause(bool optional) override;
  void plane(Plane) override {}
  void comment(std::string_view text) override;
  void literal(std::string_view text) override;
  void store_position(bool second) override;
  void restore_position(bool second, const Axes& via, unsigned named, const Axes& end) override;
  void layer(const std::string& name) override;
  void close_path() override;
  /// To be called when the program has ended; steps added then have the location `end_of_text`.
  void finish(const TextLocation& end_of_text);

 private:
  /// False after the program's end; an error if a line of literal() is not ended.
  bool is_active() { return !needs_check_ || check_pending(); }
  bool check_pending();
  OriginId origin();
  class CycleSink;
  void go(const Axes& to, unsigned named);
  void note_motion(std::size_t step, unsigned named);
  void rapid(const Axes& to, unsigned named, OriginId where);
  Point3 position() const { return {at_[0] * scale_, at_[1] * scale_, at_[2] * scale_}; }
  double straight_feed(double given, Point3 from, Point3 to) const;
  double modal_feed() const;
  void turn_spindle(SpindleTurn turn, OriginId where);
  void set_speed(double speed, OriginId where);
  void change_tool(int tool, OriginId where);
  void end(step::End how, OriginId where);
  void written_text(std::string_view text);
  void written_line(std::string_view text);
  void check_size();
  void count_text(std::size_t bytes);

  Toolpath& path_;
  Vm& vm_;
  double scale_;       // native length to mm
  bool draws_;         // SVG or DXF, for which no G-code is written
  double feed_ = 0.0;  // in native lengths, by the feed mode
  FeedMode feed_mode_ = FeedMode::per_minute;
  std::optional<double> speed_;  // rpm
  SpindleTurn turn_ = SpindleTurn::off;
  step::Coolant coolant_;
  std::optional<int> selected_tool_;  // by a T word without M6
  Axes at_{};                         // position after the motions so far; native, with offsets
  Axes commanded_{};                  // the same in the coordinates of the program
  unsigned unknown_ = 7;              // axes never commanded
  bool moved_ = false, rotary_used_ = false;
  std::optional<double> series_start_;  // level before the first of the canned cycles; native
  struct Home {
    Point3 at;  // mm
    unsigned unknown = 7;
  };
  std::array<Home, 2> homes_;
  std::size_t text_bytes_ = 0;
  std::string pending_;       // text of a line that is not ended
  bool needs_check_ = false;  // pending_ is not empty, or the program has ended
  bool ended_ = false;
  struct Key {
    std::uint64_t site;
    OriginId caller;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& k) const {
      return static_cast<std::size_t>((k.site * 0x9E3779B97F4A7C15u) ^
                                      (static_cast<std::uint64_t>(k.caller) << 20));
    }
  };
  OriginId origin_at(std::size_t instruction, OriginId caller);
  std::unordered_map<Key, OriginId, KeyHash> origins_;
  Key last_key_{~std::uint64_t{0}, OriginId::none};
  OriginId last_origin_ = OriginId::none;
};

}  // namespace kerf::gcmc
