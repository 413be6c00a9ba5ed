// Divides motions into blocks that an edit elsewhere does not change.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "app/shown/binary.h"
#include "app/shown/path_blocks.h"

#include "kerf/base/origin.h"
#include "kerf/geom/geometry.h"

namespace kerf::app::view {

/// Numbers of one kind in a block, written in the fewest bytes that hold all of them.
class Column {
 public:
  void add(std::uint32_t value) { values_.push_back(value); }
  void add(float value);
  /// Small whole numbers of both signs.
  void add_difference(std::int64_t difference);
  void write(BinaryWriter& out) const;
  void clear() { values_.clear(); }
  std::size_t size() const { return values_.size(); }
  /// The value that was added last.
  std::uint32_t& back() { return values_.back(); }

 private:
  std::vector<std::uint32_t> values_;
};

/// The locations of a block's motions in the sources, with the calls that led there. Lines count from those
/// of groups, one for each file and depth of calls: lines inserted between a subroutine and its calls change
/// nothing but these.
class BlockOrigins {
 public:
  /// `names`: the files by their numbers.
  BlockOrigins(const OriginTable& table, const std::vector<std::string>& names);

  /// The number of a location in the block.
  std::uint32_t number(OriginId id);
  void write(BinaryWriter& out) const;
  std::vector<std::uint32_t> take_lines();
  std::size_t size() const { return count_; }
  /// For the next block.
  void clear();

 private:
  struct Group {
    std::uint32_t file, depth, first_line;
    std::int64_t last_line;  // that was added
  };
  struct Known {
    std::uint32_t group, line, caller, number;
    bool is_used = false;
  };
  std::uint32_t add(const Origin& origin, std::uint32_t caller, std::uint32_t depth);
  std::uint32_t group_of(std::uint32_t file, std::uint32_t depth, std::uint32_t line);
  std::uint32_t file_number(const std::string& name);

  const OriginTable& table_;
  std::unordered_map<std::string, std::uint32_t> file_;
  std::string last_name_;
  std::uint32_t last_file_;
  std::vector<Group> groups_;
  std::vector<Known> known_;  // by a hash: a location that is not found again is stored twice
  Column group_, line_, caller_;
  std::uint32_t count_ = 0;
  OriginId last_id_ = OriginId::none;
  std::uint32_t last_ = 0;
  bool has_last_ = false;
};

/// One motion without its points.
struct ShownMotion {
  std::uint32_t step = 0;
  std::uint8_t kind = 0;
  std::int32_t tool = -1;
  OriginId origin = OriginId::none;
  float seconds = 0.0f, feed = 0.0f, flow = 0.0f, power = 0.0f;
  std::uint8_t bead = 0;
};

class BlockMaker {
 public:
  BlockMaker(const OriginTable& table, const std::vector<std::string>& names);

  /// A motion along these points, none if its position is unknown.
  void add(const ShownMotion& motion, const std::vector<Point3>& points);
  /// More time for the last motion.
  void add_seconds(float more);
  /// The whole path. Blocks of `before` with the same bytes keep their ids.
  PathBlocks finish(const PathBlocks& before, std::uint32_t revision);

 private:
  struct Made {
    std::string bytes;
    std::uint32_t motions, points, origins, first_step;
    std::vector<std::uint32_t> lines;
  };
  void end_block();
  std::uint32_t add_points(const std::vector<Point3>& points, bool& is_joined);

  BlockOrigins origins_;
  Column step_, count_, kind_, tool_, origin_, seconds_, feed_, flow_, power_, bead_;
  std::vector<float> points_;
  std::uint32_t first_step_ = 0;
  std::int64_t last_origin_ = -1;
  bool is_full_ = false;  // the next motion is in a new block
  std::vector<Made> made_;
};

}  // namespace kerf::app::view
