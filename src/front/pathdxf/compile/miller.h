// The operations of one path as steps: travel, holes, helices and chains of cuts.
#pragma once

#include <string_view>
#include <vector>

#include "front/pathdxf/compile/emitter.h"
#include "front/pathdxf/compile/frame.h"
#include "front/pathdxf/model/path.h"
#include "front/pathdxf/text/report.h"
#include "geom/base/box_tree.h"

namespace kerf::pathdxf {

class Miller {
 public:
  Miller(const Path& path, const Frame& frame, Emitter& out, Report& report)
      : path_(path), frame_(frame), out_(out), report_(report) {}

  void sweep(const Sweep& sweep);
  void drill(const Drill& drill, const Origin& where);
  void helix(const Helix& helix, const Origin& where);
  void chain(const Chain& chain, const Origin& where, const std::vector<OriginId>& origins);

 private:
  /// A segment of a chain with its passes.
  struct Pass {
    const MillSegment* segment;
    OriginId origin;
    std::vector<double> levels;  // downwards, mm in work coordinates
    std::size_t next = 0;        // level to be milled next
    Point2 start, end;           // work coordinates
  };

  double top() const { return path_.top + frame_.raise; }
  double sweep_height() const { return path_.sweep + frame_.raise; }

  void move_z(double to, double feed);
  void travel(Point3 to, double height, double feed);
  void comment_of(const MillingValues& values);
  bool has_depths(const MillingValues& values, const Origin& where);
  void check_bars(const MillingValues& values, double length, const Origin& where);
  double bottom_of(const MillingValues& values) const;
  std::vector<double> levels(double first, double infeed, double bottom, const Origin& where);
  bool passes_of(const Chain& chain, const Origin& where, const std::vector<OriginId>& origins,
                 std::vector<Pass>& passes);
  struct NextPass {
    std::size_t segment = 0;
    bool reversed = false;
  };
  class Tips;
  void greedy(std::vector<Pass>& passes);
  void slow(std::vector<Pass>& passes);
  void mill(const Pass& pass, double level, bool reversed);
  void mill_segment(const MillSegment& segment, double level, bool reversed);
  void mill_forwards(const MillSegment& s, double level);
  void mill_section(const MillSegment& segment, double from, double to, double from_z, double to_z);
  void line(Point2 from, Point2 to, double from_z, double to_z, double feed);
  void arc(Point2 centre, double radius, double start_angle, double turn, Point2 from, Point2 to,
           double from_z, double to_z, double feed);
  void helix_turns(const Helix& helix, double bottom, double infeed);
  void helix_bars(const Helix& helix, double infeed, const Origin& where);

  const Path& path_;
  const Frame& frame_;
  Emitter& out_;
  Report& report_;
  double helix_level_ = 0.0;  // of the last turn, as the statistics count it
};

}  // namespace kerf::pathdxf
