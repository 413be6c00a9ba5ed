// The toolpath of a running program: every motion complete, in mm, with the line and the calls that caused
// it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "front/gcmc/run/sink.h"
#include "front/gcmc/run/vm.h"

#include "kerf/drill.h"
#include "kerf/toolpath.h"

namespace kerf::gcmc {

class PathSink final : public Sink {
 public:
  PathSink(Toolpath& path, Vm& vm);

  void move(const Move& m) override;
  void arc(const ArcMove& m) override;
  void drill(const DrillMove& m) override;
  void broken_move(bool) override {}
  void feed_rate(double feed) override { feed_ = feed; }
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
  /// Text handed through that is not a whole line yet becomes one.
  void finish();

 private:
  OriginId origin();
  void motion(bool rapid, const Axes& to, unsigned named, double feed, OriginId where);
  class CycleSink;
  void go(const Axes& to, unsigned named);
  void note_motion(std::size_t step, unsigned named);
  Point3 position() const;
  Feed feed(double per_minute) const;
  void check_size();
  void count_text(std::size_t bytes);

  Toolpath& path_;
  Vm& vm_;
  double scale_;       // native length to mm
  double feed_ = 0.0;  // native per minute
  int feed_mode_ = 1;
  double speed_ = 0.0;
  SpindleTurn turn_ = SpindleTurn::off;
  Axes at_{};             // where the motions so far lead; native, with offsets
  Axes commanded_{};      // the same in the coordinates of the program
  unsigned unknown_ = 7;  // axes never commanded
  bool rotary_used_ = false;
  std::optional<double> series_start_;  // level before the first of the canned cycles; native
  std::size_t text_bytes_ = 0;
  std::string pending_;  // literal text before its end of line
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
